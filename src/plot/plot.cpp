#include "plot/axis.hpp"
#include "plot/label.hpp"
#include "plot/polyline.hpp"
#include "plot/style.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// From top to bottom: title, panels (legend, frame), tick labels, label of the shared axis. All lengths in px.
namespace maupertuis {
namespace {

constexpr double tick_size = 12, label_size = 14, title_size = 16, line_height = 20, gap = 14;
constexpr double radian_in_degrees = 57.295779513082323;

// One quantity to draw, from a column or from the times.
struct Series {
  std::string name, unit;
  double factor = 1;             // shown = factor · value
  std::size_t column = 0;
  bool is_time = false;

  double at(const Trajectory& trajectory, std::size_t row) const {
    return factor * (is_time ? trajectory.times[row] : trajectory.at(row, column));
  }
};

struct Panel {
  std::string unit;
  std::vector<Series> series;
  double top = 0, height = 0;    // of the frame
  double legend_height = 0;
};

struct Figure {
  const Trajectory& trajectory;
  const PlotOptions& options;
  Series horizontal;
  std::vector<Panel> panels;
  double left = 0, right = 0, bottom = 0, height = 0;
  double frame_width() const { return right - left; }
};

Series series_of(const Trajectory& trajectory, const std::string& name, bool degrees) {
  const std::size_t column = *trajectory.column(name);
  Series series{name, trajectory.columns[column].unit, 1, column, false};
  if (degrees && series.unit.compare(0, 3, "rad") == 0 && (series.unit.size() == 3 || series.unit[3] == '/')) {
    series.factor = radian_in_degrees;
    series.unit = "°" + series.unit.substr(3);
  }
  return series;
}

std::vector<Panel> group_by_unit(const Trajectory& trajectory, const PlotOptions& options) {
  std::vector<std::string> names = options.columns;
  if (names.empty())
    for (const auto& column : trajectory.columns)
      if (column.name != options.against) names.push_back(column.name);
  std::vector<Panel> panels;
  for (const auto& name : names) {
    const Series series = series_of(trajectory, name, options.degrees);
    auto panel = std::find_if(panels.begin(), panels.end(), [&](const Panel& p) { return p.unit == series.unit; });
    if (panel == panels.end()) panel = panels.insert(panel, Panel{series.unit, {}, 0, 0, 0});
    panel->series.push_back(series);
  }
  if (panels.empty()) panels.emplace_back();
  return panels;
}

Range range_of(const Trajectory& trajectory, const std::vector<Series>& series) {
  Range range;
  for (const Series& one : series)
    for (std::size_t row = 0; row < trajectory.rows(); ++row) range.include(one.at(trajectory, row));
  return range;
}

// "θ₁, θ₂ (10⁻³ rad from 2 rad)"
RichText axis_text(const std::vector<std::string>& names, const std::string& unit, const Axis& axis) {
  RichText text = names_text(names);
  if (unit.empty() && axis.exponent() == 0 && axis.offset() == 0) return text;
  append(text, " (");
  if (axis.exponent() != 0) append(text, power_of_ten(axis.exponent()));
  if (axis.exponent() != 0 && !unit.empty()) append(text, "\u2009");
  append(text, unit_text(unit));
  if (axis.offset() != 0)
    append(text, fmt::format("{}from {}", unit.empty() && axis.exponent() == 0 ? "" : " ", axis.offset_label()));
  append(text, ")");
  return text;
}

std::vector<std::string> names_of(const std::vector<Series>& series) {
  std::vector<std::string> names;
  for (const Series& one : series) names.push_back(one.name);
  return names;
}

std::string text_element(double x, double y, std::string_view anchor, double size, const RichText& text,
                         std::string_view more = {}) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\"{}>{}</text>\n", x, y, anchor,
                     size, more, to_svg(text, size));
}

// --------------------------------------------------------------------------------------------------------- legend

struct LegendEntry {
  std::size_t series;
  RichText text;
  double width;
};

// The curves' names; of very many the first, the last and some between. A single curve is named by its axis.
std::vector<LegendEntry> legend_entries(const Panel& panel) {
  std::vector<LegendEntry> entries;
  const std::size_t count = panel.series.size();
  if (count < 2) return entries;
  const std::size_t stride = (count + 11) / 12;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % stride != 0 && i + 1 != count) continue;
    const RichText text = name_text(panel.series[i].name);
    entries.push_back({i, text, 26 + text_width(text, label_size) + 14});
  }
  return entries;
}

// Lines of entries that fit into the width.
std::vector<std::vector<LegendEntry>> legend_rows(const Panel& panel, double width) {
  std::vector<std::vector<LegendEntry>> rows;
  double used = 0;
  for (const LegendEntry& entry : legend_entries(panel)) {
    if (rows.empty() || used + entry.width > width) {
      rows.emplace_back();
      used = 0;
    }
    rows.back().push_back(entry);
    used += entry.width;
  }
  return rows;
}

// Above the frame, so that it never covers a curve.
std::string draw_legend(const Panel& panel, const Figure& figure) {
  std::string svg;
  double y = panel.top - panel.legend_height + 12;
  for (const auto& row : legend_rows(panel, figure.frame_width())) {
    double x = figure.left;
    for (const LegendEntry& entry : row) {
      svg += fmt::format("<path class=\"curve {} d=\"M{:.1f} {:.1f}h20\"/>",
                         series_attributes(entry.series, panel.series.size()), x, y - 4);
      svg += text_element(x + 26, y, "start", label_size, entry.text);
      x += entry.width;
    }
    y += line_height;
  }
  return svg;
}

// ---------------------------------------------------------------------------------------------------------- curves

Polyline pixels_of(const Figure& figure, const Panel& panel, const Series& series, const Axis& across, const Axis& up) {
  Polyline points(figure.trajectory.rows());
  for (std::size_t row = 0; row < points.size(); ++row)
    points[row] = {figure.left + figure.frame_width() * across.position(figure.horizontal.at(figure.trajectory, row)),
                   panel.top + panel.height * (1 - up.position(series.at(figure.trajectory, row)))};
  return points;
}

std::vector<Polyline> thinned(const std::vector<Polyline>& lines, bool over_time, double width, double height) {
  constexpr double column = 0.5, tolerance = 0.04;
  constexpr std::size_t crowded = 20'000;
  std::vector<Polyline> result;
  Ink ink(width, height);
  for (const Polyline& line : lines) {
    const Polyline straight = straighten(over_time ? thin_columns(line, column) : line, tolerance);
    if (over_time || straight.size() < crowded) result.push_back(straight);
    else for (auto& part : ink.draw(straight)) result.push_back(std::move(part));
  }
  return result;
}

std::string draw_curve(const Figure& figure, const Panel& panel, std::size_t index, const Axis& across, const Axis& up) {
  const std::string attributes = series_attributes(index, panel.series.size());
  const auto lines = split_at_gaps(pixels_of(figure, panel, panel.series[index], across, up));
  const bool over_time = figure.horizontal.is_time;
  const auto drawn = thinned(lines, over_time, figure.options.width, figure.height);
  std::size_t points = 0;
  for (const Polyline& line : drawn) points += line.size();
  std::string svg = fmt::format("<path class=\"curve {}{} d=\"{}\"/>\n", points > 1500 ? "dense " : "", attributes,
                                path_data(drawn));
  const auto dot = [&](Pixel p, double radius) {
    svg += fmt::format("<circle class=\"dot {} cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", attributes, p.x, p.y, radius);
  };
  // Points without neighbours; the start of a phase portrait.
  std::size_t alone = 0;
  for (const Polyline& line : lines)
    if (line.size() == 1 && ++alone <= 500) dot(line[0], 2);
  if (!over_time && !lines.empty()) dot(lines[0][0], 3);
  return svg;
}

// ----------------------------------------------------------------------------------------------------------- frame

std::string draw_frame(const Figure& figure, const Panel& panel, const Axis& across, const Axis& up, bool lowest) {
  std::string grid, labels, svg;
  const double bottom = panel.top + panel.height;
  for (const Tick& tick : across.ticks()) {
    const double x = figure.left + tick.position * figure.frame_width();
    grid += fmt::format("M{:.2f} {:.2f}v{:.2f}", x, panel.top, panel.height);
    if (lowest) labels += text_element(x, bottom + 17, "middle", tick_size, {{tick.label}}, " class=\"tick\"");
  }
  for (const Tick& tick : up.ticks()) {
    const double y = bottom - tick.position * panel.height;
    grid += fmt::format("M{:.2f} {:.2f}h{:.2f}", figure.left, y, figure.frame_width());
    labels += text_element(figure.left - 7, y + 4, "end", tick_size, {{tick.label}}, " class=\"tick\"");
  }
  svg += fmt::format("<path class=\"grid\" d=\"{}\"/>\n", grid);
  svg += fmt::format("<path class=\"axis\" d=\"M{:.2f} {:.2f}v{:.2f}h{:.2f}\"/>\n", figure.left, panel.top, panel.height,
                     figure.frame_width());
  return svg + labels;
}

std::string draw_vertical_label(const Panel& panel, const Axis& up) {
  const double middle = panel.top + panel.height / 2;
  return text_element(16, middle, "middle", label_size, axis_text(names_of(panel.series), panel.unit, up),
                      fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", middle));
}

// ---------------------------------------------------------------------------------------------------------- layout

double widest_label(const std::vector<Axis>& axes) {
  double widest = 20;
  for (const Axis& axis : axes)
    for (const Tick& tick : axis.ticks()) widest = std::max(widest, text_width({{tick.label}}, tick_size));
  return widest;
}

bool equal_aspect(const Figure& figure) {
  if (figure.options.aspect != PlotAspect::Auto) return figure.options.aspect == PlotAspect::Equal;
  return figure.horizontal.unit == "m" && figure.panels.size() == 1 && figure.panels[0].unit == "m";
}

double chosen_panel_height(const Figure& figure, const std::vector<Range>& up, const Range& across) {
  const double width = figure.options.width - 90;
  if (figure.options.panel_height > 0) return figure.options.panel_height;
  if (equal_aspect(figure) && !across.empty && !up[0].empty && across.high > across.low)
    return std::clamp(width * (up[0].high - up[0].low) / (across.high - across.low), 0.35 * width, 1.1 * width);
  if (!figure.horizontal.is_time) return 0.8 * width;
  return figure.panels.size() == 1 ? std::clamp(0.42 * width, 160.0, 320.0) : std::clamp(0.3 * width, 120.0, 210.0);
}

// Places the panels; the left margin follows the widest label.
void arrange(Figure& figure, double panel_height, double label_width) {
  figure.left = 30 + label_width + 10;
  figure.right = figure.options.width - 18;
  double y = figure.options.title.empty() ? 10 : 38;
  for (Panel& panel : figure.panels) {
    panel.legend_height = line_height * static_cast<double>(legend_rows(panel, figure.frame_width()).size());
    panel.top = y + panel.legend_height;
    panel.height = panel_height;
    y = panel.top + panel.height + gap;
  }
  figure.bottom = y - gap;
  figure.height = figure.bottom + 46;
}

struct Axes {
  Axis across;
  std::vector<Axis> up;  // [panels]
};

Axes choose_axes(const Figure& figure, const Range& across, const std::vector<Range>& up, double frame_width,
                 double panel_height) {
  const bool over_time = figure.horizontal.is_time;
  const auto degrees = [](const std::string& unit) { return unit == "°"; };
  const Axis::Options x{frame_width, 78, over_time ? 0 : 0.04, degrees(figure.horizontal.unit)};
  Axes axes{Axis(across, x), {}};
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    axes.up.emplace_back(up[i], Axis::Options{panel_height, 38, 0.06, degrees(figure.panels[i].unit)});
  if (!equal_aspect(figure)) return axes;
  // Equal aspect: the scale of the axis that needs most, on all.
  double scale = axes.across.span() / frame_width;
  for (const Axis& axis : axes.up) scale = std::max(scale, axis.span() / panel_height);
  axes.across = Axis::with_span(across, scale * frame_width, x);
  for (std::size_t i = 0; i < axes.up.size(); ++i)
    axes.up[i] = Axis::with_span(up[i], scale * panel_height, {panel_height, 38, 0, false});
  return axes;
}

std::string opening(const Figure& figure) {
  const double width = figure.options.width, height = figure.height;
  std::string size = fmt::format("viewBox=\"0 0 {:.0f} {:.0f}\"", width, height);
  if (figure.options.theme != PlotTheme::Page) size += fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", width, height);
  RichText what;
  for (const Panel& panel : figure.panels)
    for (const Series& series : panel.series) append(what, (what.empty() ? "" : ", ") + series.name);
  const std::string label = figure.options.title.empty() ? plain(what) + " against " + figure.horizontal.name : figure.options.title;
  std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"maup-plot\" role=\"img\" {} aria-label=\"{}\">\n",
                                size, escape_xml(label));
  if (figure.options.theme != PlotTheme::Page)
    svg += fmt::format("<style>{}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n",
                       own_style(figure.options.theme));
  return svg;
}

}  // namespace

std::string plot_problem(const Trajectory& trajectory, const PlotOptions& options) {
  std::vector<std::string> known{"t"};
  for (const auto& column : trajectory.columns) known.push_back(column.name);
  auto wanted = options.columns;
  if (!options.against.empty()) wanted.push_back(options.against);
  for (const auto& name : wanted) {
    if (trajectory.column(name)) continue;
    if (name == "t") return "the time is the horizontal axis: name what to draw against it";
    const std::string near = did_you_mean(name, known);
    return fmt::format("the run has no {}{}", name, near.empty() ? "" : fmt::format("; did you mean {}?", near));
  }
  if (!(options.width >= 240)) return "a picture is at least 240 px wide";
  return {};
}

std::string plot_svg(const Trajectory& trajectory, const PlotOptions& options) {
  MAUP_REQUIRE(plot_problem(trajectory, options).empty());
  MAUP_REQUIRE(trajectory.values.size() == trajectory.rows() * trajectory.columns.size());
  Figure figure{trajectory, options, Series{"t", "s", 1, 0, true}, group_by_unit(trajectory, options), 0, 0, 0, 0};
  if (!options.against.empty()) figure.horizontal = series_of(trajectory, options.against, options.degrees);

  // Ranges come first, then axes; their labels give the margin; with the margin the axes are final.
  const Range across = range_of(trajectory, {figure.horizontal});
  std::vector<Range> up;
  for (const Panel& panel : figure.panels) up.push_back(range_of(trajectory, panel.series));
  const double panel_height = chosen_panel_height(figure, up, across);
  Axes axes = choose_axes(figure, across, up, options.width - 90, panel_height);
  arrange(figure, panel_height, widest_label(axes.up));
  axes = choose_axes(figure, across, up, figure.frame_width(), panel_height);

  std::string svg = opening(figure);
  if (!options.title.empty()) svg += text_element(options.width / 2, 24, "middle", title_size, {{options.title}});
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    svg += draw_frame(figure, panel, axes.across, axes.up[i], i + 1 == figure.panels.size());
    for (std::size_t k = 0; k < panel.series.size(); ++k) svg += draw_curve(figure, panel, k, axes.across, axes.up[i]);
    if (up[i].empty || across.empty)
      svg += text_element((figure.left + figure.right) / 2, panel.top + panel.height / 2, "middle", label_size, {{"no data"}});
    svg += draw_vertical_label(panel, axes.up[i]) + draw_legend(panel, figure);
  }
  svg += text_element((figure.left + figure.right) / 2, figure.height - 9, "middle", label_size,
                      axis_text({figure.horizontal.name}, figure.horizontal.unit, axes.across));
  return svg + "</svg>\n";
}

}  // namespace maupertuis

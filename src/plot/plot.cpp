#include "plot/panel.hpp"
#include "plot/style.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/escape_xml.hpp>
#include <maupertuis/plot.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>

/// From top to bottom: title, panels (legend, frame), tick labels, label of the shared axis.
namespace maupertuis {
namespace {

constexpr double gap = 14;  // px between panels

Series series_of(const Trajectory& trajectory, const std::string& name, bool degrees) {
  const std::size_t column = *trajectory.column(name);
  Series series{name, trajectory.columns[column].unit, 1, column, false};
  if (degrees && series.unit.compare(0, 3, "rad") == 0 && (series.unit.size() == 3 || series.unit[3] == '/')) {
    series.factor = radian_in_degrees;
    series.unit = "°" + series.unit.substr(3);
  }
  return series;
}

/// What bare numbers are: "" of coordinates and points, "'" of velocities, "energy", "(" of reactions and formulas.
/// Units tell these apart where there are some.
std::string kind_of(const Series& series) {
  const std::string& name = series.name;
  if (!series.unit.empty() || name.empty()) return "";
  if (name == "energy") return name;
  if (name.find('(') != std::string::npos) return "(";
  return name.substr(name.find_last_not_of('\'') + 1);
}

/// A panel a unit; columns that nobody named are apart by what they are as well.
std::vector<Panel> group_by_unit(const Trajectory& trajectory, const PlotOptions& options) {
  std::vector<std::string> names = options.columns;
  const bool all = names.empty();
  if (all)
    for (const auto& column : trajectory.columns)
      if (column.name != options.against && column.name != options.dots_by) names.push_back(column.name);
  std::vector<Panel> panels;
  for (const auto& name : names) {
    const Series series = series_of(trajectory, name, options.degrees);
    auto panel = std::find_if(panels.begin(), panels.end(), [&](const Panel& p) {
      return p.unit == series.unit && (!all || kind_of(p.series.front()) == kind_of(series));
    });
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
  figure.left = std::max(30 + label_width, 8 + widest_strip_name(figure)) + 10;
  figure.right = figure.options.width - 18;
  double y = figure.options.title.empty() ? 10 : 38;
  figure.marks_top = y;
  y += names_of_marks_height(figure);
  for (Panel& panel : figure.panels) {
    panel.legend_height = legend_height(panel, figure.frame_width());
    panel.top = y + panel.legend_height;
    panel.height = panel_height;
    y = panel.top + panel.height + gap;
  }
  figure.strips_top = y - gap + 7;
  figure.bottom = y - gap + strips_height(figure);
  figure.height = figure.bottom + 46 + strips_legend_height(figure);
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
  if (figure.options.theme != PlotTheme::Page)
    size += fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", width, height);
  RichText what;
  for (const Panel& panel : figure.panels)
    for (const Series& series : panel.series) append(what, (what.empty() ? "" : ", ") + series.name);
  const std::string label =
      figure.options.title.empty() ? plain(what) + " against " + figure.horizontal.name : figure.options.title;
  std::string svg =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"maup-plot\" role=\"img\" {} aria-label=\"{}\">\n",
                  size, escape_xml(label));
  if (figure.options.theme != PlotTheme::Page)
    svg += fmt::format("<style>{}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n",
                       own_style(figure.options.theme));
  return svg;
}

}  // namespace

std::string plot_problem(const Trajectory& trajectory, const PlotOptions& options) {
  std::vector<std::string> known{trajectory.independent.name};
  for (const auto& column : trajectory.columns) known.push_back(column.name);
  auto wanted = options.columns;
  if (!options.against.empty()) wanted.push_back(options.against);
  if (!options.dots_by.empty()) wanted.push_back(options.dots_by);
  for (const auto& name : wanted) {
    if (trajectory.column(name)) continue;
    if (name == trajectory.independent.name)
      return fmt::format("{} is the horizontal axis: name what to draw against it", name == "t" ? "the time" : name);
    const std::string near = did_you_mean(name, known);
    return fmt::format("the run has no {}{}", name, near.empty() ? "" : fmt::format("; did you mean {}?", near));
  }
  if (!(options.width >= 240)) return "a picture is at least 240 px wide";
  return {};
}

std::string plot_svg(const Trajectory& trajectory, const PlotOptions& options) {
  MAUP_REQUIRE(plot_problem(trajectory, options).empty());
  MAUP_REQUIRE(trajectory.values.size() == trajectory.rows() * trajectory.columns.size());
  MAUP_REQUIRE(trajectory.errors.empty() || trajectory.errors.size() == trajectory.values.size());
  MAUP_REQUIRE(options.outline.empty() || (options.columns.size() == 1 && !options.against.empty()));
  Figure figure{trajectory, options, Series{trajectory.independent.name, trajectory.independent.unit, 1, 0, true},
                group_by_unit(trajectory, options)};
  if (!options.against.empty()) figure.horizontal = series_of(trajectory, options.against, options.degrees);

  // Ranges come first, then axes; their labels give the margin; with the margin the axes are final.
  Range across = range_of(trajectory, {figure.horizontal});
  std::vector<Range> up;
  for (const Panel& panel : figure.panels) up.push_back(range_of(trajectory, panel.series));
  for (const auto& [x, y] : options.outline)
    across.include(figure.horizontal.factor * x), up[0].include(figure.panels[0].series[0].factor * y);
  const double panel_height = chosen_panel_height(figure, up, across);
  Axes axes = choose_axes(figure, across, up, options.width - 90, panel_height);
  arrange(figure, panel_height, widest_label(axes.up));
  axes = choose_axes(figure, across, up, figure.frame_width(), panel_height);
  figure.mark_rows = rows_of_names(figure, axes.across);
  if (figure.mark_rows > 1) arrange(figure, panel_height, widest_label(axes.up));

  std::string svg = opening(figure);
  if (!options.title.empty()) svg += text_element(options.width / 2, 24, "middle", title_size, {{options.title}});
  svg += draw_marks(figure, axes.across);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    svg += draw_panel(figure, panel, axes.across, axes.up[i], i + 1 == figure.panels.size());
    if (up[i].empty || across.empty)
      svg += text_element((figure.left + figure.right) / 2, panel.top + panel.height / 2, "middle", label_size,
                          {{"no data"}});
  }
  svg += draw_names_and_strips(figure, axes.across);
  svg += text_element((figure.left + figure.right) / 2, figure.bottom + 37, "middle", label_size,
                      axis_text({figure.horizontal.name}, figure.horizontal.unit, axes.across));
  return svg + "</svg>\n";
}

}  // namespace maupertuis

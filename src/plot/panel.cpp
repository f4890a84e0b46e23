#include "plot/panel.hpp"

#include "plot/polyline.hpp"
#include "plot/style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace maupertuis {

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

std::string text_element(double x, double y, std::string_view anchor, double size, const RichText& text,
                         std::string_view more) {
  const std::string content = to_svg(text, size);
  // A blank at the beginning of a <tspan> is one of the text; librsvg drops it unless it is told.
  const char* blanks = content.find("> ") != std::string::npos ? " xml:space=\"preserve\"" : "";
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\"{}{}>{}</text>\n", x, y,
                     anchor, size, blanks, more, content);
}

namespace {

std::vector<std::string> names_of(const std::vector<Series>& series) {
  std::vector<std::string> names;
  for (const Series& one : series) names.push_back(one.name);
  return names;
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
    if (over_time || straight.size() < crowded)
      result.push_back(straight);
    else
      for (auto& part : ink.draw(straight)) result.push_back(std::move(part));
  }
  return result;
}

/// How far up and down a value may be: an infinite error takes the whole panel.
struct Reach {
  double x, top, bottom;
};

std::vector<Reach> reaches_of(const Figure& figure, const Panel& panel, const Series& series, const Axis& across,
                              const Axis& up) {
  std::vector<Reach> out;
  const double low = panel.top + panel.height;
  const auto y = [&](double value) { return panel.top + panel.height * (1 - up.position(value)); };
  for (std::size_t row = 0; row < figure.trajectory.rows(); ++row) {
    const double value = series.at(figure.trajectory, row),
                 error = series.factor * figure.trajectory.error(row, series.column);
    const double x = figure.left + figure.frame_width() * across.position(figure.horizontal.at(figure.trajectory, row));
    const bool known = std::isfinite(value) && !std::isnan(error);
    Reach reach{x, known ? std::clamp(y(value + error), panel.top, low) : 0,
                known ? std::clamp(y(value - error), panel.top, low) : 0};
    constexpr double column = 0.5;  // px; what falls into one is drawn as one
    if (!out.empty() && std::abs(out.back().x - x) < column && known && out.back().bottom > 0)
      out.back() = {out.back().x, std::min(out.back().top, reach.top), std::max(out.back().bottom, reach.bottom)};
    else
      out.push_back(reach);
  }
  return out;
}

/// The band in which the curve may lie, where it is wider than the curve itself.
std::string draw_band(const Figure& figure, const Panel& panel, std::size_t index, const Axis& across, const Axis& up) {
  constexpr double visible = 1.5;  // px
  if (figure.trajectory.errors.empty() || !figure.horizontal.is_time) return {};
  const std::vector<Reach> reaches = reaches_of(figure, panel, panel.series[index], across, up);
  std::vector<Polyline> bands;
  for (std::size_t i = 0; i < reaches.size();) {
    Polyline upper, lower;
    for (; i < reaches.size() && reaches[i].bottom - reaches[i].top > visible; ++i) {
      upper.push_back({reaches[i].x, reaches[i].top});
      lower.push_back({reaches[i].x, reaches[i].bottom});
    }
    if (upper.empty())
      ++i;
    else {
      upper.insert(upper.end(), lower.rbegin(), lower.rend());
      bands.push_back(straighten(upper, 0.04));
    }
  }
  if (bands.empty()) return {};
  return fmt::format("<path class=\"band {} d=\"{}\"/>\n", series_attributes(index, panel.series.size()),
                     path_data(bands));
}

/// A phase portrait without what is not certain at all, and that alone.
std::pair<Polyline, Polyline> split_by_certainty(const Figure& figure, const Series& series, const Polyline& pixels) {
  std::pair<Polyline, Polyline> out{pixels, {}};
  const Trajectory& rows = figure.trajectory;
  if (rows.errors.empty() || figure.horizontal.is_time) return out;
  out.second = pixels;
  const Pixel gap{std::nan(""), std::nan("")};
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const bool lost =
        std::isinf(rows.error(row, series.column)) || std::isinf(rows.error(row, figure.horizontal.column));
    (lost ? out.first : out.second)[row] = gap;
  }
  return out;
}

std::string draw_curve(const Figure& figure, const Panel& panel, std::size_t index, const Axis& across,
                       const Axis& up) {
  const std::string attributes = series_attributes(index, panel.series.size());
  const auto [certain, lost] =
      split_by_certainty(figure, panel.series[index], pixels_of(figure, panel, panel.series[index], across, up));
  const bool over_time = figure.horizontal.is_time;
  // Over time what was left out is hidden in a band of oscillations; across it, a chord would be a way that is not
  // gone.
  const auto breaks = over_time ? std::vector<std::size_t>() : figure.trajectory.gaps;
  const auto lines = split_at_gaps(certain, breaks);
  const auto drawn = thinned(lines, over_time, figure.options.width, figure.height);
  std::size_t points = 0;
  for (const Polyline& line : drawn) points += line.size();
  std::string svg =
      fmt::format("<path class=\"curve {}{} d=\"{}\"/>\n", points > 1500 ? "dense " : "", attributes, path_data(drawn));
  if (const auto faint = split_at_gaps(lost, breaks); !faint.empty())
    svg += fmt::format("<path class=\"curve lost {} d=\"{}\"/>\n", attributes,
                       path_data(thinned(faint, false, figure.options.width, figure.height)));
  const auto dot = [&](Pixel p, double radius) {
    svg += fmt::format("<circle class=\"dot {} cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", attributes, p.x, p.y, radius);
  };
  // Points without neighbours, unless these were left out; the start of a phase portrait.
  std::size_t alone = 0;
  for (const Polyline& line : breaks.empty() ? lines : std::vector<Polyline>())
    if (line.size() == 1 && ++alone <= 500) dot(line[0], 2);
  if (!over_time && !lines.empty()) dot(lines[0][0], 3);
  return svg;
}

/// The rows of each value of the column that colours are by, in ascending order of the values.
std::map<double, std::vector<std::size_t>> rows_by(const Trajectory& trajectory, const std::string& column) {
  std::map<double, std::vector<std::size_t>> out;
  const std::size_t index = *trajectory.column(column);
  for (std::size_t row = 0; row < trajectory.rows(); ++row) out[trajectory.at(row, index)].push_back(row);
  return out;
}

/// Lines of no length with round ends: the shortest way to write many dots. Dots on one pixel in one colour are one
/// dot.
std::string draw_dots(const Figure& figure, const Panel& panel, const Series& series, const Axis& across,
                      const Axis& up) {
  const Polyline pixels = pixels_of(figure, panel, series, across, up);
  const auto groups = rows_by(figure.trajectory, figure.options.dots_by);
  std::string svg;
  std::size_t index = 0;
  for (const auto& [value, rows] : groups) {
    std::string path;
    std::set<std::pair<long, long>> drawn;
    for (const std::size_t row : rows) {
      const Pixel p = pixels[row];
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      if (drawn.emplace(std::lround(2 * p.x), std::lround(2 * p.y)).second)
        path += fmt::format("M{:.1f} {:.1f}h0", p.x, p.y);
    }
    svg += fmt::format("<path class=\"dots {} d=\"{}\"/>\n", series_attributes(index++, groups.size()), path);
  }
  return svg;
}

std::string draw_outline(const Figure& figure, const Panel& panel, const Axis& across, const Axis& up) {
  Polyline line;
  for (const auto& [x, y] : figure.options.outline)
    line.push_back({figure.left + figure.frame_width() * across.position(figure.horizontal.factor * x),
                    panel.top + panel.height * (1 - up.position(panel.series[0].factor * y))});
  return line.empty() ? std::string() : fmt::format("<path class=\"outline\" d=\"{}\"/>\n", path_data({line}));
}

// ----------------------------------------------------------------------------------------------------------- frame

std::string draw_frame(const Figure& figure, const Panel& panel, const Axis& across, const Axis& up, bool lowest) {
  std::string grid, labels, svg;
  const double bottom = panel.top + panel.height;
  for (const Tick& tick : across.ticks()) {
    const double x = figure.left + tick.position * figure.frame_width();
    grid += fmt::format("M{:.2f} {:.2f}v{:.2f}", x, panel.top, panel.height);
    if (lowest) labels += text_element(x, figure.bottom + 17, "middle", tick_size, {{tick.label}}, " class=\"tick\"");
  }
  for (const Tick& tick : up.ticks()) {
    const double y = bottom - tick.position * panel.height;
    grid += fmt::format("M{:.2f} {:.2f}h{:.2f}", figure.left, y, figure.frame_width());
    labels += text_element(figure.left - 7, y + 4, "end", tick_size, {{tick.label}}, " class=\"tick\"");
  }
  svg += fmt::format("<path class=\"grid\" d=\"{}\"/>\n", grid);
  svg += fmt::format("<path class=\"axis\" d=\"M{:.2f} {:.2f}v{:.2f}h{:.2f}\"/>\n", figure.left, panel.top,
                     panel.height, figure.frame_width());
  return svg + labels;
}

/// With as many names as the panel is high for: the legend has them all.
RichText vertical_label(const Panel& panel, const Axis& up) {
  std::vector<std::string> names = names_of(panel.series);
  RichText text = axis_text(names, panel.unit, up);
  for (std::size_t count = names.size(); count-- > 1 && text_width(text, label_size) > panel.height;) {
    names.resize(count);
    names.emplace_back("…");
    text = axis_text(names, panel.unit, up);
  }
  return text;
}

std::string draw_vertical_label(const Panel& panel, const Axis& up) {
  const double middle = panel.top + panel.height / 2;
  const RichText text = vertical_label(panel, up);
  // "energy (10⁻¹⁵ J from 0.1973920880217)" is longer than the panel is high.
  const double size = label_size * std::min(1.0, panel.height / text_width(text, label_size));
  return text_element(16, middle, "middle", std::round(10 * size) / 10, text,
                      fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", middle));
}

}  // namespace

double legend_height(const Panel& panel, double width) {
  return line_height * static_cast<double>(legend_rows(panel, width).size());
}

std::string draw_panel(const Figure& figure, const Panel& panel, const Axis& across, const Axis& up, bool lowest) {
  std::string svg = draw_frame(figure, panel, across, up, lowest);
  svg += draw_outline(figure, panel, across, up);
  for (std::size_t k = 0; k < panel.series.size() && figure.options.dots_by.empty(); ++k)
    svg += draw_band(figure, panel, k, across, up);
  for (std::size_t k = 0; k < panel.series.size(); ++k)
    svg += figure.options.dots_by.empty() ? draw_curve(figure, panel, k, across, up)
                                          : draw_dots(figure, panel, panel.series[k], across, up);
  return svg + draw_vertical_label(panel, up) + draw_legend(panel, figure);
}

}  // namespace maupertuis

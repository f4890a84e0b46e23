#include "plot/bands.hpp"
#include "plot/panel.hpp"
#include "plot/style.hpp"

#include <maupertuis/escape_xml.hpp>
#include <maupertuis/field_map.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

/// Sheets of colours beside their bar; above a single one, curves along some of its rows.
namespace maupertuis {
namespace {

constexpr int bands = 25;  // odd: the middle of both signs is a band, white, where rounding shows no sign
constexpr double bar_width = 14, bar_gap = 16, sheet_gap = 22, caption_height = 20;

/// A colour of Ottosson's Oklab, in which equal steps look alike, as sRGB.
std::string from_oklch(double lightness, double chroma, double hue_in_degrees) {
  const double hue = hue_in_degrees * 3.14159265358979323846 / 180, a = chroma * std::cos(hue),
               b = chroma * std::sin(hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b),
               m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b),
               s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  const std::array<double, 3> linear{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                                     -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                                     -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
  std::string out = "#";
  for (const double x : linear) {
    const double c = std::clamp(x, 0.0, 1.0);
    const double shown = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    out += fmt::format("{:02x}", static_cast<int>(std::lround(255 * shown)));
  }
  return out;
}

/// "t = 2 s" with its t as a symbol.
RichText moment_text(const std::string& text) {
  if (text.compare(0, 2, "t ") != 0) return {{text}};
  return {{"t", true}, {text.substr(1)}};
}

class MapPicture {
 public:
  explicit MapPicture(const FieldMap& map) : m_(map) {
    MAUP_REQUIRE(m_.x.size() > 1 && m_.y.size() > 1 && !m_.sheets.empty());
    for (const FieldMap::Sheet& sheet : m_.sheets) {
      MAUP_REQUIRE(sheet.values.size() == m_.x.size() * m_.y.size());
      for (const double v : sheet.values) values_.include(v);
    }
    for (const double v : m_.include) values_.include(v);
    choose_colours();
    const std::size_t count = m_.sheets.size();
    columns_ = count <= 1 ? 1 : count == 2 || count == 4 ? 2 : 3;
    rows_ = (count + columns_ - 1) / columns_;
    arrange();
  }

  std::string svg() const {
    std::string out = opening();
    if (!m_.title.empty()) out += text_element(m_.width / 2, 24, "middle", title_size, {{m_.title}});
    if (!m_.lines.empty()) out += curves();
    for (std::size_t i = 0; i < m_.sheets.size(); ++i) out += sheet(i);
    return out + bar() + "</svg>\n";
  }

 private:
  // ------------------------------------------------------------------------------------------------------- colours

  void choose_colours() {
    if (values_.empty) values_.include(0), values_.include(1);
    const double size = std::max(std::abs(values_.low), std::abs(values_.high));
    two_signs_ = values_.low < -0.02 * size && values_.high > 0.02 * size;
    low_ = two_signs_ ? -size : values_.low, high_ = two_signs_ ? size : values_.high;
    if (!(high_ - low_ > 1e-12 * size)) low_ -= 0.5 * std::max(size, 1e-300), high_ += 0.5 * std::max(size, 1e-300);
  }
  double level(int band) const { return low_ + (high_ - low_) * band / bands; }
  std::string colour(int band) const {
    const double part = (band + 0.5) / bands;
    return field_colour(two_signs_ ? 2 * part - 1 : part, two_signs_);
  }

  // -------------------------------------------------------------------------------------------------------- layout

  double shown_height(double width) const {
    const double x = m_.x.back() - m_.x.front(), y = m_.y.back() - m_.y.front();
    if (m_.equal_scales) return std::clamp(width * y / x, 0.3 * width, 1.6 * width);
    return columns_ == 1 ? std::clamp(0.62 * width, 150.0, 460.0) : width;
  }

  void arrange() {
    bar_axis_.emplace(Range{low_, high_, false}, Axis::Options{300, 34, 0, false});
    double bar_labels = 20;
    for (const Tick& tick : bar_axis_->ticks())
      bar_labels = std::max(bar_labels, text_width({{tick.label}}, tick_size));
    Axis y(range_of(m_.y), {300, 38, 0, false});
    double labels = 20;
    for (const Tick& tick : y.ticks()) labels = std::max(labels, text_width({{tick.label}}, tick_size));
    if (!m_.lines.empty()) {
      const Axis up(range_of_curves(), {curve_height, 38, 0.06, false});
      for (const Tick& tick : up.ticks()) labels = std::max(labels, text_width({{tick.label}}, tick_size));
    }
    left_ = 30 + labels + 10;
    const double right = m_.width - (bar_gap + bar_width + 8 + bar_labels + 26);
    const double columns = static_cast<double>(columns_);
    sheet_width_ = (right - left_ - sheet_gap * (columns - 1)) / columns;
    sheet_height_ = shown_height(sheet_width_);
    if (m_.equal_scales && columns_ == 1 && sheet_height_ > 560)
      sheet_width_ *= 560 / sheet_height_, sheet_height_ = 560;
    right_ = left_ + sheet_width_ * columns + sheet_gap * (columns - 1);
    double top = m_.title.empty() ? 12 : 40;
    if (!m_.lines.empty()) {
      curve_top_ = top + line_height * static_cast<double>(key_rows()) + 4;
      top = curve_top_ + curve_height + 14;
    }
    top_ = top;
    row_height_ = sheet_height_ + (captions() ? caption_height : 0) + (rows_ > 1 ? 16 : 0);
    bottom_ = top_ + static_cast<double>(rows_) * row_height_ - (rows_ > 1 ? 16 : 0);
    across_.emplace(range_of(m_.x), Axis::Options{sheet_width_, 70, 0, false});
    up_.emplace(range_of(m_.y), Axis::Options{sheet_height_, 38, 0, false});
    bar_axis_.emplace(Range{low_, high_, false}, Axis::Options{bottom_ - top_, 34, 0, false});
  }
  bool captions() const { return !m_.sheets.front().caption.empty(); }
  static Range range_of(const std::vector<double>& places) {
    Range out;
    out.include(places.front()), out.include(places.back());
    return out;
  }
  Pixel corner(std::size_t sheet) const {
    const double column = static_cast<double>(sheet % columns_), row = static_cast<double>(sheet / columns_);
    return {left_ + column * (sheet_width_ + sheet_gap), top_ + row * row_height_ + (captions() ? caption_height : 0)};
  }

  std::string opening() const {
    const double height = bottom_ + 46;
    const bool page = m_.theme == PlotTheme::Page;
    std::string size = fmt::format("viewBox=\"0 0 {:.0f} {:.0f}\"", m_.width, height);
    if (!page) size += fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", m_.width, height);
    const std::string label =
        m_.title.empty() ? fmt::format("{} over {} and {}", m_.value_name, m_.x_name, m_.y_name) : m_.title;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"maup-plot\" role=\"img\" {} aria-label=\"{}\">\n", size,
        escape_xml(label));
    if (!page)
      out += fmt::format("<style>{}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n",
                         own_style(m_.theme));
    return out;
  }

  // -------------------------------------------------------------------------------------------------------- sheets

  std::string sheet(std::size_t i) const {
    const Pixel at = corner(i);
    Grid grid{{}, {}, m_.sheets[i].values};
    for (const double x : m_.x) grid.x.push_back(at.x + sheet_width_ * across_->position(x));
    for (const double y : m_.y) grid.y.push_back(at.y + sheet_height_ * (1 - up_->position(y)));
    std::string out = "<g stroke=\"none\">\n";
    for (int band = 0; band < bands; ++band) {
      if (band > 0 && level(band) > values_.high) break;
      // What lies above the next level is painted over.
      const std::string d = closed_path(region_above(grid, band == 0 ? -INFINITY : level(band)));
      if (!d.empty()) out += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", colour(band), d);
    }
    out += "</g>\n";
    const bool lowest = i + columns_ >= m_.sheets.size(), leftmost = i % columns_ == 0;
    return out + frame(at, lowest, leftmost) + moments(at) +
           (captions() ? text_element(at.x + sheet_width_ / 2, at.y - 7, "middle", tick_size + 1,
                                      moment_text(m_.sheets[i].caption))
                       : std::string());
  }

  /// Ticks point outwards: nothing covers the colours.
  std::string frame(Pixel at, bool lowest, bool leftmost) const {
    std::string d =
        fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z", at.x, at.y, sheet_width_, sheet_height_, -sheet_width_);
    std::string labels;
    for (const Tick& tick : across_->ticks()) {
      const double x = at.x + sheet_width_ * tick.position, y = at.y + sheet_height_;
      d += fmt::format("M{:.1f} {:.1f}v4", x, y);
      if (lowest) labels += text_element(x, y + 17, "middle", tick_size, {{tick.label}}, " class=\"tick\"");
    }
    for (const Tick& tick : up_->ticks()) {
      const double y = at.y + sheet_height_ * (1 - tick.position);
      d += fmt::format("M{:.1f} {:.1f}h-4", at.x, y);
      if (leftmost) labels += text_element(at.x - 7, y + 4, "end", tick_size, {{tick.label}}, " class=\"tick\"");
    }
    std::string out = fmt::format("<path class=\"axis\" d=\"{}\"/>\n{}", d, labels);
    if (lowest)
      out += text_element(at.x + sheet_width_ / 2, at.y + sheet_height_ + 39, "middle", label_size,
                          axis_text({m_.x_name}, m_.x_unit, *across_));
    const double middle = at.y + sheet_height_ / 2;
    if (leftmost)
      out += text_element(18, middle, "middle", label_size, axis_text({m_.y_name}, m_.y_unit, *up_),
                          fmt::format(" transform=\"rotate(-90 18 {:.1f})\"", middle));
    return out;
  }

  std::string bar() const {
    const double x = right_ + bar_gap, top = corner(0).y, height = bottom_ - top;
    std::string out = "<g stroke=\"none\" shape-rendering=\"crispEdges\">\n";
    for (int band = bands; band-- > 0;)
      out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.1f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
                         top + height * (1 - (band + 1.0) / bands), bar_width, height * (band + 1.0) / bands,
                         colour(band));  // down to the foot: no gaps
    std::string d = fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z", x, top, bar_width, height, -bar_width);
    std::string labels;
    double widest = 0;
    for (const Tick& tick : bar_axis_->ticks()) {
      const double y = top + height * (1 - tick.position);
      d += fmt::format("M{:.1f} {:.1f}h4", x + bar_width, y);
      labels += text_element(x + bar_width + 7, y + 4, "start", tick_size, {{tick.label}}, " class=\"tick\"");
      widest = std::max(widest, text_width({{tick.label}}, tick_size));
    }
    const double middle = top + height / 2, across = x + bar_width + 7 + widest + 17;
    return out + "</g>\n" + fmt::format("<path class=\"axis\" d=\"{}\"/>\n{}", d, labels) +
           text_element(across, middle, "middle", label_size, axis_text({m_.value_name}, m_.value_unit, *bar_axis_),
                        fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", across, middle));
  }

  // -------------------------------------------------------------------------------------------------------- curves

  Range range_of_curves() const {
    Range out;
    for (const FieldMap::Line& line : m_.lines)
      for (std::size_t i = 0; i < m_.x.size(); ++i) out.include(m_.sheets.front().values[line.row * m_.x.size() + i]);
    return out;
  }
  double key_width(const FieldMap::Line& line) const { return 26 + text_width({{line.name}}, tick_size) + 14; }
  std::size_t key_rows() const {
    double x = 0;
    std::size_t rows = 1;
    for (const FieldMap::Line& line : m_.lines) {
      if (x > 0 && x + key_width(line) > right_ - left_) ++rows, x = 0;
      x += key_width(line);
    }
    return rows;
  }

  std::string curves() const {
    const Axis up(range_of_curves(), {curve_height, 38, 0.06, false});
    const double bottom = curve_top_ + curve_height;
    std::string grid, labels, lines;
    for (const Tick& tick : across_->ticks())
      grid += fmt::format("M{:.1f} {:.1f}v{:.1f}", left_ + sheet_width_ * tick.position, curve_top_, curve_height);
    for (const Tick& tick : up.ticks()) {
      const double y = bottom - curve_height * tick.position;
      grid += fmt::format("M{:.1f} {:.1f}h{:.1f}", left_, y, sheet_width_);
      labels += text_element(left_ - 7, y + 4, "end", tick_size, {{tick.label}}, " class=\"tick\"");
    }
    double x = left_, y = curve_top_ - 10 - line_height * static_cast<double>(key_rows() - 1);
    for (std::size_t n = 0; n < m_.lines.size(); ++n) {
      const std::string colours = series_attributes(n, m_.lines.size());
      Polyline points;
      for (std::size_t i = 0; i < m_.x.size(); ++i)
        points.push_back({left_ + sheet_width_ * across_->position(m_.x[i]),
                          bottom - curve_height * up.position(m_.sheets[0].values[m_.lines[n].row * m_.x.size() + i])});
      std::vector<Polyline> pieces = split_at_gaps(points);
      for (Polyline& piece : pieces) piece = straighten(piece, 0.08);
      lines += fmt::format("<path class=\"curve {} d=\"{}\"/>\n", colours, path_data(pieces));
      if (x > left_ && x + key_width(m_.lines[n]) > right_) x = left_, y += line_height;
      lines += fmt::format("<path class=\"curve {} d=\"M{:.1f} {:.1f}h20\"/>", colours, x, y - 4);
      lines += text_element(x + 26, y, "start", tick_size, moment_text(m_.lines[n].name));
      x += key_width(m_.lines[n]);
    }
    const double middle = curve_top_ + curve_height / 2;
    return fmt::format("<path class=\"grid\" d=\"{}\"/>\n<path class=\"axis\" d=\"M{:.1f} {:.1f}v{:.1f}h{:.1f}\"/>\n",
                       grid, left_, curve_top_, curve_height, sheet_width_) +
           labels + lines +
           text_element(18, middle, "middle", label_size, axis_text({m_.value_name}, m_.value_unit, up),
                        fmt::format(" transform=\"rotate(-90 18 {:.1f})\"", middle));
  }

  /// At the right of the map, where the curves are taken.
  std::string moments(Pixel at) const {
    std::string out;
    for (std::size_t n = 0; n < m_.lines.size(); ++n)
      out += fmt::format("<path class=\"curve {} stroke-width=\"2.5\" d=\"M{:.1f} {:.1f}h7\"/>\n",
                         series_attributes(n, m_.lines.size()), at.x + sheet_width_ + 1,
                         at.y + sheet_height_ * (1 - up_->position(m_.y[m_.lines[n].row])));
    return out;
  }

  static constexpr double curve_height = 170;
  const FieldMap& m_;
  Range values_;
  bool two_signs_ = false;
  double low_ = 0, high_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0, sheet_width_ = 0, sheet_height_ = 0, row_height_ = 0;
  double curve_top_ = 0;
  std::optional<Axis> across_, up_, bar_axis_;
};

}  // namespace

std::string field_colour(double value, bool two_signs) {
  if (two_signs) {
    const double size = std::min(std::abs(value), 1.0);
    return from_oklch(0.97 - 0.55 * size, 0.19 * std::pow(size, 0.8), value < 0 ? 258 : 27);
  }
  // Lightness falls evenly; the hue goes from yellow over green to blue.
  const double part = std::clamp(value, 0.0, 1.0);
  return from_oklch(0.97 - 0.6 * part, 0.045 + 0.07 * std::sin(3.14159265358979323846 * (0.15 + 0.8 * part)),
                    105 + 165 * part);
}

std::string field_map_svg(const FieldMap& map) { return MapPicture(map).svg(); }

}  // namespace maupertuis

#include "plot/panel.hpp"
#include "plot/polyline.hpp"
#include "plot/style.hpp"

#include <maupertuis/diagram.hpp>
#include <maupertuis/escape_xml.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// From top to bottom: title, legend, frame, tick labels, label of the horizontal axis.
namespace maupertuis {
namespace {

class Picture {
 public:
  explicit Picture(const Diagram& diagram) : d_(diagram), across_(make_across(400)), up_(make_up(300)) {
    height_ = d_.frame_height > 0 ? d_.frame_height : std::clamp(0.55 * (d_.width - 90), 150.0, 420.0);
    up_ = make_up(height_);
    double label = 20;
    for (const Tick& tick : up_.ticks()) label = std::max(label, text_width({{tick.label}}, tick_size));
    left_ = 30 + label + 10;
    right_ = d_.width - 18;
    across_ = make_across(right_ - left_);
    const std::vector<KeyPlace> keys = key_places();
    top_ =
        (d_.title.empty() ? 10 : 38) + (keys.empty() ? 0 : line_height * static_cast<double>(keys.back().row + 1) + 4);
  }

  std::string svg() const {
    std::string out = opening();
    if (!d_.title.empty()) out += text_element(d_.width / 2, 24, "middle", title_size, {{d_.title}});
    out += legend() + frame();
    for (const Diagram::Curve& curve : d_.curves) out += drawn(curve);
    for (const Diagram::Mark& mark : d_.marks) out += drawn(mark);
    return out + "</svg>\n";
  }

 private:
  double factor_x() const { return d_.degrees_x ? radian_in_degrees : 1; }
  double factor_y() const { return d_.degrees_y ? radian_in_degrees : 1; }

  template <class Part>
  Range range(Part&& part) const {
    Range out;
    for (const Diagram::Curve& c : d_.curves)
      for (std::size_t i = 0; i < c.x.size(); ++i)
        if (std::isfinite(c.x[i]) && std::isfinite(c.y[i])) out.include(part(c.x[i], c.y[i]));
    for (const Diagram::Mark& m : d_.marks) out.include(part(m.x, m.y));
    return out;
  }
  Axis make_across(double length) const {
    Range r = range([&](double x, double) { return factor_x() * x; });
    for (const auto& label : d_.x_labels) r.include(label.first);
    return Axis(r, {length, 78, 0.04, d_.degrees_x});
  }
  Axis make_up(double length) const {
    Range r = range([&](double, double y) { return factor_y() * y; });
    for (const double y : d_.include_y) r.include(factor_y() * y);
    return Axis(r, {length, 38, 0.06, d_.degrees_y});
  }

  double bottom() const { return top_ + height_; }
  Pixel place(double x, double y) const {
    return {left_ + (right_ - left_) * across_.position(factor_x() * x),
            top_ + height_ * (1 - up_.position(factor_y() * y))};
  }

  std::string opening() const {
    const double height = bottom() + 46;
    const bool page = d_.theme == PlotTheme::Page;
    std::string size = fmt::format("viewBox=\"0 0 {:.0f} {:.0f}\"", d_.width, height);
    if (!page) size += fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", d_.width, height);
    const std::string label = d_.title.empty() ? d_.y_name + " against " + d_.x_name : d_.title;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"maup-plot\" role=\"img\" {} aria-label=\"{}\">\n", size,
        escape_xml(label));
    if (!page)
      out += fmt::format("<style>{}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n",
                         own_style(d_.theme));
    return out;
  }

  std::size_t colours() const { return plot_palette(false).size(); }
  std::string line_attributes(std::size_t series, bool dashed) const {
    return fmt::format("class=\"curve {}{}", series_attributes(series % colours(), colours()),
                       dashed ? " stroke-dasharray=\"5 4\"" : "");
  }

  struct KeyPlace {
    std::size_t row;
    double x;
  };
  /// As many keys in a row as the frame is wide.
  std::vector<KeyPlace> key_places() const {
    std::vector<KeyPlace> out;
    double x = left_;
    std::size_t row = 0;
    for (const Diagram::Key& key : d_.legend) {
      const double width = 26 + text_width({{key.text}}, label_size);
      if (x > left_ && x + width > right_) {
        ++row;
        x = left_;
      }
      out.push_back({row, x});
      x += width + 18;
    }
    return out;
  }

  std::string legend() const {
    std::string out;
    const std::vector<KeyPlace> places = key_places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Diagram::Key& key = d_.legend[i];
      const double x = places[i].x,
                   y = top_ - 10 - line_height * static_cast<double>(places.back().row - places[i].row);
      if (key.dots)
        out += fmt::format("<circle class=\"dot {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n",
                           series_attributes(key.series % colours(), colours()), x + 10, y - 4);
      else
        out += fmt::format("<path {} d=\"M{:.1f} {:.1f}h20\"/>", line_attributes(key.series, key.dashed), x, y - 4);
      out += text_element(x + 26, y, "start", label_size, {{key.text}});
    }
    return out;
  }

  std::string frame() const {
    std::string grid, labels;
    const auto vertical = [&](double x, const RichText& text) {
      grid += fmt::format("M{:.1f} {:.1f}v{:.1f}", x, top_, height_);
      labels += text_element(x, bottom() + 17, "middle", tick_size, text, " class=\"tick\"");
    };
    if (d_.x_labels.empty())
      for (const Tick& tick : across_.ticks()) vertical(left_ + (right_ - left_) * tick.position, {{tick.label}});
    else
      for (const auto& [at, name] : d_.x_labels)
        vertical(left_ + (right_ - left_) * across_.position(at), name_text(name));
    for (const Tick& tick : up_.ticks()) {
      const double y = top_ + height_ * (1 - tick.position);
      grid += fmt::format("M{:.1f} {:.1f}h{:.1f}", left_, y, right_ - left_);
      labels += text_element(left_ - 7, y + 4, "end", tick_size, {{tick.label}}, " class=\"tick\"");
    }
    std::string out =
        fmt::format("<path class=\"grid\" d=\"{}\"/>\n<path class=\"axis\" d=\"M{:.1f} {:.1f}v{:.1f}h{:.1f}\"/>\n",
                    grid, left_, top_, height_, right_ - left_);
    if (d_.zero_line) out += zero_lines();
    out += labels;
    if (!d_.x_name.empty())
      out += text_element((left_ + right_) / 2, bottom() + 39, "middle", label_size,
                          axis_text({d_.x_name}, d_.degrees_x ? "°" : d_.x_unit, across_));
    const double middle = top_ + height_ / 2;
    return out + text_element(18, middle, "middle", label_size,
                              axis_text({d_.y_name}, d_.degrees_y ? "°" : d_.y_unit, up_),
                              fmt::format(" transform=\"rotate(-90 18 {:.1f})\"", middle));
  }

  std::string zero_lines() const {
    const Pixel origin = place(0, 0);
    std::string d;
    if (origin.x > left_ && origin.x < right_) d += fmt::format("M{:.1f} {:.1f}v{:.1f}", origin.x, top_, height_);
    if (origin.y > top_ && origin.y < bottom())
      d += fmt::format("M{:.1f} {:.1f}h{:.1f}", left_, origin.y, right_ - left_);
    return d.empty() ? d : fmt::format("<path class=\"axis\" d=\"{}\"/>\n", d);
  }

  std::string drawn(const Diagram::Curve& curve) const {
    MAUP_REQUIRE(curve.x.size() == curve.y.size());
    Polyline points;
    for (std::size_t i = 0; i < curve.x.size(); ++i) points.push_back(place(curve.x[i], curve.y[i]));
    std::vector<Polyline> lines = split_at_gaps(points);
    std::string out;
    const auto dot = [&](Pixel p, double r) {
      out += fmt::format("<circle class=\"dot {} cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n",
                         series_attributes(curve.series % colours(), colours()), p.x, p.y, r);
    };
    if (curve.dots) {
      for (const Polyline& line : lines)
        for (const Pixel& p : line) dot(p, 1.6);
      return out;
    }
    for (Polyline& line : lines) {
      if (line.size() == 1) dot(line[0], 2);
      line = straighten(line, 0.04);
    }
    return out + fmt::format("<path {} d=\"{}\"/>\n", line_attributes(curve.series, curve.dashed), path_data(lines));
  }

  std::string drawn(const Diagram::Mark& mark) const {
    const Pixel p = place(mark.x, mark.y);
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return {};
    const bool right_half = p.x > (left_ + right_) / 2;
    return fmt::format("<circle class=\"axis\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4\"/>\n", p.x, p.y) +
           (mark.label.empty() ? ""
                               : text_element(p.x + (right_half ? -9 : 9), p.y - 9, right_half ? "end" : "start",
                                              tick_size, {{mark.label}}));
  }

  const Diagram& d_;
  Axis across_, up_;
  double left_ = 0, right_ = 0, top_ = 0, height_ = 0;
};

}  // namespace

std::string diagram_svg(const Diagram& diagram) { return Picture(diagram).svg(); }

}  // namespace maupertuis

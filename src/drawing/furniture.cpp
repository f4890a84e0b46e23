#include "drawing/frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::drawing {
namespace {

using Ink = FrameColour::Ink;

std::string length_text(double size, bool dimensionless) {
  struct Unit {
    double size;
    const char* name;
  };
  static constexpr Unit units[] = {{1e9, "Gm"},  {1e6, "Mm"},  {1e3, "km"},  {1, "m"},
                                   {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "µm"}, {1e-9, "nm"}};
  if (dimensionless) return fmt::format("{:.2g}", size);
  const Unit* unit =
      std::find_if(std::begin(units), std::end(units) - 1, [&](const Unit& u) { return size >= 0.999 * u.size; });
  const double number = size / unit->size;
  return number < 1e5 ? fmt::format("{:g} {}", std::stod(fmt::format("{:.2g}", number)), unit->name)
                      : fmt::format("{:.0e} m", size);
}

/// 1, 2 or 5 times a power of ten of metres, about 90 px long.
void add_scale_bar(std::vector<FrameItem>& out, const Drawing& drawing, const View& view, const FrameOptions& options) {
  const double wanted = 90 * view.unit() / view.scale(), power = std::pow(10, std::floor(std::log10(wanted)));
  double size = power;
  for (const double factor : {2.0, 5.0})
    if (factor * power <= wanted) size = factor * power;
  const double u = view.unit(), x = 18 * u, y = options.height - 16 * u, end = x + size * view.scale();
  FrameItem bar;
  bar.points = {x, y - 4 * u, x, y, end, y, end, y - 4 * u};
  bar.stroke = {Ink::Muted};
  bar.width = u;
  out.push_back(std::move(bar));
  out.push_back(
      words({length_text(size, drawing.dimensionless), "", 0, true}, end + 7 * u, y - 3 * u, 'l', {Ink::Muted}));
}

void add(std::vector<FrameItem>& out, std::vector<FrameItem> more) {
  for (FrameItem& item : more) out.push_back(std::move(item));
}

void add_gravity(std::vector<FrameItem>& out, const Drawing& drawing, const View& view, const FrameOptions& options) {
  double norm = 0;
  for (const double g : drawing.gravity) norm = std::hypot(norm, g);
  if (!(norm > 0)) return;
  const std::vector<double> centre = view.centre_at(0);
  std::vector<double> tip = centre;
  for (std::size_t k = 0; k < tip.size(); ++k) tip[k] += drawing.gravity[k] / norm * drawing.radius;
  const View::Placed from = view.project(centre.data(), centre), to = view.project(tip.data(), centre);
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy), u = view.unit();
  if (!(length > 0)) return;
  const double size = std::min(34.0, 34 * length / (view.scale() * drawing.radius) + 8) * u, x = options.width - 30 * u,
               y = 26 * u;
  add(out, arrow({x, y}, {x + dx / length * size, y + dy / length * size}, {Ink::Muted}, 1.3, u));
  out.push_back(words({"g", "", 0, false}, x + dx / length * size / 2 - 11 * u * std::abs(dy / length),
                      y + dy / length * size / 2 - 11 * u * std::abs(dx / length), 'c', {Ink::Muted}));
}

void add_axes(std::vector<FrameItem>& out, const Drawing& drawing, const View& view, const FrameOptions& options) {
  const std::vector<double> centre = view.centre_at(0);
  const View::Placed origin = view.project(centre.data(), centre);
  const double u = view.unit(), x = 44 * u, y = options.height - 40 * u;
  constexpr const char* names[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> tip = centre;
    tip[k] += 0.05 * drawing.radius;
    const View::Placed at = view.project(tip.data(), centre);
    const double dx = (at.x - origin.x) / (0.05 * drawing.radius * view.scale()),
                 dy = (at.y - origin.y) / (0.05 * drawing.radius * view.scale());
    add(out, arrow({x, y}, {x + 27 * u * dx, y + 27 * u * dy}, {Ink::Muted}, 1.2, u));
    if (std::hypot(dx, dy) > 0.15)
      out.push_back(words({names[k], "", 0, false}, x + 36 * u * dx, y + 36 * u * dy, 'c', {Ink::Muted}));
  }
}

}  // namespace

std::vector<FrameItem> furniture(const Drawing& drawing, const View& view, const FrameOptions& options) {
  std::vector<FrameItem> out;
  if (options.furniture) {
    if (drawing.dimension == 2)
      add_scale_bar(out, drawing, view, options);
    else
      add_axes(out, drawing, view, options);
    add_gravity(out, drawing, view, options);
  }
  if (!options.caption.empty())
    out.push_back(words({options.caption, "", 0, true}, options.width - 16 * view.unit(),
                        options.height - 19 * view.unit(), 'r', {Ink::Muted}));
  return out;
}

std::size_t series_of(const Drawing::Element& e) {
  using Origin = Drawing::ForceOrigin;
  switch (e.origin) {
    case Origin::Asked:
      return e.impulse ? 4 : 1;
    case Origin::Reaction:
      return 1;
    case Origin::Weight:
      return 3;
    case Origin::Spring:
      return 2;
    case Origin::Damper:
      return 6;
    case Origin::Applied:
      return 5;
    case Origin::Potential:
      return 0;
    case Origin::Torque:
      return 4;
  }
  return 1;
}

std::vector<FrameItem> arrow(std::array<double, 2> from, std::array<double, 2> to, FrameColour colour, double weight,
                             double unit) {
  const double dx = to[0] - from[0], dy = to[1] - from[1], length = std::hypot(dx, dy);
  if (!(length >= 4 * unit)) return {};
  const double ux = dx / length, uy = dy / length, long_ = std::min(8 * std::sqrt(weight / 1.3) * unit, 0.6 * length),
               half = 0.4 * long_;
  FrameItem shaft, head;
  shaft.points = {from[0], from[1], to[0] - 0.7 * long_ * ux, to[1] - 0.7 * long_ * uy};
  shaft.stroke = colour;
  shaft.width = weight * unit;
  head.points = {to[0],
                 to[1],
                 to[0] - long_ * ux - half * uy,
                 to[1] - long_ * uy + half * ux,
                 to[0] - long_ * ux + half * uy,
                 to[1] - long_ * uy - half * ux};
  head.closed = true;
  head.fill = colour;
  return {shaft, head};
}

FrameItem words(const NameParts& text, double x, double y, char align, FrameColour colour) {
  FrameItem item;
  item.kind = FrameItem::Kind::Text;
  item.points = {x, y};
  item.text = text;
  item.align = align;
  item.fill = colour;
  return item;
}

std::vector<double> thinned(const std::vector<double>& line, double step) {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
    const bool ends = i == 0 || i + 2 == line.size();
    if (!ends && std::hypot(line[i] - out[out.size() - 2], line[i + 1] - out.back()) < step) continue;
    out.insert(out.end(), {line[i], line[i + 1]});
  }
  return out;
}

std::array<double, 6> sides_of(const std::array<double, 3>& e) {
  // Across the axis of the world that e is farthest from; for a circle the choice does not show.
  std::size_t seed = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(e[k]) < std::abs(e[seed])) seed = k;
  const double norm = std::hypot(e[0], e[1], e[2]);
  const std::array<double, 3> n{e[0] / norm, e[1] / norm, e[2] / norm};
  std::array<double, 3> u{-n[seed] * n[0], -n[seed] * n[1], -n[seed] * n[2]};
  u[seed] += 1;
  const double size = std::hypot(u[0], u[1], u[2]);
  for (double& x : u) x /= size;
  return {u[0], u[1], u[2], n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
}

}  // namespace maupertuis::drawing

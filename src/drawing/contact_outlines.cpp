#include "drawing/contact_outlines.hpp"

#include "drawing/contact_surfaces.hpp"
#include "drawing/moments.hpp"
#include "drawing/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace maupertuis::drawing {
namespace {

using Kind = Drawing::Kind;
using Place = std::array<double, 2>;

constexpr double longest_force = 0.22, longest_impulse = 0.26;  // parts of the scene
constexpr double part_of_the_run = 1.0 / 60;                    // for which an impulse is seen

double to_segment(const Place& p, const Place& a, const Place& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const double u = square > 0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p[0] - a[0] - u * dx, p[1] - a[1] - u * dy);
}

bool is_round(const SolidShape& shape) {
  const auto& list = shape.faces.empty() ? shape.lines : shape.faces;
  return !list.empty() && list[0].closed && list[0].points.size() > 8;
}

class ContactPictures {
 public:
  ContactPictures(const ContactSetting& setting, std::vector<Outline>& outlines) : s_(setting), outlines_(outlines) {
    find_still_lines();
  }

  void add() {
    for (const ContactPlaces& c : s_.tracks.contacts)
      if (c.places.size() == 1) add_surface(c);
    for (const Line& line : lines_) cut(line);
    add_arrows();
    for (Outline& o : new_) outlines_.push_back(std::move(o));
  }

 private:
  std::size_t frames() const { return s_.drawing.times.size(); }

  /// What the model draws and what stands still, as lines.
  void find_still_lines() {
    for (const Outline& o : outlines_) {
      const Drawing::Element& e = o.element;
      if (e.kind != Kind::Path && e.kind != Kind::Solid) continue;
      const std::size_t width = 2 * e.points;
      bool moves = false;
      for (std::size_t i = width; i < e.positions.size(); ++i)
        moves = moves || std::abs(e.positions[i] - e.positions[i % width]) > 1e-9 * s_.extent;
      if (moves && !turns_in_place(e)) continue;
      const std::vector<double> pose(e.positions.begin(), e.positions.begin() + static_cast<std::ptrdiff_t>(width));
      if (e.kind == Kind::Path)
        still_.push_back(pose);
      else
        for (const auto* list : {&e.shape.faces, &e.shape.lines})
          for (const SolidShape::Outline& line : *list) still_.push_back(carried(line, pose));
    }
  }

  /// A disc about a middle that stands still.
  bool turns_in_place(const Drawing::Element& e) const {
    if (e.kind != Kind::Solid || !is_round(e.shape)) return false;
    for (std::size_t i = 0; i + 6 <= e.positions.size(); i += 6) {
      const double* p = &e.positions[i];
      const double u = std::hypot(p[2] - p[0], p[3] - p[1]), v = std::hypot(p[4] - p[0], p[5] - p[1]);
      const double off = std::hypot(p[0] - e.positions[0], p[1] - e.positions[1]) + std::abs(u - v);
      if (!(off <= 1e-9 * s_.extent)) return false;
    }
    return true;
  }

  static std::vector<double> carried(const SolidShape::Outline& line, const std::vector<double>& pose) {
    std::vector<double> out;
    const auto add = [&](const double* local) {
      double world[2];
      carry(pose, local, 2, world);
      out.insert(out.end(), {world[0], world[1]});
    };
    for (std::size_t i = 0; i < line.points.size(); i += 2) add(&line.points[i]);
    if (line.closed) add(&line.points[0]);
    return out;
  }

  /// How far the shape of this name reaches against a direction, at a frame.
  double reach(const std::string& name, std::size_t frame, double nx, double ny) const {
    double out = 0;
    for (const Outline& o : outlines_) {
      const Drawing::Element& e = o.element;
      if (name.empty()) break;
      for (std::size_t p = 0; e.kind == Kind::Path && p < e.points; ++p)
        if (e.names[p] == name && e.masses[p] > 0) out = std::max(out, e.radii[p]);
      if (e.kind != Kind::Solid || e.names != std::vector<std::string>{name}) continue;
      const std::size_t at = e.still ? 0 : 6 * frame;
      const std::vector<double> pose(e.positions.begin() + static_cast<std::ptrdiff_t>(at),
                                     e.positions.begin() + static_cast<std::ptrdiff_t>(at + 6));
      if (is_round(e.shape)) {  // an ellipse, whatever polygon stands for it
        out = std::max(out, std::hypot((pose[2] - pose[0]) * nx + (pose[3] - pose[1]) * ny,
                                       (pose[4] - pose[0]) * nx + (pose[5] - pose[1]) * ny));
        continue;
      }
      const std::vector<double> points = reach_of(e.shape, pose);
      for (std::size_t i = 0; i < points.size(); i += 2)
        out = std::max(out, -(points[i] - pose[0]) * nx - (points[i + 1] - pose[1]) * ny);
    }
    return out;
  }

  // ------------------------------------------------------------------------------------------------------ surfaces

  void add_surface(const ContactPlaces& c) {
    const auto least =
        std::min_element(c.gap.begin(), c.gap.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const auto nearest = static_cast<std::size_t>(least - c.gap.begin());
    const SurfaceRequest request{
        s_.system,        s_.parameters,
        s_.drawing,       c,
        s_.tracks.states, s_.low,
        s_.high,          s_.extent,
        s_.hatching,      [&](double nx, double ny) { return reach(c.places[0].name, nearest, nx, ny); }};
    for (Surface& surface : surfaces_of(request)) {
      if ((surface.still && is_shown(surface)) || is_string(surface, c.places[0].name)) continue;
      include(surface, c);
      if (surface.still) still_.push_back(surface.line);
      Outline o;
      o.element.kind = Kind::Solid;
      o.element.points = 3;
      o.element.still = surface.still;
      o.element.shape = std::move(surface.shape);
      o.element.positions = std::move(surface.positions);
      if (surface.straight && surface.still && !surface.stop) lines_.push_back({new_.size(), c.places[0].name});
      new_.push_back(std::move(o));
    }
  }

  /// A straight surface that stands still, and what touches it.
  struct Line {
    std::size_t outline;  // of the new ones
    std::string place;
  };

  /// It ends where what touches it cannot be for another one: in the corners of a box.
  void cut(const Line& line) {
    Drawing::Element& e = new_[line.outline].element;
    std::vector<double>& p = e.positions;
    const double half = std::abs(e.shape.lines[0].points[0]), tx = p[2] - p[0], ty = p[3] - p[1];
    double low = -half, high = half;
    for (const Line& other : lines_) {
      if (other.outline == line.outline || other.place != line.place) continue;
      const std::vector<double>& w = new_[other.outline].element.positions;
      const double nx = w[4] - w[0], ny = w[5] - w[1], slope = tx * nx + ty * ny;
      const double end = -((p[0] - w[0]) * nx + (p[1] - w[1]) * ny) / slope;
      if (std::abs(slope) < 0.05) continue;
      (slope > 0 ? low : high) = slope > 0 ? std::max(low, end) : std::min(high, end);
    }
    if (!(high - low > 2 * s_.hatching) || high - low >= 2 * half) return;
    const double middle = (low + high) / 2;
    e.shape = shapes::ground_line((high - low) / 2, s_.hatching);
    for (std::size_t i = 0; i < 6; i += 2) p[i] += middle * tx, p[i + 1] += middle * ty;
  }

  /// As much of it as shows what it is: all of a curve that closes or ends, of a longer one what the motion comes to.
  void include(const Surface& surface, const ContactPlaces& c) const {
    const std::vector<double>& line = surface.line;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (std::size_t i = 0; i < line.size(); ++i)
      low[i % 2] = std::min(low[i % 2], line[i]), high[i % 2] = std::max(high[i % 2], line[i]);
    const bool whole =
        (surface.closed || c.freedoms == 1) && std::max(high[0] - low[0], high[1] - low[1]) < 2.5 * s_.extent;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      bool near = whole;
      for (std::size_t f = 0; f < frames() && !near; f += 1 + frames() / 200)
        near = std::hypot(c.places[0].at[2 * f] - line[i], c.places[0].at[2 * f + 1] - line[i + 1]) <
               std::abs(c.gap[f]) + surface.distance + 0.04 * s_.extent;
      if (!near) continue;
      for (const int side : {-1, 1})
        for (std::size_t k = 0; k < 2; ++k) {
          double at[2] = {line[i], line[i + 1]};
          at[k] += side * 0.6 * s_.hatching;
          s_.include(at, 0);
        }
    }
    if (surface.still) return;
    for (std::size_t f = 0; f < frames(); ++f) s_.include(&surface.positions[6 * f], f);
  }

  /// Whether ground, a wall, a circle or a line of the model shows it, as far as it is seen.
  bool is_shown(const Surface& surface) const {
    const double tolerance = surface.distance + 0.015 * s_.extent;
    if (surface.stop) return is_on_the_drawn({surface.positions[0], surface.positions[1]}, tolerance);
    const Place middle{(s_.low[0] + s_.high[0]) / 2, (s_.low[1] + s_.high[1]) / 2};
    Place nearest{HUGE_VAL, HUGE_VAL};
    for (std::size_t i = 0; i + 1 < surface.line.size(); i += 2) {
      const Place p{surface.line[i], surface.line[i + 1]};
      if (std::hypot(p[0] - middle[0], p[1] - middle[1]) < std::hypot(nearest[0] - middle[0], nearest[1] - middle[1]))
        nearest = p;
      const bool seen = p[0] >= s_.low[0] && p[0] <= s_.high[0] && p[1] >= s_.low[1] && p[1] <= s_.high[1];
      if (seen && !is_on_the_drawn(p, tolerance)) return false;
    }
    return is_on_the_drawn(nearest, tolerance);
  }

  bool is_on_the_drawn(const Place& p, double tolerance) const {
    return is_near_line(p, tolerance) || std::any_of(s_.grounds.begin(), s_.grounds.end(), [&](const WrittenGround& g) {
             return std::abs((p[0] - g.place[0]) * g.normal[0] + (p[1] - g.place[1]) * g.normal[1]) <=
                    tolerance * std::hypot(g.normal[0], g.normal[1]);
           });
  }

  bool is_near_line(const Place& p, double tolerance) const {
    for (const std::vector<double>& line : still_)
      for (std::size_t k = 0; k + 3 < line.size(); k += 2)
        if (to_segment(p, {line[k], line[k + 1]}, {line[k + 2], line[k + 3]}) <= tolerance) return true;
    return false;
  }

  /// A bound of the distance from a fixed place to which a line is drawn is the string or rod that the line shows.
  bool is_string(const Surface& surface, const std::string& name) const {
    for (const Outline& o : outlines_) {
      const Drawing::Element& e = o.element;
      if (e.kind != Kind::Path || name.empty()) continue;
      for (std::size_t p = 0; p < e.points; ++p)
        for (const std::size_t other : {p - 1, p + 1}) {
          if (e.names[p] != name || other >= e.points) continue;
          const double *end = &e.positions[2 * other],
                       *then = end + (e.positions.size() / (2 * e.points) / 2) * 2 * e.points;
          if (std::hypot(end[0] - then[0], end[1] - then[1]) > 1e-9 * s_.extent) continue;
          double least = HUGE_VAL, most = 0;
          for (std::size_t i = 0; i + 1 < surface.line.size(); i += 2) {
            const double d = std::hypot(surface.line[i] - end[0], surface.line[i + 1] - end[1]);
            least = std::min(least, d), most = std::max(most, d);
          }
          if (most - least < 1e-3 * most) return true;
        }
    }
    return false;
  }

  // -------------------------------------------------------------------------------------------------------- arrows

  bool drawn_by_the_model(const std::string& label) const {
    return std::any_of(outlines_.begin(), outlines_.end(), [&](const Outline& o) {
      return o.placement == Outline::Placement::Force && !o.element.names.empty() && o.element.names[0] == label;
    });
  }

  void add_arrows() {
    double force = 0, impulse = 0;
    for (const ContactPlaces& c : s_.tracks.contacts)
      for (std::size_t f = 0; f < c.multiplier.size(); ++f)
        for (const auto& place : c.places) {
          const double size = std::abs(c.multiplier[f]) * std::hypot(place.push[2 * f], place.push[2 * f + 1]);
          if (std::isfinite(size)) force = std::max(force, size);
        }
    for (const ContactPlaces& c : s_.tracks.contacts)
      for (const ContactImpulse& i : s_.impulses)
        if (i.contact == c.contact)
          for (const auto& place : c.places) impulse = std::max(impulse, i.size * slope(place, frame_at(i.t)));
    const double metres = s_.metres_a_newton > 0 ? s_.metres_a_newton
                          : force > 0            ? longest_force * s_.extent / force
                                                 : 0;
    if (force > 0) s_.drawing.metres_a_newton = metres;
    for (const ContactPlaces& c : s_.tracks.contacts) {
      const std::string label = s_.system.contact_label(c.contact);
      for (const auto& place : c.places) {
        if (metres > 0 && !c.multiplier.empty() && !drawn_by_the_model(label)) force_on(c, place, label, metres);
        if (impulse > 0) impulses_on(c, place, longest_impulse * s_.extent / impulse);
      }
    }
  }

  double slope(const ContactPlaces::Place& place, std::size_t f) const {
    const double out = std::hypot(place.push[2 * f], place.push[2 * f + 1]);
    return std::isfinite(out) ? out : 0;
  }

  std::size_t frame_at(double t) const {
    const auto& times = s_.drawing.times;
    const auto found = std::lower_bound(times.begin(), times.end(), t);
    return std::min<std::size_t>(static_cast<std::size_t>(found - times.begin()), times.size() - 1);
  }

  /// Where the force acts: on the rim of what touches.
  Place foot(const ContactPlaces::Place& place, std::size_t f) const {
    const double size = std::hypot(place.push[2 * f], place.push[2 * f + 1]);
    const double nx = size > 0 ? place.push[2 * f] / size : 0, ny = size > 0 ? place.push[2 * f + 1] / size : 0;
    const double r = reach(place.name, f, nx, ny);
    return {place.at[2 * f] - r * nx, place.at[2 * f + 1] - r * ny};
  }

  Outline arrow() const {
    Outline o;
    o.element.kind = Kind::Arrow;
    o.element.points = 2;
    return o;
  }

  void put(Outline& o, const Place& foot, double dx, double dy, std::size_t f) const {
    const double tip[2] = {foot[0] + dx, foot[1] + dy};
    o.element.positions.insert(o.element.positions.end(), {foot[0], foot[1], tip[0], tip[1]});
    s_.include(tip, f);
  }

  void force_on(const ContactPlaces& c, const ContactPlaces::Place& place, const std::string& label, double metres) {
    Outline o = arrow();
    o.element.names = {label, ""};
    if (c.places.size() == 1) o.element.text = name_parts(label);
    bool acts = false;
    for (std::size_t f = 0; f < frames(); ++f) {
      const double factor = std::isfinite(c.multiplier[f]) ? metres * c.multiplier[f] : 0;
      acts = acts || factor != 0;
      const Place rubs = friction_on(c, place, f);
      put(o, foot(place, f), factor * place.push[2 * f] + metres * rubs[0],
          factor * place.push[2 * f + 1] + metres * rubs[1], f);
    }
    if (acts) new_.push_back(std::move(o));
  }

  Place friction_on(const ContactPlaces& c, const ContactPlaces::Place& place, std::size_t f) const {
    const double size = slope(place, f);
    if (c.friction.empty() || !std::isfinite(c.friction[f]) || !(size > 0)) return {0, 0};
    return {c.friction[f] * place.push[2 * f + 1] / size, -c.friction[f] * place.push[2 * f] / size};
  }

  /// At the place of the impact, the longer the larger; it shrinks until it is gone.
  void impulses_on(const ContactPlaces& c, const ContactPlaces::Place& place, double metres) {
    const auto& times = s_.drawing.times;
    Outline o = arrow();
    o.element.impulse = true;
    o.element.names = {s_.system.contact_label(c.contact), ""};
    std::vector<ContactImpulse> own;
    for (const ContactImpulse& i : s_.impulses)
      if (i.contact == c.contact) own.push_back(i);
    if (own.empty()) return;
    const double seen = std::max(part_of_the_run * (times.back() - times.front()),
                                 2.5 * (times.back() - times.front()) / static_cast<double>(frames()));
    std::size_t next = 0;
    for (std::size_t f = 0; f < frames(); ++f) {
      while (next < own.size() && own[next].t <= times[f]) ++next;
      double most = 0;
      std::size_t at = f;
      for (std::size_t k = next; k-- > 0 && times[f] - own[k].t < seen;) {
        const double left = own[k].size * (1 - (times[f] - own[k].t) / seen);
        if (left > most) most = left, at = frame_at(own[k].t);
      }
      put(o, foot(place, at), metres * most * place.push[2 * at], metres * most * place.push[2 * at + 1], f);
    }
    new_.push_back(std::move(o));
  }

  const ContactSetting& s_;
  std::vector<Outline>& outlines_;
  std::vector<Outline> new_;
  std::vector<Line> lines_;
  std::vector<std::vector<double>> still_;  // [n × 2] each
};

}  // namespace

void add_contacts(const ContactSetting& setting, std::vector<Outline>& outlines) {
  ContactPictures(setting, outlines).add();
}

}  // namespace maupertuis::drawing

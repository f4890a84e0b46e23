#include "drawing/contact_outlines.hpp"
#include "drawing/outlines.hpp"
#include "drawing/shapes.hpp"

#include <maupertuis/constraint_manifold.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

/// Sizes that a picture needs and no model says: parts of its extent.
namespace maupertuis::drawing {
namespace {

using Kind = Drawing::Kind;
using Fitting = Outline::Fitting;
using Placement = Outline::Placement;

constexpr double bob_size = 0.024, joint_size = 0.007, pivot_size = 0.042, anchor_size = 0.042, coil_size = 0.02,
                 dashpot_size = 0.018;
constexpr int spokes_of_a_wheel = 6;
constexpr double hatching = 0.028, longest_arrow = 1.0 / 3, torque_size = 0.07;

double distance(const double* a, const double* b, std::size_t d) {
  double square = 0;
  for (std::size_t k = 0; k < d; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

class Settler {
 public:
  Settler(Drawing& drawing, std::vector<Outline>& outlines, const Plan& plan, const MechanicalSystem& system,
          const Bindings& parameters, const ContactTracks& contacts, const std::vector<ContactImpulse>& impulses)
      : drawing_(drawing),
        outlines_(outlines),
        plan_(plan),
        system_(system),
        parameters_(parameters),
        contacts_(contacts),
        impulses_(impulses),
        d_(static_cast<std::size_t>(drawing.dimension)) {}

  void settle() {
    find_bounds();
    drawing_.metres_a_newton = longest_force_ > 0 ? longest_arrow * extent_ / longest_force_ : 0;
    for (Outline& o : outlines_) place(o);
    size_marks();
    const std::vector<WrittenGround> grounds = written_grounds();
    add_contacts(grounds);
    add_grounds(grounds);
    for (Outline& o : outlines_) drawing_.elements.push_back(std::move(o.element));
    // What stands on the paper comes first, then the ways of points.
    const auto rank = [](const Drawing::Element& e) {
      if (e.kind == Kind::Solid && e.shape.role == SolidShape::Role::Ground) return 0;
      if (e.kind == Kind::Arrow) return 3;
      if (e.kind == Kind::Label) return 4;
      return e.kind == Kind::Trail ? 1 : 2;
    };
    std::stable_sort(drawing_.elements.begin(), drawing_.elements.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  }

 private:
  void find_bounds();
  void include(const double* place, std::size_t frame, double reach = 0);
  void include_solid(const Outline& o, std::size_t frame, const double* pose);
  void place(Outline& o);
  struct Link;
  struct LinkAxes;
  Link link_of(const std::vector<double>& positions) const;
  LinkAxes shape_dashpot(Outline& o, const Link& link) const;
  LinkAxes shape_link(Outline& o, const Link& link) const;
  void place_link(Outline& o);
  void place_axis(Outline& o);
  bool spins(const Drawing::Element& e) const;
  void place_arrow(Outline& o);
  void place_pivot(Outline& o);
  void size_marks();
  std::vector<WrittenGround> written_grounds() const;
  void add_contacts(const std::vector<WrittenGround>& grounds);
  void add_grounds(const std::vector<WrittenGround>& grounds);
  void add_ground(std::vector<double> place, std::vector<double> normal);
  std::vector<double> up() const;
  /// Floor, ceiling or wall: the one that a spring of this direction stands on best.
  std::pair<double, double> away_from_wall(const std::vector<double>& direction) const;

  Drawing& drawing_;
  std::vector<Outline>& outlines_;
  const Plan& plan_;
  const MechanicalSystem& system_;
  const Bindings& parameters_;
  const ContactTracks& contacts_;
  const std::vector<ContactImpulse>& impulses_;
  std::size_t d_;
  std::vector<double> world_low_, world_high_;
  double extent_ = 1;
  double longest_force_ = 0;
};

void Settler::include(const double* place, std::size_t frame, double reach) {
  for (std::size_t k = 0; k < d_; ++k) {
    if (!std::isfinite(place[k]) || !std::isfinite(reach)) continue;
    const double seen = place[k] - (drawing_.follow.empty() ? 0 : drawing_.follow[frame * d_ + k]);
    drawing_.low[k] = std::min(drawing_.low[k], seen - reach);
    drawing_.high[k] = std::max(drawing_.high[k], seen + reach);
    world_low_[k] = std::min(world_low_[k], place[k] - reach);
    world_high_[k] = std::max(world_high_[k], place[k] + reach);
  }
}

/// The box around a box, or around the ellipsoid that the axes span.
void Settler::include_solid(const Outline& o, std::size_t frame, const double* pose) {
  if (o.placement == Placement::AboutAxis) return include(pose, frame, o.size);
  const bool corners = !o.element.shape.faces.empty() && o.element.shape.faces[0].points.size() == 4 * d_;
  for (const int side : {-1, 1}) {
    std::vector<double> tip(d_);
    for (std::size_t k = 0; k < d_; ++k) {
      double sum = 0;
      for (std::size_t a = 1; a <= d_; ++a) {
        const double part = pose[a * d_ + k] - pose[k];
        sum += corners ? std::abs(part) : part * part;
      }
      tip[k] = pose[k] + side * (corners ? sum : std::sqrt(sum));
    }
    include(tip.data(), frame);
  }
}

void Settler::find_bounds() {
  for (auto* list : {&drawing_.low, &world_low_}) list->assign(d_, HUGE_VAL);
  for (auto* list : {&drawing_.high, &world_high_}) list->assign(d_, -HUGE_VAL);
  const std::size_t frames = drawing_.times.size();
  for (const Outline& o : outlines_) {
    const std::size_t width = o.values.size();
    if (o.element.still && !drawing_.follow.empty()) continue;
    if (o.element.kind == Kind::Trail && !drawing_.follow.empty()) continue;  // the past is left behind
    for (std::size_t f = 0; f < (o.element.still ? 1 : frames); ++f) {
      const double* at = o.element.positions.data() + f * width;
      if (o.placement == Placement::Force) {
        double force = 0;
        for (std::size_t k = 0; k < d_; ++k) force = std::hypot(force, at[d_ + k]);
        if (std::isfinite(force)) longest_force_ = std::max(longest_force_, force);
      } else if (o.placement == Placement::Torque) {
        double torque = 0;
        for (std::size_t k = d_; k < width; ++k) torque = std::hypot(torque, at[k]);
        if (std::isfinite(torque)) drawing_.largest_torque = std::max(drawing_.largest_torque, torque);
      } else if (o.fitting == Fitting::Pivot)
        include(at, f);
      else if (o.element.kind == Kind::Solid && (o.fitting == Fitting::None || o.fitting == Fitting::Wheel))
        include_solid(o, f, at);
      else
        for (std::size_t p = 0; p < width / d_; ++p) include(at + p * d_, f);
    }
  }
  for (std::size_t k = 0; k < d_; ++k) {
    if (!(drawing_.low[k] <= drawing_.high[k])) drawing_.low[k] = drawing_.high[k] = world_low_[k] = world_high_[k] = 0;
    extent_ = std::max(k == 0 ? 0 : extent_, drawing_.high[k] - drawing_.low[k]);
  }
  if (!(extent_ > 0)) extent_ = 1;
  if (!drawing_.follow.empty()) {  // something of what it passes
    const std::size_t across = d_ == 2 ? 1 : 2;
    for (std::size_t k = 0; k < across; ++k) drawing_.low[k] -= 0.4 * extent_, drawing_.high[k] += 0.4 * extent_;
  }
}

/// Whether a wheel turns about its own axis: its first axis towards its second, not with the plane of both.
bool Settler::spins(const Drawing::Element& e) const {
  const std::size_t width = e.points * d_;
  double turned = 0;
  for (std::size_t f = 0; f + 1 < e.positions.size() / width; ++f) {
    const double *now = &e.positions[f * width], *then = now + width;
    double part = 0, square = 0;
    for (std::size_t k = 0; k < d_; ++k) {
      const double u = now[d_ + k] - now[k], v = now[2 * d_ + k] - now[k];
      part += (then[d_ + k] - then[k] - u) * v;
      square += v * v;
    }
    if (std::isfinite(part)) turned += std::abs(part / square);
  }
  return turned > 1e-3;
}

void Settler::place(Outline& o) {
  if (o.placement == Placement::Force)
    place_arrow(o);
  else if (o.placement == Placement::Torque)
    place_torque(o, d_, torque_size * extent_, drawing_.largest_torque);
  else if (o.placement == Placement::AboutAxis)
    place_axis(o);
  else if (o.placement != Placement::Direct)
    place_link(o);
  else if (o.fitting == Fitting::Pivot)
    place_pivot(o);
  else if (o.fitting == Fitting::Wheel && spins(o.element))
    shapes::add_spokes(o.element.shape, drawing_.dimension, spokes_of_a_wheel);
}

/// Unit vectors across a direction of space, the same from frame to frame: by the axis of the world that it is never
/// close to.
std::array<double, 6> across(const double* e, std::size_t seed) {
  std::array<double, 3> s{};
  s[seed] = 1;
  std::array<double, 3> u{};
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) u[k] = s[k] - e[seed] * e[k], square += u[k] * u[k];
  if (!(square > 1e-12)) {
    const auto basis = shapes::basis_about({e[0], e[1], e[2]});
    return {basis[0][0], basis[0][1], basis[0][2], basis[1][0], basis[1][1], basis[1][2]};
  }
  for (double& x : u) x /= std::sqrt(square);
  return {u[0], u[1], u[2], e[1] * u[2] - e[2] * u[1], e[2] * u[0] - e[0] * u[2], e[0] * u[1] - e[1] * u[0]};
}

std::size_t seed_of(const std::vector<double>& directions) {
  std::array<double, 3> worst{};
  for (std::size_t i = 0; i < directions.size(); ++i) worst[i % 3] = std::max(worst[i % 3], std::abs(directions[i]));
  return static_cast<std::size_t>(std::min_element(worst.begin(), worst.end()) - worst.begin());
}

/// Two places in each frame, seen as a link.
struct Settler::Link {
  std::vector<double> lengths, along;  // [frames], [frames × d] unit vectors
  double shortest = HUGE_VAL, longest = 0, mean = 0;
};

/// The lengths of its axes; 0 along it: as long as it is at the time.
struct Settler::LinkAxes {
  double first = 1, thick = 1;
};

Settler::Link Settler::link_of(const std::vector<double>& positions) const {
  const std::size_t frames = positions.size() / (2 * d_);
  Link link;
  link.lengths.resize(frames), link.along.resize(frames * d_);
  double sum = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    const double *a = &positions[2 * f * d_], *b = a + d_;
    const double length = link.lengths[f] = distance(a, b, d_);
    for (std::size_t k = 0; k < d_; ++k) link.along[f * d_ + k] = length > 0 ? (b[k] - a[k]) / length : k == 0;
    if (!std::isfinite(length)) continue;
    link.shortest = std::min(link.shortest, length);
    link.longest = std::max(link.longest, length);
    sum += length;
  }
  link.mean = frames > 0 && sum > 0 ? sum / static_cast<double>(frames) : extent_;
  return link;
}

/// A dashpot that does not reach as far as its ends move has a picture that stretches.
Settler::LinkAxes Settler::shape_dashpot(Outline& o, const Link& link) const {
  const double thick = std::min(dashpot_size * extent_, 0.15 * link.mean);
  const bool plate = o.fitting == Fitting::Plate;
  if (link.longest > 1.7 * link.shortest) {
    o.element.shape = plate ? shapes::plate(drawing_.dimension, 0.45) : shapes::cup(drawing_.dimension, 0.35, 0.7);
    return {0, thick};
  }
  const double shortest = link.shortest, end = 0.85 * shortest, rod = link.longest - end + 0.06 * shortest;
  const double begin = std::max(0.1 * shortest, shortest - rod - 0.08 * shortest);
  o.element.shape = plate ? shapes::plate(drawing_.dimension, rod) : shapes::cup(drawing_.dimension, begin, end);
  return {1, thick};
}

Settler::LinkAxes Settler::shape_link(Outline& o, const Link& link) const {
  if (o.fitting == Fitting::Anchor) return {anchor_size * extent_, anchor_size * extent_};
  if (o.fitting != Fitting::Spring) return shape_dashpot(o, link);
  const double thick = std::min(coil_size * extent_, 0.2 * link.mean);
  const int windings = static_cast<int>(std::lround(std::clamp(0.8 * link.mean / (1.6 * thick), 5.0, 24.0)));
  o.element.shape = shapes::spring(drawing_.dimension, windings, 0.45 * thick / link.mean);
  return {0, thick};
}

/// From two places a frame to an origin and the tips of axes.
void Settler::place_link(Outline& o) {
  std::vector<double>& positions = o.element.positions;
  const Link link = link_of(positions);
  const auto [first, thick] = shape_link(o, link);
  if (o.aside != 0) shapes::add_bars_to_middle(o.element.shape, d_, o.aside, o.fitting == Fitting::Spring);
  std::vector<double> mean_direction(d_, 0);
  for (std::size_t i = 0; i < link.along.size(); ++i) mean_direction[i % d_] += link.along[i];
  const std::size_t seed = d_ == 3 ? seed_of(link.along) : 0;
  std::vector<double> poses;
  for (std::size_t f = 0; f < link.lengths.size(); ++f) {
    double* a = &positions[2 * f * d_];
    const double* e = &link.along[f * d_];
    const auto sides = d_ == 2 ? std::array<double, 6>{-e[1], e[0]} : across(e, seed);
    if (o.aside != 0)  // its neighbour is as thick
      for (std::size_t k = 0; k < d_; ++k) a[k] += o.aside * thick * sides[k];
    poses.insert(poses.end(), a, a + d_);
    if (o.fitting == Fitting::Anchor) {  // along the wall, then away from it
      const auto [x, y] = away_from_wall(mean_direction);
      poses.insert(poses.end(), {a[0] + first * y, a[1] - first * x, a[0] + thick * x, a[1] + thick * y});
      continue;
    }
    const double reach = first == 0 ? link.lengths[f] : first;
    for (std::size_t k = 0; k < d_; ++k) poses.push_back(a[k] + reach * e[k]);
    for (std::size_t s = 0; s < (d_ == 2 ? 2 : 6); ++s) poses.push_back(a[s % d_] + thick * sides[s]);
  }
  positions = std::move(poses);
}

void Settler::place_axis(Outline& o) {
  std::vector<double>& positions = o.element.positions;
  const std::size_t frames = positions.size() / 6;
  std::vector<double> axes, poses;
  for (std::size_t f = 0; f < frames; ++f) {
    const double* n = &positions[6 * f + 3];
    const double length = std::hypot(n[0], n[1], n[2]);
    for (std::size_t k = 0; k < 3; ++k) axes.push_back(length > 0 ? n[k] / length : k == 2);
  }
  const std::size_t seed = seed_of(axes);
  for (std::size_t f = 0; f < frames; ++f) {
    const double *a = &positions[6 * f], *n = &axes[3 * f];
    const auto sides = across(n, seed);
    poses.insert(poses.end(), a, a + 3);
    for (std::size_t s = 0; s < 6; ++s) poses.push_back(a[s % 3] + o.size * sides[s]);
    for (std::size_t k = 0; k < 3; ++k) poses.push_back(a[k] + o.size * n[k]);
  }
  positions = std::move(poses);
}

void Settler::place_arrow(Outline& o) {
  const double metres = drawing_.metres_a_newton;
  for (std::size_t i = 0; i + 2 * d_ <= o.element.positions.size(); i += 2 * d_) {
    double* foot = &o.element.positions[i];
    for (std::size_t k = 0; k < d_; ++k) foot[d_ + k] = foot[k] + metres * foot[d_ + k];
    if (o.element.origin == Drawing::ForceOrigin::Asked) include(foot + d_, i / (2 * d_));
  }
}

std::vector<double> Settler::up() const {
  std::vector<double> out(d_, 0);
  double square = 0;
  for (const double g : drawing_.gravity) square += g * g;
  out[d_ - 1] = 1;
  for (std::size_t k = 0; k < d_ && square > 0; ++k) out[k] = -drawing_.gravity[k] / std::sqrt(square);
  return out;
}

std::pair<double, double> Settler::away_from_wall(const std::vector<double>& direction) const {
  const std::vector<double> n = up();
  const double upwards = direction[0] * n[0] + direction[1] * n[1], aside = direction[0] * n[1] - direction[1] * n[0];
  const double side = std::abs(upwards) >= std::abs(aside) ? std::copysign(1.0, upwards) : std::copysign(1.0, aside);
  return std::abs(upwards) >= std::abs(aside) ? std::pair{side * n[0], side * n[1]}
                                              : std::pair{side * n[1], -side * n[0]};
}

/// Below what stands on it, above what hangs on it.
void Settler::place_pivot(Outline& o) {
  std::vector<double> n = up();
  if (!drawing_.gravity.empty() && !o.element.positions.empty() && drawing_.follow.empty()) {
    double above = 0;
    for (std::size_t k = 0; k < 2; ++k)
      above += n[k] * (o.element.positions[k] - (drawing_.low[k] + drawing_.high[k]) / 2);
    if (above > 0.05 * extent_)
      for (double& x : n) x = -x;
  }
  const double s = pivot_size * extent_;
  std::vector<double> poses;
  for (std::size_t i = 0; i + 6 <= o.element.positions.size(); i += 6) {
    const double* p = &o.element.positions[i];
    poses.insert(poses.end(), {p[0], p[1], p[0] + s * n[1], p[1] - s * n[0], p[0] + s * n[0], p[1] + s * n[1]});
    const double foot[2] = {p[0] - 1.4 * s * n[0], p[1] - 1.4 * s * n[1]};
    if (drawing_.follow.empty()) include(foot, i / 6);
  }
  o.element.positions = std::move(poses);
}

/// A bob's area follows its mass; none hides the rod that it hangs on.
void Settler::size_marks() {
  double heaviest = 0, shortest = HUGE_VAL;
  std::set<std::string> solids;
  for (const Outline& o : outlines_)
    if (o.element.kind == Kind::Solid) solids.insert(o.element.names.begin(), o.element.names.end());
  for (const Outline& o : outlines_) {
    const Drawing::Element& e = o.element;
    if (e.kind != Kind::Path) continue;
    for (const double m : e.masses) heaviest = std::max(heaviest, m);
    const std::size_t width = e.points * d_, frames = e.positions.size() / width;
    for (std::size_t p = 0; p + 1 < e.points; ++p) {
      double sum = 0;
      for (std::size_t f = 0; f < frames; ++f)
        sum += distance(&e.positions[f * width + p * d_], &e.positions[f * width + (p + 1) * d_], d_);
      if (const double mean = sum / static_cast<double>(frames); mean > 0) shortest = std::min(shortest, mean);
    }
  }
  const double largest = std::min(bob_size * extent_, 0.3 * shortest),
               joint = std::min(joint_size * extent_, 0.12 * shortest);
  for (Outline& o : outlines_) {
    Drawing::Element& e = o.element;
    for (std::size_t p = 0; e.kind == Kind::Path && p < e.points; ++p) {
      if (solids.count(e.names[p]) > 0) e.masses[p] = 0;  // it has a shape of its own
      const double m = e.masses[p];
      e.radii.push_back(m > 0 ? largest * std::max(0.4, std::sqrt(m / heaviest)) : joint);
    }
  }
}

std::vector<WrittenGround> Settler::written_grounds() const {
  std::vector<WrittenGround> out;
  const auto values = [&](const ExprVector& v) {
    Bindings start = parameters_;
    start[system_.context->time()] = drawing_.times.front();
    for (const Coordinate& c : system_.coordinates) start.insert({{c.q, 0.0}, {c.velocity, 0.0}});
    return v.empty() ? std::vector<double>() : evaluate(in_terms_of_motion(system_, v), start);
  };
  for (const Plan::Ground& g : plan_.grounds) {
    const std::vector<double> place = values(g.place);
    std::vector<double> normal = values(g.normal);
    if (normal.empty()) normal = up();
    if (g.wall && g.normal.empty()) {  // upright, facing the middle
      const double middle = (drawing_.low[0] + drawing_.high[0]) / 2;
      normal.assign(d_, 0);
      normal[0] = place[0] <= middle ? 1 : -1;
    }
    out.push_back({place, normal});
  }
  return out;
}

void Settler::add_contacts(const std::vector<WrittenGround>& grounds) {
  if (contacts_.contacts.empty()) return;
  drawing::add_contacts({drawing_, system_, parameters_, contacts_, impulses_, grounds, world_low_, world_high_,
                         extent_, hatching * extent_, drawing_.metres_a_newton,
                         [&](const double* place, std::size_t frame) { include(place, frame); }},
                        outlines_);
}

void Settler::add_grounds(const std::vector<WrittenGround>& grounds) {
  for (const WrittenGround& g : grounds) add_ground(g.place, g.normal);
  const std::vector<double> u = up();
  if (d_ == 3 && plan_.grounds.empty() && !drawing_.gravity.empty() && u[2] > 0.999)
    add_ground({0, 0, world_low_[2]}, u);
  double radius = 0;
  for (std::size_t k = 0; k < d_; ++k) radius = std::hypot(radius, drawing_.high[k] / 2 - drawing_.low[k] / 2);
  drawing_.radius = radius > 0 ? radius : 1;
}

void Settler::add_ground(std::vector<double> place, std::vector<double> normal) {
  double length = 0, height = 0, size = 0;
  for (const double x : normal) length = std::hypot(length, x);
  if (!(length > 0) || !std::isfinite(length)) return;
  for (double& x : normal) x /= length;
  std::vector<double> foot(d_);
  for (std::size_t k = 0; k < d_; ++k) {
    foot[k] = (world_low_[k] + world_high_[k]) / 2;
    height += (foot[k] - place[k]) * normal[k];
    size = std::hypot(size, world_high_[k] - world_low_[k]);
  }
  for (std::size_t k = 0; k < d_; ++k) foot[k] -= height * normal[k];
  Outline o;
  o.element.kind = Kind::Solid;
  o.element.points = d_ + 1;
  o.element.still = true;
  std::vector<double>& pose = o.element.positions;
  pose = foot;
  if (d_ == 2) {
    o.element.shape = shapes::ground_line(size / 2 + 2 * extent_, hatching * extent_);
    pose.insert(pose.end(), {foot[0] + normal[1], foot[1] - normal[0], foot[0] + normal[0], foot[1] + normal[1]});
    double below[2];  // the place of the ground under the middle of what is seen
    for (std::size_t k = 0; k < 2; ++k) below[k] = foot[k] - 1.2 * hatching * extent_ * normal[k];
    if (drawing_.follow.empty())
      include(foot.data(), 0), include(below, 0);
    else
      for (std::size_t k = 0; k < 2; ++k)
        if (std::abs(normal[k]) > 0.9) {
          const double seen = below[k] - drawing_.follow[k];
          drawing_.low[k] = std::min(drawing_.low[k], seen);
          drawing_.high[k] = std::max(drawing_.high[k], seen);
        }
  } else {
    const auto basis = shapes::basis_about({normal[0], normal[1], normal[2]});
    double reach = 0.2 * extent_;
    for (std::size_t k = 0; k < 3; ++k)
      reach = std::max(reach, (1 - std::abs(normal[k])) * 0.55 * (world_high_[k] - world_low_[k]));
    const int lines = drawing_.follow.empty() ? 8 : static_cast<int>(std::clamp(8 * reach / extent_, 8.0, 120.0));
    o.element.shape = shapes::ground_grid(lines);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < 3; ++k) pose.push_back(foot[k] + reach * basis[a][k]);
    include(foot.data(), 0);
  }
  outlines_.push_back(std::move(o));
}

}  // namespace

void settle(Drawing& drawing, std::vector<Outline>& outlines, const Plan& plan, const MechanicalSystem& system,
            const Bindings& parameters, const ContactTracks& contacts, const std::vector<ContactImpulse>& impulses) {
  Settler(drawing, outlines, plan, system, parameters, contacts, impulses).settle();
}

}  // namespace maupertuis::drawing

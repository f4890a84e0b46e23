#include "analysis/invariants/world.hpp"

#include "analysis/invariants/motion_sampler.hpp"

#include <map>

namespace maupertuis::invariants {

ExprVector cross(const ExprVector& a, const ExprVector& b) {
  if (a.size() < 2) return {};
  if (a.size() == 2) return {a[0] * b[1] - a[1] * b[0]};
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

namespace {

ExprVector velocity_of(const ExprVector& position) {
  ExprVector out;
  for (const Expr& x : position) out.push_back(total_time_derivative(x));
  return out;
}

void add_to(ExprVector& sum, const ExprVector& more, Expr factor) {
  if (sum.empty()) sum.assign(more.size(), factor.context().number(0));
  for (std::size_t i = 0; i < more.size(); ++i) sum[i] = sum[i] + factor * more[i];
}

/// R I ω: the spin in world axes.
ExprVector spin_of(const Body& body, Context& context) {
  const std::size_t d = body.inertia.rows;
  ExprVector in_body(d, context.number(0)), out(d, context.number(0));
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j) in_body[i] = in_body[i] + body.inertia.at(i, j) * body.angular_velocity[j];
  if (d == 1) return in_body;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j) out[i] = out[i] + body.rotation.at(i, j) * in_body[j];
  return out;
}

class Builder {
 public:
  explicit Builder(const EquationsOfMotion& equations)
      : equations_(equations), system_(*equations.system), one_(system_.context->number(1)) {}

  World build() {
    for (const Point& p : system_.points)
      if (p.mass) add_particle(p.position, p.mass);
    for (const Body& b : system_.bodies) add_body(b);
    if (world_.points.empty())
      guess_from_names();
    else
      world_.axes = system_.space_dimension == 2 ? "xy" : "xyz";
    return std::move(world_);
  }

 private:
  void add_particle(const ExprVector& position, Expr mass) {
    const ExprVector r = in_state_variables(system_, position), v = velocity_of(r);
    world_.points.push_back({r, v, mass});
    add_to(world_.momentum, v, mass);
    add_to(world_.mass_moment, r, mass);
    add_to(world_.angular_momentum, cross(r, v), mass);
  }

  /// The centre of mass and a point along each body axis.
  void add_body(const Body& body) {
    if (body.mass && !body.position.empty()) add_particle(body.position, body.mass);
    const ExprVector spin = in_state_variables(system_, spin_of(body, *system_.context));
    add_to(world_.angular_momentum, spin, one_);
    const std::size_t d = body.rotation.rows;
    for (std::size_t axis = 0; axis < d; ++axis) {
      ExprVector tip;
      for (std::size_t i = 0; i < d; ++i)
        tip.push_back(body.position.empty() ? body.rotation.at(i, axis) : body.position[i] + body.rotation.at(i, axis));
      tip = in_state_variables(system_, tip);
      world_.points.push_back({tip, velocity_of(tip), {}});
    }
  }

  /// x1, y1 and x2, y2 as two particles; nothing where some coordinate has another name.
  void guess_from_names() {
    std::map<std::string, std::map<char, Expr>> particles;
    std::string axes;
    for (const char axis : {'x', 'y', 'z'})
      for (const Coordinate& c : system_.coordinates)
        if (c.name[0] == axis && c.kind != "angle") {
          particles[c.name.substr(1)][axis] = c.q;
          if (axes.empty() || axes.back() != axis) axes += axis;
        }
    std::size_t used = 0;
    for (const auto& [suffix, coordinates] : particles) used += coordinates.size();
    if (used < system_.coordinates.size() || axes.empty()) return;
    world_.axes = axes;
    world_.from_names = true;
    for (const auto& [suffix, coordinates] : particles) {
      ExprVector r;
      for (const char axis : axes)
        r.push_back(coordinates.count(axis) ? coordinates.at(axis) : system_.context->number(0));
      world_.points.push_back({r, velocity_of(r), mass_of(coordinates.begin()->second)});
    }
  }

  /// ∂²L/∂q̇∂q̇ of this coordinate.
  Expr mass_of(Expr q) const {
    for (std::size_t i = 0; i < system_.coordinates.size(); ++i)
      if (system_.coordinates[i].q == q) return differentiate(equations_.momenta[i], system_.coordinates[i].velocity);
    return {};
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  Expr one_;
  World world_;
};

}  // namespace

World world_of(const EquationsOfMotion& equations) { return Builder(equations).build(); }

Orbit orbit_of(const World& world) {
  const auto& p = world.points;
  if (p.empty() || p.size() > 2 || !p[0].mass || !p.back().mass) return {};
  if (p.size() == 1) return {p[0].position, p[0].velocity, p[0].mass, false};
  Orbit out{{}, {}, p[0].mass * p[1].mass / (p[0].mass + p[1].mass), true};
  for (std::size_t i = 0; i < p[0].position.size(); ++i) {
    out.position.push_back(p[0].position[i] - p[1].position[i]);
    out.velocity.push_back(p[0].velocity[i] - p[1].velocity[i]);
  }
  return out;
}

}  // namespace maupertuis::invariants

#include "drawing/coordinate_forces.hpp"
#include "drawing/shapes.hpp"

#include <array>
#include <cmath>

/// Forces that no `draw` line asks for, as arrows where they act.
namespace maupertuis::drawing {
namespace {

using Origin = Drawing::ForceOrigin;
constexpr std::size_t points_of_an_arc = 17;

ExprVector negative(const ExprVector& v) {
  ExprVector out;
  for (const Expr& x : v) out.push_back(-x);
  return out;
}

bool acts(const ExprVector& force) {
  for (const Expr& f : force)
    if (!f.is_zero()) return true;
  return false;
}

void add_weights(const MechanicalSystem& system, std::vector<Outline>& out) {
  if (!acts(system.gravity)) return;
  const auto weigh = [&](const auto& one) {
    if (!one.mass) return;
    ExprVector weight;
    for (const Expr& g : system.gravity) weight.push_back(one.mass * g);
    out.push_back(arrow_of(one.position, weight, Origin::Weight, one.name));
  };
  for (const Point& p : system.points) weigh(p);
  for (const Body& b : system.bodies) weigh(b);
}

/// r from one end to the other; |r| and its rate as they stand in the energy of the link.
struct Way {
  ExprVector r, rates;
  Expr length, rate;
  Expr square_of_rates;
};

Way way_of(Context& context, const Link& link) {
  Way out;
  ExprVector squares, rate_squares;
  for (std::size_t k = 0; k < link.from.size(); ++k) {
    out.r.push_back(link.to[k] - link.from[k]);
    out.rates.push_back(context.time_derivative(out.r.back()));
    squares.push_back(out.r.back() * out.r.back());
    rate_squares.push_back(out.rates.back() * out.rates.back());
  }
  out.length = sqrt(context.sum(squares));
  out.rate = context.time_derivative(out.length);
  out.square_of_rates = context.sum(rate_squares);
  return out;
}

ExprVector times(const Expr& factor, const ExprVector& v) {
  ExprVector out;
  for (const Expr& x : v) out.push_back(factor * x);
  return out;
}

/// ∂E/∂s of an energy in a length or its rate s; empty where the energy holds coordinates besides, as a stiffness may:
/// its force is not one along the link alone.
Expr slope(Context& context, Expr energy, Expr s) {
  const Expr symbol = context.symbol("length of a link", Role::Auxiliary);
  const Expr in_symbol = substitute(energy, {{s, symbol}});
  bool found = false;
  for (const Expr& one : symbols_of({&in_symbol, 1})) {
    if (one.role() == Role::Coordinate) return {};
    found = found || one == symbol;
  }
  return found ? substitute(differentiate(in_symbol, symbol), {{symbol, s}}) : Expr();
}

/// The force on the end `from`, N; on the other end it is the opposite. Empty where it is not known.
ExprVector pull_of(Context& context, const Link& link, Expr energy) {
  const Way way = way_of(context, link);
  const bool spring = link.kind == Link::Kind::Spring;
  if (const Expr force = slope(context, energy, spring ? way.length : way.rate))
    return times(force / way.length, way.r);
  // ½ k r·r and ½ c ṙ·ṙ, without a root.
  const Expr square = spring ? way.length * way.length : way.square_of_rates;
  const Expr twice = Rational(2) * energy / square;
  for (const Expr& one : symbols_of({&twice, 1}))
    if (one.role() == Role::Coordinate &&
        !vanishes_identically(expand_time_derivatives(differentiate(expand_time_derivatives(twice), one))))
      return {};
  ExprMap somewhere;  // a constant: also where its quotient would be 0/0
  for (const Expr& one : symbols_of({&twice, 1}))
    if (one.role() == Role::Coordinate) somewhere.emplace(one, context.number(1));
  return times(substitute(expand_time_derivatives(twice), somewhere), spring ? way.r : way.rates);
}

void add_links(const MechanicalSystem& system, std::vector<Outline>& out) {
  for (const Link::Kind kind : {Link::Kind::Spring, Link::Kind::Damper}) {
    // Links of one kind and their energies stand in the order of the text.
    const bool spring = kind == Link::Kind::Spring;
    std::vector<Expr> energies;
    for (const EnergyTerm& t : spring ? system.potential : system.dissipation)
      if (t.origin.rfind(spring ? "spring " : "damper ", 0) == 0) energies.push_back(t.value);
    std::size_t next = 0;
    for (const Link& l : system.links) {
      if (l.kind != kind || next >= energies.size()) continue;
      const ExprVector pull = pull_of(*system.context, l, energies[next++]);
      if (pull.empty()) continue;
      const Drawing::ForceOrigin origin = spring ? Origin::Spring : Origin::Damper;
      out.push_back(arrow_of(l.from, pull, origin, l.from_name));
      out.push_back(arrow_of(l.to, negative(pull), origin, l.to_name));
    }
  }
}

void add_torque(const MechanicalSystem& system, const std::string& on, const ExprVector& torque,
                std::vector<Outline>& out) {
  if (const Body* body = system.find_body(on)) out.push_back(torque_about(body->position, torque, Origin::Torque, on));
}

void add_applied(const MechanicalSystem& system, std::vector<Outline>& out) {
  for (const AppliedForce& f : system.forces) {
    if (f.kind == AppliedForce::Kind::OnPoint && acts(f.components))
      out.push_back(arrow_of(f.lever, f.components, Origin::Applied, f.target));
    if (f.kind != AppliedForce::Kind::Torque || !acts(f.components)) continue;
    add_torque(system, f.target, f.components, out);
    if (!f.reaction_on.empty()) add_torque(system, f.reaction_on, negative(f.components), out);
  }
}

}  // namespace

void add_acting_forces(const MechanicalSystem& system, Plan& plan) {
  add_weights(system, plan.outlines);
  add_links(system, plan.outlines);
  add_applied(system, plan.outlines);
  add_forces_on_coordinates(system, plan);
}

Outline arrow_of(const ExprVector& place, const ExprVector& force, Origin origin, const std::string& name) {
  Outline out;
  out.element.kind = Drawing::Kind::Arrow;
  out.element.points = 2;
  out.element.names = {name, ""};
  out.element.origin = origin;
  out.placement = Outline::Placement::Force;
  out.values = place;
  for (const Expr& f : force) out.values.push_back(expand_time_derivatives(f));
  return out;
}

Outline torque_about(const ExprVector& place, const ExprVector& torque, Origin origin, const std::string& name) {
  Outline out = arrow_of(place, torque, origin, name);
  out.placement = Outline::Placement::Torque;
  return out;
}

void place_torque(Outline& o, std::size_t d, double radius, double largest) {
  const std::size_t width = o.values.size();
  std::vector<double> arcs;
  for (std::size_t f = 0; f * width < o.element.positions.size(); ++f) {
    const double* at = &o.element.positions[f * width];
    double size = at[d];
    std::array<std::array<double, 3>, 2> sides{{{1, 0, 0}, {0, 1, 0}}};
    if (d == 3) {
      size = std::hypot(at[3], at[4], at[5]);
      const auto basis = shapes::basis_about({at[3], at[4], size > 0 ? at[5] : 1});
      sides = {basis[0], basis[1]};
    }
    const double sweep = largest > 0 ? 1.5 * M_PI * size / largest : 0;
    for (std::size_t i = 0; i < points_of_an_arc; ++i) {
      const double angle = sweep * static_cast<double>(i) / (points_of_an_arc - 1);
      for (std::size_t k = 0; k < d; ++k)
        arcs.push_back(at[k] + radius * (std::cos(angle) * sides[0][k] + std::sin(angle) * sides[1][k]));
    }
  }
  o.element.points = points_of_an_arc;
  o.element.positions = std::move(arcs);
}

}  // namespace maupertuis::drawing

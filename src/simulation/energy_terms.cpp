#include "simulation/energy_terms.hpp"

#include <maupertuis/rounded_value.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

/// q̇·∂l/∂q̇ − l
Expr contribution(Expr l, const MechanicalSystem& system) {
  ExprVector velocities;
  for (const Coordinate& c : system.coordinates) velocities.push_back(c.velocity);
  const Expr expanded = expand_time_derivatives(l);
  const auto momenta = gradient(expanded, velocities);
  const std::vector<Expr> in_momenta = symbols_of(momenta);
  const auto is_velocity = [&](Expr s) {
    return std::find(velocities.begin(), velocities.end(), s) != velocities.end();
  };
  if (std::none_of(in_momenta.begin(), in_momenta.end(), is_velocity)) {  // what is linear in q̇ leaves nothing
    ExprMap at_rest;
    for (const Expr& v : velocities) at_rest.emplace(v, system.context->number(0));
    return -substitute(expanded, at_rest);
  }
  ExprVector terms{-expanded};
  for (std::size_t i = 0; i < velocities.size(); ++i) terms.push_back(velocities[i] * momenta[i]);
  return system.context->sum(terms);
}

}  // namespace

std::vector<Expr> energy_terms(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  std::vector<Expr> terms;
  const auto add = [&](Expr part_of_lagrangian) {
    const Expr term = contribution(part_of_lagrangian, system);
    if (!term.is_zero()) terms.push_back(term);
  };
  if (system.lagrangian_given) {
    const Expr whole = system.lagrangian_given->value;
    if (whole.is(Kind::Sum))
      for (const NodeId id : whole.argument_ids()) add(system.context->node(id));
    else
      add(whole);
  } else {
    add(system.kinetic_energy());
    for (const EnergyTerm& v : system.potential) add(-v.value);
    for (const EnergyTerm& u : system.generalized_potential) add(-u.value);
  }
  for (const EnergyTerm& extra : system.lagrangian_extra) add(extra.value);
  return terms;
}

double rounding_of_energy(const EquationsOfMotion& equations, const MotionState& state) {
  const MechanicalSystem& system = *equations.system;
  const ExprVector terms = in_terms_of_motion(system, expand_time_derivatives(energy_terms(equations)));
  const Expr energy = system.context->sum(terms);
  Bindings at = parameter_bindings(system);
  at[system.context->time()] = state.t;
  double out = 0;
  for (const double part : {1.0, 0.96, 0.93, 0.89}) {  // at one state alone rounding may be small by chance
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      at[system.coordinates[i].q] = part * state.q[i];
      at[system.coordinates[i].velocity] = part * state.v[i];
    }
    double size = 0;
    for (const double term : evaluate(terms, at)) size += std::abs(term);
    const double exact = rounded_value(energy, at);
    double here = std::abs(evaluate(energy, at) - exact);
    for (const Coordinate& c : system.coordinates)
      for (const Expr& x : {c.q, c.velocity}) {
        const double value = at[x];
        at[x] = std::nextafter(value, std::numeric_limits<double>::infinity());
        here += std::abs(rounded_value(energy, at) - exact);
        at[x] = value;
      }
    if (size > 0) out = std::max(out, here / size);
  }
  return out;
}

}  // namespace maupertuis

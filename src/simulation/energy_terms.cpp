#include "simulation/energy_terms.hpp"

namespace maupertuis {
namespace {

/// q̇·∂l/∂q̇ − l
Expr contribution(Expr l, const MechanicalSystem& system) {
  ExprVector velocities;
  for (const Coordinate& c : system.coordinates) velocities.push_back(c.velocity);
  const Expr expanded = expand_time_derivatives(l);
  const auto momenta = gradient(expanded, velocities);
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

}  // namespace maupertuis

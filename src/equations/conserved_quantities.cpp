#include <maupertuis/across_switches.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/seen_nonzero.hpp>

namespace maupertuis {
namespace {

/// h_E against T + V when L = T − V − U was built from parts.
std::string compare_with_energy(const EquationsOfMotion& equations, bool& equal) {
  const MechanicalSystem& system = *equations.system;
  const Expr energy = expand_time_derivatives(system.kinetic_energy() + system.potential_energy());
  const Expr difference = equations.energy_function - energy;
  const ZeroTest test = zero_test(difference);
  equal = test.verdict == Verdict::Zero;
  if (test.verdict == Verdict::Undecided)
    return "Whether h_E is T + V was not decided: " +
           (test.reason.empty() ? "no point was found at which both have a value" : test.reason) + ".";
  const bool has_generalized_potential = !system.generalized_potential.empty() || !system.lagrangian_extra.empty();
  if (equal && has_generalized_potential)
    return "h_E = T + V: the velocity-dependent part of L is linear in the velocities and does no work.";
  if (equal) return "h_E = T + V: T is a homogeneous quadratic form in the velocities, and V does not depend on them.";
  if (has_generalized_potential) return "h_E is not T + V: L has a part beside T − V, which enters as q'·∂L/∂q' − L.";
  return "h_E is not T + V: the prescribed motion gives T terms of degree 1 or 0 in the velocities.";
}

/// No constraint acts on coordinate i, whatever the multipliers are.
bool free_of_constraints(const EquationsOfMotion& equations, std::size_t i) {
  return equations.constraint_forces.empty() || vanishes_identically(equations.constraint_forces[i]);
}

/// λ·A q̇ holds q̇·∂ψ/∂q̇ − ψ, and ψ vanishes along the motion: where ψ is homogeneous in the velocities, of any degree,
/// the constraint does no work.
Expr power_on_constraints(const EquationsOfMotion& equations) {
  Expr power = equations.power;
  ExprVector velocities;
  for (const Coordinate& q : equations.system->coordinates) velocities.push_back(q.velocity);
  const SparseGradient by_velocities(velocities);
  for (const Constraint& c : equations.system->constraints) {
    if (c.level == Constraint::Level::Position) continue;
    ExprVector terms;
    for (const auto& [i, slope] : by_velocities(c.value)) terms.push_back(velocities[i] * slope);
    const Expr work = c.value.context().sum(terms);
    for (const int degree : {2, 3, 4})
      if (vanishes_identically(work - Rational(degree) * c.value))
        power = power - Rational(degree - 1) * (c.multiplier * c.value);
  }
  return power;
}

}  // namespace

ConservedQuantities conserved_quantities(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  ExprVector q;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q);
  const auto forces = gradient(equations.lagrangian_expanded, q);

  ConservedQuantities result;
  const std::vector<bool> varies = seen_nonzero(forces);  // most do, and forces along a chain share their parts
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (varies[i] || !vanishes_identically(forces[i])) continue;
    result.cyclic.push_back(i);
    if (vanishes_identically(equations.generalized_forces[i] - equations.dissipative_terms[i]) &&
        free_of_constraints(equations, i) && !across_switches(system, equations.momenta[i], equations.order).jump)
      result.conserved_momenta.push_back(i);
  }
  const AcrossSwitches energy = across_switches(system, equations.energy_function, equations.order);
  result.energy_conserved =
      !energy.jump && (vanishes_identically(equations.power) || vanishes_identically(power_on_constraints(equations)));
  if (system.lagrangian_given && system.independent != "t") {
    result.energy_case =
        "h_E = q'·∂L/∂q' − L, which is constant where L does not depend on " + system.independent + " (Beltrami).";
  } else if (system.lagrangian_given) {
    result.energy_case =
        "L was given whole: h_E = q'·∂L/∂q' − L, which is T + V where L = T − V with T quadratic in the velocities.";
  } else {
    result.energy_case = compare_with_energy(equations, result.energy_is_t_plus_v);
  }
  return result;
}

}  // namespace maupertuis

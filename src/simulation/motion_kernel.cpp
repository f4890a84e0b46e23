#include "simulation/motion_kernel.hpp"

#include "simulation/energy_terms.hpp"
#include "simulation/motion_balance.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {

KernelSource motion_source(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  KernelSource source;
  for (const Coordinate& c : system.coordinates) source.coordinates.push_back(c.q);
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.residual = in_terms_of_motion(system, motion_balance(equations));
  source.multipliers = equations.multipliers;
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    const Constraint& c = system.constraints[i];
    const Expr value = in_terms_of_motion(system, {&c.value, 1}).front();
    source.constraints.push_back({value, c.level == Constraint::Level::Position ? 0 : 1, system.constraint_label(i)});
  }
  return source;
}

KernelSource motion_source(const EquationsOfMotion& equations, const WantedFunctions& wanted) {
  const MechanicalSystem& system = *equations.system;
  KernelSource source = motion_source(equations);
  const Bindings parameters = parameter_bindings(system);
  const auto value_of = [&](Expr e) { return evaluate(e, parameters); };
  const auto finite = [&](std::span<const Expr> formulas) {
    return without_overflow(formulas, value_of, wanted.has_wide_range ? 600 : 400);
  };
  source.residual = finite(source.residual);
  source.observables = finite(in_terms_of_motion(system, wanted.observables));
  source.events = finite(in_terms_of_motion(system, wanted.events));
  source.integrands = finite(in_terms_of_motion(system, wanted.integrands));
  return source;
}

Kernel motion_kernel(const EquationsOfMotion& equations, const WantedFunctions& wanted) {
  return build_kernel(motion_source(equations, wanted));
}

MotionKernel motion_kernel(const EquationsOfMotion& equations, std::span<const Expr> events) {
  check_one_mode(*equations.system, "motion_kernel");
  return free_motion_kernel(solvable_equations(equations), events);
}

MotionKernel free_motion_kernel(const EquationsOfMotion& equations, std::span<const Expr> events) {
  const ExpressionLock lock(*equations.system->context);
  WantedFunctions wanted;
  wanted.events.assign(events.begin(), events.end());
  wanted.observables = energy_terms(equations);
  return {motion_kernel(equations, wanted), parameter_values(*equations.system), wanted.observables.size()};
}

}  // namespace maupertuis

#include "equations/degenerate/lagrange_problem.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {
namespace {

/// e, which is linear in the unknowns, as a condition.
LinearCondition linear_in(Expr e, const ExprVector& unknowns) {
  ExprMap at_rest;
  for (const Expr& u : unknowns) at_rest.emplace(u, e.context().number(0));
  return {gradient(e, unknowns), substitute(e, at_rest)};
}

}  // namespace

ConstraintProblem lagrange_problem(const EquationsOfMotion& equations, bool with_gauges) {
  const MechanicalSystem& system = *equations.system;
  const MotionTerms in_motion(system);
  ConstraintProblem out;
  out.order = equations.order;
  ExprVector unknowns;
  for (const Coordinate& c : system.coordinates) out.states.push_back(c.q);
  for (const Coordinate& c : system.coordinates) out.states.push_back(c.velocity);
  for (const Coordinate& c : system.coordinates) unknowns.push_back(c.acceleration);
  unknowns.insert(unknowns.end(), equations.multipliers.begin(), equations.multipliers.end());

  out.derivative = [unknowns](Expr constraint) {
    LinearCondition row = linear_in(total_time_derivative(constraint), unknowns);
    row.is_derivative = true;
    return row;
  };
  for (const Expr& row : expand_time_derivatives(in_motion(equations.balance())))
    out.conditions.push_back(linear_in(row, unknowns));
  for (const Expr& row : expand_time_derivatives(in_motion(equations.constraint_accelerations)))
    out.conditions.push_back(linear_in(row, unknowns));
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    if (system.constraints[k].level == Constraint::Level::Position)
      out.relations.push_back(in_motion(system.constraints[k].value));
    out.relations.push_back(expand_time_derivatives(in_motion(equations.constraint_rates[k])));
  }
  for (const Gauge& gauge : system.gauges) {
    if (!with_gauges) break;
    out.relations.push_back(in_motion(gauge.value));
    out.conditions.push_back(out.derivative(out.relations.back()));
  }
  return out;
}

ExprVector relations_of_motion(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis) {
  const MechanicalSystem& system = *equations.system;
  ExprVector unknowns, out = lagrange_problem(equations, analysis.gauges > 0).relations;
  for (const Coordinate& c : system.coordinates) unknowns.push_back(c.acceleration);
  unknowns.insert(unknowns.end(), equations.multipliers.begin(), equations.multipliers.end());
  for (const FoundConstraint& c : analysis.chain.constraints) out.push_back(c.value);
  for (const LinearCondition& row : analysis.chain.conditions) {
    ExprVector terms{row.rest};
    for (std::size_t j = 0; j < unknowns.size(); ++j) terms.push_back(row.coefficients[j] * unknowns[j]);
    out.push_back(system.context->sum(terms));
  }
  return out;
}

}  // namespace maupertuis

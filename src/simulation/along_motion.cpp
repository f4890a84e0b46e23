#include <maupertuis/along_motion.hpp>

#include <maupertuis/degenerate.hpp>
#include <maupertuis/simulation.hpp>

#include <fmt/format.h>

namespace maupertuis {

std::string ground_of(const ZeroTest& test, bool constrained) {
  if (test.points == 0 && test.error_bound == 0)
    return "proved term by term: the difference of the two sides is 0 as it is written";
  if (constrained && test.error_bound == 1)
    return fmt::format("vanishes to 60 digits at {} points of the constraints", test.points);
  if (test.error_bound < 1)
    return fmt::format("proved at {} random points, error bound {:.1e}", test.points, test.error_bound);
  return test.reason.empty() ? fmt::format("vanishes at {} random points", test.points) : test.reason;
}

AlongMotion::AlongMotion(const EquationsOfMotion& equations) : AlongMotion(equations, equations.balance()) {}

AlongMotion::AlongMotion(const EquationsOfMotion& equations, const ExprVector& residual)
    : equations_(equations), residual_(residual) {
  if (constrained()) return;
  const MechanicalSystem& system = *equations.system;
  const auto solved = accelerations(in_terms_of_motion(system, residual), system);
  if (!solved) return;
  accelerations_.emplace();
  for (std::size_t i = 0; i < solved->size(); ++i)
    accelerations_->emplace(system.coordinates[i].acceleration, (*solved)[i]);
}

Expr AlongMotion::put_in(Expr e) const {
  e = with_reactions(equations_, {&e, 1}).front();
  const Expr plain = expand_time_derivatives(in_terms_of_motion(*equations_.system, {&e, 1}).front());
  return accelerations_ ? substitute(plain, *accelerations_) : plain;
}

ZeroTest AlongMotion::vanishes(Expr e) const {
  const Expr plain = put_in(e);
  if (!constrained() || plain.is_zero()) return zero_test(plain);
  ExprVector unknowns = equations_.multipliers;
  for (const Coordinate& c : equations_.system->coordinates)
    unknowns.insert(unknowns.end(), {c.q, c.velocity, c.acceleration});
  return zero_test_where({&plain, 1}, relations(), unknowns, center());
}

ZeroTest AlongMotion::vanishes_on(Expr e, std::span<const Expr> level) const {
  const Expr plain = put_in(e);
  if (plain.is_zero()) return zero_test(plain);
  std::vector<Expr> all = constrained() ? relations() : std::vector<Expr>();
  for (const Expr& x : level) all.push_back(put_in(x));
  ExprVector unknowns = constrained() ? equations_.multipliers : ExprVector();
  for (const Coordinate& c : equations_.system->coordinates) {
    unknowns.insert(unknowns.end(), {c.q, c.velocity});
    if (constrained()) unknowns.push_back(c.acceleration);
  }
  Bindings near = center();
  const ZeroTest test = zero_test_where({&plain, 1}, all, unknowns, near);
  if (test.verdict != Verdict::Undecided) return test;
  // r² φ' = 0: from the start Newton's method may run towards r = 0; from rest it need not.
  for (const Coordinate& c : equations_.system->coordinates) near[c.velocity] = 0.0;
  return zero_test_where({&plain, 1}, all, unknowns, near);
}

Expr AlongMotion::rate(Expr integral) const {
  return put_in(total_time_derivative(in_terms_of_motion(*equations_.system, {&integral, 1}).front()));
}

AcrossSwitches AlongMotion::across(Expr integral) const {
  const Expr plain = put_in(integral);
  return across_switches(*equations_.system, plain, equations_.order, [&](Expr g) { return rate(g); });
}

/// φ, dφ/dt or ψ, A q̈ − b, and R − Aᵀλ: what the motion satisfies at each point.
std::vector<Expr> AlongMotion::relations() const {
  if (equations_.degenerate) return relations_of_motion(equations_, *equations_.degenerate);
  const MechanicalSystem& system = *equations_.system;
  std::vector<Expr> out;
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Position) out.push_back(c.value);
  for (const auto* list : {&equations_.constraint_rates, &equations_.constraint_accelerations, &residual_})
    out.insert(out.end(), list->begin(), list->end());
  return in_terms_of_motion(system, expand_time_derivatives(out));
}

Bindings AlongMotion::center() const {
  const MechanicalSystem& system = *equations_.system;
  Bindings out = parameter_bindings(system);
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    out[c.q] = start_ ? start_->q[i] : 0.0;
    out[c.velocity] = start_ ? start_->v[i] : 0.0;
    out[c.acceleration] = 0.0;
  }
  for (const Expr& multiplier : equations_.multipliers) out[multiplier] = 0.0;
  if (start_) out[system.context->time()] = start_->t;
  return out;
}

}  // namespace maupertuis

#include "verification/along_motion.hpp"

#include <maupertuis/simulation.hpp>

namespace maupertuis {

AlongMotion::AlongMotion(const EquationsOfMotion& equations) : AlongMotion(equations, equations.residual) {}

AlongMotion::AlongMotion(const EquationsOfMotion& equations, const ExprVector& residual) : equations_(equations) {
  const MechanicalSystem& system = *equations.system;
  const auto solved = accelerations(in_terms_of_motion(system, residual), system);
  if (!solved) return;
  accelerations_.emplace();
  for (std::size_t i = 0; i < solved->size(); ++i)
    accelerations_->emplace(system.coordinates[i].acceleration, (*solved)[i]);
}

Expr AlongMotion::put_in(Expr e) const {
  const Expr plain = expand_time_derivatives(in_terms_of_motion(*equations_.system, {&e, 1}).front());
  return accelerations_ ? substitute(plain, *accelerations_) : plain;
}

ZeroTest AlongMotion::vanishes(Expr e) const { return zero_test(put_in(e)); }

Expr AlongMotion::rate(Expr integral) const {
  return put_in(total_time_derivative(in_terms_of_motion(*equations_.system, {&integral, 1}).front()));
}

}  // namespace maupertuis

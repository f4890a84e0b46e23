#pragma once
#include "analysis/invariants/motion_sampler.hpp"

#include <maupertuis/invariants.hpp>

#include <vector>

namespace maupertuis::invariants {

/// The rank of the gradients by (q, q') of `functions`, one after the other, on the tangent space of the constraints:
/// true where a function adds to the rank of those before it. At a random point over a prime field; t held fixed.
std::vector<bool> independent_functions_of_state(const MotionRows& rows, const EquationsOfMotion& equations,
                                                 const std::vector<Expr>& functions, std::uint64_t seed);

/// {F, G} = Σ ∂F/∂q ∂G/∂p − ∂F/∂p ∂G/∂q as a function of q, q', t; for systems without constraints.
class PoissonAlgebra {
 public:
  PoissonAlgebra(const MotionRows& rows, const EquationsOfMotion& equations);
  Expr bracket(Expr f, Expr g) const;

 private:
  struct Slopes {
    ExprVector by_position, by_momentum;
  };  // ∂/∂q at fixed p, ∂/∂p
  Slopes slopes(Expr f) const;
  const MotionRows& rows_;
  ExprVector q_;
  ExprMatrix momentum_by_position_;  // ∂p/∂q at fixed q̇ [n × n]
};

/// Fills relations, brackets, ranks and the statement on integrability.
void add_algebra(Invariants& result, const MotionRows& rows, const EquationsOfMotion& equations, std::uint64_t seed);

}  // namespace maupertuis::invariants

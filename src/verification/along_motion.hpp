#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <optional>
#include <string>

namespace maupertuis {

/// Proofs about functions along the motion: q̈ is replaced by −M⁻¹ h as a shared DAG, and the rest is the zero test's.
class AlongMotion {
 public:
  explicit AlongMotion(const EquationsOfMotion& equations);
  /// With other equations than the derived ones, to see whether a claim follows from a known mistake.
  AlongMotion(const EquationsOfMotion& equations, const ExprVector& residual);

  /// False where M is singular: then nothing can be said.
  bool solvable() const { return accelerations_.has_value(); }
  /// e with q̈ put in; lets and inputs as well.
  Expr put_in(Expr e) const;
  ZeroTest vanishes(Expr e) const;
  /// dI/dt along the motion, q̈ put in.
  Expr rate(Expr integral) const;

 private:
  const EquationsOfMotion& equations_;
  std::optional<ExprMap> accelerations_;
};

}  // namespace maupertuis

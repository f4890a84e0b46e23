#pragma once
#include <maupertuis/comparison.hpp>

namespace maupertuis::comparison {

/// What holds along the motions of a model, and states of it to look at.
class Motions {
 public:
  Motions(const Model& model, const EquationsOfMotion& equations);

  /// Where the model starts, then other consistent states near it; at least one unless the model has no consistent
  /// start.
  const std::vector<MotionState>& states() const { return states_; }
  /// Every symbol of q, q̇, t and the parameters at a state.
  Bindings at(const MotionState& state) const;

  /// Do the functions of q, q̇, q̈, t vanish along all motions? Exact without constraints; with them, and where roots or
  /// inverse functions keep the exact test from an answer, at points to 60 digits.
  ZeroTest vanish(std::span<const Expr> functions) const;
  /// The same, or for parameters that have the signs of the model's alone.
  ZeroTest vanish_for_given_signs(std::span<const Expr> functions) const;
  /// The same where the parameters have the values of the model, and only these.
  ZeroTest vanish_at_these_values(std::span<const Expr> functions) const;
  /// At states near the start, with parameters within a hundredth of their values; and, where switches stand in the
  /// functions or the equations, near points in each of the branches that are found.
  ZeroTest at_points(std::span<const Expr> functions) const;
  /// States in the branches of these functions and of the equations, as far as no constraints have to be met.
  std::vector<MotionState> states_in_branches(std::span<const Expr> functions) const;
  /// Exactly, where each function is one of the constraints or vanishes everywhere; else `vanish`.
  ZeroTest constraints_vanish(std::span<const Expr> functions) const;

 private:
  void find_states();
  std::vector<Bindings> centers(std::span<const Expr> functions, const Bindings& start) const;

  const Model& model_;
  const EquationsOfMotion& equations_;
  std::vector<MotionState> states_;
  ExprVector relations_;                  // φ, dφ/dt or ψ, A q̈ − b, R − Aᵀλ
  std::optional<ExprMap> accelerations_;  // without constraints: q̈ solved for
};

}  // namespace maupertuis::comparison

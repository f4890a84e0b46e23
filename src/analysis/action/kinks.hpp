#pragma once
#include <maupertuis/action.hpp>

#include <vector>

namespace maupertuis::action {

/// The switches at which a first derivative of L jumps (kinks). There the second variation has a part of its own,
/// Δ(∂L/∂g) (∇g·ξ)²/|ġ| at each passage, which none of the counts knows.
std::vector<Expr> kinks_of(const EquationsOfMotion& equations);

/// The differences g that change sign there, at a state.
std::vector<double> kink_values(const std::vector<Expr>& kinks, const MotionState& s, const MechanicalSystem& system);

/// A kink that the path passes or touches.
struct KinkPassed {
  double t = 0;
  Expr difference;
};
std::optional<KinkPassed> kink_passed(const ActionPath& path, const std::vector<Expr>& kinks,
                                      const MechanicalSystem& system);

}  // namespace maupertuis::action

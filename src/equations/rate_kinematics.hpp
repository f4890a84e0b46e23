#pragma once
#include "equations/norm_reduction.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// σ = Y q̇ + y solved for the velocities. The rates come first: those that are named, then the velocities that stay;
/// the last σ are the constraints, which are 0 on the motion.
struct RateKinematics {
  std::vector<Expr> sigma;        // σ [n], symbols of order 1; that of a velocity that stays is q' itself
  std::vector<Expr> values;       // σ in q, q', t [n]
  std::vector<bool> is_velocity;  // [n] σ is q' itself
  std::size_t free = 0;           // σ beyond it are the constraints
  ExprVector velocities;          // q̇ [n] in all σ
  ExprMatrix x;                   // X = ∂q̇/∂σ [n × n]

  /// q' → its value; on the constraints, where the last σ are 0.
  ExprMap replacements(const MechanicalSystem& system) const;
  ExprMap on_constraints() const;
  /// e(q, q̇, t) in all σ. A rate that stands there whole is replaced first, so that its formula need not be recognised.
  Expr in_rates(const MechanicalSystem& system, Expr e) const;
  /// Of degree two in σ with every coefficient in its best form; another expression as it is.
  Expr by_coefficients(Expr e, const ReadingOrder& order, const UnitQuaternions& spheres) const;
};

/// q, then the rates in their order.
ReadingOrder order_with_rates(const EquationsOfMotion& equations, const std::vector<Rate>& rates);

/// Nothing, and `reason`, where constraints are not linear in q̇ or the velocities cannot be solved for.
std::optional<RateKinematics> rate_kinematics(const EquationsOfMotion& equations, const std::vector<Rate>& rates,
                                              const ReadingOrder& order, const UnitQuaternions& spheres,
                                              std::string& reason);

}  // namespace maupertuis

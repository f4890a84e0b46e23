#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <optional>

namespace maupertuis {

/// The equations of motion as R₀ = F λ. Forces of friction that are made of multipliers count with those of constraint:
///
///     R = M q̈ + h = R₀ + (∂R/∂λ) λ,      F = Aᵀ − ∂R/∂λ
///
/// Without such friction R₀ = R, F = Aᵀ.
struct MultiplierForces {
  ExprVector residual;  // R₀ [n], time derivatives expanded
  ExprMatrix rows;      // Fᵀ [m × n]
  bool of_friction = false;
};
/// Nothing where R is not linear in λ.
std::optional<MultiplierForces> multiplier_forces(const EquationsOfMotion& equations);

}  // namespace maupertuis

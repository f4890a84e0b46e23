#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <vector>

namespace maupertuis {

/// φ = left − right with the terms of positive sign left and the others right: x^2 + y^2 = l^2. Its sign is that of λ.
ConstraintEquation constraint_equation(const EquationsOfMotion& equations, std::size_t index);

/// (Aᵀλ)_i = Σ_k A_ki λ_k, each coefficient readable, one term a multiplier.
std::vector<ReadableForm> readable_constraint_forces(const EquationsOfMotion& equations);

}  // namespace maupertuis

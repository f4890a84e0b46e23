#pragma once
#include "comparison/motions.hpp"
#include "comparison/pull_back.hpp"

namespace maupertuis::comparison {

/// What is left of A's equations when its multipliers are eliminated.
struct Differences {
  ExprVector values;                     // vanish along the motions of B if and only if R_A lies in the image of A_Aᵀ
  std::vector<std::size_t> coordinates;  // of A: whose equation each one is
};

/// Gaussian elimination of λ_A from R_A = A_Aᵀ λ_A, both pulled back, with pivots chosen in numbers at a state of B.
/// Cost: O(n m²) nodes.
Differences without_multipliers(const EquationsOfMotion& a, const PullBack& pull_back, const Bindings& at);

/// (∂f/∂q)ᵀ R_A − R_B [n_B]. Where it vanishes for all q, q̇, q̈, both models do the same virtual work.
ExprVector work_differences(const EquationsOfMotion& a, const EquationsOfMotion& b, const PullBack& pull_back);

/// The rows of constraints of A along the mapped curve: φ and ψ.
ExprVector mapped_constraints(const MechanicalSystem& a, const PullBack& pull_back);

}  // namespace maupertuis::comparison

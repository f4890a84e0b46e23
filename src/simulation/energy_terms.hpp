#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>

#include <vector>

namespace maupertuis {

/// The contributions of T, each V, U and the rest of L to the energy function h_E = q̇·∂L/∂q̇ − L. Their sum is h_E;
/// the sum of their absolute values is what its drift is measured against (docs/theory/measures.md).
std::vector<Expr> energy_terms(const EquationsOfMotion& equations);

/// What rounding makes of h_E near a state, relative to the sum of its terms: how far its value in double is from that
/// in 100 digits, and what one unit in the last place of each coordinate and velocity changes.
double rounding_of_energy(const EquationsOfMotion& equations, const MotionState& state);

}  // namespace maupertuis

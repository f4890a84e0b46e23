#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <vector>

namespace maupertuis {

/// The contributions of T, each V, U and the rest of L to the energy function h_E = q̇·∂L/∂q̇ − L. Their sum is h_E;
/// the sum of their absolute values is what its drift is measured against (docs/theory/measures.md).
std::vector<Expr> energy_terms(const EquationsOfMotion& equations);

}  // namespace maupertuis

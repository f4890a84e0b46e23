#pragma once
#include "analysis/invariants/motion_sampler.hpp"

#include <optional>

namespace maupertuis::invariants {

/// δq with M δq = ∂I/∂q̇ [n]: the transformation at fixed t whose charge an integral is, as a shared graph; of −ξ h_E +
/// η·p − f it is η − ξ q̇. It is ∂I/∂p as well. Nothing where M is singular.
std::optional<ExprVector> symmetry_of(Expr integral, const MotionRows& rows);

}  // namespace maupertuis::invariants

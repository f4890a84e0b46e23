#pragma once
#include "system/lint.hpp"

namespace maupertuis::lint_rules {

/// True if M = ∂²L/∂q̇∂q̇ is positive definite at a point, found without M itself: L is second order in few intermediate
/// quantities at a time, which are eliminated one after the other. False where it is not, and where that is not seen.
/// Cost: for chains and trees of points proportional to the nodes of L.
bool kinetic_form_is_definite(const Subject& s, const Bindings& point);

}  // namespace maupertuis::lint_rules

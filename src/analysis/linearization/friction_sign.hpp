#pragma once
#include <maupertuis/linearization.hpp>

namespace maupertuis {

/// Whether friction gives no energy at any state, proved: q̇·∂D/∂q̇ is a sum of squares with coefficients that are never
/// negative, or a quadratic form in q̇ with constant ones that has no negative eigenvalue.
bool friction_never_gives(const PointEquations::Impl& e);

}  // namespace maupertuis

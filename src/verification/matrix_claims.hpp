#pragma once
#include <maupertuis/modes.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// expect M at …: ∂²L/∂q'∂q' at the point, at rest or moving, for the coordinates that the expectation names.
void decide_mass_matrix(const expectation::Matrix& e, const EquationsOfMotion& equations, const MotionState& start,
                        ExpectationResult& result);

/// expect A, B, C, G, K, N at …: those of the linearization. C and G are the symmetric and the skew part beside ξ', K
/// and N beside ξ.
void decide_linearization(const expectation::Matrix& e, const MechanicalSystem& system,
                          const Linearization& linearization, ExpectationResult& result);

}  // namespace maupertuis

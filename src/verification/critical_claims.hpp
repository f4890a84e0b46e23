#pragma once
#include <maupertuis/modes.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// expect stable for Ω < c ± tol at θ = 0: the verdict of `maup modes` at the point is the one that is named at c less
/// the tolerance, at 24 values beyond and where a part of the formulas in the parameter alone vanishes, as far as the
/// model's sweep of the parameter goes, or to zero (or twice c), and another one at c plus the tolerance. The value at
/// which it changes is found by bisection.
void decide_critical(const expectation::Stable& e, PointEquations& equations, const MotionState& start,
                     ExpectationResult& result, const Experiment& experiment);

}  // namespace maupertuis

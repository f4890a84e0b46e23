#pragma once
#include "simulation/hybrid_motions.hpp"

/// Where the roots of a step lie, and what rounding hides of them.
namespace maupertuis::hybrid {

/// How far rounding may hide the time at which a force comes to its limit: |f/ḟ| where f is as small as it is told from
/// 0, a third of the whole at a triple root, a fifth at one of five. 0 where the root is a simple one.
double hidden_by_rounding(const ModeMotion& motion, const Met& met, double bound);

/// For how long before its root a gap is not told from 0, where it closes ever more slowly: the third root of its
/// rounding at a root of third order. 0 at a simple one, which is known as time is. `length`: of the step, negative
/// backwards.
double hides_gap(std::size_t contact, double length, const ModeMotion& motion, const State& here,
                 const UsualSizes& sizes);

/// Forces come to their limits at one instant where rounding alone tells their times apart: the first that is located
/// ends the step, and the others count as met with it. A mode that was chosen for the first alone would hold the others
/// beyond their limits, unseen.
void meet_together(Met& met, const ModeMotion& motion, const MechanicalSystem& system, double bound);

}  // namespace maupertuis::hybrid

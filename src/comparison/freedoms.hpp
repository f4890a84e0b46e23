#pragma once
#include "comparison/motions.hpp"
#include "comparison/pull_back.hpp"

namespace maupertuis::comparison {

/// Counts the freedoms of both models and the rank of the map, at states of B. Fills the counts and `degenerate`.
void count_freedoms(const EquationsOfMotion& a, const EquationsOfMotion& b, const PullBack& pull_back,
                    const Motions& motions, Comparison& comparison);

/// "θ = 0, φ = 1.2": a configuration, and the velocities that are not 0.
std::string describe(const MotionState& state, const MechanicalSystem& system);

}  // namespace maupertuis::comparison

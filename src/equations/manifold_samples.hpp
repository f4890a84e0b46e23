#pragma once
#include <maupertuis/constraint_manifold.hpp>

namespace maupertuis {

/// Random consistent states, the same in every run.
struct ManifoldSamples {
  std::vector<MotionState> states;
  std::vector<MotionState> beside;    // [states] where each was taken from: off the constraints
  std::vector<std::size_t> clashing;  // no state was found: a smallest set of constraints that clashes
};

/// Near `start`, or near a state that a search finds: on its branch of the manifold. At times shortly after it, so that
/// what holds at that instant alone is not taken for a rule.
ManifoldSamples sample_manifold(const ConstraintManifold& manifold, const MechanicalSystem& system,
                                const MotionState* start);

}  // namespace maupertuis

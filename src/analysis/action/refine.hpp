#pragma once
#include "analysis/action/newton.hpp"

#include <optional>

namespace maupertuis::action {

/// A stationary path on a mesh that resolves it, and again with every element halved: what differs is the error.
struct Refined {
  Trial coarse, fine;
  double action = 0, action_error = 0, path_error = 0, correction = 0;
  /// Of a motion: its states at the breaks, which are known better than the slopes of polynomials.
  std::vector<MotionState> states;
};

/// Ends at which L has no finite value.
struct SingularEnds {
  bool start = false, end = false;
  bool any() const { return start || end; }
  Pace pace() const { return start ? (end ? Pace::SlowEnds : Pace::SlowStart) : end ? Pace::SlowEnd : Pace::Even; }
};

/// Halves the elements whose polynomials have not converged, and solves again, until all have. Nothing where Newton's
/// method fails on a finer mesh: then there was no path, only one of the coarse equations. `least` [n]: sizes below
/// which a coordinate is not resolved further. `may_have_layers`: elements that do not converge yet may hold a layer of
/// a path, not a jump, as paths of a degenerate L have none; then they are halved on (to 100 elements).
std::optional<Refined> refine(Functional& functional, Trial trial, const FixedEnds& fixed, const Vector& least,
                              const NewtonOptions& options, bool may_have_layers);

}  // namespace maupertuis::action

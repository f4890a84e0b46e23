#pragma once
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/stop_flag.hpp>

#include <string>
#include <vector>

namespace maupertuis::orbits {

/// A stretch of a motion in enough states to see its shape.
struct Survey {
  std::vector<MotionState> states;
  std::vector<double> sizes;  // [2n] how large each coordinate and each velocity gets, > 0: half its range, an angle at
                              // most π; its largest value.
                              // Of what rests its own value, or 1, and that in the time seen
  bool rests = false;         // nothing moves but by rounding
  std::size_t steps = 0;
  std::string ended;              // why before the end; empty: it did not
  std::vector<double> instants;   // s: of impacts, changes of mode, events that set the state
  std::vector<std::size_t> held;  // [instants + 1] how much contacts and friction hold before the first, after each
};

Survey survey(const MechanicalSystem& system, const MotionKernel& motion, const MotionState& start, double duration,
              const StopFlag* interrupt);
/// Through contacts, friction and events of the model, if there are any; `sizes` [2n] of the motion before, or none.
Survey survey(const Model& model, const EquationsOfMotion& equations, const MotionKernel& motion,
              const MotionState& start, double duration, const StopFlag* interrupt, std::span<const double> sizes = {});

}  // namespace maupertuis::orbits

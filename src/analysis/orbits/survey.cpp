#include "analysis/orbits/survey.hpp"

#include <maupertuis/integrator.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis::orbits {
namespace {

constexpr int states_of_a_step = 16;

/// What a coordinate that never moves is measured against.
double size_at_rest(double value) { return value != 0 ? std::abs(value) : 1.0; }

std::vector<double> sizes_of(const MechanicalSystem& system, const std::vector<MotionState>& states) {
  const std::size_t n = system.coordinates.size();
  std::vector<double> sizes(2 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    double low = states.front().q[i], high = low, speed = 0;
    for (const MotionState& s : states) {
      low = std::min(low, s.q[i]), high = std::max(high, s.q[i]);
      speed = std::max(speed, std::abs(s.v[i]));
    }
    sizes[i] = high > low ? (high - low) / 2 : size_at_rest(low);
    if (system.coordinates[i].kind == "angle") sizes[i] = std::min(sizes[i], std::numbers::pi);
    sizes[n + i] = size_at_rest(speed);
  }
  return sizes;
}

}  // namespace

Survey survey(const MechanicalSystem& system, const MotionKernel& motion, const MotionState& start, double duration,
              const std::atomic<bool>* interrupt) {
  Survey out;
  TaylorStepper stepper(motion.kernel, motion.parameters, {.interrupt = interrupt});
  stepper.start(start.t, start.q, start.v);
  out.states.push_back(start);
  const double end = start.t + duration;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    if (step.ending != StepEnding::None) {
      out.ended = step.reason;
      break;
    }
    for (int k = 1; k <= states_of_a_step; ++k) {
      MotionState state = start;
      state.t = k == states_of_a_step ? step.end : step.begin + (step.end - step.begin) * k / states_of_a_step;
      stepper.state(state.t, state.q, state.v);
      out.states.push_back(std::move(state));
    }
  }
  out.steps = stepper.steps();
  out.sizes = sizes_of(system, out.states);
  return out;
}

}  // namespace maupertuis::orbits

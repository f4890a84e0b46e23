#include "analysis/orbits/survey.hpp"

#include <maupertuis/integrator.hpp>
#include <maupertuis/quaternion_coordinates.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace maupertuis::orbits {
namespace {

constexpr int states_of_a_step = 16;
constexpr double rounding_of_rest = 1e-12;
constexpr std::size_t most_states = 1u << 20;
constexpr std::size_t most_steps = 300'000;

/// What a coordinate that never moves is measured against.
double size_at_rest(double value) { return value != 0 ? std::abs(value) : 1.0; }

struct Range {
  double low, high, speed;
};

Range range_of(const std::vector<MotionState>& states, std::size_t i) {
  Range out{states.front().q[i], states.front().q[i], 0};
  for (const MotionState& s : states) {
    out.low = std::min(out.low, s.q[i]), out.high = std::max(out.high, s.q[i]);
    out.speed = std::max(out.speed, std::abs(s.v[i]));
  }
  return out;
}

/// Neighbours of an equilibrium are as large as one likes: what stirs there is rounding of the place, and sizes made of
/// it would measure nothing.
bool is_rest(const Range& r, double duration) {
  const double place = size_at_rest(r.low);
  return r.high - r.low <= rounding_of_rest * place && r.speed * duration <= rounding_of_rest * place;
}

std::vector<double> sizes_of(const MechanicalSystem& system, const std::vector<MotionState>& states, bool& all_rest) {
  const std::size_t n = system.coordinates.size();
  const double duration = std::abs(states.back().t - states.front().t);
  std::vector<double> sizes(2 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Range r = range_of(states, i);
    const bool rests = is_rest(r, duration);
    all_rest = all_rest && rests;
    sizes[i] = r.high > r.low && !rests ? (r.high - r.low) / 2 : size_at_rest(r.low);
    if (system.coordinates[i].kind == "angle") sizes[i] = std::min(sizes[i], std::numbers::pi);
    sizes[n + i] = !rests ? size_at_rest(r.speed) : duration > 0 ? sizes[i] / duration : size_at_rest(r.speed);
  }
  return sizes;
}

/// A quaternion is one place on the sphere: its components share a size, and those that stay at 0 but for rounding are
/// measured by the others.
void share_sizes_of_quaternions(const MechanicalSystem& system, const std::vector<MotionState>& states,
                                std::vector<double>& sizes) {
  const std::size_t n = system.coordinates.size();
  const double duration = std::abs(states.back().t - states.front().t);
  for (const std::array<std::size_t, 4>& four : quaternion_coordinates(system)) {
    double extent = 0, speed = 0;
    for (const std::size_t i : four) {
      const Range r = range_of(states, i);
      extent = std::max(extent, (r.high - r.low) / 2), speed = std::max(speed, r.speed);
    }
    const bool rests = 2 * extent <= rounding_of_rest && speed * duration <= rounding_of_rest;
    for (const std::size_t i : four) {
      sizes[i] = rests ? 1 : extent;
      sizes[n + i] = !rests ? speed : duration > 0 ? 1 / duration : 1;
    }
  }
}

/// Closed contacts hold a place and its rate, friction that sticks a rate.
std::size_t held_in(const ContactMode& mode) {
  std::size_t held = 0;
  for (const bool closed : mode.closed) held += closed ? 2 : 0;
  for (const FrictionState f : mode.friction) held += f == FrictionState::Stick ? 1 : 0;
  return held;
}

void note_instant(const TaylorStepper&, Survey&) {}
void note_instant(const MotionThroughModes& motion, Survey& out) {
  if (out.held.empty()) out.held.push_back(held_in(motion.instant() ? motion.instant()->mode_before : motion.mode()));
  if (const ModeInstant* instant = motion.instant()) {
    out.instants.push_back(instant->before.t);
    out.held.push_back(held_in(instant->mode_after));
  }
  if (motion.stopped_by()) out.ended = "The event `" + *motion.stopped_by() + "` of the model stops it.";
}

/// Of a motion that is longer than can be kept every second state is left out, again and again.
void keep_every_second(std::vector<MotionState>& states) {
  for (std::size_t k = 1; 2 * k < states.size(); ++k) std::swap(states[k], states[2 * k]);
  states.resize((states.size() + 1) / 2);
}

template <class Stepper>
Survey survey_by(Stepper stepper, const MechanicalSystem& system, const MotionState& start, double duration) {
  Survey out;
  stepper.start(start.t, start.q, start.v);
  out.states.push_back(start);
  const double end = start.t + duration;
  std::size_t seen = 0, stride = 1;
  const auto add = [&](double t) {
    if (out.states.size() >= most_states) keep_every_second(out.states), stride *= 2;
    MotionState state = start;
    state.t = t;
    stepper.state(state.t, state.q, state.v);
    out.states.push_back(std::move(state));
  };
  while (stepper.time() != end && out.ended.empty() && stepper.steps() < most_steps) {
    const Step step = stepper.step(end);
    if (step.ending != StepEnding::None) {
      out.ended = step.reason;
      break;
    }
    note_instant(stepper, out);
    for (int k = 1; k <= states_of_a_step; ++k)
      if (++seen % stride == 0)
        add(k == states_of_a_step ? step.end : step.begin + (step.end - step.begin) * k / states_of_a_step);
  }
  if (out.ended.empty() && stepper.time() != end)
    out.ended = fmt::format("It takes more than {} steps, and what comes after them was not looked at.", most_steps);
  if (out.states.back().t != stepper.time()) add(stepper.time());
  out.steps = stepper.steps();
  out.rests = true;
  out.sizes = sizes_of(system, out.states, out.rests);
  share_sizes_of_quaternions(system, out.states, out.sizes);
  return out;
}

}  // namespace

Survey survey(const MechanicalSystem& system, const MotionKernel& motion, const MotionState& start, double duration,
              const StopFlag* interrupt) {
  return survey_by(TaylorStepper(motion.kernel, motion.parameters, {.interrupt = interrupt}), system, start, duration);
}

Survey survey(const Model& model, const EquationsOfMotion& equations, const MotionKernel& motion,
              const MotionState& start, double duration, const StopFlag* interrupt, std::span<const double> sizes) {
  if (!jumps_on_its_way(model)) return survey(*equations.system, motion, start, duration, interrupt);
  MotionThroughModes through(model, equations, {}, {.interrupt = interrupt});
  through.keep_instants();
  if (!sizes.empty()) through.set_usual_sizes(sizes.first(start.q.size()), sizes.subspan(start.q.size()));
  return survey_by(std::move(through), *equations.system, start, duration);
}

}  // namespace maupertuis::orbits

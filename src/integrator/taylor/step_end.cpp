#include "integrator/taylor/stepper.hpp"

#include <cmath>

namespace maupertuis {

/// The end of a step, in the mode in which the step was made, before anything acts there. Where nothing else is in the
/// way, the expansion there is that of the next step.
bool TaylorStepper::Impl::settles(double bound, const taylor::Crossing& crossing, Step& result) {
  if (m > 0 && watched.empty()) {
    constexpr int halvings = 16;
    const double residual_before = constraints.residual;
    last.dense.keep();
    land(result, last.tau_of(state.t));
    // Next to a singular position a shorter step may keep the constraints where a long one does not.
    if (result.ending == StepEnding::SingularConstraints && attempts < halvings) {
      result.ending = StepEnding::None;
      result.reason.clear();
      constraints.residual = residual_before;
      return false;
    }
    if (result.ending != StepEnding::None || !expanded) return true;
    return equations_hold(work);
  }
  const bool goes_on = m == 0 && watched.switches.empty() && !crossing.found && state.t.hi != bound;
  if (goes_on) {
    state.wind();
    last.dense.keep();
    end_status = work.expand(state.t.hi, state.q_now, state.v_now);
    expanded = end_status == KernelStatus::Ok;
    return expanded && equations_hold(work);
  }
  if (control.is_exact) return true;  // the equations are the same at each of its states
  end_status = probe.evaluate(state.t.hi, state.q_now, state.v_now);
  return end_status == KernelStatus::Ok && equations_hold(probe);
}

/// By the polynomial; where forces balance those of the equations, if they are rounding.
std::vector<double> TaylorStepper::Impl::accelerations_at_end(const KernelWorkspace& at_end, double tau) const {
  const std::span<const double> by_polynomial = last.dense.accelerations(tau);
  std::vector<double> out(by_polynomial.begin(), by_polynomial.end());
  for (const taylor::Balanced& x : balanced)
    if (const double a = 2 * at_end.coordinate(2)[x.coordinate]; std::abs(a) <= x.rounding) out[x.coordinate] = a;
  return out;
}

bool TaylorStepper::Impl::equations_hold(const KernelWorkspace& at_end) {
  const double tau = last.tau_of(state.t);
  std::vector<double> where_balanced;
  if (!balanced.empty()) where_balanced = accelerations_at_end(at_end, tau);
  const std::span<const double> by_polynomial = balanced.empty() ? last.dense.accelerations(tau) : where_balanced;
  if (tau == 0 || end_check.agrees(by_polynomial, at_end.coordinate(2), 1, tau)) return true;
  const bool rounds = taylor::agrees_but_for_rounding(end_check, by_polynomial, at_end.coordinate(2), 1, probe,
                                                      state.t.hi, state.q_now, state.v_now, tau, safe.disks());
  safe.set_constants(work.constants());  // the disks had those of the point
  if (rounds) return true;
  // Noise in a coordinate that does not move does not fall with the length of the step.
  constexpr int halvings = 3;
  if (attempts < halvings && !noisy) return false;
  noisy = end_check.agrees_on_the_whole(by_polynomial, at_end.coordinate(2), tau);
  return noisy;
}

/// The state at the beginning of the step that failed, and its expansion.
bool TaylorStepper::Impl::take_back(Step& result) {
  expanded = false;
  state.take_back(last.dense, last.begin, last.turns);
  result.end = state.t.hi;
  last.dense.keep();
  const KernelStatus status = work.expand(state.t.hi, state.q_now, state.v_now);
  return status == KernelStatus::Ok || fail(result, status);
}

}  // namespace maupertuis

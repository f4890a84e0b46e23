#include "integrator/taylor/stepper.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis {

/// What runs already goes on where other code cannot be had.
void TaylorStepper::Impl::compile(bool long_run) {
  const CompileReport report = work.compile({.cache = options.cache, .long_run = long_run, .processor = {}});
  runs_long = long_run;
  const double before = backend.compile_seconds;
  if (report.compiled || !backend.compiled) backend = {report.compiled, before + report.seconds, report.trouble, report.cache_trouble};
}

/// Code for a stage is there soon; code for the whole expansion of a small program is one and a half to six times as fast and takes as long to compile as some
/// 10⁵ steps, from 9 unknowns on as 10⁶. The expected number of steps decides, not the clock and not what the cache holds: so that equal runs give equal results.
void TaylorStepper::Impl::compile_if_it_pays(double bound) {
  constexpr std::size_t first_look = 512;
  constexpr double enough = 20'000, enough_for_long_code = 200'000, usual_size = 8;  // docs/design/kernel_speed.md
  constexpr double enough_for_slow_code = 1'000'000;  // beyond the usual size, as far as whole expansions are written out
  constexpr std::size_t largest_written_out = 16;
  if (options.backend == Backend::Interpreter || steps < first_look || (steps & (steps - 1)) != 0) return;  // looks at powers of two
  const double done = std::abs(t.hi - run_begin), left = std::abs(remaining(bound));
  const double expected = static_cast<double>(steps) * (1 + left / done);
  const double size = std::max(1.0, static_cast<double>(n) / usual_size);  // a step saves more where there are more unknowns
  if (!backend.trouble.empty() || runs_long) return;
  const bool is_slow_to_compile = n > usual_size && n <= largest_written_out;
  if (expected >= (is_slow_to_compile ? enough_for_slow_code : enough_for_long_code)) compile(true);
  else if (!backend.compiled && expected * size >= enough) compile(false);
}

void TaylorStepper::Impl::end(Step& result, StepEnding ending, std::string reason) const {
  result.end = result.begin;
  result.ending = ending;
  result.reason = std::move(reason);
}

bool TaylorStepper::Impl::fail(Step& result, KernelStatus status) const {
  if (status == KernelStatus::SingularMass)
    end(result, StepEnding::SingularMass,
        "The mass matrix is singular here: the equations do not determine the acceleration of " +
            kernel.coordinate_name(work.singular_coordinate()) + ".");
  else if (status == KernelStatus::Contradiction)
    end(result, StepEnding::SingularConstraints,
        "The constraints are singular here: what " + kernel.constraint_name(work.contradicting_constraint()) +
            " asks of the accelerations, the others exclude.");
  else
    end(result, StepEnding::Overflow, "A force or an acceleration is infinite or undefined here.");
  return false;
}

bool TaylorStepper::Impl::expand(double bound, Step& result) {
  dense.keep();
  set_sides(work);
  const KernelStatus status = work.expand(t.hi, q_now, v_now);
  if (status != KernelStatus::Ok) return fail(result, status);
  if (m > 0 && !project(result)) return false;
  return switch_state.empty() || decide_sides(bound, result);
}

/// Up to the first crossing, or to the end of the step.
void TaylorStepper::Impl::advance(double bound, double h, const Crossing& crossing, Step& result) {
  const bool reaches_bound = !crossing.found && h == remaining(bound);
  const double tau = h * crossing.x;
  dense.advance(tau, q, v, integrals);
  if (reaches_bound) t = {bound, 0};
  else t.add(tau);
  for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
  result.end = t.hi;
}

/// Whether steps shrink as the inverse square of their number, or faster, and what is left would take more of them than a run has: looked at where their
/// number doubles, so that equal runs end alike.
bool TaylorStepper::Impl::comes_to_a_stop(double bound) {
  constexpr std::size_t first_look = 4096;
  constexpr double shrinks = 0.3, too_many = 1e8;
  if (steps < first_look || (steps & (steps - 1)) != 0 || steps == last_look) return false;
  // The mean of the steps since the last look: single ones differ by more than that.
  const double mean = std::abs(t.hi - time_at_look) / static_cast<double>(steps - last_look);
  last_look = steps;
  time_at_look = t.hi;
  const double before = std::exchange(length_at_look, mean);
  return before > 0 && length_at_look < shrinks * before && std::abs(remaining(bound)) > too_many * length_at_look;
}

bool TaylorStepper::Impl::is_at_rest() const {
  constexpr double rest = 1e-200;
  const double *const v = work.coordinate(1), *const half_a = work.coordinate(2);
  for (std::size_t i = 0; i < n; ++i)
    if (!(std::abs(v[i]) < rest && std::abs(half_a[i]) < rest)) return false;
  return true;
}

/// What the last coefficients, the multipliers and the disks about every value allow; infinite for a motion that is a polynomial.
double TaylorStepper::Impl::choose_length(double bound) {
  double chosen = restraint * taylor::step_size(work, n, control, length);
  const double left = std::abs(remaining(bound));
  if (m > 0) chosen = taylor::step_within_multipliers(work, n, m, control, std::min(chosen, left));
  length = std::isfinite(chosen) ? chosen : 0;
  end_check.note_rates(work.coordinate(1), work.coordinate(2), 1, std::min(chosen, left));
  if (!safe.is_needed()) return chosen;
  // What is left of velocities below the range of double tells nothing of the motion.
  if (is_at_rest()) chosen = std::numeric_limits<double>::infinity();
  if (!switch_state.empty() || !safe.has_constants()) safe.set_constants(work.constants());
  renew_momenta();
  return safe.within({work.coordinate(0), work.row_stride(), control.order, 1}, t.hi, chosen, left);
}

Step TaylorStepper::Impl::step(double bound) {
  Step result;
  result.begin = result.end = t.hi;
  if (remaining(bound) == 0) return result;
  if (options.interrupt && options.interrupt->load(std::memory_order_relaxed)) {
    end(result, StepEnding::Interrupted, "The run was interrupted.");
    return result;
  }
  if (steps >= options.maximum_steps) {
    end(result, StepEnding::TooManySteps, "The run used up its steps.");
    return result;
  }
  compile_if_it_pays(bound);
  if (comes_to_a_stop(bound)) {
    end(result, StepEnding::StepUnderflow,
        "The steps go on shrinking, so that their number would have no bound: a force or a switch oscillates without end near here.");
    return result;
  }
  if (!expanded && turns.wind(q))
    for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi;
  if (!std::exchange(expanded, false) && !expand(bound, result)) {
    if (result.ending == StepEnding::Overflow) passes_from_here(bound, result);
    return result;
  }
  double chosen = choose_length(bound);
  attempts = 0;
  if (passes_shrinking(chosen, bound, result)) return result;
  if (m > 0 && forces_diverge()) {
    end(result, StepEnding::SingularConstraints, "The constraints are singular near here: the forces that they ask for grow without bound.");
    return result;
  }
  for (;; chosen = 0.5 * std::min(chosen, std::abs(remaining(bound)))) {
    if (!(chosen > 2 * std::numeric_limits<double>::epsilon() * std::abs(t.hi)) || chosen < 1e-290) {
      if (end_status != KernelStatus::Ok) return fail(result, end_status), result;
      end(result, StepEnding::StepUnderflow,
          "The steps shrink below the resolution of time: a force grows without bound, as in a collision.");
      return result;
    }
    const double left = remaining(bound);
    if (make_step(bound, chosen < std::abs(left) ? std::copysign(chosen, left) : left, result)) return result;
    ++rejected;
    ++attempts;
    if (!take_back(result)) return result;
  }
}

/// False: the equations do not hold at its end.
bool TaylorStepper::Impl::make_step(double bound, double h, Step& result) {
  keep_polynomial();
  record_start();
  const Crossing crossing = watches() ? first_crossing(h) : Crossing();
  if (crossing.found && stuck >= 100) {
    end(result, StepEnding::Sliding, "Switches follow each other in no time: the motion has come to slide along a switch.");
    return true;
  }
  advance(bound, h, crossing, result);
  if (!settles(bound, crossing, result)) return false;
  if (result.ending != StepEnding::None) return true;
  stuck = crossing.found && t.hi == begin.hi ? stuck + 1 : 0;
  mark_crossings(crossing, result);
  first = false;
  ++steps;
  return true;
}

// ----------------------------------------------------------------------------------------------------- interface

TaylorStepper::TaylorStepper(const Kernel& kernel, std::span<const double> parameters, const TaylorOptions& options)
    : impl_(std::make_unique<Impl>(kernel, parameters, options)) {}
TaylorStepper::~TaylorStepper() = default;
TaylorStepper::TaylorStepper(TaylorStepper&&) noexcept = default;

int TaylorStepper::order() const { return impl_->control.order; }

void TaylorStepper::start(double t, std::span<const double> q, std::span<const double> v) {
  Impl& s = *impl_;
  MAUP_REQUIRE(q.size() == s.n && v.size() == s.n);
  s.t = {t, 0};
  s.run_begin = t;
  s.turns.forget();
  s.dense_turns.forget();
  for (std::size_t i = 0; i < s.n; ++i) {
    s.q[i] = {q[i], 0};
    s.v[i] = {v[i], 0};
    s.q_now[i] = q[i];
    s.v_now[i] = v[i];
  }
  std::fill(s.integrals.begin(), s.integrals.end(), Compensated{});
  std::fill(s.switch_state.begin(), s.switch_state.end(), taylor::Watched{});
  std::fill(s.event_state.begin(), s.event_state.end(), taylor::Watched{});
  s.first = true;
  s.expanded = false;
  s.length = 0;
  s.restraint = 1;
  s.best_pivot_ratio = 0;
  s.longest = 0;
  s.largest_row.clear();
  s.most_in_force = 0;
  s.steps = s.switches = s.rejected = 0;
  s.safe.forget();
  s.end_check.forget();
  s.end_status = KernelStatus::Ok;
  s.last_look = 0;
  s.noisy = false;
  s.length_at_look = 0;
  s.time_at_look = t;
  s.constraint_residual = 0;
  s.stuck = 0;
  // Before any step the dense output is the starting point.
  s.dense.resize(s.n, s.kernel.integrands(), s.control.order + 1);
  s.begin = s.t;
  s.dense.q = s.q;
  s.dense.v = s.v;
  s.choose_first_sides();
  s.start_sample = s.sample(t);
}

Step TaylorStepper::step(double bound) { return impl_->step(bound); }

double TaylorStepper::time() const { return impl_->t.hi; }
std::span<const double> TaylorStepper::q() const {
  const Impl& s = *impl_;
  s.q_unwound.resize(s.n);
  for (std::size_t i = 0; i < s.n; ++i) s.q_unwound[i] = s.turns.unwound(i, s.q[i]);
  return s.q_unwound;
}
std::span<const double> TaylorStepper::v() const { return impl_->v_now; }
std::size_t TaylorStepper::steps() const { return impl_->steps; }
std::size_t TaylorStepper::rejected() const { return impl_->rejected; }
std::size_t TaylorStepper::switches() const { return impl_->switches; }
const BackendUse& TaylorStepper::backend() const { return impl_->backend; }

bool TaylorStepper::covers(double t) const {
  const double low = std::min(impl_->begin.hi, impl_->t.hi), high = std::max(impl_->begin.hi, impl_->t.hi);
  return low <= t && t <= high;
}

Sample TaylorStepper::sample(double t) const {
  MAUP_REQUIRE(covers(t));
  return impl_->sample(t);
}

double TaylorStepper::constraint_residual() const { return impl_->constraint_residual; }
const Sample& TaylorStepper::step_start() const { return impl_->start_sample; }

}  // namespace maupertuis

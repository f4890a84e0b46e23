#include "integrator/taylor/stepper.hpp"

#include "integrator/taylor/reasons.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace maupertuis {

/// The mixing of G. Steele, D. Lea and C. Flood, Fast splittable pseudorandom number generators (2014).
double share_of_rounding(std::uint64_t number, double at) {
  std::uint64_t x = 0;
  std::memcpy(&x, &at, sizeof x);
  x += number * 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  x ^= x >> 31U;
  return std::ldexp(static_cast<double>(x >> 11U), -52) - 1;
}

void TaylorStepper::Impl::end(Step& result, StepEnding ending, std::string reason) const {
  result.end = result.begin;
  result.ending = ending;
  result.reason = std::move(reason);
}

bool TaylorStepper::Impl::fail(Step& result, KernelStatus status) {
  const StepEnding ending = status == KernelStatus::SingularMass    ? StepEnding::SingularMass
                            : status == KernelStatus::Contradiction ? StepEnding::SingularConstraints
                                                                    : StepEnding::Overflow;
  const bool is_finite =
      ending == StepEnding::Overflow && work.evaluate(state.t.hi, state.q_now, state.v_now) == KernelStatus::Ok;
  end(result, ending, taylor::reason_of(status, kernel, work, is_finite));
  return false;
}

bool TaylorStepper::Impl::expand(double bound, Step& result) {
  last.dense.keep();
  watched.set_sides(work);
  const KernelStatus status = work.expand(state.t.hi, state.q_now, state.v_now);
  if (status != KernelStatus::Ok) return fail(result, status);
  if (m > 0 && !project(result)) return false;
  return watched.switches.empty() || decide_sides(bound, result);
}

/// The motion through the present state under the present sides; the length over which to judge it.
std::optional<double> TaylorStepper::Impl::trial(double bound) {
  watched.set_sides(work);
  if (work.expand(state.t.hi, state.q_now, state.v_now) != KernelStatus::Ok) return std::nullopt;
  const double h = taylor::step_size(work, n, control, length);
  return std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound));
}

bool TaylorStepper::Impl::decide_sides(double bound, Step& result) {
  using taylor::SideChooser;
  const double h = taylor::step_size(work, n, control, length);
  SideChooser chooser(work, watched.switches, [&](const std::vector<std::int8_t>&) { return trial(bound); });
  switch (chooser.decide(std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound)))) {
    case SideChooser::Outcome::Decided:
      return switches_have_values(bound, result);
    case SideChooser::Outcome::Failed:
      return fail(result, KernelStatus::NonFinite);
    case SideChooser::Outcome::Sliding:
      break;
  }
  end(result, StepEnding::Sliding,
      "Both sides of a switch push the motion back to it, so that it would slide along the switch.");
  return false;
}

/// A switch function without a value (√ of what is negative) decides nothing. It may stand where it changes nothing: in
/// a branch that is not in force.
bool TaylorStepper::Impl::switches_have_values(double bound, Step& result) {
  const auto motion_on = [&](taylor::Watched& w, std::int8_t side) {
    w.side = side;
    std::vector<double> coefficients;
    if (!trial(bound)) return coefficients;
    for (int k = 2; k <= control.order; ++k)
      coefficients.insert(coefficients.end(), work.coordinate(k), work.coordinate(k) + n);
    return coefficients;
  };
  for (std::size_t i = 0; i < watched.switches.size(); ++i) {
    if (!std::isnan(work.switch_function(i, 0))) continue;
    taylor::Watched& w = watched.switches[i];
    const std::vector<double> above = motion_on(w, 1), below = motion_on(w, -1);
    w.side = 0;
    if (above.empty() || above != below || !trial(bound)) {
      end(result, StepEnding::Overflow,
          "The argument of a switch (step, sign, abs, min, max or a comparison) is no real number here, and the motion "
          "depends on it.");
      return false;
    }
  }
  return true;
}

/// Within the step; one that is not longer than the rounding stays as it is. Where nothing asks for the time, roots are
/// known to the rounding of coordinates.
double TaylorStepper::Impl::moved(double tau, double h, bool meets_events_alone) const {
  double age = std::abs(state.t.hi + tau);
  if (work.program().time == no_slot) {
    double slowest = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (state.v_now[i] != 0) slowest = std::max(slowest, std::abs(state.q_now[i] / state.v_now[i]));
    age = std::min(age, slowest + std::abs(tau));
  }
  const double rounding = 0.5 * std::numeric_limits<double>::epsilon() * age;
  const double share = share_of_rounding(options.moved_instants, state.t.hi + tau);
  // From the beginning of a run τ is no finer than the time itself, to which the root was rounded. Beyond a switch the
  // motion may have no values on the side from which it came.
  const double by_share = tau + rounding * share;
  const double to =
      by_share == tau && meets_events_alone ? std::nextafter(tau, std::copysign(HUGE_VAL, share)) : by_share;
  return std::abs(tau) > 2 * rounding && std::abs(to) <= std::abs(h) ? to : tau;
}

/// Up to the first crossing, or to the end of the step.
void TaylorStepper::Impl::advance(double bound, double h, const taylor::Crossing& crossing, Step& result) {
  const bool reaches_bound = !crossing.found && crossing.x == 1 && h == remaining(bound);
  double tau = h * crossing.x;
  if (crossing.found && options.moved_instants != 0) {
    const auto is_event = [&](const taylor::MetRoot<double>& root) { return root.index >= watched.switches.size(); };
    tau = moved(tau, h, std::all_of(crossing.roots.begin(), crossing.roots.end(), is_event));
  }
  state.move(last.dense, last.begin, tau);
  if (reaches_bound) state.arrive(bound);
  result.end = state.t.hi;
}

bool TaylorStepper::Impl::is_at_rest() const {
  constexpr double rest = 1e-200;
  const double *const v = work.coordinate(1), *const half_a = work.coordinate(2);
  for (std::size_t i = 0; i < n; ++i)
    if (!(std::abs(v[i]) < rest && std::abs(half_a[i]) < rest)) return false;
  return true;
}

/// Whether no velocity and no acceleration is there, and no formula asks for the time: then q for ever is a motion,
/// also where a force has no derivative, as −√q at 0.
bool TaylorStepper::Impl::rests_for_ever() const {
  if (work.program().time != no_slot) return false;
  const double *const v = work.coordinate(1), *const half_a = work.coordinate(2);
  return std::all_of(v, v + n, [](double x) { return x == 0; }) &&
         std::all_of(half_a, half_a + n, [](double x) { return x == 0; });
}

/// Whether all forces balance over a step of length h, all velocities are rounding, and no formula asks for the time:
/// then nothing ever moves, whatever rounding makes of the coefficients.
bool TaylorStepper::Impl::stays(double h) const {
  if (m == 0 || work.program().time != no_slot) return false;
  const auto still = taylor::balanced(work, n, m, h, std::abs(state.t.hi - last.begin.hi), constraints.usual);
  return still.size() == n && std::all_of(still.begin(), still.end(), [](const auto& x) { return x.rests; });
}

/// What the last coefficients, the multipliers and the disks about every value allow; infinite for a motion that is a
/// polynomial.
double TaylorStepper::Impl::choose_length(double bound) {
  double chosen = constraints.restraint * taylor::step_size(work, n, control, length);
  const double left = std::abs(remaining(bound));
  if (m > 0) chosen = taylor::step_within_multipliers(work, n, m, control, std::min(chosen, left));
  // A motion that is a parabola asks for no step, but what is made of it may have a series that ends.
  if (!std::isfinite(chosen) && !integrand_sizes.empty() && !is_at_rest())
    if (const double cut = taylor::step_within_integrals(work, integrand_sizes, control, left); cut < left)
      chosen = cut;
  length = std::isfinite(chosen) ? chosen : 0;
  end_check.note_rates(work.coordinate(1), work.coordinate(2), 1, std::min(chosen, left));
  if (!safe.is_needed()) return chosen;
  if (stays(left)) return std::numeric_limits<double>::infinity();
  // What is left of velocities below the range of double tells nothing of the motion.
  if (is_at_rest()) chosen = std::numeric_limits<double>::infinity();
  if (!watched.switches.empty() || !safe.has_constants()) safe.set_constants(work.constants());
  if (safe.wants_momenta(end_check.rates())) safe.set_momenta(end_check.rates(), work);
  const auto measure = safe.disks().has_bases() ? nullptr : work.polynomials().sizes;
  if (measure) measure(work.coordinate(0), safe.disk_radius(std::min(chosen, left)), sizes.data());
  return safe.within({work.coordinate(0), work.row_stride(), control.order, 1}, state.t.hi, chosen, left,
                     measure ? sizes.data() : nullptr);
}

/// Whether the velocities of now would be made, or taken away, in a small part of the longest step so far.
bool TaylorStepper::Impl::accelerations_grow() const {
  constexpr double small = 1e-3;
  double speed = 0, acceleration = 0;
  for (std::size_t i = 0; i < n; ++i) {
    speed = std::max(speed, std::abs(state.v_now[i]));
    acceleration = std::max(acceleration, std::abs(work.acceleration(i)));
  }
  return !(acceleration * small * longest <= speed);
}

std::string TaylorStepper::Impl::why_steps_shrink() const {
  const int usual = taylor_order(options.tolerance);
  if (2 * control.order < usual)
    return fmt::format(
        "The steps go on shrinking, so that their number would have no bound: of order {} they are too "
        "short for this tolerance, for which {} is usual.",
        control.order, usual);
  return "The steps go on shrinking, so that their number would have no bound: near here a force or a switch "
         "oscillates "
         "without end, or a coordinate grows beyond all bounds.";
}

/// Whether a step is to be made at all.
bool TaylorStepper::Impl::may_go_on(double bound, Step& result) {
  if (options.interrupt && options.interrupt->load(std::memory_order_relaxed))
    end(result, StepEnding::Interrupted, "The run was interrupted.");
  else if (steps >= options.maximum_steps)
    end(result, StepEnding::TooManySteps, "The run used up its steps.");
  else if (shrinking.come_to_a_stop(steps, state.t.hi, remaining(bound)))
    end(result, StepEnding::StepUnderflow, why_steps_shrink());
  else if (shrinking.never_arrives(steps, remaining(bound)))
    end(result, StepEnding::TooManySteps,
        fmt::format("Steps of this motion are about {:.2g} s long: some 10^{:.0f} of them were left, and a run has "
                    "{:.1g}.",
                    shrinking.mean(), std::log10(std::abs(remaining(bound))) - std::log10(shrinking.mean()),
                    static_cast<double>(options.maximum_steps)));
  return result.ending == StepEnding::None;
}

Step TaylorStepper::Impl::step(double bound) {
  Step result;
  result.begin = result.end = state.t.hi;
  if (remaining(bound) == 0 || !may_go_on(bound, result)) return result;
  code.compile_if_it_pays(work, kernel, options, steps, state.t.hi, bound);
  if (!expanded) state.wind();
  if (!std::exchange(expanded, false) && !expand(bound, result)) {
    if (result.ending == StepEnding::Overflow) passes_from_here(bound, result);
    return result;
  }
  double chosen = choose_length(bound);
  constexpr double no_time = 16 * std::numeric_limits<double>::epsilon();
  if (std::abs(remaining(bound)) <= no_time * std::abs(state.t.hi))
    chosen = std::max(chosen, std::abs(remaining(bound)));
  attempts = 0;
  if (passes_shrinking(chosen, bound, result)) return result;
  if (m > 0 && forces_diverge()) {
    end(result, StepEnding::SingularConstraints,
        "The constraints are singular near here: the forces that they ask for grow without bound.");
    return result;
  }
  for (;; chosen = 0.5 * std::min(chosen, std::abs(remaining(bound)))) {
    if (!(chosen > 2 * std::numeric_limits<double>::epsilon() * std::abs(state.t.hi)) || chosen < 1e-290) {
      if (end_status != KernelStatus::Ok) return fail(result, end_status), result;
      end(result, StepEnding::StepUnderflow,
          accelerations_grow()
              ? "The steps shrink below the resolution of time: a force grows without bound, as in a collision."
              : "The steps shrink below the resolution of time: no force grows, but a formula ends here or has no "
                "derivatives, as x^(3/2) where x comes to 0.");
      return result;
    }
    const double left = remaining(bound);
    if (make_step(bound, chosen < std::abs(left) ? std::copysign(chosen, left) : left, result)) return result;
    ++rejected;
    ++attempts;
    if (!take_back(result)) return result;
  }
}

/// The first crossing of a step of length h, which becomes shorter where a watched function swings too often in it to
/// be followed to its end, or so often that rounding of its places hides the swings.
taylor::Crossing TaylorStepper::Impl::crossing_within(double& h) {
  constexpr double longer = 1.1, sure = 0.9, shorter = 1.0 / 16, moment = 1e4 * std::numeric_limits<double>::epsilon();
  const double shortest = moment * std::max(std::abs(state.t.hi), std::abs(h));
  const bool was_shortened = followed > 0;
  if (was_shortened) h = std::copysign(std::min(std::abs(h), longer * followed), h);
  for (;;) {
    taylor::Crossing out = watched.first_crossing(work, state.t, h);
    const bool is_crowded = out.followed < out.x, is_hidden = out.is_lost && out.x == 0 && std::abs(h) > shortest;
    if (is_crowded || is_hidden) h *= is_crowded ? sure * out.followed : shorter;
    if (is_crowded || is_hidden || was_shortened) followed = std::abs(h);
    if (!is_crowded && !is_hidden) return out;
  }
}

/// False: the equations do not hold at its end.
bool TaylorStepper::Impl::make_step(double bound, double h, Step& result) {
  balanced = taylor::balanced(work, n, m, std::abs(h), std::abs(state.t.hi - last.begin.hi), constraints.usual);
  last.keep(work, state);
  for (const taylor::Balanced& x : balanced) last.dense.leave_out_acceleration(x.coordinate, x.rests);
  watched.set_sides(probe);
  last.record_start(work, steps % options.observed_steps == 0);
  has_start_sample = true;
  const taylor::Crossing crossing = watched.empty() ? taylor::Crossing() : crossing_within(h);
  if (crossing.found && stuck >= 100) {
    end(result, StepEnding::Sliding,
        "Switches follow each other in no time: the motion has come to slide along a switch.");
    return true;
  }
  if (crossing.is_lost && crossing.x == 0) {
    end(result, StepEnding::Overflow, taylor::no_series_of_watched);
    return true;
  }
  advance(bound, h, crossing, result);
  if (!settles(bound, crossing, result)) return false;
  if (result.ending != StepEnding::None) return true;
  stuck = crossing.found && state.t.hi == last.begin.hi ? stuck + 1 : 0;
  watched.leave(crossing, h, result);
  switches += result.switches.size() + crossing.turned.size();
  first = false;
  ++steps;
  return true;
}

// ----------------------------------------------------------------------------------------------------- interface

TaylorStepper::TaylorStepper(const Kernel& kernel, std::span<const double> parameters, const TaylorOptions& options)
    : impl_((check_argument(parameters.size() == kernel.parameters(),
                            "TaylorStepper: `parameters` has another length than the kernel has parameters"),
             std::make_unique<Impl>(kernel, parameters, options))) {}
TaylorStepper::~TaylorStepper() = default;
TaylorStepper::TaylorStepper(TaylorStepper&&) noexcept = default;

int TaylorStepper::order() const { return impl_->usual_control.order; }

void TaylorStepper::start(double t, std::span<const double> q, std::span<const double> v, double rest) {
  Impl& s = *impl_;
  check_argument(q.size() == s.n, "TaylorStepper::start: q has another length than the kernel has coordinates");
  check_argument(v.size() == s.n, "TaylorStepper::start: v has another length than the kernel has coordinates");
  check_argument(std::isfinite(t), "TaylorStepper::start: t is no time");
  s.has_started = true;
  // After an impact a motion goes on from where it has come to.
  const bool is_same_place = s.steps > 0 && s.state.t.hi == t && s.state.t.lo == rest &&
                             std::equal(q.begin(), q.end(), s.state.q_now.begin()) && s.watched.know_sides();
  s.state.start(t, q, v);
  s.state.t.lo = rest;
  s.integrand_sizes.assign(s.state.integrals.size(), 0);
  s.watched.start();
  s.constraints.start();
  s.shrinking.start(t);
  s.safe.forget();
  s.end_check.forget();
  s.length = s.longest = s.tried = s.followed = 0;
  s.first = true;
  s.expanded = s.noisy = false;
  s.stuck = 0;
  s.end_status = KernelStatus::Ok;
  s.code.begin(t, s.steps);
  s.steps = s.switches = s.rejected = 0;
  s.last.start(s.state);
  if (!is_same_place) s.watched.choose_first_sides(s.work, s.state);
  s.watched.set_sides(s.probe);
  s.last.start_sample.t = t;
  s.has_start_sample = false;
}

void TaylorStepper::put_at_zero(std::span<const std::size_t> events, std::uint8_t order) {
  for (const std::size_t i : events) {
    check_argument(i < impl_->kernel.events(), "TaylorStepper::put_at_zero: the kernel has no such event");
    impl_->watched.put_at_zero(i, order);
  }
}

void TaylorStepper::treat_events(std::span<const EventTreatment> treatments) {
  check_argument(treatments.size() == impl_->kernel.events(),
                 "TaylorStepper::treat_events: another number of treatments than the kernel has events");
  impl_->watched.treat(treatments);
}

void TaylorStepper::set_usual_sizes(std::span<const double> q, std::span<const double> v, std::span<const double> a) {
  impl_->constraints.usual.q.assign(q.begin(), q.end());
  impl_->constraints.usual.v.assign(v.begin(), v.end());
  impl_->constraints.usual.a.assign(a.begin(), a.end());
  impl_->work.set_usual_accelerations(a);
  impl_->probe.set_usual_accelerations(a);
}

TaylorStepper::Outlook TaylorStepper::outlook(double bound) {
  Impl& s = *impl_;
  Outlook out;
  Step result;
  result.begin = result.end = s.state.t.hi;
  s.state.wind();
  s.expanded = s.expand(bound, result);
  out.ending = result.ending;
  out.reason = result.reason;
  if (!s.expanded) return out;
  const double h = std::min(taylor::step_size(s.work, s.n, s.control, s.length), std::abs(s.remaining(bound)));
  out.length = h;
  for (auto* list : {&out.reach, &out.values, &out.slopes}) list->reserve(s.kernel.events());
  out.sides.reserve(s.kernel.events());
  out.accelerations.reserve(s.n);
  for (const auto& [side, reach] : s.watched.sides_of_events(s.work, std::copysign(h, s.remaining(bound)))) {
    out.sides.push_back(side);
    out.reach.push_back(reach);
  }
  for (std::size_t i = 0; i < s.kernel.events(); ++i)
    out.values.push_back(s.work.event(i, 0)), out.slopes.push_back(s.work.event(i, 1));
  for (std::size_t i = 0; i < s.n; ++i) out.accelerations.push_back(s.work.acceleration(i));
  return out;
}

Step TaylorStepper::step(double bound) {
  check_argument(impl_->has_started, "TaylorStepper::step: the motion has no start");
  check_argument(!std::isnan(bound), "TaylorStepper::step: `bound` is no time");
  return impl_->step(bound);
}

double TaylorStepper::time() const { return impl_->state.t.hi; }
double TaylorStepper::time_rest() const { return impl_->state.t.lo; }
std::span<const double> TaylorStepper::q() const {
  const Impl& s = *impl_;
  s.q_unwound.resize(s.n);
  for (std::size_t i = 0; i < s.n; ++i) s.q_unwound[i] = s.state.turns.unwound(i, s.state.q[i]);
  return s.q_unwound;
}
std::span<const double> TaylorStepper::v() const { return impl_->state.v_now; }
double TaylorStepper::integral(std::size_t index) const {
  check_argument(index < impl_->state.integrals.size(), "TaylorStepper::integral: the kernel has no such integral");
  return impl_->state.integrals[index].hi;
}
double TaylorStepper::event_at_begin(std::size_t event) const { return impl_->work.event(event, 0); }
std::size_t TaylorStepper::steps() const { return impl_->steps; }
std::size_t TaylorStepper::rejected() const { return impl_->rejected; }
std::size_t TaylorStepper::switches() const { return impl_->switches; }
const BackendUse& TaylorStepper::backend() const { return impl_->code.use(); }

bool TaylorStepper::covers(double t) const {
  const double low = std::min(impl_->last.begin.hi, impl_->state.t.hi),
               high = std::max(impl_->last.begin.hi, impl_->state.t.hi);
  return low <= t && t <= high;
}

Sample TaylorStepper::sample(double t) const {
  check_argument(covers(t), "TaylorStepper: t is not within the last step");
  return impl_->last.sample(t, impl_->probe);
}

void TaylorStepper::state(double t, std::span<double> q, std::span<double> v) const {
  check_argument(covers(t), "TaylorStepper: t is not within the last step");
  impl_->last.state(t, q, v);
}

std::span<const double> TaylorStepper::accelerations_of_step(double t) const {
  MAUP_REQUIRE(covers(t));
  return impl_->last.accelerations(t);
}

double TaylorStepper::constraint_residual() const { return impl_->constraints.residual; }
const Sample& TaylorStepper::step_start() const {
  Impl& s = *impl_;
  if (!s.has_start_sample) {
    s.watched.set_sides(s.probe);
    s.last.start_sample = s.last.sample(s.state.t.hi, s.probe);
    s.has_start_sample = true;
  }
  return s.last.start_sample;
}

}  // namespace maupertuis

#include "integrator/dense_output/dense_output.hpp"
#include "integrator/taylor/constraint_error.hpp"
#include "integrator/taylor/step_size.hpp"
#include "integrator/taylor/switches.hpp"

#include <maupertuis/integrator.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace maupertuis {

using taylor::SideChooser;
using taylor::Watched;

/// A step: expand the motion, decide the sides of switch functions that begin at a zero, choose a length, shorten it to
/// the first crossing, advance.
struct TaylorStepper::Impl {
  Impl(const Kernel& k, std::span<const double> parameters, const TaylorOptions& o)
      : kernel(k), options(o), control(taylor::step_control(o.tolerance, o.order)), work(k, control.order),
        probe(k, 1), n(k.freedoms()), switch_state(k.switches().size()), event_state(k.events()) {
    work.set_parameters(parameters);
    probe.set_parameters(parameters);
    dense.resize(n, k.integrands(), control.order + 1);
    for (auto* state : {&q, &v}) state->resize(n);
    for (auto* values : {&q_now, &v_now}) values->resize(n);
    for (auto* values : {&dq, &dv}) values->resize(n);
    integrals.resize(k.integrands());
    if (options.backend == Backend::Compiled) compile();
  }

  struct Crossing {
    double x = 1;       // fraction of the step
    bool found = false;
    std::vector<std::size_t> switches;
    std::optional<std::size_t> event;
  };

  Step step(double bound);
  bool forces_diverge();
  void compile();
  void compile_if_it_pays(double bound);
  bool expand(double bound, Step& result);
  bool project(Step& result, bool known = false);
  void land(Step& result, double tau);
  void move_to(double tau, Step& result);
  bool decide_sides(double bound, Step& result);
  std::optional<double> trial(double bound);
  bool expands_once() const { return kernel.constraints() == 0 && switch_state.empty(); }
  void keep_polynomial();
  void restore_polynomial();
  void record_start() const;
  Crossing first_crossing(double h) const;
  std::int8_t event_side(std::size_t index, const taylor::ScaledPolynomial& polynomial) const;
  void note(Crossing& crossing, double x) const;
  void advance(double bound, double h, const Crossing& crossing, Step& result);
  void mark_crossings(const Crossing& crossing, Step& result);
  void end(Step& result, StepEnding ending, std::string reason) const;
  bool fail(Step& result, KernelStatus status) const;
  double remaining(double bound) const { return (bound - t.hi) - t.lo; }
  double tau_of(double time) const { return (time - begin.hi) - begin.lo; }
  void set_sides(KernelWorkspace& w) const;
  void choose_first_sides();
  Sample sample(double time) const;

  Kernel kernel;
  TaylorOptions options;
  taylor::StepControl control;
  KernelWorkspace work;
  mutable KernelWorkspace probe;         // for the kernel at points within the step
  std::size_t n;

  Compensated t, begin;                  // now; the beginning of the last step
  std::vector<Compensated> q, v, integrals;
  std::vector<double> q_now, v_now;      // [n] their leading parts
  std::vector<double> dq, dv;            // [n] back to the constraints
  double constraint_residual = 0;
  DenseOutput dense;
  std::vector<Watched> switch_state, event_state;
  bool first = true;                     // no step made yet
  bool expanded = false;                 // the workspace holds the motion through the present state already
  double length = 0;                     // the last length that the control chose
  double best_pivot_ratio = 0;           // of the bordered matrix so far
  std::size_t most_in_force = 0;         // constraints so far
  double restraint = 1;                  // of the lengths that the control chooses
  double longest = 0;                    // length so far
  std::vector<double> largest_row;       // [constraints] of A so far
  std::size_t steps = 0, switches = 0;
  int stuck = 0;                         // crossings in a row that did not move time
  BackendUse backend;
  double run_begin = 0;
  mutable Sample start_sample;
  mutable bool start_is_recorded = false;
};

namespace {

void multipliers_of(const KernelWorkspace& work, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = work.multiplier_is_determined(i) ? work.multiplier(i) : std::numeric_limits<double>::quiet_NaN();
}

std::int8_t sign(double x) { return static_cast<std::int8_t>((x > 0) - (x < 0)); }

}  // namespace

/// A row of A that goes to zero while the steps do: its multiplier has a pole there. Rounding errors of the state grow with it, so that
/// further steps would lead to whatever branch of the configurations they happen to be on.
bool TaylorStepper::Impl::forces_diverge() {
  constexpr double vanishing = 1e-6;
  longest = std::max(longest, length);
  largest_row.resize(kernel.constraints(), 0.0);
  bool vanishes = false;
  for (std::size_t j = 0; j < kernel.constraints(); ++j) {
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(work.constraint_matrix(j, i)));
    largest_row[j] = std::max(largest_row[j], size);
    vanishes = vanishes || size < vanishing * largest_row[j];
  }
  return vanishes && length > 0 && length < vanishing * longest;
}

void TaylorStepper::Impl::compile() {
  const CompileReport report = work.compile({options.cache, control.order, true, {}});
  backend = {report.compiled, report.seconds, report.trouble, report.cache_trouble};
}

/// The expected number of steps decides, not the clock and not what the cache holds: so that equal runs give equal results.
void TaylorStepper::Impl::compile_if_it_pays(double bound) {
  constexpr std::size_t first_look = 512, enough = 40'000;  // docs/design/kernel_speed.md
  if (options.backend != Backend::Automatic || steps < first_look || !std::has_single_bit(steps)) return;
  const double done = std::abs(t.hi - run_begin), left = std::abs(remaining(bound));
  if (static_cast<double>(steps) * (1 + left / done) >= static_cast<double>(enough) && !backend.compiled && backend.trouble.empty()) compile();
}

void TaylorStepper::Impl::set_sides(KernelWorkspace& w) const {
  if (switch_state.empty()) return;
  std::vector<std::int8_t> sides;
  for (const Watched& s : switch_state) sides.push_back(s.side);
  w.set_branches(sides);
}

/// Signs of the switch functions at the start, zeros left open: enough for the values there.
void TaylorStepper::Impl::choose_first_sides() {
  set_sides(work);
  if (!switch_state.empty() && work.evaluate(t.hi, q_now, v_now) == KernelStatus::Ok)
    for (std::size_t i = 0; i < switch_state.size(); ++i) switch_state[i].side = sign(work.switch_function(i, 0));
  set_sides(probe);
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

/// The motion through the present state under the present sides; the length over which to judge it.
std::optional<double> TaylorStepper::Impl::trial(double bound) {
  set_sides(work);
  if (work.expand(t.hi, q_now, v_now) != KernelStatus::Ok) return std::nullopt;
  const double h = taylor::step_size(work, n, control, length);
  return std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound));
}

bool TaylorStepper::Impl::expand(double bound, Step& result) {
  set_sides(work);
  const KernelStatus status = work.expand(t.hi, q_now, v_now);
  if (status != KernelStatus::Ok) {
    fail(result, status);
    restore_polynomial();
    return false;
  }
  if (kernel.constraints() > 0 && !project(result)) return false;
  return switch_state.empty() || decide_sides(bound, result);
}

/// Brings q and q̇ back to the constraints. The expansion has factored the bordered matrix, so that this costs two
/// solves; only where the corrections are above rounding is the motion expanded anew.
/// `known`: the corrections are there.
bool TaylorStepper::Impl::project(Step& result, bool known) {
  double error = taylor::constraint_error(work, n, kernel.constraints(), length);
  if (!first) constraint_residual = std::max(constraint_residual, error);
  // In a rotation the radius of convergence is no bound: steps get so long that each order of λ multiplies the rounding
  // errors of those before it. What a step leaves in the constraints shows it.
  if (!first && error > taylor::rounding_of_constraints + options.tolerance) restraint = 0.45;
  const double allowed = std::max(1e-7, 1e3 * options.tolerance);
  for (int turn = 0; turn < 20; ++turn) {
    if (!std::exchange(known, false)) work.corrections(dq, dv);
    if (!first && !(error <= allowed && taylor::correction_size(work, dq, dv, length) <= allowed)) {
      end(result, StepEnding::SingularConstraints,
          "The constraints are singular near here: they do not determine where the motion goes.");
      return false;
    }
    for (std::size_t i = 0; i < n; ++i) {
      q[i].add(dq[i]), v[i].add(dv[i]);
      q_now[i] = q[i].hi, v_now[i] = v[i].hi;
    }
    if (error <= taylor::rounding_of_constraints) return true;
    if (const KernelStatus status = work.expand(t.hi, q_now, v_now); status != KernelStatus::Ok) return fail(result, status);
    const double now = taylor::constraint_error(work, n, kernel.constraints(), length);
    if (turn > 2 && now > 0.5 * error) break;
    error = now;
  }
  if (error < 1e-10) return true;
  end(result, StepEnding::SingularConstraints, "The constraints cannot be met near here.");
  return false;
}

/// Next to a singular configuration of the constraints what rounding left of them is blown up by the projection, and λ and q̈
/// lose digits as the pivots fall. The
/// motion goes through it all the same where it is determined, so that a step must not end just there: then it is made
/// shorter, and the next one passes. The expansion at its end is that of the next step.
void TaylorStepper::Impl::land(Step& result, double tau) {
  const double sound = std::max(1e-12, 1e2 * options.tolerance), allowed = std::max(1e-7, 1e3 * options.tolerance);
  bool defined = false;
  for (int trial = 0; trial < 12; ++trial) {
    set_sides(work);
    if (work.expand(t.hi, q_now, v_now) == KernelStatus::Ok) {
      defined = true;
      work.corrections(dq, dv);
      const double error = taylor::constraint_error(work, n, kernel.constraints(), length);
      const std::size_t in_force = work.constraints_in_force();
      const bool regular = in_force >= most_in_force && work.pivot_ratio() > 1e-6 * best_pivot_ratio;
      if (regular && error <= allowed && taylor::correction_size(work, dq, dv, length) <= sound) {
        if (in_force > most_in_force) best_pivot_ratio = 0;
        most_in_force = in_force;
        best_pivot_ratio = std::max(best_pivot_ratio, work.pivot_ratio());
        Step projected;
        expanded = project(projected, true);
        return;
      }
    }
    tau *= 0.83;
    move_to(tau, result);
  }
  if (!defined) return;  // the next step says why
  move_to(0, result);
  end(result, StepEnding::SingularConstraints,
      "The constraints are singular near here: they do not determine where the motion goes.");
}

/// Ends the last step earlier.
void TaylorStepper::Impl::move_to(double tau, Step& result) {
  dense.advance(tau, q, v, integrals);
  t = begin;
  t.add(tau);
  for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
  result.end = t.hi;
}

bool TaylorStepper::Impl::decide_sides(double bound, Step& result) {
  const double h = taylor::step_size(work, n, control, length);
  SideChooser chooser(work, switch_state, [&](const std::vector<std::int8_t>&) { return trial(bound); });
  switch (chooser.decide(std::copysign(std::min(h, std::abs(remaining(bound))), remaining(bound)))) {
    case SideChooser::Outcome::Decided: return true;
    case SideChooser::Outcome::Failed: return fail(result, KernelStatus::NonFinite);
    case SideChooser::Outcome::Sliding: break;
  }
  end(result, StepEnding::Sliding,
      "Both sides of a switch push the motion back to it, so that it would slide along the switch.");
  return false;
}

/// The expansion that failed has overwritten that of the last step, which is still asked for.
void TaylorStepper::Impl::restore_polynomial() {
  if (first || !expands_once()) return;
  std::vector<double> position(n), velocity(n);
  for (std::size_t i = 0; i < n; ++i) position[i] = dense.q[i].hi, velocity[i] = dense.v[i].hi;
  work.expand(begin.hi, position, velocity);
}

/// Where a step may be expanded more than once, the rows of the workspace do not stay.
void TaylorStepper::Impl::keep_polynomial() {
  begin = t;
  set_sides(probe);
  if (expands_once()) dense.refer_to(work.coordinate(0), work.row_stride());
  else dense.copy(work.coordinate(0), work.row_stride());
  for (std::size_t i = 0; i < integrals.size(); ++i)
    for (int k = 0; k <= control.order + 1; ++k) dense.integrand(k)[i] = work.integrand(i, k);
  std::copy(q.begin(), q.end(), dense.q.begin());
  std::copy(v.begin(), v.end(), dense.v.begin());
  std::copy(integrals.begin(), integrals.end(), dense.integrals.begin());
}

/// From what `dense` and the workspace hold; done when it is asked for, where the workspace stays as it is.
void TaylorStepper::Impl::record_start() const {
  start_is_recorded = true;
  start_sample.t = begin.hi;
  start_sample.q.resize(n), start_sample.v.resize(n), start_sample.a.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    start_sample.q[i] = dense.q[i].hi, start_sample.v[i] = dense.v[i].hi;
    start_sample.a[i] = work.acceleration(i);
  }
  start_sample.observables.resize(kernel.observables());
  for (std::size_t i = 0; i < kernel.observables(); ++i) start_sample.observables[i] = work.observable(i);
  start_sample.multipliers.resize(kernel.constraints());
  multipliers_of(work, start_sample.multipliers);
  start_sample.integrals.resize(integrals.size());
  for (std::size_t i = 0; i < integrals.size(); ++i) start_sample.integrals[i] = dense.integrals[i].hi;
}

void TaylorStepper::Impl::note(Crossing& crossing, double x) const {
  // Roots that rounding does not tell apart are one crossing.
  if (x < crossing.x * (1 - 4 * std::numeric_limits<double>::epsilon())) {
    crossing.switches.clear();
    crossing.event.reset();
  }
  crossing.x = std::min(crossing.x, x);
  crossing.found = true;
}

/// The sign of an event function, or at a zero the sign that it takes from there.
std::int8_t TaylorStepper::Impl::event_side(std::size_t index, const taylor::ScaledPolynomial& polynomial) const {
  const bool at_zero = event_state[index].at_zero || polynomial.begins_at_zero();
  return at_zero ? polynomial.direction() : sign(polynomial.p[0]);
}

TaylorStepper::Impl::Crossing TaylorStepper::Impl::first_crossing(double h) const {
  Crossing first_of_all;
  const auto is_later = [&](double x) { return x > first_of_all.x * (1 + 4 * std::numeric_limits<double>::epsilon()); };
  for (std::size_t i = 0; i < switch_state.size(); ++i) {
    const auto x = taylor::crossing(taylor::switch_polynomial(work, i, h), switch_state[i]);
    if (!x || is_later(*x)) continue;
    note(first_of_all, *x);
    first_of_all.switches.push_back(i);
  }
  for (std::size_t i = 0; i < event_state.size(); ++i) {
    const auto polynomial = taylor::event_polynomial(work, i, h);
    const std::int8_t before = event_state[i].side, now = event_side(i, polynomial);
    // A step may have ended just past a root, within rounding: then the root is here.
    const bool passed = before != 0 && now == -before;
    const auto x = passed ? std::optional(0.0) : taylor::crossing(polynomial, {now, event_state[i].at_zero});
    if (!x || is_later(*x)) continue;
    note(first_of_all, *x);
    if (!first_of_all.event) first_of_all.event = i;
  }
  return first_of_all;
}

void TaylorStepper::Impl::mark_crossings(const Crossing& crossing, Step& result) {
  for (Watched& s : switch_state) s.at_zero = false;
  for (const std::size_t i : crossing.switches) {
    switch_state[i].at_zero = true;
    switch_state[i].side = static_cast<std::int8_t>(-switch_state[i].side);
  }
  switches += crossing.switches.size();
  result.switches = static_cast<int>(crossing.switches.size());
  result.event = crossing.event;
}

void TaylorStepper::Impl::advance(double bound, double h, const Crossing& crossing, Step& result) {
  const bool reaches_bound = !crossing.found && h == remaining(bound);
  // The signs that the events have at the beginning; a root in the step leaves them at zero.
  for (std::size_t i = 0; i < event_state.size(); ++i) {
    const auto polynomial = taylor::event_polynomial(work, i, h);
    event_state[i].side = event_side(i, polynomial);
    event_state[i].at_zero = crossing.event == i;
    if (event_state[i].at_zero) event_state[i].side = 0;
  }
  const double tau = h * crossing.x;
  dense.advance(tau, q, v, integrals);
  if (reaches_bound) t = {bound, 0};
  else t.add(tau);
  for (std::size_t i = 0; i < n; ++i) q_now[i] = q[i].hi, v_now[i] = v[i].hi;
  stuck = crossing.found && t.hi == begin.hi ? stuck + 1 : 0;
  mark_crossings(crossing, result);
  result.end = t.hi;
  first = false;
  ++steps;
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
  if (!std::exchange(expanded, false) && !expand(bound, result)) return result;
  double chosen = restraint * taylor::step_size(work, n, control, length);
  if (const std::size_t m = kernel.constraints(); m > 0)
    chosen = taylor::step_within_multipliers(work, n, m, control, std::min(chosen, std::abs(remaining(bound))));
  length = std::isfinite(chosen) ? chosen : 0;
  if (kernel.constraints() > 0 && forces_diverge()) {
    end(result, StepEnding::SingularConstraints, "The constraints are singular near here: the forces that they ask for grow without bound.");
    return result;
  }
  const double left = remaining(bound);
  const double h = chosen < std::abs(left) ? std::copysign(chosen, left) : left;
  if (!(chosen > 2 * std::numeric_limits<double>::epsilon() * std::abs(t.hi)) || chosen < 1e-290) {
    end(result, StepEnding::StepUnderflow,
        "The steps shrink below the resolution of time: a force grows without bound, as in a collision.");
    return result;
  }
  keep_polynomial();
  start_is_recorded = false;
  if (!expands_once()) record_start();
  const Crossing crossing = first_crossing(h);
  if (crossing.found && stuck >= 100) {
    end(result, StepEnding::Sliding, "Switches follow each other in no time: the motion has come to slide along a switch.");
    return result;
  }
  advance(bound, h, crossing, result);
  if (kernel.constraints() > 0 && switch_state.empty() && event_state.empty()) land(result, h);
  return result;
}

Sample TaylorStepper::Impl::sample(double time) const {
  std::vector<Compensated> position(n), velocity(n), integral(integrals.size());
  dense.advance(tau_of(time), position, velocity, integral);
  Sample result;
  result.t = time;
  for (std::size_t i = 0; i < n; ++i) {
    result.q.push_back(position[i].hi);
    result.v.push_back(velocity[i].hi);
  }
  for (const Compensated& x : integral) result.integrals.push_back(x.hi);
  const bool ok = probe.evaluate(time, result.q, result.v) == KernelStatus::Ok;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < n; ++i) result.a.push_back(ok ? probe.acceleration(i) : nothing);
  result.multipliers.assign(kernel.constraints(), nothing);
  if (ok) multipliers_of(probe, result.multipliers);
  for (std::size_t i = 0; i < kernel.observables(); ++i)
    result.observables.push_back(ok ? probe.observable(i) : nothing);
  return result;
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
  for (std::size_t i = 0; i < s.n; ++i) {
    s.q[i] = {q[i], 0};
    s.v[i] = {v[i], 0};
    s.q_now[i] = q[i];
    s.v_now[i] = v[i];
  }
  std::fill(s.integrals.begin(), s.integrals.end(), Compensated{});
  std::fill(s.switch_state.begin(), s.switch_state.end(), Watched{});
  std::fill(s.event_state.begin(), s.event_state.end(), Watched{});
  s.first = true;
  s.expanded = false;
  s.length = 0;
  s.restraint = 1;
  s.best_pivot_ratio = 0;
  s.longest = 0;
  s.largest_row.clear();
  s.most_in_force = 0;
  s.steps = s.switches = 0;
  s.constraint_residual = 0;
  s.stuck = 0;
  // Before any step the dense output is the starting point.
  s.dense.resize(s.n, s.kernel.integrands(), s.control.order + 1);
  s.begin = s.t;
  s.dense.q = s.q;
  s.dense.v = s.v;
  s.choose_first_sides();
  s.start_sample = s.sample(t);
  s.start_is_recorded = true;
}

Step TaylorStepper::step(double bound) { return impl_->step(bound); }

double TaylorStepper::time() const { return impl_->t.hi; }
std::span<const double> TaylorStepper::q() const { return impl_->q_now; }
std::span<const double> TaylorStepper::v() const { return impl_->v_now; }
std::size_t TaylorStepper::steps() const { return impl_->steps; }
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

void TaylorStepper::state(double t, std::span<double> q, std::span<double> v) const {
  MAUP_REQUIRE(covers(t));
  const Impl& s = *impl_;
  std::vector<Compensated> position(s.n), velocity(s.n), integral(s.integrals.size());
  s.dense.advance(s.tau_of(t), position, velocity, integral);
  for (std::size_t i = 0; i < s.n; ++i) q[i] = position[i].hi, v[i] = velocity[i].hi;
}

double TaylorStepper::constraint_residual() const { return impl_->constraint_residual; }
const Sample& TaylorStepper::step_start() const {
  if (!impl_->start_is_recorded) impl_->record_start();
  return impl_->start_sample;
}

}  // namespace maupertuis

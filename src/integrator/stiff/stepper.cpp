#include "integrator/point/event_search.hpp"
#include "integrator/point/sample.hpp"
#include "integrator/stiff/force_check.hpp"
#include "integrator/stiff/radau_method.hpp"
#include "integrator/stiff/reason.hpp"

#include <maupertuis/require.hpp>
#include <maupertuis/stiff.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace maupertuis {

/// States are q [n], v [n], integrals [w].
struct StiffStepper::Impl {
  Impl(const MotionFunctions& functions, std::span<const double> parameters, const StiffOptions& options)
      : n(functions.freedoms),
        motion(functions, parameters, options),
        observables(functions.observables),
        method(motion),
        check(motion),
        events(functions, parameters),
        now(motion.states()) {
    observables.set_parameters(parameters);
  }

  void start(double time, std::span<const double> q, std::span<const double> v);
  void restart();
  Step step(double bound);
  Step failed(stiff::Failure failure) {
    motion.solve(t, now);
    auto [ending, reason] = stiff::reason_of(failure, motion.status, t);
    return ended(ending, std::move(reason));
  }
  std::optional<Step> advance(double bound, std::vector<double>& next, stiff::Advance& reached);
  std::optional<Step> end_at_root(std::vector<double>& next, stiff::Advance& reached, Step& result);
  void drift(double h, std::vector<double>& next, stiff::Advance& reached);
  void begin_anew(double bound, std::vector<double>& next);
  void bound_steps(double length);
  bool stands_still(double bound);
  bool jumps_within(double h);
  bool fast_parts_die_out(double length);
  Step ended(StepEnding ending, std::string reason) const { return {t, t, ending, std::move(reason), {}, 0, {}, {}}; }
  Sample sample(double time) const;
  void state_at(double time, std::span<double> out) const;

  std::size_t n;
  mutable stiff::Motion motion;
  mutable FunctionWorkspace observables;
  stiff::RadauMethod method;
  stiff::ForceCheck check;
  EventSearch events;

  double t = 0, t_before = 0;
  std::vector<double> now, before;  // the states at the ends of the last step
  bool history = false;             // the method holds the polynomials of the last step
  bool history_ends = false;        // … but does not go on from its end
  double direction = 0;
  double t_window = 0;              // a thousand steps ago, at
  std::size_t attempts_window = 0;  // so many steps and rejections
  std::size_t steps = 0, rejected = 0;
  double longest = 0;   // of the next step, while the one before was taken back; 0: no limit
  double residual = 0;  // of the constraints, the largest so far
  mutable Sample start_sample;
};

void StiffStepper::Impl::start(double time, std::span<const double> q, std::span<const double> v) {
  t = t_before = t_window = time;
  std::fill(now.begin(), now.end(), 0.0);
  std::copy(v.begin(), v.end(), std::copy(q.begin(), q.end(), now.begin()));
  before = now;
  steps = rejected = attempts_window = 0;
  residual = 0;
  bound_steps(0);
  motion.at_point.forget_rows();
  motion.solve(t, now);
  motion.take_sizes(now);
  restart();
}

/// Begins a new history at the present state.
void StiffStepper::Impl::restart() {
  motion.solve(t, now);
  method.restart(t, now);
  history = history_ends = false;
  direction = 0;
}

Step StiffStepper::Impl::step(double bound) {
  const StiffOptions& options = motion.options;
  if (options.interrupt && *options.interrupt) return ended(StepEnding::Interrupted, "the run was interrupted");
  if (steps >= options.maximum_steps)
    return ended(StepEnding::TooManySteps, fmt::format("the run reached its limit of {} steps", options.maximum_steps));

  const double towards = bound < t ? -1 : 1;
  if (direction * towards < 0 || history_ends) restart();
  if (!history && motion.status != PointStatus::Ok) return failed(stiff::Failure::Value);
  direction = towards;
  Step result;
  result.begin = t;
  // Nothing happens between two neighbouring numbers.
  const bool close =
      std::abs(bound - t) <= 4 * std::numeric_limits<double>::epsilon() * (std::abs(t) + std::abs(bound));
  stiff::Advance reached;
  std::vector<double> next = now;
  if (close)
    reached.reached = bound, reached.history_ends = true;
  else if (const auto end = advance(bound, next, reached))
    return *end;
  const bool drifted = reached.drifted;
  if (!close && !drifted && !events.empty())
    if (const auto end = end_at_root(next, reached, result)) return *end;
  t_before = t;
  before.swap(now);
  now.swap(next);
  result.end = t = reached.reached;
  history = !close && !drifted;
  history_ends = reached.history_ends || result.event;
  ++steps;
  if (motion.functions.constraints > 0 && motion.solve(t, now))
    residual = std::max(residual, motion.at_point.constraint_residual(t - t_before));
  if (stands_still(bound)) {
    result.ending = StepEnding::StepUnderflow;
    result.reason = fmt::format(
        "time stands still at t = {} s, so short have the steps become: a collision, an infinite force, or a "
        "switch with forces that push back to it from both sides, as dry friction at rest does",
        t);
  }
  return result;
}

/// One step of the method in which no force acted unseen: others are taken back, and begun anew at a quarter of their
/// length. A step that was accepted allows the next one twice its limit.
std::optional<Step> StiffStepper::Impl::advance(double bound, std::vector<double>& next, stiff::Advance& reached) {
  while (true) {
    reached = method.advance(bound, next);
    if (reached.failure && history) {  // other rows of the constraints, or less noise of an old history, may help
      motion.at_point.forget_rows();
      begin_anew(bound, next);
      if (motion.status == PointStatus::Ok) reached = method.advance(bound, next);
    }
    const double resolution = 16 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t), std::abs(bound));
    if (reached.failure == stiff::Failure::ErrorTest && jumps_within(resolution)) {
      begin_anew(bound, next);
      drift(std::copysign(std::min(2 * resolution, std::abs(bound - t)), bound - t), next, reached);
      return std::nullopt;
    }
    if (reached.failure) return failed(*reached.failure);
    if (check.sees_all(method, t, reached.reached, next)) break;
    ++rejected;
    const double length = 0.25 * std::abs(reached.reached - t);
    begin_anew(bound, next);
    if (length <= resolution) {
      drift(std::copysign(std::min(resolution, std::abs(bound - t)), bound - t), next, reached);
      return std::nullopt;
    }
    bound_steps(length);
  }
  if (longest > 0) bound_steps(2 * longest < std::abs(bound - reached.reached) ? 2 * longest : 0);
  return std::nullopt;
}

/// Shortens the step that was accepted so that it ends at the first root of an event function.
std::optional<Step> StiffStepper::Impl::end_at_root(std::vector<double>& next, stiff::Advance& reached, Step& result) {
  const double end = reached.reached;
  std::vector<double> y;
  const auto find_state = [&](double time) {
    y = time == end ? next : now;
    if (time == t || time == end) return;
    method.interpolate(time, y);
    motion.project(time, y);
  };
  const auto found = events.first(t, end, [&](double time) {
    find_state(time);
    motion.solve(time, y);
    return motion.at_point.point();
  });
  if (found.outcome != EventSearch::Outcome::Seen)
    return ended(StepEnding::NoConvergence, reason_of(found.outcome, t, end));
  if (!found.root) return std::nullopt;
  result.event = found.root->event;
  reached.reached = found.root->t;
  find_state(reached.reached);
  next = y;
  return std::nullopt;
}

/// Over a jump of the forces, which lies within the resolution of time: what it gives there is rounding. Where one
/// follows another without end, time stands still.
void StiffStepper::Impl::drift(double h, std::vector<double>& next, stiff::Advance& reached) {
  for (std::size_t i = 0; i < n; ++i) next[i] += h * now[n + i];
  reached = {};
  reached.reached = t + h;
  reached.history_ends = reached.drifted = true;
}

void StiffStepper::Impl::begin_anew(double bound, std::vector<double>& next) {
  restart();
  direction = bound < t ? -1 : 1;
  next = now;
}

void StiffStepper::Impl::bound_steps(double length) {
  longest = length;
  method.limit(length);
}

/// Five thousand steps, those taken back counted, that make less than a billionth of the way: the rest would take
/// longer than anyone waits. The jump of a relaxation oscillation, a trillionth of its period, takes some two thousand.
bool StiffStepper::Impl::stands_still(double bound) {
  constexpr std::size_t window = 5000;
  if (steps + rejected < attempts_window + window) return false;
  attempts_window = steps + rejected;
  const double advanced = std::abs(t - t_window);
  t_window = t;
  return advanced < 1e-9 * std::max(std::abs(t), std::abs(bound - t));
}

/// Whether forces jump within the resolution of time here: on either side they have settled, beside what they differ by
/// across. Towards an infinite force they do not settle.
bool StiffStepper::Impl::jumps_within(double h) {
  constexpr double settled = 1e-3;
  std::vector<std::vector<double>> a;  // at t − 2h, t − h, t + h, t + 2h
  std::vector<double> there = now;
  for (const double by : {-2 * h, -h, h, 2 * h}) {
    for (std::size_t i = 0; i < n; ++i) there[i] = now[i] + by * now[n + i];
    if (!motion.solve(t + by, there)) return false;
    a.emplace_back(motion.at_point.a().begin(), motion.at_point.a().end());
  }
  const auto difference = [&](std::size_t i, std::size_t j) {
    double out = 0;
    for (std::size_t k = 0; k < n; ++k) out = std::max(out, std::abs(a[i][k] - a[j][k]));
    return out;
  };
  const double across = difference(1, 2);
  return across > 0 && std::max(difference(0, 1), difference(2, 3)) <= settled * across;
}

/// At the point of the last solve.
bool StiffStepper::Impl::fast_parts_die_out(double length) {
  constexpr double fast = 0.5, inclination = 0.34;  // of |λ| length; cos 70°
  Eigen::MatrixXd by_q, by_v;
  motion.at_point.derivatives(by_q, by_v);
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  rates.topRightCorner(size, size).setIdentity();
  rates.bottomRows(size) << by_q, by_v;
  if (!rates.allFinite()) return false;
  bool some = false;
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(rates, false).eigenvalues();
  for (const std::complex<double>& z : values) {
    if (std::abs(z) * length <= fast) continue;
    if (z.real() > -inclination * std::abs(z)) return false;
    some = true;
  }
  return some;
}

/// The state at a time of the last step, on the constraints.
void StiffStepper::Impl::state_at(double time, std::span<double> out) const {
  if (time == t || !history) {
    std::copy(now.begin(), now.end(), out.begin());
  } else if (time == t_before) {
    std::copy(before.begin(), before.end(), out.begin());
  } else {
    method.interpolate(time, out);
    motion.project(time, out);
  }
}

Sample StiffStepper::Impl::sample(double time) const {
  std::vector<double> y(now.size());
  state_at(time, y);
  Sample out;
  out.t = time;
  out.q.assign(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n));
  out.v.assign(y.begin() + static_cast<std::ptrdiff_t>(n), y.begin() + static_cast<std::ptrdiff_t>(2 * n));
  out.integrals.assign(y.begin() + static_cast<std::ptrdiff_t>(2 * n), y.end());
  fill_sample(motion.at_point, observables, motion.functions.observables.outputs(), out);
  return out;
}

StiffStepper::StiffStepper(const MotionFunctions& functions, std::span<const double> parameters,
                           const StiffOptions& options)
    : impl_((MAUP_REQUIRE(options.tolerance > 0), std::make_unique<Impl>(functions, parameters, options))) {}
StiffStepper::~StiffStepper() = default;
StiffStepper::StiffStepper(StiffStepper&&) noexcept = default;

void StiffStepper::start(double t, std::span<const double> q, std::span<const double> v) { impl_->start(t, q, v); }
bool StiffStepper::fast_parts_die_out(double t, std::span<const double> q, std::span<const double> v, double length) {
  std::vector<double> y(q.begin(), q.end());
  y.insert(y.end(), v.begin(), v.end());
  return impl_->motion.solve(t, y) && impl_->fast_parts_die_out(length);
}
Step StiffStepper::step(double bound) { return impl_->step(bound); }
int StiffStepper::order() const { return impl_->method.order(); }
double StiffStepper::time() const { return impl_->t; }
std::span<const double> StiffStepper::q() const { return impl_->motion.q_of(impl_->now); }
std::span<const double> StiffStepper::v() const { return impl_->motion.v_of(impl_->now); }
std::size_t StiffStepper::steps() const { return impl_->steps; }
std::size_t StiffStepper::rejected() const { return impl_->rejected; }

double StiffStepper::constraint_residual() const { return impl_->residual; }

bool StiffStepper::covers(double t) const {
  const auto [low, high] = std::minmax(impl_->t_before, impl_->t);
  return low <= t && t <= high;
}

Sample StiffStepper::sample(double t) const {
  MAUP_REQUIRE(covers(t));
  return impl_->sample(t);
}

void StiffStepper::state(double t, std::span<double> q, std::span<double> v) const {
  MAUP_REQUIRE(covers(t));
  std::vector<double> y(impl_->now.size());
  impl_->state_at(t, y);
  std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(impl_->n), q.begin());
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(impl_->n), y.begin() + static_cast<std::ptrdiff_t>(2 * impl_->n),
            v.begin());
}

const Sample& StiffStepper::step_start() const { return impl_->start_sample = impl_->sample(impl_->t_before); }

}  // namespace maupertuis

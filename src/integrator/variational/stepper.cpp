#include "integrator/point/event_search.hpp"
#include "integrator/point/sample.hpp"
#include "integrator/variational/force_check.hpp"
#include "integrator/variational/stages.hpp"

#include <maupertuis/require.hpp>
#include <maupertuis/variational.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {

using variational::Phase;
using variational::StageSolver;
using variational::StageStatus;

namespace {

variational::Tableau tableau_for(int order, bool constrained) {
  const auto half = static_cast<std::size_t>((order + 1) / 2);
  return constrained ? variational::lobatto(half + 1) : variational::gauss(half);
}

}  // namespace

struct VariationalStepper::Impl {
  Impl(const VariationalFunctions& f, std::span<const double> parameters, const VariationalOptions& o)
      : functions(f.motion),
        options(o),
        n(f.motion.freedoms),
        at_point(f.motion, parameters),
        solver(f, parameters, tableau_for(o.order, f.motion.constraints > 0)),
        partial(solver),
        check(f, parameters),
        observables(f.motion.observables),
        integrands(f.motion.integrands),
        events(f.motion, parameters) {
    for (FunctionWorkspace* work : {&observables, &integrands}) work->set_parameters(parameters);
    integrals.resize(functions.integrands.outputs());
  }

  void start(double t, std::span<const double> q, std::span<const double> v);
  Step step(double bound);
  EventSearch::Result first_root();
  void end_at(double t);
  Step taken_back(std::string reason);
  StageStatus part_of_step(double t, Phase& end) const;
  void add_integrals(StageSolver& stages, double h, std::vector<Compensated>& sums) const;
  Sample sample(double t) const;
  Sample sample_at(const Phase& phase, const std::vector<Compensated>& sums) const;
  Step ended(StepEnding ending, std::string reason) const {
    return {now.t, now.t, ending, std::move(reason), {}, {}, {}, {}};
  }

  MotionFunctions functions;
  VariationalOptions options;
  std::size_t n;
  mutable PointSolver at_point;
  StageSolver solver;
  mutable StageSolver partial;  // shorter steps within the last one
  variational::ForceCheck check;
  mutable FunctionWorkspace observables, integrands;
  EventSearch events;

  Phase before, now;  // the ends of the last step
  std::vector<double> q_now, p_now;
  std::vector<Compensated> integrals, integrals_before;
  double t_start = 0, h = 0;  // of the run; the last step
  std::size_t steps = 0, counted = 0;
  double residual = 0;  // of the constraints, the largest so far
  PointStatus first_status = PointStatus::Ok;
  bool first = true;  // the last step does not tell where the next one begins to iterate
  mutable Sample start_sample;
};

namespace {

std::vector<double> leading(const std::vector<Compensated>& values) {
  std::vector<double> out;
  for (const Compensated& value : values) out.push_back(value.hi);
  return out;
}

std::string reason_of(StageStatus status, double t, double h) {
  switch (status) {
    case StageStatus::Singular:
      return fmt::format(
          "the discrete equations of motion have no unique solution after t = {} s: the mass matrix is "
          "singular there on the motions that the constraints allow",
          t);
    case StageStatus::NonFinite:
      return fmt::format("a value is infinite or undefined on the step from t = {} s to {} s", t, t + h);
    case StageStatus::NoConvergence:
      return fmt::format(
          "Newton's iteration does not solve the discrete equations of motion on the step from t = {} s to "
          "{} s: the step is too long there, a switch lies in it, or no motion obeys the constraints",
          t, t + h);
    case StageStatus::Ok:
      break;
  }
  return {};
}

StepEnding ending_of(StageStatus status) {
  return status == StageStatus::Singular    ? StepEnding::SingularMass
         : status == StageStatus::NonFinite ? StepEnding::Overflow
                                            : StepEnding::NoConvergence;
}

}  // namespace

void VariationalStepper::Impl::start(double t, std::span<const double> q, std::span<const double> v) {
  now = {};
  now.t = t_start = t;
  now.q.resize(n), now.p.resize(n);
  for (std::size_t i = 0; i < n; ++i) now.q[i].hi = q[i];
  now.v.assign(v.begin(), v.end());
  std::vector<double> p(n);
  solver.momenta(t, q, v, p);
  for (std::size_t i = 0; i < n; ++i) now.p[i].hi = p[i];
  q_now.assign(q.begin(), q.end()), p_now = p;
  before = now;
  integrals.assign(integrals.size(), {});
  integrals_before = integrals;
  steps = counted = 0;
  residual = 0;
  h = 0;
  first = true;
  at_point.forget_rows();
  first_status = at_point.solve(t, q, v);
  if (first_status == PointStatus::Ok) {
    const Eigen::VectorXd mobility = at_point.mobility().diagonal();
    std::vector<double> inertia(n);
    for (std::size_t i = 0; i < n; ++i)
      inertia[i] = mobility[static_cast<Eigen::Index>(i)] > 0 ? 1 / mobility[static_cast<Eigen::Index>(i)] : 0;
    check.start(inertia);
  }
  solver.set_rows(at_point.rows());
  partial.set_rows(at_point.rows());
}

Step VariationalStepper::Impl::step(double bound) {
  if (options.interrupt && *options.interrupt) return ended(StepEnding::Interrupted, "the run was interrupted");
  if (steps >= options.maximum_steps)
    return ended(StepEnding::TooManySteps, fmt::format("the run reached its limit of {} steps", options.maximum_steps));
  if (first_status == PointStatus::Singular)
    return ended(StepEnding::SingularMass, reason_of(StageStatus::Singular, now.t, 0));
  if (first_status == PointStatus::NonFinite)
    return ended(StepEnding::Overflow, reason_of(StageStatus::NonFinite, now.t, 0));

  // Times are counted from the start, so that their rounding does not add up.
  const double direction = bound < now.t ? -1 : 1, length = direction * options.step;
  if (h * direction < 0) t_start = now.t, counted = 0;
  double end_time = t_start + length * static_cast<double>(counted + 1);
  if ((bound - end_time) * direction <= 1e-9 * options.step) end_time = bound;
  const double next = end_time - now.t;
  // A step of the common length is exactly of that length: the same map from step to step.
  const double this_h = std::abs(next - length) <= 1e-9 * options.step ? length : next;

  if (first)
    solver.guess(this_h, now.v, at_point.a(), at_point.lambda());
  else
    solver.extrapolate(solver, 1, this_h / h);
  Phase end;
  const StageStatus status = solver.solve(now, this_h, end_time, end);
  if (status != StageStatus::Ok) return ended(ending_of(status), reason_of(status, now.t, this_h));
  const variational::Sight sight = check.look(solver, now.t, this_h, leading(end.p));
  if (sight == variational::Sight::NonFinite)
    return ended(StepEnding::Overflow, reason_of(StageStatus::NonFinite, now.t, this_h));
  if (sight == variational::Sight::NotAll)
    return ended(StepEnding::NoConvergence, fmt::format("a force acts between the nodes of the step from t = {} s "
                                                        "to {} s that they do not see: the step is too "
                                                        "long there",
                                                        now.t, now.t + this_h));

  before = std::move(now);
  now = std::move(end);
  h = this_h;
  first = false;
  integrals_before = integrals;
  ++steps, ++counted;
  Step result;
  result.begin = before.t;
  if (!events.empty()) {
    const EventSearch::Result found = first_root();
    if (found.outcome != EventSearch::Outcome::Seen) return taken_back(reason_of(found.outcome, before.t, now.t));
    if (found.root) {
      result.event = found.root->event;
      end_at(found.root->t);
    }
  }
  add_integrals(solver, h, integrals);
  result.end = now.t;
  q_now = leading(now.q), p_now = leading(now.p);
  if (functions.constraints > 0 && at_point.solve(now.t, q_now, now.v) == PointStatus::Ok)
    residual = std::max(residual, at_point.constraint_residual(h));
  return result;
}

/// The same step again, but only to the time t; `partial` keeps its stages.
StageStatus VariationalStepper::Impl::part_of_step(double t, Phase& end) const {
  partial.extrapolate(solver, 0, (t - before.t) / h);
  return partial.solve(before, t - before.t, t, end);
}

/// The first root of an event function in the step.
EventSearch::Result VariationalStepper::Impl::first_root() {
  return events.first(before.t, now.t, [&](double t) {
    Phase phase = t == now.t ? now : before;
    if (t != before.t && t != now.t) part_of_step(t, phase);
    at_point.solve(t, leading(phase.q), phase.v);
    return at_point.point();
  });
}

/// Shortens the last step so that it ends at t; the next one begins a new count.
void VariationalStepper::Impl::end_at(double t) {
  Phase phase;
  if (t != now.t && part_of_step(t, phase) == StageStatus::Ok) {
    now = std::move(phase);
    h = t - before.t;
    solver = partial;
  }
  t_start = now.t, counted = 0;
}

/// The last step, which cannot be searched for events, is none.
Step VariationalStepper::Impl::taken_back(std::string reason) {
  now = before;
  --steps, --counted;
  return ended(StepEnding::NoConvergence, std::move(reason));
}

void VariationalStepper::Impl::add_integrals(StageSolver& stages, double length, std::vector<Compensated>& sums) const {
  if (sums.empty()) return;
  std::vector<double> values(sums.size());
  const variational::Tableau& tableau = stages.tableau();
  for (std::size_t j = 0; j < tableau.stages; ++j) {
    integrands.evaluate(stages.node_point(j), values);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i].add(static_cast<double>(length * tableau.b[j] * values[i]));
  }
}

Sample VariationalStepper::Impl::sample_at(const Phase& phase, const std::vector<Compensated>& sums) const {
  Sample out;
  out.t = phase.t, out.q = leading(phase.q), out.v = phase.v, out.integrals = leading(sums);
  fill_sample(at_point, observables, functions.observables.outputs(), out);
  return out;
}

Sample VariationalStepper::Impl::sample(double t) const {
  if (t == now.t) return sample_at(now, integrals);
  if (t == before.t) return sample_at(before, integrals_before);
  Phase phase;
  std::vector<Compensated> sums = integrals_before;
  if (part_of_step(t, phase) == StageStatus::Ok) {
    add_integrals(partial, t - before.t, sums);
    return sample_at(phase, sums);
  }
  // A shorter step than one that was solved should always be solvable; the polynomials are what there is otherwise.
  phase = before;
  phase.t = t;
  for (std::size_t i = 0; i < n; ++i) {
    phase.q[i] = {solver.position_at((t - before.t) / h, i), 0};
    phase.v[i] = solver.velocity_at((t - before.t) / h, i);
  }
  return sample_at(phase, sums);
}

VariationalStepper::VariationalStepper(const VariationalFunctions& functions, std::span<const double> parameters,
                                       const VariationalOptions& options)
    : impl_((MAUP_REQUIRE(options.step > 0 && options.order >= 2 && options.order <= 12),
             MAUP_REQUIRE(functions.motion.holonomic && "constraints between velocities have no variational step"),
             std::make_unique<Impl>(functions, parameters, options))) {}
VariationalStepper::~VariationalStepper() = default;
VariationalStepper::VariationalStepper(VariationalStepper&&) noexcept = default;

int VariationalStepper::order() const { return 2 * ((impl_->options.order + 1) / 2); }
void VariationalStepper::start(double t, std::span<const double> q, std::span<const double> v) {
  impl_->start(t, q, v);
}
Step VariationalStepper::step(double bound) { return impl_->step(bound); }
double VariationalStepper::time() const { return impl_->now.t; }
std::span<const double> VariationalStepper::q() const { return impl_->q_now; }
std::span<const double> VariationalStepper::v() const { return impl_->now.v; }
std::span<const double> VariationalStepper::p() const { return impl_->p_now; }
std::size_t VariationalStepper::steps() const { return impl_->steps; }

double VariationalStepper::constraint_residual() const { return impl_->residual; }

bool VariationalStepper::covers(double t) const {
  const auto [low, high] = std::minmax(impl_->before.t, impl_->now.t);
  return low <= t && t <= high;
}

Sample VariationalStepper::sample(double t) const {
  MAUP_REQUIRE(covers(t));
  return impl_->sample(t);
}

void VariationalStepper::state(double t, std::span<double> q, std::span<double> v) const {
  MAUP_REQUIRE(covers(t));
  const long double x = impl_->h == 0 ? 0 : (t - impl_->before.t) / impl_->h;
  for (std::size_t i = 0; i < impl_->n; ++i) {
    q[i] = impl_->h == 0 ? impl_->q_now[i] : impl_->solver.position_at(x, i);
    v[i] = impl_->h == 0 ? impl_->now.v[i] : impl_->solver.velocity_at(x, i);
  }
}

const Sample& VariationalStepper::step_start() const {
  return impl_->start_sample = impl_->sample_at(impl_->before, impl_->integrals_before);
}

}  // namespace maupertuis

#ifdef MAUPERTUIS_SUNDIALS
#include "integrator/point/sample.hpp"
#include "integrator/stiff/cvode_handles.hpp"
#include "integrator/stiff/reason.hpp"

#include <maupertuis/require.hpp>
#include <maupertuis/stiff.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {

bool has_stiff_method() { return true; }

/// The unknowns of CVODE are q [n], v [n], integrals [w].
struct StiffStepper::Impl {
  Impl(const MotionFunctions& f, std::span<const double> parameters, const StiffOptions& o)
      : functions(f), options(o), n(f.freedoms), at_point(f, parameters), observables(f.observables), events(f.events),
        integrands(f.integrands), cvode(2 * n + f.integrands.outputs()) {
    for (FunctionWorkspace* work : {&observables, &events, &integrands}) work->set_parameters(parameters);
    now.resize(2 * n + f.integrands.outputs());
    if (options.absolute == 0) options.absolute = 1e-4 * options.tolerance;
    set_up();
  }

  void set_up();
  void start(double time, std::span<const double> q, std::span<const double> v);
  void restart();
  Step step(double bound);
  Step failed(int flag) const {
    auto [ending, reason] = stiff::reason_of(flag, last_status, t);
    return ended(ending, std::move(reason));
  }
  bool stands_still(double bound);
  Step ended(StepEnding ending, std::string reason) const { return {t, t, ending, std::move(reason), {}, 0}; }
  Sample sample(double time) const;
  void state_at(double time, std::span<double> out) const;

  std::span<const double> q_of(std::span<const double> y) const { return y.first(n); }
  std::span<const double> v_of(std::span<const double> y) const { return y.subspan(n, n); }

  // Called by CVODE with `this` as user data; 0: done, 1: try a shorter step.
  static int rates(double t, N_Vector y, N_Vector rate, void* self);
  static int jacobian(double t, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector);
  static int weights(N_Vector y, N_Vector weight, void* self);
  static int project(double t, N_Vector y, N_Vector correction, double, N_Vector error, void* self);
  static int roots(double t, N_Vector y, double* out, void* self);

  MotionFunctions functions;
  StiffOptions options;
  std::size_t n;
  mutable PointSolver at_point;
  mutable FunctionWorkspace observables, events, integrands;
  stiff::CvodeHandles cvode;

  double t = 0, t_before = 0;
  std::vector<double> now, before;  // the unknowns at the ends of the last step
  std::vector<double> sizes;        // [2n] what errors of q and v are measured against
  PointStatus last_status = PointStatus::Ok;
  bool history = false;             // CVODE holds the polynomials of the last step
  bool after_event = false;         // the last step was cut: CVODE's history goes beyond its end
  double direction = 0;
  double t_window = 0;              // a thousand steps ago
  std::size_t steps = 0;
  double residual = 0;              // of the constraints, the largest so far
  Eigen::MatrixXd by_q, by_v;
  mutable Sample start_sample;
};

void StiffStepper::Impl::set_up() {
  using stiff::require_success;
  void* memory = cvode.memory;
  CVodeSetErrHandlerFn(memory, [](int, const char*, const char*, char*, void*) {}, nullptr);
  std::fill(stiff::values(cvode.state).begin(), stiff::values(cvode.state).end(), 0.0);
  require_success(CVodeInit(memory, rates, 0, cvode.state));
  require_success(CVodeSetUserData(memory, this));
  require_success(CVodeWFtolerances(memory, weights));
  require_success(CVodeSetLinearSolver(memory, cvode.solver, cvode.matrix));
  require_success(CVodeSetJacFn(memory, jacobian));
  require_success(CVodeSetMaxNumSteps(memory, -1));
  if (functions.constraints > 0) require_success(CVodeSetProjFn(memory, project));
  if (functions.events.outputs() > 0) {
    require_success(CVodeRootInit(memory, static_cast<int>(functions.events.outputs()), roots));
    require_success(CVodeSetNoInactiveRootWarn(memory));
  }
}

int StiffStepper::Impl::rates(double t, N_Vector y, N_Vector rate, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  const auto in = stiff::values(y), out = stiff::values(rate);
  impl.last_status = impl.at_point.solve(t, impl.q_of(in), impl.v_of(in));
  if (impl.last_status != PointStatus::Ok) return 1;
  std::copy(in.begin() + static_cast<std::ptrdiff_t>(impl.n), in.begin() + static_cast<std::ptrdiff_t>(2 * impl.n), out.begin());
  std::copy(impl.at_point.a().begin(), impl.at_point.a().end(), out.begin() + static_cast<std::ptrdiff_t>(impl.n));
  impl.integrands.evaluate(impl.at_point.point(), out.subspan(2 * impl.n));
  return 0;
}

int StiffStepper::Impl::jacobian(double t, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector) {
  Impl& impl = *static_cast<Impl*>(self);
  const auto in = stiff::values(y);
  impl.last_status = impl.at_point.solve(t, impl.q_of(in), impl.v_of(in));
  if (impl.last_status != PointStatus::Ok) return 1;
  impl.at_point.derivatives(impl.by_q, impl.by_v);
  const auto size = SUNDenseMatrix_Rows(matrix), n = static_cast<sunindextype>(impl.n);
  Eigen::Map<Eigen::MatrixXd> out(SUNDenseMatrix_Data(matrix), size, size);
  out.setZero();
  out.block(0, n, n, n).setIdentity();
  out.block(n, 0, n, n) = impl.by_q;
  out.block(n, n, n, n) = impl.by_v;
  return 0;
}

/// Each unknown is measured against its own size, which it keeps for a while when it passes through zero; integrals
/// have no part in the control of the error.
int StiffStepper::Impl::weights(N_Vector y, N_Vector weight, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  const auto in = stiff::values(y), out = stiff::values(weight);
  constexpr double memory = 0.9, none = 1e-30;
  std::fill(out.begin(), out.end(), none);
  for (std::size_t i = 0; i < 2 * impl.n; ++i) {
    impl.sizes[i] = std::max(memory * impl.sizes[i], std::abs(in[i]));
    out[i] = 1 / (impl.options.tolerance * impl.sizes[i] + impl.options.absolute);
    if (!std::isfinite(out[i])) return -1;
  }
  return 0;
}

int StiffStepper::Impl::project(double t, N_Vector y, N_Vector correction, double, N_Vector error, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  const auto in = stiff::values(y), out = stiff::values(correction);
  std::copy(in.begin(), in.end(), out.begin());
  if (!impl.at_point.project(t, out.first(impl.n), out.subspan(impl.n, impl.n))) return 1;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= in[i];
  if (error) impl.at_point.make_tangent(stiff::values(error).first(impl.n), stiff::values(error).subspan(impl.n, impl.n));
  return 0;
}

int StiffStepper::Impl::roots(double t, N_Vector y, double* out, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  const auto in = stiff::values(y);
  if (impl.at_point.solve(t, impl.q_of(in), impl.v_of(in)) != PointStatus::Ok) return -1;
  impl.events.evaluate(impl.at_point.point(), {out, impl.functions.events.outputs()});
  return 0;
}

void StiffStepper::Impl::start(double time, std::span<const double> q, std::span<const double> v) {
  t = t_before = t_window = time;
  std::fill(now.begin(), now.end(), 0.0);
  std::copy(q.begin(), q.end(), now.begin());
  std::copy(v.begin(), v.end(), now.begin() + static_cast<std::ptrdiff_t>(n));
  before = now;
  steps = 0;
  residual = 0;
  sizes.assign(2 * n, 0);
  at_point.forget_rows();
  last_status = at_point.solve(t, q, v);
  restart();
}

/// Begins a new history at the present state.
void StiffStepper::Impl::restart() {
  std::copy(now.begin(), now.end(), stiff::values(cvode.state).begin());
  stiff::require_success(CVodeReInit(cvode.memory, t, cvode.state));
  history = after_event = false;
  direction = 0;
}

Step StiffStepper::Impl::step(double bound) {
  if (options.interrupt && *options.interrupt) return ended(StepEnding::Interrupted, "the run was interrupted");
  if (steps >= options.maximum_steps)
    return ended(StepEnding::TooManySteps, fmt::format("the run reached its limit of {} steps", options.maximum_steps));
  if (steps == 0 && last_status != PointStatus::Ok) return failed(CV_FIRST_RHSFUNC_ERR);

  const double towards = bound < t ? -1 : 1;
  if (direction * towards < 0 || after_event) restart();
  direction = towards;
  stiff::require_success(CVodeSetStopTime(cvode.memory, bound));
  double reached = t;
  const int flag = CVode(cvode.memory, bound, cvode.state, &reached, CV_ONE_STEP);
  if (flag < 0 && flag != CV_TOO_CLOSE) return failed(flag);

  Step result;
  result.begin = t_before = t;
  before = now;
  ++steps;
  if (flag == CV_TOO_CLOSE) {  // nothing happens between two neighbouring numbers
    result.end = t = bound;
    history = false;
    return result;
  }
  history = true;
  const auto state = stiff::values(cvode.state);
  std::copy(state.begin(), state.end(), now.begin());
  result.end = t = reached;
  if (flag == CV_ROOT_RETURN) {
    after_event = true;
    std::vector<int> found(functions.events.outputs());
    CVodeGetRootInfo(cvode.memory, found.data());
    result.event = static_cast<std::size_t>(std::find_if(found.begin(), found.end(), [](int f) { return f != 0; }) - found.begin());
    at_point.project(t, std::span(now).first(n), std::span(now).subspan(n, n));
  }
  if (functions.constraints > 0 && at_point.solve(t, q_of(now), v_of(now)) == PointStatus::Ok)
    residual = std::max(residual, at_point.constraint_residual(t - t_before));
  if (stands_still(bound)) {
    result.ending = StepEnding::StepUnderflow;
    result.reason = fmt::format("time stands still at t = {:.17g} s, so short have the steps become: a collision, an infinite force, or a "
                                "switch with forces that push back to it from both sides, as dry friction at rest does", t);
  }
  return result;
}

/// A thousand steps that make less than a ten-billionth of the way: the rest would take longer than anyone waits.
bool StiffStepper::Impl::stands_still(double bound) {
  constexpr std::size_t window = 1000;
  if (steps % window != 0) return false;
  const double advanced = std::abs(t - t_window);
  t_window = t;
  return advanced < 1e-10 * std::max(std::abs(t), std::abs(bound - t));
}

/// q, v and the integrals at a time of the last step, projected.
void StiffStepper::Impl::state_at(double time, std::span<double> out) const {
  if (time == t || !history) {
    std::copy(now.begin(), now.end(), out.begin());
  } else if (time == t_before) {
    std::copy(before.begin(), before.end(), out.begin());
  } else {
    N_Vector y = N_VMake_Serial(static_cast<sunindextype>(out.size()), out.data(), cvode.context);
    const int flag = CVodeGetDky(cvode.memory, time, 0, y);
    N_VDestroy(y);
    stiff::require_success(flag);
    at_point.project(time, out.first(n), out.subspan(n, n));
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
  fill_sample(at_point, observables, functions.observables.outputs(), out);
  return out;
}

StiffStepper::StiffStepper(const MotionFunctions& functions, std::span<const double> parameters, const StiffOptions& options)
    : impl_((MAUP_REQUIRE(options.tolerance > 0), std::make_unique<Impl>(functions, parameters, options))) {}
StiffStepper::~StiffStepper() = default;
StiffStepper::StiffStepper(StiffStepper&&) noexcept = default;

void StiffStepper::start(double t, std::span<const double> q, std::span<const double> v) { impl_->start(t, q, v); }
Step StiffStepper::step(double bound) { return impl_->step(bound); }
double StiffStepper::time() const { return impl_->t; }
std::span<const double> StiffStepper::q() const { return impl_->q_of(impl_->now); }
std::span<const double> StiffStepper::v() const { return impl_->v_of(impl_->now); }
std::size_t StiffStepper::steps() const { return impl_->steps; }

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
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(impl_->n), y.begin() + static_cast<std::ptrdiff_t>(2 * impl_->n), v.begin());
}

const Sample& StiffStepper::step_start() const { return impl_->start_sample = impl_->sample(impl_->t_before); }

}  // namespace maupertuis
#endif

#ifdef MAUPERTUIS_SUNDIALS
#include "integrator/stiff/formula.hpp"
#include "integrator/stiff/index_two_system.hpp"
#include "integrator/stiff/sundials.hpp"

#include <fmt/format.h>
#include <idas/idas.h>
#include <idas/idas_ls.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::stiff {
namespace {

Failure failure_of_ida(int flag) {
  switch (flag) {
    case IDA_RES_FAIL:
    case IDA_REP_RES_ERR:
    case IDA_FIRST_RES_FAIL:
    case IDA_RTFUNC_FAIL:
    case IDA_QRHS_FAIL:
    case IDA_FIRST_QRHS_ERR:
    case IDA_REP_QRHS_ERR:
    case IDA_ILL_INPUT:
      return Failure::Value;
    case IDA_TOO_MUCH_ACC:
      return Failure::Accuracy;
    case IDA_ERR_FAIL:
      return Failure::ErrorTest;
    case IDA_CONV_FAIL:
    case IDA_LSETUP_FAIL:
    case IDA_LSOLVE_FAIL:
      return Failure::Convergence;
    default:
      throw std::logic_error(fmt::format("the stiff method failed with code {} of IDA; please report", flag));
  }
}

/// The integrals are quadratures of IDAS, evaluated once a step.
class IdaFormula final : public Formula {
 public:
  explicit IdaFormula(Motion& motion);
  ~IdaFormula() override { IDAFree(&memory_); }
  void restart(double t, std::span<const double> y) override;
  Advance advance(double bound, std::span<double> y) override;
  void interpolate(double t, std::span<double> y) const override;
  int order() const override;
  void limit(double longest) override { require_success(IDASetMaxStep(memory_, longest)); }

 private:
  // Called by IDA with `this` as user data; 0: done, 1: try a shorter step.
  static int residual(double t, N_Vector y, N_Vector rate, N_Vector out, void* self);
  static int jacobian(double t, double c, N_Vector y, N_Vector rate, N_Vector, SUNMatrix out, void* self, N_Vector,
                      N_Vector, N_Vector);
  static int weights(N_Vector y, N_Vector weight, void* self);
  static int integrands(double t, N_Vector y, N_Vector, N_Vector out, void* self);
  double guess_first_step();
  Advance settle(Advance out, std::span<double> y);
  std::size_t integrals() const { return motion_.functions.integrands.outputs(); }

  Motion& motion_;
  IndexTwoSystem system_;
  Context context_;
  Vector state_, rate_, differential_, integrals_, weight_;
  DenseSolver linear_;
  void* memory_;
  std::vector<std::size_t> rows_;  // of this history
  double t_start_ = 0;             // of this history
  double first_step_ = 0;          // its length; 0 when it is made
};

IdaFormula::IdaFormula(Motion& motion)
    : motion_(motion),
      system_(motion),
      state_(system_.size(), context_),
      rate_(system_.size(), context_),
      differential_(system_.size(), context_),
      integrals_(integrals(), context_),
      weight_(system_.size(), context_),
      linear_(state_, context_),
      memory_(require_memory(IDACreate(context_))) {
  IDASetErrHandlerFn(memory_, say_nothing, nullptr);
  require_success(IDAInit(memory_, residual, 0, state_, rate_));
  require_success(IDASetUserData(memory_, this));
  require_success(IDAWFtolerances(memory_, weights));
  require_success(IDASetLinearSolver(memory_, linear_.solver, linear_.matrix));
  require_success(IDASetJacFn(memory_, jacobian));
  require_success(IDASetMaxNumSteps(memory_, -1));
  const auto kinds = values(differential_).first(2 * motion.freedoms());
  std::fill(kinds.begin(), kinds.end(), 1.0);
  require_success(IDASetId(memory_, differential_));
  require_success(IDASetSuppressAlg(memory_, SUNTRUE));
  // What Newton's iteration leaves of the constraints returns as noise of v / step: a third of the tolerance, IDA's own
  // choice, doubles the number of steps.
  require_success(IDASetNonlinConvCoef(memory_, 0.03));
  require_success(IDASetMaxErrTestFails(memory_, 30));  // the first step is a guess
  require_success(IDASetMaxConvFails(memory_, 30));
  if (integrals() > 0) require_success(IDAQuadInit(memory_, integrands, integrals_));
}

int IdaFormula::residual(double t, N_Vector y, N_Vector rate, N_Vector out, void* self) {
  IdaFormula& formula = *static_cast<IdaFormula*>(self);
  const bool finite = formula.system_.residual(t, values(y), values(rate), values(out));
  formula.motion_.status = finite ? PointStatus::Ok : PointStatus::NonFinite;
  return finite ? 0 : 1;
}

int IdaFormula::jacobian(double t, double c, N_Vector y, N_Vector rate, N_Vector, SUNMatrix out, void* self, N_Vector,
                         N_Vector, N_Vector) {
  IdaFormula& formula = *static_cast<IdaFormula*>(self);
  const auto size = SUNDenseMatrix_Rows(out);
  Eigen::Map<Eigen::MatrixXd> matrix(SUNDenseMatrix_Data(out), size, size);
  return formula.system_.jacobian(t, c, values(y), values(rate), matrix) ? 0 : 1;
}

int IdaFormula::weights(N_Vector y, N_Vector weight, void* self) {
  return static_cast<IdaFormula*>(self)->motion_.weigh(values(y), values(weight)) ? 0 : -1;
}

int IdaFormula::integrands(double t, N_Vector y, N_Vector, N_Vector out, void* self) {
  Motion& motion = static_cast<IdaFormula*>(self)->motion_;
  if (!motion.solve(t, values(y))) return 1;
  motion.integrand_values(values(out));
  return 0;
}

/// λ and v̇ are those of the bordered system; μ = 0.
void IdaFormula::restart(double t, std::span<const double> y) {
  rows_ = motion_.at_point.rows();
  system_.set_rows(rows_);
  const std::size_t n = motion_.freedoms();
  const auto v = motion_.v_of(y), a = motion_.at_point.a(), lambda = motion_.at_point.lambda();
  N_VConst(0, state_);
  N_VConst(0, rate_);
  std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(2 * n), values(state_).begin());
  std::copy(lambda.begin(), lambda.end(), values(state_).subspan(2 * n).begin());
  std::copy(a.begin(), a.end(), std::copy(v.begin(), v.end(), values(rate_).begin()));
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(2 * n), y.end(), values(integrals_).begin());
  require_success(IDAReInit(memory_, t, state_, rate_));
  if (integrals() > 0) require_success(IDAQuadReInit(memory_, integrals_));
  t_start_ = t;
  first_step_ = guess_first_step();
}

/// A tenth of the time in which q bends away from its tangent by what a step may err. IDA's own guess looks at the
/// rates of the velocities too, and those of a system at rest make it start with steps that change nothing.
double IdaFormula::guess_first_step() {
  const auto weight = values(weight_), rate = values(rate_);
  motion_.weigh(values(state_), weight);
  const std::size_t n = motion_.freedoms();
  double bend = 0;
  for (std::size_t i = 0; i < n; ++i) bend = std::max(bend, weight[i] * std::abs(rate[n + i]));
  return 0.1 * std::sqrt(2 / bend);
}

Advance IdaFormula::advance(double bound, std::span<double> y) {
  Advance out;
  require_success(IDASetStopTime(memory_, bound));
  if (first_step_ > 0) {
    const double distance = bound - t_start_;
    require_success(IDASetInitStep(memory_, std::copysign(std::min(first_step_, 1e-3 * std::abs(distance)), distance)));
    first_step_ = 0;
  }
  const int flag = IDASolve(memory_, bound, &out.reached, state_, rate_, IDA_ONE_STEP);
  if (flag < 0) {
    out.failure = failure_of_ida(flag);
    return out;
  }
  return settle(out, y);
}

/// Projects what is given out. The history stays as it is: its constraints are solved in every step, so that it does
/// not drift, and the projection moves it by less than a step may err. Where it would move it by more, or onto other
/// rows of the constraints, the history ends.
Advance IdaFormula::settle(Advance out, std::span<double> y) {
  interpolate(out.reached, y);
  const std::vector<double> solved(y.begin(), y.end());
  if (!motion_.project(out.reached, y)) {
    out.failure = Failure::Constraints;
    return out;
  }
  const auto weight = values(weight_);
  require_success(IDAGetErrWeights(memory_, weight_));
  double move = 0;
  for (std::size_t i = 0; i < 2 * motion_.freedoms(); ++i)
    move = std::max(move, std::abs((y[i] - solved[i]) * weight[i]));
  out.history_ends = move > 1 || motion_.at_point.rows() != rows_;
  return out;
}

void IdaFormula::interpolate(double t, std::span<double> y) const {
  const std::size_t n = motion_.freedoms();
  const Vector state(system_.size(), context_);
  require_success(IDAGetDky(memory_, t, 0, state));
  std::copy_n(values(state).begin(), 2 * n, y.begin());
  if (integrals() > 0) require_success(IDAGetQuadDky(memory_, t, 0, Vector(y.subspan(2 * n), context_)));
}

int IdaFormula::order() const {
  int order = 0;
  require_success(IDAGetLastOrder(memory_, &order));
  return order;
}

}  // namespace

std::unique_ptr<Formula> index_two(Motion& motion) { return std::make_unique<IdaFormula>(motion); }

}  // namespace maupertuis::stiff
#endif

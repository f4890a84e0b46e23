#ifdef MAUPERTUIS_SUNDIALS
#include "integrator/stiff/formula.hpp"
#include "integrator/stiff/sundials.hpp"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::stiff {
namespace {

Failure failure_of(int flag) {
  switch (flag) {
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
    case CV_LSETUP_FAIL:
    case CV_ILL_INPUT:
      return Failure::Value;
    case CV_TOO_MUCH_ACC:
      return Failure::Accuracy;
    case CV_ERR_FAILURE:
      return Failure::ErrorTest;
    case CV_CONV_FAILURE:
      return Failure::Convergence;
    default:
      throw std::logic_error(fmt::format("the stiff method failed with code {} of CVODE; please report", flag));
  }
}

class CvodeFormula final : public Formula {
 public:
  explicit CvodeFormula(Motion& motion);
  ~CvodeFormula() override { CVodeFree(&memory_); }
  void restart(double t, std::span<const double> y) override;
  Advance advance(double bound, std::span<double> y) override;
  void interpolate(double t, std::span<double> y) const override;
  int order() const override;
  void limit(double longest) override { require_success(CVodeSetMaxStep(memory_, longest)); }

 private:
  // Called by CVODE with `this` as user data; 0: done, 1: try a shorter step.
  static int rates(double t, N_Vector y, N_Vector rate, void* self);
  static int jacobian(double t, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector);
  static int weights(N_Vector y, N_Vector weight, void* self);

  Motion& motion_;
  Context context_;
  Vector state_;
  DenseSolver linear_;
  void* memory_;
  Eigen::MatrixXd by_q_, by_v_;
};

CvodeFormula::CvodeFormula(Motion& motion)
    : motion_(motion),
      state_(motion.states(), context_),
      linear_(state_, context_),
      memory_(require_memory(CVodeCreate(CV_BDF, context_))) {
  CVodeSetErrHandlerFn(memory_, say_nothing, nullptr);
  require_success(CVodeInit(memory_, rates, 0, state_));
  require_success(CVodeSetUserData(memory_, this));
  require_success(CVodeWFtolerances(memory_, weights));
  require_success(CVodeSetLinearSolver(memory_, linear_.solver, linear_.matrix));
  require_success(CVodeSetJacFn(memory_, jacobian));
  require_success(CVodeSetMaxNumSteps(memory_, -1));
}

int CvodeFormula::rates(double t, N_Vector y, N_Vector rate, void* self) {
  Motion& motion = static_cast<CvodeFormula*>(self)->motion_;
  const auto in = values(y), out = values(rate);
  if (!motion.solve(t, in)) return 1;
  const auto v = motion.v_of(in), a = motion.at_point.a();
  std::copy(a.begin(), a.end(), std::copy(v.begin(), v.end(), out.begin()));
  motion.integrand_values(out.subspan(2 * motion.freedoms()));
  return 0;
}

int CvodeFormula::jacobian(double t, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector) {
  CvodeFormula& formula = *static_cast<CvodeFormula*>(self);
  if (!formula.motion_.solve(t, values(y))) return 1;
  formula.motion_.at_point.derivatives(formula.by_q_, formula.by_v_);
  const auto size = SUNDenseMatrix_Rows(matrix), n = static_cast<sunindextype>(formula.motion_.freedoms());
  Eigen::Map<Eigen::MatrixXd> out(SUNDenseMatrix_Data(matrix), size, size);
  out.setZero();
  out.block(0, n, n, n).setIdentity();
  out.block(n, 0, n, n) = formula.by_q_;
  out.block(n, n, n, n) = formula.by_v_;
  return 0;
}

int CvodeFormula::weights(N_Vector y, N_Vector weight, void* self) {
  return static_cast<CvodeFormula*>(self)->motion_.weigh(values(y), values(weight)) ? 0 : -1;
}

void CvodeFormula::restart(double t, std::span<const double> y) {
  std::copy(y.begin(), y.end(), values(state_).begin());
  require_success(CVodeReInit(memory_, t, state_));
}

Advance CvodeFormula::advance(double bound, std::span<double> y) {
  Advance out;
  require_success(CVodeSetStopTime(memory_, bound));
  const int flag = CVode(memory_, bound, state_, &out.reached, CV_ONE_STEP);
  if (flag < 0) {
    out.failure = failure_of(flag);
    return out;
  }
  std::copy(values(state_).begin(), values(state_).end(), y.begin());
  return out;
}

void CvodeFormula::interpolate(double t, std::span<double> y) const {
  const Vector out(y, context_);
  require_success(CVodeGetDky(memory_, t, 0, out));
}

int CvodeFormula::order() const {
  int order = 0;
  require_success(CVodeGetLastOrder(memory_, &order));
  return order;
}

}  // namespace

std::unique_ptr<Formula> explicit_rates(Motion& motion) { return std::make_unique<CvodeFormula>(motion); }

}  // namespace maupertuis::stiff
#endif

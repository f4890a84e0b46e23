#ifdef MAUPERTUIS_SUNDIALS
#include "integrator/stiff/reason.hpp"

#include <cvode/cvode.h>
#include <fmt/format.h>

#include <stdexcept>

namespace maupertuis::stiff {

std::pair<StepEnding, std::string> reason_of(int flag, PointStatus status, double t) {
  const auto at = [t](const char* text) { return fmt::format("{} at t = {:.17g} s", text, t); };
  switch (flag) {
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
    case CV_RTFUNC_FAIL:
    case CV_LSETUP_FAIL:
      if (status == PointStatus::Singular)
        return {StepEnding::SingularMass, at("the accelerations have no unique value: the mass matrix is singular on the motions "
                                             "that the constraints allow")};
      return {StepEnding::Overflow, at("a value is infinite or undefined")};
    case CV_PROJFUNC_FAIL:
    case CV_REPTD_PROJFUNC_ERR:
      return {StepEnding::NoConvergence, at("no state on the constraints was found near the one that the step reached")};
    case CV_TOO_MUCH_ACC:
      return {StepEnding::NoConvergence, at("the tolerance is finer than double precision resolves")};
    case CV_ERR_FAILURE:
      return {StepEnding::StepUnderflow, at("no step, however short, meets the tolerance: a collision, an impact or an infinite force")};
    case CV_CONV_FAILURE:
      return {StepEnding::NoConvergence, at("Newton's iteration does not converge, however short the step")};
    case CV_ILL_INPUT:
      return {StepEnding::Overflow, at("a value is infinite or undefined")};
    default:
      throw std::logic_error(fmt::format("the stiff method failed with code {}; please report", flag));
  }
}

}  // namespace maupertuis::stiff
#endif

#include "integrator/stiff/reason.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace maupertuis::stiff {

std::pair<StepEnding, std::string> reason_of(Failure failure, PointStatus status, double t) {
  const auto at = [t](const char* text) { return fmt::format("{} at t = {} s", text, t); };
  if (status == PointStatus::Singular)
    return {StepEnding::SingularMass,
            at("the accelerations have no unique value: the mass matrix is singular on the motions that the "
               "constraints allow")};
  switch (failure) {
    case Failure::Value:
      return {StepEnding::Overflow, at("a value is infinite or undefined")};
    case Failure::Accuracy:
      return {StepEnding::NoConvergence, at("the tolerance is finer than double precision resolves")};
    case Failure::ErrorTest:
      return {StepEnding::StepUnderflow,
              at("no step, however short, meets the tolerance: a collision, an impact or an infinite force")};
    case Failure::Convergence:
      return {StepEnding::NoConvergence, at("Newton's iteration does not converge, however short the step")};
    case Failure::Constraints:
      return {StepEnding::NoConvergence,
              at("no state on the constraints was found near the one that the step reached")};
  }
  throw std::logic_error("the stiff method failed for an unknown reason; please report");
}

}  // namespace maupertuis::stiff

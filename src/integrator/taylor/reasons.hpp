#pragma once
#include <maupertuis/kernel.hpp>

#include <string>

namespace maupertuis::taylor {

/// Why a motion ends where nothing is known of the zeros of a function (RootSearch::lost).
constexpr const char* no_series_of_watched =
    "A function of an event or of a switch has no series here, as where exp or cosh is beyond the range of numbers, or "
    "swings within the rounding of time, so that its zeros would not be seen. In another form it may stay finite: "
    "cosh(u) = 2 as sech(u) = 1/2.";

/// Why equations give no expansion at a point. work: a KernelWorkspace, or one of another number type; is_finite:
/// whether they give accelerations there.
template <class Work>
std::string reason_of(KernelStatus status, const Kernel& kernel, const Work& work, bool is_finite) {
  if (status == KernelStatus::SingularMass)
    return "The mass matrix is singular here: the equations do not determine the acceleration of " +
           kernel.coordinate_name(work.singular_coordinate()) + ".";
  if (status == KernelStatus::Contradiction)
    return "The constraints are singular here: what " + kernel.constraint_name(work.contradicting_constraint()) +
           " asks of the accelerations, the others exclude.";
  return is_finite
             ? "The accelerations are finite here, but not all of their derivatives are: at a root, as of √t at t = 0, "
               "there is none, and next to a pole they leave the range of numbers."
             : "A force or an acceleration is infinite or undefined here.";
}

}  // namespace maupertuis::taylor

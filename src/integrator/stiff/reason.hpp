#pragma once
#include "integrator/stiff/radau_method.hpp"

#include <maupertuis/step.hpp>

#include <string>
#include <utility>

namespace maupertuis::stiff {

/// What a failure means, with one sentence; `status` tells of the point that the motion has reached.
std::pair<StepEnding, std::string> reason_of(Failure failure, PointStatus status, double t);

}  // namespace maupertuis::stiff

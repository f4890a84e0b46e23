#pragma once
#include "integrator/point/point_solver.hpp"

#include <maupertuis/step.hpp>

#include <string>
#include <utility>

namespace maupertuis::stiff {

/// What a negative return value of CVode means, with one sentence; `status` tells of the last point that was evaluated.
std::pair<StepEnding, std::string> reason_of(int flag, PointStatus status, double t);

}  // namespace maupertuis::stiff

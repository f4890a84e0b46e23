#pragma once
#include <maupertuis/simulation.hpp>
#include <maupertuis/step.hpp>

namespace maupertuis {

/// Why a run that a stepper gave up ended.
Ending ending_of(StepEnding ending);

}  // namespace maupertuis

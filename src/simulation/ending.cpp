#include "simulation/ending.hpp"

namespace maupertuis {

Ending ending_of(StepEnding ending) {
  switch (ending) {
    case StepEnding::SingularMass:
      return Ending::SingularMass;
    case StepEnding::SingularConstraints:
      return Ending::SingularConstraints;
    case StepEnding::NoConvergence:
      return Ending::NoConvergence;
    case StepEnding::Overflow:
      return Ending::Overflow;
    case StepEnding::StepUnderflow:
      return Ending::StepUnderflow;
    case StepEnding::Sliding:
      return Ending::Sliding;
    case StepEnding::TooManySteps:
      return Ending::TooManySteps;
    case StepEnding::Interrupted:
      return Ending::Interrupted;
    case StepEnding::None:
      break;
  }
  return Ending::Finished;
}

}  // namespace maupertuis

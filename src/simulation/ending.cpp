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
    case StepEnding::Paradox:
      return Ending::Paradox;
    case StepEnding::Unending:
      return Ending::Unending;
    case StepEnding::None:
      break;
  }
  return Ending::Finished;
}

std::string_view word_of(Happening::Kind kind) {
  static constexpr std::string_view words[] = {"impact", "made", "lost", "stick", "slip", "event"};
  return words[static_cast<int>(kind)];
}

bool goes_through_modes(const Model& model) { return model.system.has_modes() || !model.experiment.events.empty(); }

}  // namespace maupertuis

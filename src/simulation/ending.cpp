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
    case StepEnding::Refused:
      return Ending::Paradox;
    case StepEnding::Unending:
      return Ending::Unending;
    case StepEnding::ImpossibleState:
      return Ending::ImpossibleState;
    case StepEnding::None:
      break;
  }
  return Ending::Finished;
}

std::string_view word_of(Happening::Kind kind) {
  static constexpr std::string_view words[] = {"impact", "made",  "lost",     "stick",
                                               "slip",   "event", "unloaded", "loaded"};
  return words[static_cast<int>(kind)];
}

std::string_view word_of(Ending ending) {
  switch (ending) {
    case Ending::Finished:
      return "finished";
    case Ending::UntilReached:
      return "until reached";
    case Ending::UntilNotReached:
      return "until not reached";
    case Ending::Interrupted:
      return "interrupted";
    case Ending::SingularMass:
      return "singular mass matrix";
    case Ending::SingularConstraints:
      return "singular constraints";
    case Ending::NoConvergence:
      return "no convergence";
    case Ending::Overflow:
      return "overflow";
    case Ending::StepUnderflow:
      return "step underflow";
    case Ending::Sliding:
      return "sliding";
    case Ending::TooManySteps:
      return "too many steps";
    case Ending::Stopped:
      return "stopped by an event";
    case Ending::Paradox:
      return "no motion fits";
    case Ending::Unending:
      return "events without end";
    case Ending::ImpossibleState:
      return "impossible state";
  }
  return "";
}

bool is_reason_of_modes(Ending ending) {
  return ending == Ending::ImpossibleState || ending == Ending::Unending || ending == Ending::Paradox;
}

void tell_ending(Ending ending, const std::string& reason, std::optional<Span> place, Diagnostics& diagnostics) {
  if (ending == Ending::ImpossibleState)
    diagnostics.warning("W0737", place, "the run ended: an event sets a state that is not possible", reason,
                        "`set` has to give all that the state needs: coordinates and velocities on the constraints, "
                        "inside all contacts, each a finite number.");
  else if (ending == Ending::Unending)
    diagnostics.warning("W0738", place, "the run ended: events without end, or more of them than are followed", reason,
                        "Write an event that comes less often, end the run before, or stop it with an event.");
  else if (ending == Ending::Paradox)
    diagnostics.warning("W0739", place, "the run ended: no motion goes on here", reason,
                        "`maup explain W0739` says what helps in each such case.");
}

bool goes_through_modes(const Model& model) { return model.system.has_modes() || !model.experiment.events.empty(); }

}  // namespace maupertuis

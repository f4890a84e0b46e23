#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/step.hpp>

#include <optional>
#include <string>

namespace maupertuis {

/// Why a run that a stepper gave up ended.
Ending ending_of(StepEnding ending);
/// Whether events, contacts or friction end the run, at an instant that its companions come to as well.
bool is_reason_of_modes(Ending ending);
/// What events, contacts and friction end a run for, with its reason: W0737 a state that an event must not set, W0738
/// events without end, W0739 no motion. Other endings tell nothing. `place`: of the statement that ended it, if one
/// did.
void tell_ending(Ending ending, const std::string& reason, std::optional<Span> place, Diagnostics& diagnostics);

}  // namespace maupertuis

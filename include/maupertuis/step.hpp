#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What every stepper gives, whatever its method.
namespace maupertuis {

enum class StepEnding {
  None,  // go on
  SingularMass,
  SingularConstraints,  // the constraints contradict each other here, or do not determine where the motion goes
  Overflow,             // a value is infinite or undefined
  StepUnderflow,        // steps shrink below the resolution of time: a collision, an infinite force
  Sliding,              // both sides of a switch push back to it
  TooManySteps,
  Interrupted,
  NoConvergence,    // the equations of an implicit step were not solved, or no step meets the tolerance
  Paradox,          // no mode of contacts and friction fits here
  Unending,         // events without end
  ImpossibleState,  // an event sets a state that constraints or contacts do not allow
  Refused,          // no step was made: the start or the parameters are none that the model takes
};

/// A root of an event function: 1 rising, −1 falling, 0 where it comes to zero and goes back.
struct EventRoot {
  std::size_t event = 0;
  int direction = 0;
  double time = 0;    // s
  double hidden = 0;  // s; at a root of higher order: by how much rounding may have moved it
  std::uint8_t order = 1;
};

/// One step, or the reason why there is none: then begin == end and the state is the one reached before.
struct Step {
  double begin = 0, end = 0;  // s
  StepEnding ending = StepEnding::None;
  std::string reason;                 // one sentence for every ending but None
  std::optional<std::size_t> event;   // the step ended at a root of this event function
  double hidden = 0;                  // s; by how much rounding may have moved that
  std::vector<EventRoot> events;      // all roots there, within rounding, after those that the step passed, by time
  std::vector<std::size_t> switches;  // switch functions whose root the step ended at
};

/// The motion at one time.
struct Sample {
  double t = 0;
  std::vector<double> q, v, a;      // [n] each
  std::vector<double> observables;  // [observables]
  std::vector<double> multipliers;  // [constraints]; NaN where the equations do not determine λ
  std::vector<double> integrals;    // [integrands], from the start of the run to t
};

}  // namespace maupertuis

#pragma once
#include <maupertuis/kernel.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Steps of a motion by Taylor polynomials (docs/design/taylor_step.md).
///
///     TaylorStepper stepper(kernel, parameters, {});
///     stepper.start(0, q0, v0);
///     std::size_t next = 0;
///     while (stepper.time() != end) {
///       const Step step = stepper.step(end);                      // never goes past `end`
///       while (next < times.size() && stepper.covers(times[next])) store(stepper.sample(times[next++]));
///       if (step.ending != StepEnding::None) { report(step.ending, step.reason); break; }
///       if (step.event) break;                                    // run until: stepper.time() is the located root
///     }
namespace maupertuis {

struct TaylorOptions {
  double tolerance = 0;  // relative, per step, less than 1; 0: rounding level of double
  int order = 0;         // of the polynomial of q̇, 2 to 100 (1 is taken for 2); 0: from the tolerance
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;   // looked at once a step
  Backend backend = Backend::Automatic;  // what carries out the expansions
  bool cache = true;                     // of compiled code
  /// Observables are found at the beginning of every so-manieth step; in other steps step_start() has none.
  std::size_t observed_steps = 1;
  /// Not 0: where a step ends at a switch or an event, the instant is moved by up to the rounding of its time, one way
  /// or the other, as this number says: what the motion is off by then is what located instants are known to.
  std::uint64_t moved_instants = 0;
};

/// In [−1, 1], the same for the same arguments: how a companion moves what rounding leaves open.
double share_of_rounding(std::uint64_t number, double at);

/// What carried out the expansions.
struct BackendUse {
  bool compiled = false;
  double compile_seconds = 0;
  std::string trouble;        // why compiled code that was asked for is not used
  std::string cache_trouble;  // it could not be kept for the next run
};

/// One sentence where a start is none that a motion begins with, else empty: a number is infinite or undefined, or the
/// start is off the constraints, so that q or q̇ would have to be moved by more than 10⁻⁹ of their sizes. Cost: that of
/// some steps.
std::string trouble_of_start(const Kernel& kernel, std::span<const double> parameters, double t,
                             std::span<const double> q, std::span<const double> v);

/// Advances a motion by steps whose order and length follow from the tolerance (Jorba and Zou). The state is summed
/// with compensation. Every zero of a switch function ends a step at its located root, and so do events.
class TaylorStepper {
 public:
  /// Parameters in the order of the kernel. Lists of another length, numbers that are none, indices beyond the end and
  /// steps before start(), here and below: std::invalid_argument.
  TaylorStepper(const Kernel& kernel, std::span<const double> parameters, const TaylorOptions& options);
  ~TaylorStepper();
  TaylorStepper(TaylorStepper&&) noexcept;

  int order() const;
  /// Begins a run; integrals and statistics start at zero. `rest`: what t leaves of the time, where it is known better.
  /// A start off the constraints is brought to them by the first step, without a word: trouble_of_start tells.
  void start(double t, std::span<const double> q, std::span<const double> v, double rest = 0);
  /// What a root of an event does. Those that do not end the step are told with it, at their own times, and cost it
  /// nothing: the motion is the one without them, to the bit.
  struct EventTreatment {
    bool ends_step = true;
    bool touches = true;  // roots without a change of sign are told too
    int direction = 0;    // where not 0: only roots that rise (1) or fall (−1) with time end the step
  };
  /// [events]; without it each event ends the step, and touches are told.
  void treat_events(std::span<const EventTreatment> treatments);
  /// After start(): event functions that vanish here, to rounding. They are on the side that the motion goes to.
  /// order: of the zero, where it is known; what rounding makes of lower powers of time does not count.
  void put_at_zero(std::span<const std::size_t> events, std::uint8_t order = 1);
  /// Sizes that q, q̇ and q̈ have had elsewhere in the motion [n]: constraints on coordinates that have come to rest are
  /// met to rounding of these.
  void set_usual_sizes(std::span<const double> q, std::span<const double> v, std::span<const double> a);
  /// What is seen of the motion at its start, before a step is made.
  struct Outlook {
    StepEnding ending = StepEnding::None;  // None: there is a motion
    std::string reason;
    std::vector<std::int8_t> sides;     // [events] of zero, just after; 0 where rounding hides it
    std::vector<double> values;         // [events] here
    std::vector<double> slopes;         // [events] their rates here
    std::vector<double> reach;          // [events] the largest that they can become over the length that is judged
    std::vector<double> accelerations;  // [n]
    double length = 0;                  // over which all that is judged, s
  };
  /// After start(); `bound`: how far to look at most.
  Outlook outlook(double bound);
  /// One step towards `bound`, at most up to it; time() == bound exactly when it is reached. Backwards if bound <
  /// time().
  Step step(double bound);

  double time() const;
  double time_rest() const;           // what time() leaves of the time at which q and q̇ are
  std::span<const double> q() const;  // [n]
  std::span<const double> v() const;  // [n]
  double integral(std::size_t index) const;
  double event_at_begin(std::size_t event) const;  // its function where the last step began; right after that step
  std::size_t steps() const;
  std::size_t rejected() const;  // steps so far that were taken back, since the equations did not hold at their ends
  std::size_t switches() const;  // located crossings so far
  const BackendUse& backend() const;

  /// Whether t lies in the last step, its ends included.
  bool covers(double t) const;
  /// The motion at a time in the last step, from the step's own polynomial; accelerations and observables by the
  /// kernel at that point. Also at the start, before any step. Where the forces have no value a is NaN, and so are
  /// multipliers and observables that depend on them. Precondition: covers(t).
  Sample sample(double t) const;
  /// The state alone, from the polynomial: no evaluation of the kernel. q, v: [n].
  void state(double t, std::span<double> q, std::span<double> v) const;
  /// q̈ of the step's own polynomial, until the next call: at its ends too where the forces have no value, as
  /// max(x, 0)^(3/2) that rounding takes beyond 0. [n] Precondition: covers(t), and a step was made.
  std::span<const double> accelerations_of_step(double t) const;
  /// The motion at the beginning of the last step, at no cost: accelerations and observables come with the step.
  const Sample& step_start() const;
  /// The largest of φ and of dφ/dt or ψ so far, each in units of the sizes of its terms, as the steps after the
  /// first began.
  double constraint_residual() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The order that a tolerance asks for (20 at rounding level, 12 at 1e-6; docs/theory/taylor.md), and the tolerance at
/// rounding level.
int taylor_order(double tolerance);
double rounding_tolerance();

}  // namespace maupertuis

#pragma once
#include <maupertuis/kernel.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Motions in more digits than double has (docs/design/extended_precision.md). Numbers come in exactly, as expressions
/// in a kernel, and go out as decimal text; no number type has a public face.
namespace maupertuis {

/// Bits of the mantissa that a run calculates with. Words are 64 bits: the two of a pair differ by one word or more.
enum class Mantissa { Bits113, Bits192, Bits384, Bits448 };

/// What a root of an event function of the kernel does.
struct ExtendedEvent {
  enum class Action { Record, Stop, Set } action = Action::Record;
  int direction = 0;  // of time: 1 rising, −1 falling, 0 both
  struct Assignment {
    std::size_t coordinate = 0;
    int order = 0;  // 0: q, 1: q̇
    friend bool operator==(const Assignment&, const Assignment&) = default;
  };
  std::vector<Assignment> sets{};
  std::vector<Assignment> reads{};  // the parts of the state that its function depends on
  bool of_state = false;            // and on the time, not on accelerations or forces
};

/// A mode of contacts and frictions: which equations hold between two instants.
struct ExtendedMode {
  enum class Friction : std::int8_t { None, Stick, Forward, Backward, Slide };  // Slide: in space
  std::vector<bool> closed;              // [contacts]
  std::vector<Friction> friction;        // [contacts + frictions]
  std::vector<std::int8_t> normal_sign;  // [frictions] of normal forces made of multipliers
  std::vector<bool> begins;              // [contacts] a slip in space begins, along a direction that is given
  std::vector<double> stops;             // [contacts] the speed at which a slip in space counts as stopped
};

/// What an event function of the kernel of a mode means, as ModeWatch of simulation.
struct ExtendedWatch {
  enum class What { Until, Event, Gap, Force, Hold, Slip, Normal } what = What::Event;
  std::size_t index = 0;  // of the event, the contact, the friction
};

struct ExtendedProgram {
  Kernel kernel;                       // its first observables are those of ExtendedProblem::kernel
  std::vector<ExtendedWatch> watches;  // [events of the kernel]
  std::optional<Kernel> slips{};       // where slips begin: the motion with their components as events, two a contact
};

/// Contacts and frictions. What they are at a point are observables of ExtendedProblem::kernel, whose last events are
/// the gaps.
struct ExtendedContacts {
  std::size_t count = 0;       // of contacts
  std::size_t first = 0;       // observables for each contact: ∂g/∂t, restitution, ∂g/∂q [2 + n]
  std::size_t first_slip = 0;  // for each friction, those of contacts first: v_t, μ, μ_s, ∂v_t/∂q̇ [3 + n]
  std::size_t first_second_slip = 0;  // for each friction in space: the second component of v_t, ∂/∂q̇ of it [1 + n]
  struct Friction {
    bool present = false, sticking = false;  // sticking: it never slides
    bool has_sign = false;                   // its normal force is made of multipliers
    bool in_space = false;                   // v_t has two components
  };
  std::vector<std::size_t> kind{}, gap_kind{};  // [n], [contacts]: of one dimension share a number, and their sizes
  std::vector<Friction> frictions{};            // [contacts + frictions]
  bool simultaneous = false;                    // impacts of several contacts are shared by complementarity
  /// Of the polynomials of time that are the directions of slips in space that begin. Of each such contact the kernel
  /// of a mode has parameters after those of the model: t_0, the coefficients of one component, those of the other.
  int direction_degree = 0;
  std::function<ExtendedProgram(const ExtendedMode&)> program{};  // called by one thread
};

/// What is to be computed. Every number of it is an expression in a kernel of its own, so that 9.81 is the decimal and
/// π is π.
struct ExtendedProblem {
  Kernel kernel;  // of the motion
  /// Without coordinates and parameters. Its observables are, in this order: the parameters of `kernel` [p], begin,
  /// end, the time between two rows, q [n] and q̇ [n] at the begin, the times asked for.
  Kernel numbers;
  std::vector<bool> fixed_q, fixed_v;   // [n] not to be moved when the start is brought onto the constraints
  std::size_t first_condition = 0;      // observables of `kernel` that q, or q̇, must bring to zero at the start, each
                                        // followed by its derivatives by q, or q̇: [conditions × (1 + n)]
  std::vector<bool> conditions;         // whether q is to do it
  std::size_t first_relation = 0;       // observables that q and q̇ together must bring to zero, each followed by its
  std::size_t relations = 0;            // derivatives by q and by q̇: [relations × (1 + 2n)]
  std::size_t rows = 0;                 // states wanted at begin, begin ± every, …, this many; then one at the end
  std::size_t times = 0;                // states wanted at the times asked for, in the order of the run
  bool until = false;                   // the first event of the kernel ends the run
  std::vector<ExtendedEvent> events{};  // what the next ones do, in their order
  std::size_t first_set = 0;            // observables: the values that events set, one after the other
  ExtendedContacts contacts{};
};

struct ExtendedOptions {
  double log2_tolerance = 0;  // of the relative tolerance of a step; 0: rounding level
  int order = 0;              // of the polynomial of q̇; 0: from the tolerance
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;
  std::function<void(double)> progress;  // told the fraction of the run that is done, now and then
};

/// The state at one time, in all digits that the number type has. Text is empty where there is no number.
struct ExtendedSample {
  bool reached = false;
  std::string t;
  std::vector<std::string> q, v;  // [n]
  std::vector<std::string> observables;
  std::vector<std::string> multipliers;  // [constraints]; empty text where the equations do not determine λ
};

/// What happened at an instant.
struct ExtendedRoot {
  enum class Kind { Impact, Made, Lost, Stick, Slip, Event } kind = Kind::Event;
  std::size_t index = 0;       // of the event, the contact, the friction
  ExtendedSample state;        // before an impact
  std::string impulse, speed;  // Impact: Λ, and −ġ before it
};

struct ExtendedMotion {
  std::vector<ExtendedRoot> roots;
  std::optional<std::size_t> trouble;    // the contact where it could not go on; `reason` is said of it
  std::vector<ExtendedSample> rows, at;  // at: [times]
  ExtendedSample final;
  StepEnding ending = StepEnding::None;
  std::string reason;  // one sentence for every ending but None
  bool met = false;    // an event ended the run
  std::size_t steps = 0, switches = 0;
  int order = 0;
  std::vector<std::size_t> undetermined{};  // contacts that are more than the motion needs, of the first such instant
  /// Two frictions of which either may be held while the other begins to slide.
  struct Choice {
    std::size_t held = 0, slides = 0;
    std::string t;
  };
  std::optional<Choice> choice{};  // the first
};

/// Runs a motion from begin to end. What was computed is kept whatever the ending.
/// Cost: steps × order² × instructions of the kernel, each some 50 ns (113 bits) to 250 ns (448 bits).
ExtendedMotion run_extended(const ExtendedProblem& problem, Mantissa mantissa, const ExtendedOptions& options);

/// What this build calculates with in the place of it: a module for browsers, which is to be small, has the two widest
/// alone.
Mantissa compiled_mantissa(Mantissa mantissa);
int bits_of(Mantissa mantissa);

/// The rounding unit of a type, as the logarithm of base 2.
double log2_rounding(Mantissa mantissa);

/// A number as two computations of different accuracy give it.
struct AgreedNumber {
  std::string text;  // decimal, `digits` significant digits, rounded; "0" with none where they do not tell it from zero
  int digits = 0;
  std::string difference;  // of the two, as "3e-32"
};

/// The digits of the finer value that the difference leaves standing: |rough − fine| is at most half a unit of the last
/// one. Precondition: both are numbers as ExtendedSample holds them.
AgreedNumber agreed_number(const std::string& rough, const std::string& fine, int most_digits);

}  // namespace maupertuis

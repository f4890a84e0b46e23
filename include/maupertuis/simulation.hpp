#pragma once
#include <maupertuis/backend.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/kernel.hpp>
#include <maupertuis/stop_flag.hpp>
#include <maupertuis/trajectory.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// What a run tells of its errors (docs/design/certain_digits.md). None: nothing, and no companion runs. States: those
/// of the states, reactions and probes at the times asked for and at the end. Rows: those of each row of the trajectory
/// too.
enum class ErrorEstimates { None, States, Rows };

struct SimulationOptions {
  std::optional<StepMethod> method;  // nothing: that of the model's `method`, or Automatic
  double step = 0;                   // s, Variational: the length of its steps; 0: that of the model's `method`
  int order = 0;                   // 0: that of the model's `method`; else from the tolerance (Taylor), 4 (Variational)
  double tolerance = 0;            // relative, per step; 0: rounding level of double (Stiff: 1e-10)
  std::optional<double> duration;  // s, instead of the model's run; negative: backwards in time
  std::vector<double> at;          // s: times at which the state is wanted exactly; beyond the run: it goes on to them
  std::optional<double> output_every;  // s
  bool rows_of_steps = false;   // where nobody says how often: rows between those a thousandth of the run apart, as the
                                // steps ask for, so that a picture shows oscillations that are faster
  std::vector<double> rows_at;  // s: further rows, exactly at these times of the run
  Backend backend = Backend::Automatic;  // of Taylor's steps
  bool cache = true;                     // of compiled code, on disk
  ErrorEstimates errors = ErrorEstimates::States;
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;   // set by Ctrl-C
  std::function<void(double)> progress;  // told the fraction of the run that is done, now and then
};

/// By how much the numbers of a state may be off, each in the unit of its number: 0 where it is exact, infinite where
/// no digit is certain, NaN beside a NaN.
struct StateErrors {
  double t = 0;  // 0 but for a time that was located: the end of `run until`
  std::vector<double> q, v, multipliers, reactions, quantities{};
};

struct State {
  double t = 0;
  std::vector<double> q, v, a;          // [n] each; a is NaN where the accelerations have no value
  std::vector<double> multipliers;      // [constraints] λ; NaN where the equations do not determine it
  std::vector<double> reactions;        // [SimulationResult::reactions]
  std::optional<StateErrors> errors{};  // without where nobody asked
  std::vector<double> quantities{};     // [SimulationResult::quantities]
};

enum class Ending {
  Finished,
  UntilReached,     // the condition of `run until` was met
  UntilNotReached,  // … was not met within the time given
  Interrupted,
  SingularMass,
  SingularConstraints,
  NoConvergence,  // the equations of an implicit step were not solved
  Overflow,
  StepUnderflow,
  Sliding,
  TooManySteps,
  Stopped,          // by an event of the model that stops the run
  Paradox,          // no mode, or none that is known, fits contacts and friction here
  Unending,         // events follow each other without end, or more of them than are followed
  ImpossibleState,  // an event sets a state that constraints or contacts do not allow, or one without a value
};
/// "until reached", "singular mass matrix", … for JSON.
std::string_view word_of(Ending ending);

struct SimulationStatistics {
  std::size_t steps = 0;
  std::size_t rejected = 0;    // steps taken back, since the equations did not hold at their ends
  double seconds = 0;          // stepping only
  double compile_seconds = 0;  // model to kernel, and to machine code
  int order = 0;
  std::string backend = "interpreter";  // or compiled
  std::string method = "taylor";        // of the last step: taylor, variational, stiff
  double energy_drift = 0;  // max |h_E(t) − h_E(0) − work| / max Σ|terms of h_E|, over the steps; of more than
                            // eight coordinates without switches, over every fourth and the end
  bool energy_vanishes = false;    // h_E is 0 at every state of a motion: nothing that could drift
  double constraint_residual = 0;  // docs/theory: largest φ, dφ/dt, ψ, each by the sizes of its terms
  std::size_t switches = 0;        // located switch crossings
  std::size_t companions = 0;      // runs beside it that tell its errors
  double companion_seconds = 0;    // they took, all together
};

/// From a time on no digit of some columns of the trajectory is certain: the companions have gone ways of their own.
struct Uncertainty {
  std::vector<std::size_t> columns;  // of the state, q and q'; empty: something is certain of each all along the run
  double from = 0;                   // s: from here on, for all of these
  double first = 0;                  // s: the same for one of them
  bool everything = false;           // these are all that move
};

/// What happens at an instant of a run with contacts, friction or events.
struct Happening {
  enum class Kind {
    Impact,    // a contact was hit
    Made,      // a contact is closed from here on
    Lost,      // a contact opens
    Stick,     // friction holds from here on
    Slip,      // friction gives way, or goes the other way
    Event,     // of the model
    Unloaded,  // a contact carries nothing from here on, while others keep it closed
    Loaded,    // it carries again
  } kind = Kind::Event;
  double t = 0;
  double error = 0;          // by how much t may be off; 0 where nobody asked
  std::string name;          // of the contact, the coordinate with friction, or the event
  double impulse = 0;        // Impact: Λ, in the unit of λ times s
  double speed = 0;          // Impact: −ġ before
  std::string remark{};      // "the end of infinitely many bounces at t = 4.0637 s"
  std::string mode{};        // that the motion is in afterwards: "floor, wall sliding"; empty: free
  std::vector<double> q, v;  // [n] just after; empty beyond two million numbers of a run
};
std::string_view word_of(Happening::Kind kind);

/// Where the energy of a run with contacts and friction went, J. What the terms of h_E lost is their sum to rounding.
struct EnergyBooks {
  double impacts = 0;  // lost at impacts, ½ Λ (1 − e) |ġ⁻| each
  double moving = 0;  // gained from surfaces that move: −Λ ∂g/∂t at impacts, −λ ∂g/∂t and what friction gives between
  double friction = 0;  // lost by friction while sliding
  double dampers = 0;   // lost by D
  double events = 0;    // gained where events set the state
};

struct SimulationResult {
  Trajectory trajectory;
  std::vector<Trajectory::Column> reactions;  // names and units: columns of the trajectory as well
  /// What depends on functions that a degenerate Lagrangian leaves free, "y", "y'": no columns of the trajectory.
  std::vector<std::string> undetermined{};
  /// What is told of states beside q and q̇: rates of the model; and where functions are free, what does not depend on
  /// them, "x - y", "p_x", which are columns of the trajectory as well.
  std::vector<Trajectory::Column> quantities{};
  State start, final;
  std::vector<State> at;  // in the order asked; q is empty where the run ended before
  SimulationStatistics statistics;
  Uncertainty uncertain;
  std::string first_mode;              // in which the run begins; empty: no contact is closed, nothing sticks
  std::vector<Happening> happenings;   // in the order of the run
  std::optional<EnergyBooks> books{};  // where the model has contacts or friction
  std::vector<std::string> remarks{};  // what the run has to say of its impacts and of friction, a sentence each
  Ending ending = Ending::Finished;
  std::string reason;  // one sentence for every ending but Finished
  bool ok() const { return ending == Ending::Finished || ending == Ending::UntilReached || ending == Ending::Stopped; }
};

/// Expressions with the values of reactions in place of their symbols. A reaction that the model does not determine
/// stays a symbol.
std::vector<Expr> with_reactions(const EquationsOfMotion& equations, std::span<const Expr> expressions);

/// A component of the start that the constraints changed.
struct StartAdjustment {
  std::size_t coordinate = 0;
  int order = 0;            // 0: q, 1: q'
  double from = 0, to = 0;  // SI
  bool written = false;     // the model gave it: moved only because what it gives contradicts itself
};

/// Where a run begins.
struct ConsistentStart {
  MotionState state;
  std::vector<StartAdjustment> adjustments;  // in the order of the coordinates, positions first
  bool searched = false;                     // the unwritten coordinates were found by a search from several points
};

/// The start of the model, moved onto the constraints: what is written is kept, the rest moves by the least kinetic
/// change, positions first, then velocities. Written values move only where they contradict the constraints or each
/// other, with a warning; `start exactly` makes that an error. Nothing is returned where the constraints cannot be met:
/// then `diagnostics` names a smallest set of them that clashes.
std::optional<ConsistentStart> consistent_start(const Model& model, const EquationsOfMotion& equations,
                                                Diagnostics& diagnostics);

/// What a ForwardDynamics (forward_dynamics.hpp) of a model is made from. The model's inputs are parameters here, whose
/// values each call gives instead of their formulas; of an input that L depends on its rates u' and u'' are inputs too,
/// after it, and of any other the rates that stand in a force. The expressions live as long as the system's context.
struct DynamicsSource {
  KernelSource kernel;
  std::vector<double> parameters;   // values in SI units, in the order of kernel.parameters; 0 for inputs
  std::vector<std::size_t> inputs;  // which of them are inputs, in the order of the model
};
/// Of a degenerate Lagrangian that determines a motion: the source of `equations.determined`. Throws
/// std::invalid_argument where the model has contacts or friction. Inputs in constraints keep their formulas there.
DynamicsSource dynamics_source(const EquationsOfMotion& equations);

/// Extra functions of q, q', q'', t whose values are wanted at the times `at`.
struct Probe {
  std::vector<Expr> expressions;
  std::vector<std::vector<double>> values;  // [at][expressions], filled by the run
  std::vector<std::vector<double>> errors;  // [at][expressions] as in StateErrors; empty without companions
};

/// How a motion with contacts and friction begins.
struct ContactStart {
  std::vector<double> gaps, rates;   // [contacts] g and ġ of the start, SI
  std::vector<bool> closed;          // [contacts] in the first mode
  std::vector<Happening> impacts{};  // at once, of contacts that touch and close
  std::string mode{};                // the first one; empty: free
  std::string trouble{};             // a sentence why no motion begins here; empty: one does
};

/// Of a model with contacts or friction; W0731 where no motion begins. Nothing where the start violates a contact
/// (E0728), or where contacts are such that no motion is carried out with them (E0729, E0730).
std::optional<ContactStart> contact_start(const Model& model, const EquationsOfMotion& equations,
                                          const MotionState& start, Diagnostics& diagnostics);

/// Whether its motion is one through modes and events: contacts, friction, `event` statements.
bool goes_through_modes(const Model& model);

/// Runs the experiment of a model. What was computed is kept whatever the ending. Unless options.errors says no,
/// companion runs tell the errors: seven in the lanes of vector registers up to 4 unknowns, which take about as long
/// again, else three, each as long as the run itself. Nothing is returned when the start or the run length is missing
/// or wrong (then `diagnostics` says so).
std::optional<SimulationResult> simulate(const Model& model, const EquationsOfMotion& equations,
                                         const SimulationOptions& options, Diagnostics& diagnostics,
                                         Probe* probe = nullptr);

}  // namespace maupertuis

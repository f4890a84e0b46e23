#pragma once
#include <maupertuis/constraint_algorithm.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>

#include <optional>
#include <string_view>
#include <vector>

/// Lagrangians of which det ∂²L/∂q̇∂q̇ = 0 (docs/theory/degenerate.md): what they ask of the state, what they leave
/// open, and equations that determine the motion all the same.
namespace maupertuis {

/// A direction in the space of states, by components: of q [n], then of q̇ [n].
using StateDirection = ExprVector;

struct DegenerateAnalysis {
  /// States are (q, q̇), unknowns (q̈, λ); the conditions are Lagrange's equations, then those of the constraints
  /// A q̈ = b, then of the gauges, then the derivatives of what was found.
  ConstraintChain chain;
  ExprVector states;                   // q [n], then q̇ [n]
  std::size_t gauges = 0;              // relations of `gauge` statements, taken into account
  std::vector<std::size_t> free;       // coordinates whose accelerations nothing determines, as many as functions
  std::size_t motions = 0;             // numbers that single out a motion, apart from the free functions
  std::vector<StateDirection> orbits;  // along which the free functions move a state, independent on the manifold
  std::optional<Bindings> start;       // a state on all constraints near the start, where the choices below hold
  ExprMap motion;                      // q̈ and λ in q, q̇, t and the free ones; only where functions are free

  bool closed() const { return chain.outcome == ConstraintChain::Outcome::Closed; }
  /// Whether e(q, q̇, q̈, λ, t) is the same whatever the free functions are.
  bool is_determined(Expr e) const;
};

/// The Lagrangian constraint algorithm (Gotay and Nester) for the equations of a system, near `center`, which binds
/// every symbol of coordinates and velocities; parameters have the values of the model. `with_gauges`: the gauge
/// statements count as constraints. `start`: of constraints that branch its branch is taken, and what is free, and
/// which equations a run solves, are chosen so that they are regular there, too. Cost: see constraint_algorithm.
DegenerateAnalysis analyse_degenerate(const EquationsOfMotion& equations, const Bindings& center, bool with_gauges,
                                      bool hold_parameters = true, const Bindings* start = nullptr);

/// A state near the start of an experiment, away from special places and where L has a value: for analyses by points.
Bindings generic_state(const Model& model);
/// The start as it is written, 0 where nothing is: not yet on the constraints.
Bindings written_start(const Model& model);
/// The start on the constraints where the analysis of the equations found it there, else as it is written.
Bindings start_on_constraints(const Model& model, const EquationsOfMotion& equations);

/// Equations that determine all accelerations: some rows of Lagrange's are replaced by the derivatives of the
/// constraints that were found, on which they hold by themselves. In their place stands that the multipliers of these
/// constraints, whose forces are none, vanish; accelerations that are free are 0. Nothing where the analysis did not
/// close.
std::optional<EquationsOfMotion> determined_equations(const EquationsOfMotion& equations,
                                                      const DegenerateAnalysis& analysis);

/// The equations that determine every acceleration: these, or where L is degenerate the ones that were found for it.
const EquationsOfMotion& solvable_equations(const EquationsOfMotion& equations);

/// Whether functions of time stay free, which no `gauge` chooses: what depends on them has no value of its own.
bool has_free_functions(const EquationsOfMotion& equations);

struct DeterminedQuantity {
  std::string name;  // "x - y", "p_x"
  Expr value;        // in q, q̇, t
  Dimension dimension;
};

/// What has a value though coordinates in it have none, as functions stay free: differences of coordinates and other
/// combinations with numbers as coefficients, their rates, and momenta that do not vanish.
std::vector<DeterminedQuantity> determined_quantities(const EquationsOfMotion& equations);

/// E0631 where functions stay free, of a question that has an answer for one choice of them alone. `who` opens "… want
/// one choice of them": "Lyapunov exponents".
bool refuse_free_functions(const EquationsOfMotion& equations, std::string_view who, Diagnostics& diagnostics);

/// All that a motion satisfies at each point, in q, q̇, q̈, λ, t: the relations between states, and the rows that are
/// linear in q̈ and λ.
ExprVector relations_of_motion(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis);

enum class Settled {
  Near,       // from the state that was given
  Elsewhere,  // from scattered states
  Nowhere,
};

/// What every state of a motion fulfils: the relations of the model, its gauges, and the constraints that were found.
class StateRelations {
 public:
  StateRelations(const EquationsOfMotion& equations, const DegenerateAnalysis& analysis);
  ~StateRelations();

  /// Moves what is not fixed by Gauss and Newton; where that fails, from scattered values of it. Unchanged if nowhere.
  Settled settle(MotionState& state, const std::vector<bool>& fixed_q, const std::vector<bool>& fixed_v) const;
  bool hold(const MotionState& state) const;
  /// The relation that is violated most, "x' - y = 0".
  std::string worst_at(const MotionState& state) const;
  /// What vanishes at each state, in q, q̇, t and the parameters.
  const ExprVector& values() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The model with the determined equations' system, for computations that take both. Precondition: determined.
Model with_determined_system(const Model& model, const EquationsOfMotion& equations);

/// What there is to say of a degenerate system: a note, a warning where a kinetic energy may have been forgotten, free
/// functions, contradictions, gauges that fix nothing, too much or too little, parameters with special values. False
/// where there is no motion to be computed, and the error says why.
bool report_degenerate(const Model& model, const EquationsOfMotion& equations, const DegenerateAnalysis& analysis,
                       Diagnostics& diagnostics);

/// What a textbook prints of it: the constraints, generation by generation, what stays free, the gauges, the count.
std::vector<DerivationStep> degenerate_lines(const DegenerateAnalysis& analysis, const MechanicalSystem& system);

/// The constraints, one a line: "z = 0". `with_derivatives`: also those that merely follow from another one.
std::vector<std::string> constraint_lines(const DegenerateAnalysis& analysis, const ReadingOrder& order,
                                          bool with_derivatives);

}  // namespace maupertuis

#pragma once
#include <maupertuis/contact.hpp>
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/expectation.hpp>
#include <maupertuis/expression.hpp>
#include <maupertuis/overrides.hpp>
#include <maupertuis/syntax_tree.hpp>
#include <maupertuis/units.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// A vector or a matrix of expressions, by rows.
using ExprVector = std::vector<Expr>;
struct ExprMatrix {
  std::size_t rows = 0, columns = 0;
  ExprVector entries;  // [rows × columns]
  Expr& at(std::size_t i, std::size_t j) { return entries[i * columns + j]; }
  Expr at(std::size_t i, std::size_t j) const { return entries[i * columns + j]; }
};

struct Coordinate {
  std::string name;
  Expr q, velocity, acceleration;  // symbols of order 0, 1, 2
  Dimension dimension;
  std::string kind;  // "angle", "length", "charge", "number", or "" for a unit of its own
  Span span;
};

struct Parameter {
  std::string name;     // for a Constant: how the number stood in the text, e.g. "3 J"
  Expr symbol;          // Role::Parameter, or Role::Constant
  Expr value;           // in SI base units, exact: a number, perhaps times powers of π
  double si_value = 0;  // its double
  Dimension dimension;
  std::string unit;        // as written, "cm"; empty without one
  double unit_factor = 1;  // its SI value, 0.01
  bool used = false;       // some other line of the model names it
  Span span;
};

struct Input {
  std::string name;
  Expr symbol;   // Role::Input
  Expr formula;  // u(t)
  Dimension dimension;
  Span span;
};

/// A rate (quasi-velocity) σ = Y(q,t) q̇ + y(q,t) that `rates` names. Formulas hold its value; the form of the equations
/// in rates holds its symbol.
struct Rate {
  std::string name;
  Expr symbol;  // σ as the rate of its integral (integral_symbol.hpp): order 1; σ' is order 2
  Expr value;   // in q, q', t
  Dimension dimension;
  Span span;
};

/// A `let`. One of parameters alone stays a symbol in print, with a legend; others are expanded at once.
/// The expressions of a MechanicalSystem hold no such symbols: see MechanicalSystem::written.
struct Definition {
  std::string name;
  Expr symbol;   // Role::Auxiliary where it stays a symbol in print; else empty
  Expr value;    // expanded: no `let` symbols in it; empty for a vector
  Expr formula;  // as written, with the symbols of other definitions: the legend; empty for a vector
  bool used = false;
  Dimension dimension;
  bool is_vector = false;
  ExprVector components;  // of a vector
  Span span;
};

/// A particle (with mass) or a marked point.
struct Point {
  std::string name;
  Expr mass;            // empty handle: no mass
  ExprVector position;  // [dimension] world axes, metres; shared with the points it is defined from
  Span span;
};

struct Body {
  std::string name;
  Expr mass;                    // empty handle: rotation only
  ExprMatrix inertia;           // [3 × 3] about the centre of mass, body axes, or [1 × 1] in 2-D
  ExprVector position;          // [dimension] of the centre of mass, world axes
  ExprMatrix rotation;          // [dimension × dimension] body → world
  ExprVector angular_velocity;  // [3] body axes, or [1] in 2-D, in q, q', t
  ExprVector angular_velocity_world;
  Span span;
};

struct Frame {
  std::string name;
  ExprVector origin;            // world axes
  ExprMatrix rotation;          // frame → world
  ExprVector angular_velocity;  // [3] or [1], frame axes
  Span span;
};

/// A spring or a damper between two places, as it is drawn; what it does stands in V or D.
struct Link {
  enum class Kind { Spring, Damper } kind = Kind::Spring;
  std::string from_name, to_name;  // "" where an end is an expression
  ExprVector from, to;             // world axes, metres
};

/// One additive part of T, V, U, L or D and where it comes from.
struct EnergyTerm {
  Expr value;          // may hold TimeDerivative nodes
  std::string origin;  // "particle A", "rotation of body sat", "gravity on A", "spring A - B", "T"
  Span span;
};

/// A force or torque and its virtual work.
struct AppliedForce {
  enum class Kind { OnPoint, Torque, Generalized } kind = Kind::Generalized;
  std::string target;          // the point, the body, the coordinate
  std::string reaction_on;     // torque on B from A: A
  ExprVector components;       // world axes, N or N m; Generalized: one
  ExprVector lever;            // OnPoint: position of the point; Torque: the (relative) world angular velocity
  std::size_t coordinate = 0;  // Generalized
  Span span;
};

/// A relation that the motion obeys: φ(q,t) = 0 between coordinates, or ψ(q,q̇,t) = 0 between velocities. The value is
/// left − right, in SI units; its force is +Aᵀλ with A = ∂φ/∂q or ∂ψ/∂q̇.
struct Constraint {
  enum class Level { Position, Velocity } level = Level::Position;  // Velocity: some q' stands in it
  std::string name;                                                 // as written; empty if it has none
  Expr value;                                                       // φ or ψ; no TimeDerivative nodes
  Expr multiplier;                                                  // its λ, Role::Multiplier
  Expr reaction;           // symbol, Role::Multiplier: what `reaction(name)` stands for; see `reactions`
  Dimension dimension;     // of the value
  std::string body;        // of the norm constraint that `rotation quaternion` adds: the body; else empty
  bool forceless = false;  // asked of the state by a degenerate Lagrangian, or a gauge: see determined_equations
  Span span;
};

/// A contact as the constraint g = 0 that it is while it is closed.
Constraint as_constraint(const Contact& contact);

/// reaction NAME = release PARAMETER: the force that holds the parameter constant.
struct Release {
  std::string name;
  std::size_t parameter = 0;  // index in MechanicalSystem::parameters
  Expr reaction;              // symbol, Role::Multiplier: what `reaction(name)` stands for
  Span span;
};

/// gauge e = 1: fixes what a degenerate Lagrangian leaves open, without any force. The value is left − right, in SI
/// units, in q, q', t.
struct Gauge {
  std::string text;  // as written
  Expr value;
  Dimension dimension;  // of the value
  Span span;
};

/// A coordinate whose q'' stands in L (docs/theory/degenerate.md). The system holds L* = L(q, v, v', t) + p (q' − v)
/// in its place, with coordinates of its own for v = q' and for Ostrogradsky's first momentum p.
struct HigherDerivative {
  std::size_t coordinate = 0, rate = 0, momentum = 0;  // of q, v, p
  Expr acceleration_momentum;                          // p₂ = ∂L/∂q'', in q, q', q''
  Expr velocity_momentum;                              // p₁ = ∂L/∂q' − dp₂/dt, in q, q', q'', q'''
};

/// constraint integral G = value: ∫ G dt over the path from end to end has this value (isoperimetric problems). It
/// restricts the paths of `maup action` and enters the equations as those of L + λ G with one λ for the whole path.
struct IntegralConstraint {
  std::string name;     // as written; empty if it has none
  Expr integrand;       // G in q, q', t
  Expr value;           // parameters and numbers only, SI
  Dimension dimension;  // of the value
  Span span;
};

/// A claimed energy beside the one that points and bodies give: `T = …` in a model with massive points.
struct EnergyClaim {
  syntax::EnergyStatement::Which which;
  Expr value;
  Span span;
};

/// A mechanical system as physics: no units to convert, no names to look up, every formula in SI base units.
struct MechanicalSystem {
  std::shared_ptr<Context> context;
  std::string name, title, source;
  bool dimensionless = false;
  int space_dimension = 2;  // 2 or 3

  /// What stands in the place of t, `independent x : length`: its symbol is context->time(), and q' is dq/dx.
  std::string independent = "t";
  Dimension independent_dimension = dimensions::time();   // a bare number in a model without units
  Dimension lagrangian_dimension = dimensions::energy();  // of any kind where the independent variable is no time

  std::vector<Coordinate> coordinates;
  std::vector<Parameter> parameters;  // in the order of the text; anonymous constants at the end
  std::vector<Input> inputs;
  std::vector<Definition> definitions;
  std::vector<Rate> rates;  // in the order of the text
  std::vector<Frame> frames;
  std::vector<Point> points;
  std::vector<Body> bodies;
  std::vector<Link> links;
  ExprVector gravity;  // [dimension], or empty

  std::vector<EnergyTerm> kinetic;                // T
  std::vector<EnergyTerm> potential;              // V
  std::vector<EnergyTerm> generalized_potential;  // U
  std::vector<EnergyTerm> dissipation;            // D
  std::vector<EnergyTerm> lagrangian_extra;       // L += …
  std::optional<EnergyTerm> lagrangian_given;     // L = … : then T, V, U are not used for L
  std::vector<EnergyClaim> claims;
  std::vector<AppliedForce> forces;
  std::vector<Constraint> constraints;  // as written; those of quaternions at the end
  std::vector<Gauge> gauges;
  std::vector<HigherDerivative> higher;  // in the order of the coordinates
  Expr higher_lagrangian;                // L as written, in q, q', q'', t; empty where `higher` is
  std::vector<Release> releases;
  std::vector<IntegralConstraint> integral_constraints;
  std::vector<Contact> contacts;    // inequalities; their equations are those of a mode (contact_mode.hpp)
  std::vector<Friction> frictions;  // of coordinates
  ImpactLaw impact_law = ImpactLaw::Sequential;

  /// The same system with the symbols of definitions of parameters kept (`I φ''` instead of `1/2 m R^2 φ''`): what
  /// readable forms are derived from. Null if there are no such symbols. Substituting definition_values() turns its
  /// expressions into those of this system.
  std::shared_ptr<const MechanicalSystem> written;

  bool constrained() const { return !constraints.empty(); }
  /// Whether its motion goes through modes: contacts that open and close, friction that sticks and slides.
  bool has_modes() const { return !contacts.empty() || !frictions.empty(); }
  /// The unit of the independent variable: "s", "m"; empty for a bare number.
  std::string independent_unit() const;
  /// "t = 3 s", "x = 3 m".
  std::string moment(const std::string& number) const;

  Expr kinetic_energy() const;  // Σ kinetic, 0 if none
  Expr potential_energy() const;
  Expr total_generalized_potential() const;
  Expr dissipation_function() const;
  /// L = T − V − U (+ what L += adds), or the given L. In q, q', t, inputs; may hold TimeDerivative nodes.
  Expr lagrangian() const;
  /// Q_i from the applied forces by virtual work, Σ F·∂r/∂q_i + Σ τ·∂ω/∂q̇_i.           [n]
  ExprVector generalized_forces() const;
  /// Symbol of a definition → its value, for those that stay symbols in print.
  std::unordered_map<Expr, Expr, ExprHash> definition_values() const;
  const Coordinate* find_coordinate(std::string_view name) const;
  const Parameter* find_parameter(std::string_view name) const;
  const Point* find_point(std::string_view name) const;
  const Body* find_body(std::string_view name) const;
  const Constraint* find_constraint(std::string_view name) const;
  /// How messages call a contact: `floor`, "contact 2" where it has no name.
  std::string contact_label(std::size_t index) const;
  /// How messages call a constraint: `rod`, "constraint 2" where it has no name, "the norm of sat".
  std::string constraint_label(std::size_t index) const;
};

// ------------------------------------------------------------------------------------------------------- experiment

struct DrawElement {
  syntax::DrawItem::Kind kind{};
  std::vector<ExprVector> path;    // positions, world axes; Reaction: none
  std::vector<Expr> sizes;         // metres
  std::vector<std::string> names;  // of the points of the path, "" where it is an expression; Reaction: of what acts
  ExprVector direction = {};       // Disc, Hoop: the axis; Ground, Wall: the normal; empty: not written
  std::string text = {};           // Label: what is written there
};

/// start sat.ω = (0.01, 2, 0.01) rad/s, start P.x = 1 m: what the state must give, each a number. The positions give
/// what holds no velocity, the velocities the rest.
struct StartCondition {
  Expr formula;  // in q, q', t, parameters; affine in q'
  Expr value;
  std::string name;  // as written: sat.ω
  Span span;

  bool is_of_positions() const;
};

/// sweep Ω = 0 .. 12 rad/s steps 121: equally spaced values of one parameter.
struct Sweep {
  std::size_t parameter = 0;  // index in MechanicalSystem::parameters
  Expr from, to;              // SI
  std::size_t steps = 0;      // values, both ends counted
  Span span;
};

/// How steps are made. Automatic: Taylor's, and the stiff method from where stability limits them.
enum class StepMethod { Automatic, Taylor, Variational, Stiff };

/// Of numbers. Double: 53 bits. Quad: 113 bits, up to 33 digits. Digits100: 384 bits, up to 100 digits.
enum class NumberFormat { Double, Quad, Digits100 };

/// method variational order 4 step 10 ms: what a run takes where it is not told otherwise.
struct MethodChoice {
  StepMethod method = StepMethod::Automatic;
  int order = 0;  // 0: not written
  Expr step;      // SI; empty: not written
};

/// path from (0, 1) at 0 to (2, free) at 1: between what ends `maup action` looks for stationary paths.
struct PathEnds {
  std::vector<Expr> from, to;  // [n] parameters and numbers only, SI; empty handle: that coordinate is free there
  std::vector<Expr> from_rates, to_rates;  // [n] the same of q', which an end says where q'' stands in L
  Expr start, end;                         // of the independent variable, SI; start < end
  Span span;
};

/// A formula that was asked beside the model.
struct AskedFormula {
  Expr value;  // in q, q', q'', t, momenta, multipliers and reactions
  Dimension dimension;
  Span span;
};

/// What to do with a system: where it starts, how long it runs, what is drawn and what is expected.
struct Experiment {
  std::vector<StartValue> start;  // unwritten = 0
  std::vector<StartCondition> start_conditions;
  std::vector<StartValue>
      at;  // the point that is asked about; by overrides alone, as `asked`, `section` and `given_path`
  bool start_exactly = false;
  Expr start_time;    // empty: 0
  Expr duration;      // of `run 10 s`; empty if the model has none
  Expr until;         // `run until A = B`: A − B; empty if none
  Expr within;        // the longest time for `until`
  Expr output_every;  // empty: chosen by the program
  std::optional<MethodChoice> method;
  std::optional<NumberFormat> precision;
  std::optional<Sweep> sweep;
  std::optional<PathEnds> path;
  std::vector<ModelEvent> events;
  std::vector<DrawElement> drawing;
  std::vector<Expectation> expectations;
  std::vector<AskedFormula> asked;  // in the order of the overrides
  Expr section;                     // vanishes on it; empty if none was asked for
  std::optional<PathFormulas> given_path;
};

/// note "…": a sentence for readers, and what the statements before it are about.
struct Note {
  enum class Place {
    Beginning,  // of the text
    Coordinates,
    Positions,  // points, bodies, frames
    KineticEnergy,
    PotentialEnergy,
    Lagrangian,
    Forces,  // and dissipation
    Constraints,
    End,  // starts, runs, pictures, expectations
  } place = Place::Beginning;
  std::string text;
  Span span;
};

struct FieldModel;  // field_system.hpp

struct Model {
  MechanicalSystem system;
  Experiment experiment;
  /// The fields, where the model has some; else null. `system` has no coordinates then, and holds the parameters.
  std::shared_ptr<const FieldModel> fields = nullptr;
  std::vector<Note> notes = {};  // in the order of the text
};

/// Resolves names and units, infers dimensions, builds kinematics and energies. All mistakes go to `diagnostics`;
/// nothing is returned when there is an error. Physics lint is a pass of its own (`lint`).
/// Precondition: `overrides` were read with `tree`.
std::optional<Model> elaborate(const syntax::SyntaxTree& tree, const SourceText& source, Diagnostics& diagnostics,
                               const ExperimentOverrides& overrides = {});

/// Physics lint on an elaborated model: coordinates unused or without kinetic energy, claimed energies against those of
/// the points, velocities in V, total time derivatives in L, gravity counted twice, more coordinates than freedoms, …
void lint(const Model& model, const SourceText& source, Diagnostics& diagnostics);

/// The system as text, a line an item: `maup derive --emit system`.
std::string dump(const MechanicalSystem& system);

}  // namespace maupertuis

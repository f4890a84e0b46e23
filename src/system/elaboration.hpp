#pragma once
#include "system/declaration.hpp"
#include "system/pose.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/field_system.hpp>
#include <maupertuis/transform.hpp>

#include <functional>
#include <map>
#include <set>
#include <unordered_set>

/// The state of one `elaborate`, passed through its parts, and the parts themselves (a file each).
namespace maupertuis::elaboration {

/// Where a formula stands.
struct Place {
  const Pose* frame = nullptr;        // bracketed vectors are components along its axes (`in F`); null: world
  std::optional<Dimension> expected;  // the dimension that is asked for: chooses the culprit of a bad sum
  bool in_parameter = false;          // `param`: words after a number are units alone
  bool inline_constants = false;      // start, run, …: a quantity is its value, not an anonymous parameter
  bool reactions = false;             // expect, claim: multiplier(rod) and reaction(rod) may stand in it
};

struct Elaboration {
  const syntax::SyntaxTree& tree;
  SourceTexts texts;
  const ExperimentOverrides& overrides;
  Diagnostics& diagnostics;
  SymbolTable table;
  Model model;
  Context& context;
  std::map<DeclarationId, Pose> poses;            // of frames and bodies, and of the world under kWorld
  std::unordered_set<Expr, ExprHash> constants;   // the anonymous ones so far
  Bindings values;                                // of parameters, and of definitions that stay symbols
  ExprMap exact_values;                           // the same, exactly
  ExprMap exact_definitions;                      // symbols of definitions, by parameters
  std::unordered_set<std::string> unknown_names;  // told already
  bool dimension_clash = false;                   // told already
  bool dimensionless = false;
  bool independent_is_time = true;     // else L has any dimension, and there are no masses and forces
  bool lagrangian_settled = false;     // its first part has said what dimension that is
  std::shared_ptr<FieldModel> fields;  // null: the model has none
  std::set<std::size_t> higher;        // coordinates of which q'' stands in L
  std::optional<Span> dimension_from;  // the first vector: its length is the dimension of space

  Elaboration(const syntax::SyntaxTree& tree, const SourceTexts& texts, const ExperimentOverrides& overrides,
              Diagnostics& diagnostics);
  /// Of declarations beside the model, which share the context and the values of `outer`.
  Elaboration(const Elaboration& outer, const syntax::SyntaxTree& tree, Diagnostics& diagnostics);

  MechanicalSystem& system() { return model.system; }
  Experiment& experiment() { return model.experiment; }
  Expr number(const Rational& r) { return context.number(r); }
  Dimension dimension(const Dimension& d) const { return dimensionless ? Dimension{} : d; }
  /// Of the independent variable: q' has the dimension of q over it.
  Dimension time() const { return model.system.independent_dimension; }
};

// ---------------------------------------------------------------------------------------------------- expressions

/// Whether the words behind this number are names of a model without units: there no word can be a unit.
bool has_words_of_no_unit(Elaboration& e, const syntax::Expression& quantity);
/// The meaning of a formula. Mistakes are reported; the value is poisoned then.
Value evaluate_formula(Elaboration& e, const syntax::Expression& x, const Place& place = {});
/// The same, where one number of `expected` dimension must stand; `what` names the place: "a mass".
Value scalar_of(Elaboration& e, const syntax::Expression& x, const Dimension& expected, const std::string& what,
                Place place = {});
/// The same for a vector of space.
Value vector_of(Elaboration& e, const syntax::Expression& x, const Dimension& expected, const std::string& what,
                Place place = {});
/// A name as it stands in a formula. Unknown ones are reported.
Value value_of_name(Elaboration& e, const syntax::Expression& x, const Place& place);
Value value_of_member(Elaboration& e, const syntax::Expression& x, const Place& place);
Value value_of_call(Elaboration& e, const syntax::Expression& x, const Place& place);
/// multiplier(rod) or reaction(rod).
Value value_of_reaction(Elaboration& e, const syntax::Expression& x, const Place& place);
/// friction(floor), friction(x)
Value value_of_friction(Elaboration& e, const syntax::Expression& x, const Place& place);
/// λ of a constraint, with its dimension.
Value value_of_multiplier(Elaboration& e, const Constraint& c);
/// A number or vector with unit words.
Value value_of_number(Elaboration& e, const syntax::Expression& x);
Value value_of_quantity(Elaboration& e, const syntax::Expression& x, const Place& place);
/// What to write where words after a number were read as a unit and one of them is the time, or a name with which they
/// would be of the expected dimension: 5 N/s t is newtons over seconds and tonnes. Empty for all else.
std::string advice_on_words(Elaboration& e, const syntax::Expression& x, const Dimension& expected);
/// Whether `x` is a habit of paper that the language does not have (e^x, d/dt θ, 9.81 m/s^2): then it was told.
bool tell_habit(Elaboration& e, const syntax::Expression& x);
/// d/dt (r^2 θ'), m d/dt (l θ'): the derivative of what stands in the brackets, d and dt no names of the model.
std::optional<Value> derivative_of_bracket(Elaboration& e, const syntax::Expression& x, const Place& place);
/// A sum, a product, a power of values.
Value add(Elaboration& e, const Value& a, const Value& b, bool subtract, const syntax::Expression& x,
          const Place& place);
Value multiply(Elaboration& e, const Value& a, const Value& b, const syntax::Expression& x);
Value divide(Elaboration& e, const Value& a, const Value& b, const syntax::Expression& x);
Value power(Elaboration& e, const Value& base, const Value& exponent, const syntax::Expression& x);
Value dot_product(Elaboration& e, const Value& a, const Value& b, const syntax::Expression& x);
Value cross_product(Elaboration& e, const Value& a, const Value& b, const syntax::Expression& x);
Value negative(Value v);
Value time_derivative(Elaboration& e, Value v, int times, const syntax::Expression& x);

/// False, and a message, if the dimension of `v` is not `expected`. `what`: "a mass", "the kinetic energy T".
bool check_dimension(Elaboration& e, const Value& v, const Dimension& expected, const std::string& what,
                     const syntax::Expression& x);
/// What most often lies behind a wrong dimension: "A velocity is missing as a factor."; empty if nothing is near.
std::string dimension_advice(const Dimension& found, const Dimension& expected);
/// The number or the parameter without a unit that a product begins with: 10 of 10 t, ω of ω (t − t0); null if none.
const syntax::Expression* bare_factor(Elaboration& e, const syntax::Expression& x);
/// The value of an expression of parameters and definitions; nothing if time, coordinates or inputs are in it.
std::optional<double> constant_value(const Elaboration& e, Expr value);
/// False, and a message, if the values of the parameters make it infinite or undefined.
bool is_finite(Elaboration& e, Expr value, const syntax::Expression& x, const std::string& what);
/// W0310 where a bare number meets an angle and can hardly be in radians: `start θ = 60`, `cos(θ + 30)`.
void warn_of_degrees(Elaboration& e, const Value& v, const Dimension& beside, const syntax::Expression& x,
                     bool in_formula = false);
/// Finds what `text` could be and reports it: unknown name, or a unit that needs brackets.
void unknown_name(Elaboration& e, const std::string& text, Span span);
/// A name that a statement mentions; null, and a message, if there is none of it.
Declaration* find_declared(Elaboration& e, const syntax::Name& name);
/// The part of `x` that holds a time derivative of this order, for the caret.
Span culprit_of_order(Elaboration& e, const syntax::Expression& x, int order);
/// E0401 where an acceleration stands in an energy, force or D.
bool refuse_acceleration(Elaboration& e, const Value& v, const syntax::Expression& x, const std::string& where);

// ------------------------------------------------------------------------------------------------------ the parts

void fix_space_dimension(Elaboration& e);
/// Vectors in 2-D and 3-D do not mix (E0211).
bool check_components(Elaboration& e, std::size_t count, Span span);

void elaborate_parameter(Elaboration& e, Declaration& d);
void elaborate_coordinate(Elaboration& e, Declaration& d);
void elaborate_definition(Elaboration& e, Declaration& d);
void elaborate_input(Elaboration& e, Declaration& d);
void elaborate_rate(Elaboration& e, Declaration& d);
/// E0257, E0258: rates that depend on each other, or are more than the constraints leave.
void check_rates(Elaboration& e);
void elaborate_frame(Elaboration& e, Declaration& d);
void elaborate_point(Elaboration& e, Declaration& d);
void elaborate_body(Elaboration& e, Declaration& d);
/// Fills T, V, U, L or D of the system, from statements, masses, gravity, springs and dampers.
void elaborate_energy(Elaboration& e, syntax::EnergyStatement::Which which, Declaration& d);
void elaborate_forces(Elaboration& e);
/// Fills `constraints`, and names their multipliers.
void elaborate_constraints(Elaboration& e);
void elaborate_gauges(Elaboration& e);
/// Contacts, friction and the law of impacts; after the constraints.
void elaborate_contacts(Elaboration& e);
/// Makes μ the part of λ that friction is, where the gap of a contact is not the distance to the surface; W0435.
void set_normal_forces(MechanicalSystem& system, Diagnostics& diagnostics);
/// `event` statements; after the contacts.
void elaborate_event(Elaboration& e, const syntax::EventStatement& s, Span span);
/// A relation is differentiated twice along the motion: a drive in it is taken as the formula of t that it is.
Expr with_inputs_as_formulas(const MechanicalSystem& s, Expr value);
/// left − right of a condition along the motion; an empty handle after a mistake.
Expr condition(Elaboration& e, const syntax::Expression& left, const syntax::Expression& right, const char* what);
/// E0401, E0289 where a formula has no value at an instant of the motion: it holds a third derivative that is none of
/// the state, or a field without a place.
bool refuse_along_motion(Elaboration& e, const Value& v, const syntax::Expression& x);
/// The coordinate or velocity that `x` names; nothing, and a message, if it is none.
std::optional<StartValue> start_variable(Elaboration& e, const syntax::Expression& x);
/// The name of a constraint or of a release; false, and a message, if it is none.
bool names_a_reaction(Elaboration& e, const syntax::Name& name);
/// `expect constraint roll is nonholonomic`: whether there is such a constraint, and such a class.
bool check_class_of_constraint(Elaboration& e, const syntax::expectation::ConstraintClass& x);
void elaborate_release(Elaboration& e, const syntax::ReactionStatement& s);

/// `rotation quaternion` without components: the body or frame has four coordinates, whose norm is constrained.
bool has_own_quaternion(const Declaration& d);
void add_quaternion_coordinates(Elaboration& e, Declaration& d);
ExprVector quaternion_coordinates(Elaboration& e, const Declaration& d);
/// Index of the coordinate that `sat.qw` names; nothing if `x` is none.
std::optional<std::size_t> quaternion_component(Elaboration& e, const syntax::Expression& x);
void constrain_quaternions(Elaboration& e);
/// (1, 0, 0, 0) where the model does not say otherwise.
void start_quaternions(Elaboration& e);
/// A number that is known before the run, of parameters and quantities alone.
Value constant_of(Elaboration& e, const syntax::Expression& x, const Dimension& expected, const std::string& what);
/// The same for a frequency or eigenvalue that is expected: N0252 where it has no value with these parameters, which is
/// for `test` to tell.
Value expected_constant_of(Elaboration& e, const syntax::Expression& x, const Dimension& expected,
                           const std::string& what);
/// The same for a vector.
Value constant_vector_of(Elaboration& e, const syntax::Expression& x, const Dimension& expected,
                         const std::string& what);
/// `θ' = 2 rad/s` of a start; nothing, and a message, if it is none.
std::optional<StartValue> start_value(Elaboration& e, const syntax::StartStatement::Item& item);
/// Whether a start gives a rate: `v` of `rates v = …`, or that of a body: `sat.ω`, `sat.ω_world`, `sat.ω.x`.
bool is_rate(Elaboration& e, const syntax::Expression& x);
/// Whether a start gives a rate, or a point or body by its place or velocity: `P`, `P.x`, `P'`, `P.x'`.
bool is_start_condition(Elaboration& e, const syntax::Expression& x);
/// `sat.ω = (0, 2, 0) rad/s`, `P.x = 1 m`: one condition a component; none, and a message, after a mistake.
std::vector<StartCondition> start_conditions(Elaboration& e, const syntax::StartStatement::Item& item);
/// The velocities that rates of a point ask for, added to its values. False, and a message, where none give them.
bool add_velocities_of_rates(Elaboration& e, const std::vector<StartCondition>& rates, std::vector<StartValue>& values);
void elaborate_experiment(Elaboration& e);
void elaborate_notes(Elaboration& e);
void elaborate_expectation(Elaboration& e, const syntax::ExpectStatement& s, Span span);
/// What a line says; nothing after a mistake.
using Expected = std::optional<expectation::Kind>;
/// One number that stands in a formula; `what` is told in E0210 where it is a vector.
std::optional<Value> number_of(Elaboration& e, const syntax::Expression& x, const Place& place, const char* what);
/// As written; the namespace of what they mean is `expectation`.
namespace written = syntax::expectation;
/// The quantity below signs, whose unit the value is shown in.
const syntax::Expression& unsigned_quantity(const syntax::Expression& x);
/// The unit in which `value` is written, where it is one of `dimension`: that in which what comes out is shown.
std::optional<expectation::DisplayUnit> display_unit(Elaboration& e, const syntax::Expression& value,
                                                     const Dimension& dimension);
/// ± 1e-9 is in the unit of the value, unless it has one of its own; rel 1e-9 is a bare number. Nothing after a
/// mistake. `hertz`: it was written in turns.
std::optional<expectation::Tolerance> tolerance_of(Elaboration& e, const syntax::Tolerance& tolerance,
                                                   const Dimension& dimension, const expectation::DisplayUnit& unit,
                                                   bool* hertz = nullptr);
/// A value known before the run with its tolerance; `what` names it in messages.
std::optional<expectation::Number> expected_number(Elaboration& e, const written::Number& number,
                                                   const Dimension& dimension, const std::string& what);
/// The configuration of `at θ = 0, φ' = 2 rad/s`.
std::optional<std::vector<StartValue>> point_of_expectation(Elaboration& e, const written::Point& point);
/// E0246 where the run does not end at a condition.
bool refuse_without_until(Elaboration& e, Span span);
// linear_expectations.cpp
Expected meaning_of(Elaboration& e, const written::Eigenvalues& x, Span line);
Expected meaning_of(Elaboration& e, const written::Matrix& x, Span line);
Expected meaning_of(Elaboration& e, const written::Stable& x, Span line);
Expected meaning_of(Elaboration& e, const written::Multipliers& x, Span line);
Expected meaning_of(Elaboration& e, const written::Trace& x, Span line);
Expected meaning_of(Elaboration& e, const written::Period& x, Span line);
/// `method` and `precision`.
void elaborate_method(Elaboration& e, const syntax::MethodStatement& s);
void elaborate_precision(Elaboration& e, const syntax::PrecisionStatement& s);
void elaborate_drawing(Elaboration& e, const syntax::DrawStatement& s);

/// The name of what stands in the place of t; before any expression is made.
void name_independent(Elaboration& e);
/// Its dimension; after the coordinates. False, and E0240, where a model without the time has masses, forces or
/// energies.
bool elaborate_independent(Elaboration& e);
/// A text with the name of the independent variable in the place of `time` or `the time`: "the start x".
std::string in_words(const Elaboration& e, std::string text);
void elaborate_path(Elaboration& e, const syntax::PathStatement& s, Span span);
void elaborate_integral_constraint(Elaboration& e, const syntax::ConstraintStatement& s, Span span);
/// expect action, expect index, expect path.
Expected meaning_of(Elaboration& e, const written::Action& x, Span line);
Expected meaning_of(Elaboration& e, const written::ActionAlong& x, Span line);
Expected meaning_of(Elaboration& e, const written::MorseIndex& x, Span line);
Expected meaning_of(Elaboration& e, const written::PathAt& x, Span line);
/// x = 4 t, y = 3 t + 5 of the overrides.
void override_given_path(Elaboration& e);

/// The pose of a frame or body by its name; null, and a message, if it is none.
const Pose* find_pose(Elaboration& e, const std::optional<syntax::Name>& name);
/// A place: components along `frame` from its origin, or points and vectors of the world. Null handle parts on error.
Value position_of(Elaboration& e, const syntax::Expression& x, const Pose* frame);
/// The pose of the frame or body `d`; its place and its rotation may both be absent. Nothing: a mistake was reported.
std::optional<Pose> pose_of(Elaboration& e, const Declaration& d, const syntax::ExpressionPtr& at,
                            const std::optional<syntax::Rotation>& rotation, const std::optional<syntax::Name>& in);
/// ½ m v²
Expr translational_energy(Expr mass, const ExprVector& position);

// fields.cpp, field_values.cpp, field_expectations.cpp
/// The space variables and the fields of the model, before anything is made of them. False where there are none.
bool declare_fields(Elaboration& e);
/// Densities, boundaries, forces; after the definitions.
void elaborate_fields(Elaboration& e);
/// start u = …
bool start_of_field(Elaboration& e, const syntax::StartStatement::Item& item);
/// u_x, u_tx of a field; nothing where the name is none.
std::optional<Value> value_of_jet(Elaboration& e, const syntax::Expression& x);
/// E0289 where a field or a space variable stands in a value that is asked at a time: no place says where.
bool refuse_without_place(Elaboration& e, Expr value, const syntax::Expression& x);
/// u(3 m)
Value value_at_place(Elaboration& e, const syntax::Expression& x);
Expected meaning_of(Elaboration& e, const written::OfField& x, Span line);
/// equilibrium at u(l/2) = 1 m ± 1e-9, θ = 0: in a model with fields; nothing, kept among the expectations of fields.
Expected equilibrium_of_fields(Elaboration& e, const written::Equilibrium& x, Span line);
void check_statement_counts(Elaboration& e);
/// Parameters that nothing names, definitions that nothing uses.
void warn_unused(Elaboration& e);
/// Replaces the symbols of definitions everywhere and keeps the system as written beside it.
void expand_definitions(Model& model);
/// p_x of events, `run until`, sections and normal forces becomes ∂L/∂x'. After definitions, which may hold x', are
/// expanded.
void replace_momenta(Model& model);
/// A root has no series where it vanishes: the condition `norm(P) = 0` becomes `norm(P)^2 = 0`, `acos(x) = 0` x = 1.
/// Factors of a product lose theirs too. Conditions that rise or fall keep roots of what may be negative. After
/// definitions, which may be roots, are expanded.
void take_roots_off_conditions(Experiment& x);
/// Calls `visit` on every expression of an experiment, and `starts` first on each list of values of a state.
void visit_experiment(Experiment& x, const std::function<void(Expr&)>& visit,
                      const std::function<void(std::vector<StartValue>&)>& starts);
/// Where q'' stands in L: the equivalent system without it (HigherDerivative). E0259 beside what does not go with it.
void replace_higher_derivatives(Elaboration& e);

/// Values of parameters in the place of the model's, before anything is made of them; overrides.cpp.
void override_parameters(Elaboration& e);
/// The values of a start and of the point that is asked about; after the model's own.
void override_start(Elaboration& e);

}  // namespace maupertuis::elaboration

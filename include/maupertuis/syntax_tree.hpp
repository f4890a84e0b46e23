#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/source.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// The tree of a model text: words and structure only. Names are normalized (NFC, theta → θ, θ₁ → θ1) but not
/// resolved; whether `2 m` is two metres or twice the mass is decided by `system`.
namespace maupertuis::syntax {

struct Expression;
using ExpressionPtr = std::shared_ptr<const Expression>;

/// A normalized name with the place where it stands.
struct Name {
  std::string text;
  Span span;
};

/// A product of unit words with rational exponents, as written: "N m s^-2", "J/(kg K)", "1/s".
struct UnitExpression {
  struct Factor {
    std::string word;
    int exponent_numerator = 1;
    int exponent_denominator = 1;
    Span span;
  };
  std::vector<Factor> factors;  // empty: a bare number
  Span span;
};

enum class Operator : std::uint8_t {
  Add,
  Subtract,
  Multiply,
  Juxtapose,
  Divide,
  Dot,
  Cross,  // Dot, Cross: the signs · and ×
  Power,
  Negate,
  Less,
  LessEqual,
  Greater,
  GreaterEqual,
  And,
  Or,
};

struct Expression {
  enum class Kind : std::uint8_t {
    Number,    // number
    Quantity,  // number or vector (arguments[0]) followed by unit words, in a quantity place, or `3 [J]` in a formula;
               // `-10 deg` is Negate(Quantity), a number without unit words is a Number
    Name,      // name, with `primes` time derivatives
    Member,    // arguments[0] . name, with `primes`: P.x', B.ω
    Call,      // name(arguments...): functions of rule 7, dot, cross, norm, reaction, multiplier
    Vector,    // (a, b) or (a, b, c)
    Binary,    // op, arguments[0], arguments[1]
    Unary,     // op (Negate), arguments[0]
    TimeDerivative,  // dot(expr) of one argument, or (expr)' : arguments[0], `primes` times; dot(θ) is the Name θ'
    Piecewise,       // arguments: condition, value, ..., else value
  };
  Kind kind = Kind::Number;
  Span span;
  std::string text;  // Number: the digits as written; Name, Member, Call: the normalized name
  Span name_span;    // of `text`
  int primes = 0;
  Operator op = Operator::Add;
  bool bracketed = false;              // stood in brackets of its own
  bool bare = false;                   // Call without brackets: sin θ, reaction rod
  bool unit_bracketed = false;         // Quantity of a formula, `3 [J]`: the words are units and never names
  int depth = 1;                       // of the tree below; parse bounds it, so that recursion over it is safe
  std::optional<UnitExpression> unit;  // Quantity
  std::vector<ExpressionPtr> arguments;
};

// ------------------------------------------------------------------------------------------------------- statements

struct Comment {
  std::string text;  // with its #
  Span span;
};

struct SystemStatement {
  Name name;
  std::string title;
};
struct SourceStatement {
  std::string citation;
};
struct DimensionlessStatement {};
/// A sentence for readers, which stands in reports and lectures where it stands in the text.
struct NoteStatement {
  std::string text;
};

struct ParamStatement {
  struct Item {
    Name name;
    ExpressionPtr value;
  };  // value: a Quantity, or a formula (an error of `system` offers let)
  std::vector<Item> items;
};
struct CoordStatement {
  /// kind is "angle", "length", "charge", "number", or empty with `unit` set for a unit in brackets.
  struct Item {
    Name name;
    Name kind;
    std::optional<UnitExpression> unit;
  };
  std::vector<Item> items;
};
struct LetStatement {
  struct Item {
    Name name;
    ExpressionPtr value;
  };
  std::vector<Item> items;
};
/// rates ω1, ω2, ω3 = B.ω, v = x' cos ψ + y' sin ψ
struct RatesStatement {
  struct Group {
    std::vector<Name> names;
    ExpressionPtr value;  // one component a name
  };
  std::vector<Group> groups;
};
struct InputStatement {
  Name name;
  std::vector<Name> variables;  // input q(x): a given function of space variables and t; value null: any function
  std::optional<UnitExpression> unit;
  ExpressionPtr value;
};

struct Rotation {
  enum class Kind { Angle, AxisAngle, Euler, RollPitchYaw, Quaternion, QuaternionCoordinates };
  Kind kind = Kind::Angle;
  std::string sequence;  // Euler: "zxz"
  Span sequence_span;
  ExpressionPtr axis;                 // AxisAngle
  std::vector<ExpressionPtr> values;  // 1 angle, 3 angles, 4 components, or none
  Span span;
};
struct FrameStatement {
  Name name;
  ExpressionPtr at;
  std::optional<Rotation> rotation;
  std::optional<Name> in;
};
struct PointStatement {
  Name name;
  ExpressionPtr mass;
  ExpressionPtr at;
  std::optional<Name> in;
};  // mass may be null
struct BodyStatement {
  Name name;
  ExpressionPtr mass;  // null: rotation only
  enum class Inertia { None, Scalar, Diagonal, Full } inertia_kind = Inertia::None;
  std::vector<ExpressionPtr> inertia;  // 1, 3, or 6 (xx, yy, zz, xy, xz, yz)
  Span inertia_span;
  ExpressionPtr at;  // null: at the origin of its frame
  std::optional<Rotation> rotation;
  std::optional<Name> in;
};
struct GravityStatement {
  ExpressionPtr vector;
};
struct SpringStatement {
  ExpressionPtr from, to, stiffness, length;
};  // length null: 0
struct DamperStatement {
  ExpressionPtr from, to, coefficient;
};
struct TorsionSpringStatement {
  Name coordinate;
  ExpressionPtr stiffness, rest;
};  // rest null: 0
struct EnergyStatement {
  enum class Which { T, V, U, L, D } which = Which::T;
  bool adds = false;  // +=
  ExpressionPtr value;
  Span name_span;
};
struct ForceStatement {
  enum class Target { Point, TorqueOnBody, Coordinate } target = Target::Coordinate;
  Name on;                   // point, body or coordinate
  std::optional<Name> from;  // torque on B from A
  ExpressionPtr value;
  std::optional<Name> in;
};

struct StartStatement {
  bool exactly = false;
  struct Item {
    ExpressionPtr variable;
    ExpressionPtr value;
  };  // variable: Name or Member with primes
  std::vector<Item> items;
  ExpressionPtr at;  // start at 2 s
};
struct RunStatement {
  ExpressionPtr duration;                 // run 10 s
  ExpressionPtr until_left, until_right;  // run until A = B
  ExpressionPtr within;                   // null: beside a model, where none is written
};
struct OutputStatement {
  ExpressionPtr every;
};
/// method variational order 4 step 10 ms;  method stiff
struct MethodStatement {
  Name word;
  int order = 0;
  ExpressionPtr step;
};  // order 0, step null: not written
/// precision quad, precision 100
struct PrecisionStatement {
  Name word;
};

struct DrawItem {
  enum class Kind {
    Line,
    Trail,
    Box,
    Circle,
    Spring,
    Reaction,
    Disc,
    Hoop,
    Ellipsoid,
    Damper,
    Pivot,
    Ground,
    Wall,
    Label,
    Follow
  } kind = Kind::Line;
  std::vector<ExpressionPtr>
      path;  // Line: the points; Spring, Damper: two; Reaction: the call, `reaction rod`; others: one
  std::vector<ExpressionPtr>
      sizes;                // Box: width, height, perhaps depth; Ellipsoid: semi-axes; Circle, Disc, Hoop: radius
  ExpressionPtr direction;  // Disc, Hoop: the axis; Ground, Wall: the normal; null: not written
  std::string text;         // Label; empty: the name of the point
  Span span;
};
struct DrawStatement {
  std::vector<DrawItem> items;
};

struct ReactionStatement {
  Name name;
  Name released;
};  // reaction rod = release l1

struct Equation {
  ExpressionPtr left, right;
};  // P.y = 0

/// ± 1e-9 or rel 1e-9; size null where none is written.
struct Tolerance {
  ExpressionPtr size;
  bool relative = false;
};

struct FieldClause;       // field_statements.hpp
struct FieldExpectation;  // field_statements.hpp

/// What stands behind `expect` and `claim`: a struct a kind.
namespace expectation {

struct Number {
  ExpressionPtr value;
  Tolerance tolerance;
};                                             // 0.5 rad ± 1e-9
struct Spectrum {                              // -0.1 1/s, (-0.2, 1.3) 1/s rel 1e-9
  std::vector<ExpressionPtr> real, imaginary;  // [values] imaginary: null where none is written
  Tolerance tolerance;
};
using Point = std::vector<StartStatement::Item>;  // at θ = 0, φ' = 2 rad/s

struct ValueAt {
  ExpressionPtr subject, time;
  Number expected;
};  // θ at 10 s = …; θ = …, at the start: time null
struct ValueAtUntil {
  ExpressionPtr subject;
  Number expected;
};  // θ at until = …
struct UntilAt {
  Number expected;
};  // until at 1.2 s ± 1e-9
struct EnergyConserved {
  Tolerance tolerance;
};  // energy conserved rel 1e-13
struct ConservedAlongRun {
  ExpressionPtr subject;
  Tolerance tolerance;
};  // conserved F rel 1e-13
struct Conserved {
  ExpressionPtr subject;
  std::vector<Equation> where;
};  // conserved F where p_φ = 0
struct NotConserved {
  ExpressionPtr subject;
};  // F not conserved
struct Integral {
  ExpressionPtr subject;
};                                  // integral F
using Equation = syntax::Equation;  // equation left = right; claim left = right
struct Hamiltonian {
  ExpressionPtr value;
};  // hamiltonian = H
struct Routhian {
  std::vector<ExpressionPtr> coordinates;
  ExpressionPtr value;
};  // routhian of φ, ψ = R
struct Bracket {
  ExpressionPtr a, b, value;
  bool dirac = false;
};  // bracket (A, B) = C; dirac bracket (A, B) = C
struct PhaseConstraints {
  std::vector<std::vector<ExpressionPtr>> generations;
};  // constraints : p_y ; z ; p_x
struct ClassCount {
  std::string what;
  ExpressionPtr number;
};  // first class = 3; second class, physical freedoms, motions, free functions
struct Freedoms {
  ExpressionPtr number;
};  // freedoms = 2
struct ConstraintClass {
  Name constraint, word;
};                    // constraint roll is nonholonomic
struct Frequencies {  // frequencies [squared] at θ = 0 : 0.5 Hz rel 1e-9
  bool squared = false;
  Point at;
  std::vector<ExpressionPtr> values;
  Tolerance tolerance;
};
struct Eigenvalues {
  Point at;
  Spectrum expected;
};                                           // eigenvalues at θ = 0 : …
struct Matrix {                              // A in (x, x') at x = 0 : ((2, 1), (1, 1)) ± 1e-9
  Name letter;                               // M; A, B, C, G, K, N of the linearization
  std::vector<ExpressionPtr> rows, columns;  // variables; none: all
  Point at;
  std::vector<ExpressionPtr> entries;  // by rows
  std::size_t width = 0;               // entries in a row
  Tolerance tolerance;
};
struct Place {
  StartStatement::Item value;
  Tolerance tolerance;
};
struct Equilibrium {
  std::vector<Place> at;
  Name word;
};               // equilibrium at θ = 0 ± 1e-7 is stable; or no word
struct Stable {  // stable for Ω < 5.7 rad/s ± 1e-2 at θ = 0
  Name word;     // stable, unstable
  ExpressionPtr parameter;
  bool above = false;  // for Ω > …
  Number critical;
  Point at;
};
struct Multipliers {
  ExpressionPtr over;
  Spectrum expected;
};  // multipliers over 2 s : …; over null: not written
struct Trace {
  ExpressionPtr over;
  Number expected;
};  // trace over 2 s = …
struct Period {
  ExpressionPtr over;
  Number expected;
};  // period over 2 s = …
struct Action {
  int path = 0;
  Number expected;
};                    // action = …; action of path 2 = …; 0: not written
struct ActionAlong {  // action of (x(t), y(t)) from 0 s to 10 s = …
  std::vector<ExpressionPtr> q;
  ExpressionPtr from, to;  // null: the ends of the model's `path`
  Number expected;
};
struct MorseIndex {
  int path = 0;
  ExpressionPtr index;
};  // index of path 2 = 1
struct PathAt {
  int path = 0;
  ExpressionPtr subject, time;
  Number expected;
};  // path 2 x at 0.5 s = …
struct Event {
  Name name;    // of an event or a contact
  Name change;  // of a contact: impact, made, lost, stick, slip; empty: any
  int occurrence = 1;
  Number time;
};  // event hit 3 at 0.45 s ± 1e-11;  event floor lost at 0.9 s ± 1e-11
struct EventCount {
  Name name, change;
  ExpressionPtr number;
};  // event floor impact = 12: as often along the run
struct Error {
  Name code;
};  // error E0412
struct OfField {
  std::shared_ptr<const FieldExpectation> said;
};  // natural …, solution …, current …, …: field_statements.hpp

using Kind = std::variant<ValueAt, ValueAtUntil, UntilAt, EnergyConserved, ConservedAlongRun, Conserved, NotConserved,
                          Integral, Equation, Hamiltonian, Routhian, Bracket, Freedoms, ConstraintClass, Frequencies,
                          Eigenvalues, Matrix, Equilibrium, Stable, Multipliers, Trace, Period, Action, ActionAlong,
                          MorseIndex, PathAt, Event, EventCount, PhaseConstraints, ClassCount, Error, OfField>;

}  // namespace expectation

struct ExpectStatement {
  bool claim = false;
  expectation::Kind kind;
  std::optional<Span> with = std::nullopt;  // … with s = -1: the values, as a text
};

/// constraint LEFT = RIGHT name rod,   constraint integral LEFT = RIGHT name length
struct ConstraintStatement {
  ExpressionPtr left, right;
  std::optional<Name> name;
  bool integral = false;  // ∫ left over the path = right
};

/// gauge LEFT = RIGHT
struct GaugeStatement {
  ExpressionPtr left, right;
};

/// sweep Ω = 0 .. 12 rad/s steps 121
struct SweepStatement {
  ExpressionPtr variable, from, to, steps;
};  // steps null: beside a model, not written

/// independent x : length. Stands in the place of t.
struct IndependentStatement {
  Name name;
  Name kind;  // as of a coordinate; empty with `unit` set, or where nothing is written
  std::optional<UnitExpression> unit;
};

/// path from (0, 1) at 0 to (2, free) at 1
struct PathStatement {
  struct End {
    std::vector<ExpressionPtr> configuration;  // in the order of the coordinates; null where `free` stands
    std::vector<ExpressionPtr> names;          // (x = 0, x' = 1): of what each value is; empty where none is named
    ExpressionPtr at;
    Span span;  // of the configuration
  } from, to;
};

/// contact EXPR >= EXPR restitution e friction μ static μs slip EXPR name floor;  … slip EXPR sticking
struct ContactStatement {
  ExpressionPtr left, right;
  bool at_most = false;                                        // <=
  ExpressionPtr restitution, friction, static_friction, slip;  // null: not written
  bool sticking = false;
  std::optional<Name> name;
};

/// friction q coefficient μ static μs normal EXPR,   friction q limit EXPR static EXPR
struct FrictionStatement {
  ExpressionPtr coordinate, coefficient, static_friction, normal, limit;  // null: not written
};

/// event hit when EXPR = EXPR rising : record / stop / set x' = -x', y' = y'
struct EventStatement {
  Name name;
  ExpressionPtr left, right;
  int direction = 0;  // 1: rising, -1: falling, 0: both
  enum class Action { Record, Stop, Set } action = Action::Record;
  std::vector<StartStatement::Item> sets;
};

/// impact sequential / simultaneous
struct ImpactStatement {
  bool simultaneous = false;
};

/// field, density, dissipation density, boundary, force density, force at a place of a field: what they say stands in
/// field_statements.hpp.
struct FieldStatement {
  std::string what;  // its words: "field", "density", …
  std::shared_ptr<const FieldClause> said;
};

using StatementBody =
    std::variant<SystemStatement, SourceStatement, DimensionlessStatement, ParamStatement, CoordStatement, LetStatement,
                 InputStatement, FrameStatement, PointStatement, BodyStatement, GravityStatement, SpringStatement,
                 DamperStatement, TorsionSpringStatement, EnergyStatement, ForceStatement, StartStatement, RunStatement,
                 OutputStatement, MethodStatement, PrecisionStatement, DrawStatement, ReactionStatement,
                 ExpectStatement, ConstraintStatement, SweepStatement, IndependentStatement, PathStatement,
                 ContactStatement, FrictionStatement, EventStatement, ImpactStatement, GaugeStatement, RatesStatement,
                 FieldStatement, NoteStatement>;

struct Statement {
  StatementBody body;
  Span span;  // from its first word to its last
};

class Declarations;

struct SyntaxTree {
  std::vector<Statement> statements;  // in the order of the text
  std::vector<Comment> comments;
  /// Declared by statements that were left out because of an error: a use of one of them is no second mistake.
  std::vector<Name> lost_names;
  /// The names that the text declares: they decide how a text beside it is read. Null where the text has no statement.
  std::shared_ptr<const Declarations> declarations;
};

/// Reads a model text. Errors go to `diagnostics`, all of them; a statement with an error is left out, the rest stands.
/// Time and memory are linear in the text; nesting is bounded (E0108), so is the size of the text (E0101).
SyntaxTree parse(const SourceText& source, Diagnostics& diagnostics);

/// Parts of statements in a text of their own beside the model, such as an option of a command line or a field of a
/// form. They are read with the names that `model` declares: these decide what `2e1` and `f(x)` mean. Nothing after a
/// mistake, which `diagnostics` tells at its place in `text`.
struct Assignment {
  ExpressionPtr variable, value;
};  // of a list x = 4 t, y = 3 t + 5
ExpressionPtr parse_formula(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
/// A number with its unit, or a formula of such.
ExpressionPtr parse_quantity(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
std::optional<Equation> parse_equation(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
std::optional<std::vector<Assignment>> parse_assignments(const SourceText& text, const SyntaxTree& model,
                                                         Diagnostics& diagnostics);
/// What stands behind the words `param`, `start`, `run`.
std::optional<ParamStatement> parse_parameters(const SourceText& text, const SyntaxTree& model,
                                               Diagnostics& diagnostics);
std::optional<StartStatement> parse_start(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
std::optional<RunStatement> parse_run(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
/// What stands behind `sweep`; the number of values may be left out, and `steps` is null then.
std::optional<SweepStatement> parse_sweep(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
/// What stands behind `path from`.
std::optional<PathStatement> parse_path(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);

/// The text in canonical layout (`maup fmt`). Idempotent; keeps comments and the order of statements.
/// Precondition: `source` parsed without errors to `tree`.
std::string format(const SyntaxTree& tree, const SourceText& source);

/// One expression in canonical layout; used in messages.
std::string to_string(const Expression& expression);

/// A line a node, indented: `maup derive --emit syntax`.
std::string dump(const SyntaxTree& tree);

}  // namespace maupertuis::syntax

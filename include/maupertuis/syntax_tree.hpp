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
  Add, Subtract, Multiply, Juxtapose, Divide, Dot, Cross,  // Dot, Cross: the signs · and ×
  Power, Negate,
  Less, LessEqual, Greater, GreaterEqual, And, Or,
};

struct Expression {
  enum class Kind : std::uint8_t {
    Number,       // number
    Quantity,     // number or vector (arguments[0]) followed by unit words, in a quantity place, or `3 [J]` in a formula;
                  // `-10 deg` is Negate(Quantity), a number without unit words is a Number
    Name,         // name, with `primes` time derivatives
    Member,       // arguments[0] . name, with `primes`: P.x', B.ω
    Call,         // name(arguments...): functions of rule 7, dot, cross, norm, reaction, multiplier
    Vector,       // (a, b) or (a, b, c)
    Binary,       // op, arguments[0], arguments[1]
    Unary,        // op (Negate), arguments[0]
    TimeDerivative, // dot(expr) of one argument, or (expr)' : arguments[0], `primes` times; dot(θ) is the Name θ'
    Piecewise,    // arguments: condition, value, ..., else value
  };
  Kind kind = Kind::Number;
  Span span;
  std::string text;             // Number: the digits as written; Name, Member, Call: the normalized name
  Span name_span;               // of `text`
  int primes = 0;
  Operator op = Operator::Add;
  bool bracketed = false;       // stood in brackets of its own
  bool bare = false;            // Call without brackets: sin θ, reaction rod
  bool unit_bracketed = false;  // Quantity of a formula, `3 [J]`: the words are units and never names
  int depth = 1;                // of the tree below; parse bounds it, so that recursion over it is safe
  std::optional<UnitExpression> unit;  // Quantity
  std::vector<ExpressionPtr> arguments;
};

// ------------------------------------------------------------------------------------------------------- statements

struct Comment {
  std::string text;  // with its #
  Span span;
};

struct SystemStatement { Name name; std::string title; };
struct SourceStatement { std::string citation; };
struct DimensionlessStatement {};

struct ParamStatement {
  struct Item { Name name; ExpressionPtr value; };  // value: a Quantity, or a formula (an error of `system` offers let)
  std::vector<Item> items;
};
struct CoordStatement {
  /// kind is "angle", "length", "charge", "number", or empty with `unit` set for a unit in brackets.
  struct Item { Name name; Name kind; std::optional<UnitExpression> unit; };
  std::vector<Item> items;
};
struct LetStatement {
  struct Item { Name name; ExpressionPtr value; };
  std::vector<Item> items;
};
struct InputStatement { Name name; std::optional<UnitExpression> unit; ExpressionPtr value; };

struct Rotation {
  enum class Kind { Angle, AxisAngle, Euler, RollPitchYaw, Quaternion, QuaternionCoordinates };
  Kind kind = Kind::Angle;
  std::string sequence;                  // Euler: "zxz"
  Span sequence_span;
  ExpressionPtr axis;                    // AxisAngle
  std::vector<ExpressionPtr> values;     // 1 angle, 3 angles, 4 components, or none
  Span span;
};
struct FrameStatement { Name name; ExpressionPtr at; std::optional<Rotation> rotation; std::optional<Name> in; };
struct PointStatement { Name name; ExpressionPtr mass; ExpressionPtr at; std::optional<Name> in; };  // mass may be null
struct BodyStatement {
  Name name;
  ExpressionPtr mass;                    // null: rotation only
  enum class Inertia { None, Scalar, Diagonal, Full } inertia_kind = Inertia::None;
  std::vector<ExpressionPtr> inertia;    // 1, 3, or 6 (xx, yy, zz, xy, xz, yz)
  Span inertia_span;
  ExpressionPtr at;                      // null: at the origin of its frame
  std::optional<Rotation> rotation;
  std::optional<Name> in;
};
struct GravityStatement { ExpressionPtr vector; };
struct SpringStatement { ExpressionPtr from, to, stiffness, length; };     // length null: 0
struct DamperStatement { ExpressionPtr from, to, coefficient; };
struct TorsionSpringStatement { Name coordinate; ExpressionPtr stiffness, rest; };  // rest null: 0
struct EnergyStatement {
  enum class Which { T, V, U, L, D } which = Which::T;
  bool adds = false;                     // +=
  ExpressionPtr value;
  Span name_span;
};
struct ForceStatement {
  enum class Target { Point, TorqueOnBody, Coordinate } target = Target::Coordinate;
  Name on;                               // point, body or coordinate
  std::optional<Name> from;              // torque on B from A
  ExpressionPtr value;
  std::optional<Name> in;
};

struct StartStatement {
  bool exactly = false;
  struct Item { ExpressionPtr variable; ExpressionPtr value; };   // variable: Name or Member with primes
  std::vector<Item> items;
  ExpressionPtr at;                      // start at 2 s
};
struct RunStatement {
  ExpressionPtr duration;                // run 10 s
  ExpressionPtr until_left, until_right; // run until A = B
  ExpressionPtr within;                  // null: beside a model, where none is written
};
struct OutputStatement { ExpressionPtr every; };
/// method variational order 4 step 10 ms;  method stiff
struct MethodStatement { Name word; int order = 0; ExpressionPtr step; };   // order 0, step null: not written
/// precision quad, precision 100
struct PrecisionStatement { Name word; };

struct DrawItem {
  enum class Kind {
    Line, Trail, Box, Circle, Spring, Reaction, Disc, Hoop, Ellipsoid, Damper, Pivot, Ground, Wall, Label, Follow
  } kind = Kind::Line;
  std::vector<ExpressionPtr> path;       // Line: the points; Spring, Damper: two; Reaction: the call, `reaction rod`; others: one
  std::vector<ExpressionPtr> sizes;      // Box: width, height, perhaps depth; Ellipsoid: semi-axes; Circle, Disc, Hoop: radius
  ExpressionPtr direction;               // Disc, Hoop: the axis; Ground, Wall: the normal; null: not written
  std::string text;                      // Label; empty: the name of the point
  Span span;
};
struct DrawStatement { std::vector<DrawItem> items; };

struct ReactionStatement { Name name; Name released; };            // reaction rod = release l1

/// expect … and claim …
struct ExpectStatement {
  enum class Kind {
    ValueAt,          // subject at `time` = value ± / rel tolerance
    EnergyConserved,  // expect energy conserved rel 1e-13
    Conserved,        // expect conserved EXPR [rel 1e-13]
    NotConserved,     // expect EXPR not conserved
    Equation,         // expect equation left = right;  claim left = right
    Freedoms,         // expect freedoms = 2
    ConstraintClass,  // expect constraint roll is nonholonomic
    Integral,         // expect integral EXPR
    Frequencies,      // expect frequencies at θ = 0 : list
    EventAt,          // expect event hit 3 at T ± tol
    Error,            // expect error E0412
    Equilibrium,      // expect equilibrium at θ = 0 is stable
    Action,           // expect action = VALUE ± tol;  expect action of (x(t), y(t)) = VALUE ± tol
    MorseIndex,       // expect index = 1
    PathAt,           // expect path x at 0.5 s = VALUE ± tol
    Value,            // expect EXPR = VALUE ± tol (no time: parameters only, or the start)
    Eigenvalues,      // expect eigenvalues at θ = 0 : -0.1 1/s, (-0.2, 1.3) 1/s rel 1e-9
    Matrix,           // expect M at q1 = 0 : ((2, 1), (1, 1)) kg m^2 ± tol; A, B, C, G, K, N of the linearization
    Stable,           // expect stable for Ω < 5.7 rad/s ± tol at θ = 0
    Multipliers,      // expect multipliers over 2 s : (0.98, 0.19) rel 1e-9
    Trace,            // expect trace over 2 s = 2.3 ± tol
    Period,           // expect period over 2 s = 2.1 s ± tol
    UntilAt,          // expect until at 1.2 s ± tol: when `run until` ends
  } kind = Kind::ValueAt;
  bool claim = false;
  Name name;                             // constraint, event, reaction; the code of Error; the letter of Matrix
  Name word;                             // nonholonomic, …
  ExpressionPtr subject, time, value;    // Equation: subject = value
  ExpressionPtr tolerance;               // ± (absolute) or rel
  bool relative = false;
  int occurrence = 0;                    // EventAt; Action, MorseIndex, PathAt: `path 2`; 0: the path with the smallest action
  std::vector<ExpressionPtr> values;     // Frequencies; Action: a given path, one a coordinate; none: the stationary path;
                                         // Eigenvalues, Multipliers: real parts; Matrix: its entries by rows
  std::vector<ExpressionPtr> imaginary;  // [values] Eigenvalues, Multipliers: imaginary parts, null where none is written
  std::size_t width = 0;                 // Matrix: entries in a row
  std::vector<ExpressionPtr> rows, columns;  // Matrix: `in (x, x') by u`, the variables of its rows and columns
  bool squared = false;                  // Frequencies: expect frequencies squared …
  std::vector<StartStatement::Item> at;  // Frequencies, Equilibrium and others about a point: `at θ = 0`
  struct Tolerance { ExpressionPtr size; bool relative = false; };
  std::vector<Tolerance> at_tolerances;  // [at] Equilibrium: `at θ = 0.84 ± 1e-7`; size null where none is written
  struct Level { ExpressionPtr left, right; };
  std::vector<Level> where;              // Conserved: `where p_φ = 0`
  bool at_until = false;                 // ValueAt: `at until` in the place of a time
  bool above = false;                    // Stable: `for Ω > …`
  ExpressionPtr from, to;                // Action of a given path: its ends; null: those of the model's `path`
};

/// constraint LEFT = RIGHT name rod,   constraint integral LEFT = RIGHT name length
struct ConstraintStatement {
  ExpressionPtr left, right;
  std::optional<Name> name;
  bool integral = false;                 // ∫ left over the path = right
};

/// sweep Ω = 0 .. 12 rad/s steps 121
struct SweepStatement { ExpressionPtr variable, from, to, steps; };  // steps null: beside a model, where none are written

/// independent x : length. Stands in the place of t.
struct IndependentStatement {
  Name name;
  Name kind;                             // as of a coordinate; empty with `unit` set, or where nothing is written
  std::optional<UnitExpression> unit;
};

/// path from (0, 1) at 0 to (2, free) at 1
struct PathStatement {
  struct End {
    std::vector<ExpressionPtr> configuration;  // in the order of the coordinates; null where `free` stands
    ExpressionPtr at;
    Span span;                                 // of the configuration
  } from, to;
};

/// A statement of the grammar that a later version carries out: contact, friction, event, impact,
/// field, density. It is parsed whole (formatting and messages work) and kept as its expressions.
struct LaterStatement {
  std::string what;                      // its first word
  std::vector<Name> names;               // that it declares: the field and its variable, an event, a constraint
  std::vector<ExpressionPtr> expressions;
};

using StatementBody =
    std::variant<SystemStatement, SourceStatement, DimensionlessStatement, ParamStatement, CoordStatement, LetStatement,
                 InputStatement, FrameStatement, PointStatement, BodyStatement, GravityStatement, SpringStatement,
                 DamperStatement, TorsionSpringStatement, EnergyStatement, ForceStatement, StartStatement, RunStatement,
                 OutputStatement, MethodStatement, PrecisionStatement, DrawStatement, ReactionStatement, ExpectStatement, ConstraintStatement, SweepStatement, IndependentStatement,
                 PathStatement, LaterStatement>;

struct Statement {
  StatementBody body;
  Span span;                             // from its first word to its last
};

class Declarations;

struct SyntaxTree {
  std::vector<Statement> statements;     // in the order of the text
  std::vector<Comment> comments;
  /// Declared by statements that were left out because of an error: a use of one of them is no second mistake.
  std::vector<Name> lost_names;
  /// The names that the text declares: they decide how a text beside it is read. Null where the text has no statement.
  std::shared_ptr<const Declarations> declarations;
};

/// Reads a model text. Errors go to `diagnostics`, all of them; a statement with an error is left out, the rest stands.
/// Time and memory are linear in the text; nesting is bounded (E0108), so is the size of the text (E0101).
SyntaxTree parse(const SourceText& source, Diagnostics& diagnostics);

/// Parts of statements in a text of their own beside the model, such as an option of a command line or a field of a form.
/// They are read with the names that `model` declares: these decide what `2e1` and `f(x)` mean. Nothing after a mistake,
/// which `diagnostics` tells at its place in `text`.
struct Equation { ExpressionPtr left, right; };                    // P.y = 0
struct Assignment { ExpressionPtr variable, value; };              // of a list x = 4 t, y = 3 t + 5
ExpressionPtr parse_formula(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
/// A number with its unit, or a formula of such.
ExpressionPtr parse_quantity(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
std::optional<Equation> parse_equation(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
std::optional<std::vector<Assignment>> parse_assignments(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
/// What stands behind the words `param`, `start`, `run`.
std::optional<ParamStatement> parse_parameters(const SourceText& text, const SyntaxTree& model, Diagnostics& diagnostics);
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

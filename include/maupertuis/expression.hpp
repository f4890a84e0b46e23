#pragma once
#include <maupertuis/rational.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// The kinds of node. kinds.hpp tells their families; one table (symbolic/expression/kind_table.hpp) holds arity and
/// names of each, and functions.hpp all that passes ask of a function of one argument.
enum class Kind : std::uint8_t {
  // leaves
  Number,  // exact rational
  Pi,
  Symbol,
  // algebra
  Sum,      // n-ary; every argument but one Number is a term; a term with a coefficient is a Product
  Product,  // n-ary; a leading Number coefficient other than 1, then factors; repeated factors are Powers
  Power,    // base, exponent (any expression; sqrt(x) is x^(1/2), 1/x is x^(-1))
  // d/dt, kept as an operator of the computational form (docs/design/computational_form.md)
  TimeDerivative,
  // elementary functions of one argument
  Sin,
  Cos,
  Tan,
  Asin,
  Acos,
  Atan,
  Sinh,
  Cosh,
  Tanh,
  Asinh,
  Acosh,
  Atanh,
  Exp,
  Log,
  Erf,       // 2/√π ∫₀ˣ exp(−s²) ds
  LambertW,  // the root w ≥ −1 of w eʷ = x
  // functions with a switch
  Abs,
  Sign,
  Step,  // sign(0) = 0, step(0) = 1
  Atan2,
  Min,
  Max,        // two arguments
  Piecewise,  // condition, value, condition, value, ..., else value
  // conditions, only inside Piecewise
  Less,
  LessEqual,
  And,
  Or,
};

/// What a symbol stands for. Coordinates and inputs depend on time; their derivatives are symbols of higher `order`.
enum class Role : std::uint8_t {
  Parameter,   // constant in time
  Constant,    // an anonymous parameter: a number with a unit that stood in a formula
  Coordinate,  // q, q', q'' by order
  Input,       // u, u' by order
  Time,
  Multiplier,  // λ of a constraint, or a reaction; depends on time, and no derivative of it is ever taken
  Auxiliary,   // a named intermediate or an unknown of an algorithm; constant under d/dt
};

using NodeId = std::uint32_t;
class Context;

/// A handle of an interned, immutable expression: two handles of one context are equal if and only if the expressions
/// are the same after the constructor's rewrites. Cheap to copy; valid as long as its context.
///
/// The constructors rewrite only this: constant folding in exact rationals; x + 0, x·1, x·0, x^1, x^0; like terms of
/// one sum (2x + 3x); equal bases with numeric exponents in one product (x·x^2); √(x²) = |x|; products inside a
/// product are flattened; a numeric factor of a one-term sum is multiplied in. Sums inside sums are NOT
/// flattened, so that shared partial sums stay shared: `expand` does that.
/// Odd and even functions of an argument with a leading minus sign are normalized: sin(-x) = -sin x, cos(-x) = cos x.
class Expr {
 public:
  Expr() = default;
  Expr(Context* context, NodeId id) : context_(context), id_(id) {}

  explicit operator bool() const { return context_ != nullptr; }
  Context& context() const { return *context_; }
  NodeId id() const { return id_; }

  Kind kind() const;
  std::size_t size() const;                  // number of arguments
  Expr operator[](std::size_t index) const;  // argument
  std::span<const NodeId> argument_ids() const;

  bool is(Kind k) const { return kind() == k; }
  bool is_number() const { return is(Kind::Number); }
  bool is_symbol() const { return is(Kind::Symbol); }
  bool is_zero() const;
  bool is_one() const;
  /// Precondition: is_number().
  const Rational& number() const;
  /// The number, of any expression: its value if it is a Number, else nothing.
  const Rational* number_or_null() const { return is_number() ? &number() : nullptr; }

  // Precondition of all: is_symbol().
  const std::string& name() const;  // without primes: θ for θ''
  Role role() const;
  int order() const;  // number of time derivatives: 2 for θ''

  friend bool operator==(const Expr& a, const Expr& b) { return a.id_ == b.id_ && a.context_ == b.context_; }
  friend bool operator!=(const Expr& a, const Expr& b) { return !(a == b); }

 private:
  Context* context_ = nullptr;
  NodeId id_ = 0;
};

struct ExprHash {
  std::size_t operator()(const Expr& e) const { return e.id() * 0x9E3779B97F4A7C15ull; }
};

/// A term split into its numeric coefficient and the rest: -3 x y → (-3, x y); a Number → (value, 1).
struct ScaledTerm {
  Rational coefficient;
  Expr rest;
};
ScaledTerm split_coefficient(Expr term);

/// Owns the nodes of a family of expressions. Not thread-safe while nodes are being made; reading is.
/// Node ids grow in order of creation, so that a child's id is smaller than its parent's: a loop over ids is a
/// topological walk.
class Context {
 public:
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  Expr number(const Rational& value);
  Expr pi();
  Expr time();  // the symbol of Role::Time, of whatever name it was made with; t if there is none
  /// The symbol of this name and order; made at first use. A name has one role for ever.
  /// Precondition: the role agrees with earlier uses of the name; order > 0 only for Coordinate and Input.
  Expr symbol(std::string_view name, Role role, int order = 0);

  Expr sum(std::span<const Expr> terms);
  Expr product(std::span<const Expr> factors);
  Expr power(Expr base, Expr exponent);
  /// A function, condition or piecewise node. Precondition: arity as in the kind table.
  Expr function(Kind kind, std::span<const Expr> arguments);
  /// The node of this kind over these arguments, by whichever of the constructors makes it. Precondition: no leaf.
  Expr make(Kind kind, std::span<const Expr> arguments);
  /// d/dt e. Numbers, parameters: 0; t: 1; symbols of coordinates and inputs: the symbol of the next order; a
  /// time-independent factor is moved out; anything else stays an operator node.
  Expr time_derivative(Expr e);

  std::size_t node_count() const;
  Expr node(NodeId id) { return Expr(this, id); }

  /// True if the node's value can change with time.
  bool depends_on_time(NodeId id) const;
  /// True if a TimeDerivative node stands in it.
  bool has_time_derivative(NodeId id) const;

  struct Storage;
  const Storage& storage() const { return *storage_; }

 private:
  friend class Expr;
  friend ScaledTerm split_coefficient(Expr term);
  std::unique_ptr<Storage> storage_;
};

Expr operator+(Expr a, Expr b);
Expr operator-(Expr a, Expr b);
Expr operator*(Expr a, Expr b);
Expr operator/(Expr a, Expr b);
Expr operator-(Expr a);
Expr operator+(Expr a, const Rational& b);
Expr operator-(Expr a, const Rational& b);
Expr operator*(Expr a, const Rational& b);
Expr operator*(const Rational& a, Expr b);
Expr operator/(Expr a, const Rational& b);
Expr operator/(const Rational& a, Expr b);
Expr pow(Expr base, const Rational& exponent);
Expr sqrt(Expr e);
Expr sin(Expr e);
Expr cos(Expr e);
Expr apply(Kind function, Expr argument);
Expr sum_of(std::span<const Expr> terms, Context& context);
Expr sum_of(std::initializer_list<Expr> terms);        // not empty
Expr product_of(std::initializer_list<Expr> factors);  // not empty

/// Splits a factor into base and numeric exponent: x^2 → (x, 2); x → (x, 1); x^y → (x^y, 1).
struct PowerOf {
  Expr base;
  Rational exponent;
};
PowerOf split_power(Expr factor);

/// The nodes below `roots`, each once, children before parents.
std::vector<Expr> topological_order(std::span<const Expr> roots);
/// The symbols below `roots`, each once, in order of creation.
std::vector<Expr> symbols_of(std::span<const Expr> roots);

}  // namespace maupertuis

#pragma once
#include "symbolic/evaluate/evaluator.hpp"
#include "symbolic/evaluate/prime_field.hpp"

#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace maupertuis::evaluation {

/// Thrown where a random point is of no use: a denominator vanishes, a radicand is no square. Draw another.
struct Redraw {
  bool another_prime = false;  // a constant is to blame: another point does not help
  Position at = ~Position{0};  // the node whose argument has the wrong sign, at which the walk ended
  std::uint64_t argument = 0;  // its value
};

/// What an evaluation over a prime field must know of an expression beside its nodes.
struct FieldHints {
  std::uint64_t m_used = 0;       // lcm of 2·denominator over the multiples of π in angles; 0: none
  std::uint64_t m = 840;          // lcm of that and 840
  std::vector<std::int8_t> sign;  // [tape] +1, −1 where the value has this sign at all real points, else 0
  // Symbols under a root or a logarithm that stands outside of all pieces: drawn positive, since the formula has no
  // value otherwise.
  std::unordered_set<NodeId> positive;
  std::vector<bool> in_a_piece;                 // [tape] asked only where a piece of piecewise is in force
  std::unordered_map<Position, Expr> asking;    // the arguments of nodes with a sign to meet
  std::unordered_map<NodeId, Position> met_by;  // symbol: the first such node that sees it
};
FieldHints field_hints(const Tape& tape);
/// +1, −1 where a formula has this sign at all real values of its symbols, by interval arithmetic; else 0.
int definite_sign(Expr e);
/// How many roots may be mended before a search for points is given up: bounded work for a hopeless one.
int mends_allowed(const Tape& tape);

/// Primes modulo which rotations by the angles of the hints agree with the order of the reals: only some do, the fewer
/// the more angles there are. Throws Redraw where none was found.
PrimeTriple agreeing_primes(const FieldHints& hints, std::uint64_t seed);

/// The real numbers with their elementary functions, imitated over a prime field: a random homomorphic image in which
/// every identity that the functions obey by algebra holds exactly.
///
///   sign      Legendre's symbol: multiplicative, and −1 at −1. |x| = sign(x) x; √ of a "positive" number is its
///             "positive" root, so that √(xy) = √x √y and √(x²) = |x|.
///   powers    positive numbers form a group of prime order q: x^s is a power with exponent in ℤ/q.
///   exp       a sum of multiples of basis elements goes to a product of powers in that group; log inverts it.
///   sin, cos  the same in the circle c² + s² = 1, a group of order m·r, whose m-th roots are the multiples of π.
///   others    (log of a sum, atan …): a random number that depends on the value of the argument alone, with the
///             symmetries of the function.
///
/// docs/theory/zero_test.md proves what follows from a value that is zero here.
class FieldNumbers {
 public:
  using Value = PrimeField::Value;
  struct Angle {
    Value cosine, sine;
  };

  virtual ~FieldNumbers() = default;
  FieldNumbers(const PrimeTriple& primes, const FieldHints& hints, std::uint64_t seed);

  const PrimeField& field() const { return field_; }
  /// A random number that depends on the seed and the two keys alone.
  Value random(std::uint64_t key, std::uint64_t second = 0) const;
  void set_seed(std::uint64_t seed);
  /// Another value for one symbol, such that most signs that were met before stay as they are: many roots cost a few
  /// draws each and not 2^roots. Which symbol: of those below the root the one that fewest earlier roots see; a symbol
  /// on which the radicand has turned out not to depend (sin²ψ + cos²ψ, not simplified) is passed over from then on. An
  /// empty handle where none is left.
  Expr mend(const Redraw& redraw);
  /// From now on x^c with c = n + f, 0 < f < 1, is x^n times a random number that depends on the values of x and f
  /// alone, whatever the sign of x. Fewer identities hold then ((x^f)² is no power of x any more), none that is false;
  /// for formulas with so many roots that no point is found at which all of them are defined, as of many bodies.
  void let_roots_be_free() { free_roots_ = true; }
  /// To be told where a kind of numbers derived from this one gives a symbol another value within one point.
  void symbols_changed() {
    angles_.clear();
    units_.clear();
  }

  Value number(const Rational& value) const { return field_.from(value); }
  Value pi() const;
  Value symbol(Expr e) const;
  Value add(Value a, Value b) const { return field_.add(a, b); }
  Value subtract(Value a, Value b) const { return field_.subtract(a, b); }
  Value multiply(Value a, Value b) const { return field_.multiply(a, b); }
  Value negate(Value a) const { return field_.negate(a); }
  Value inverse(Value a) const;
  bool is_zero(Value a) const { return a == 0; }

  /// `values` need hold only what stands below `at`.
  Value function(const Tape& tape, Position at, const std::vector<Value>& values);
  bool holds(const Tape& tape, Position condition, const std::vector<Value>& values);
  Angle cos_sin(const Tape& tape, Position argument, const std::vector<Value>& values);
  Value exponential(const Tape& tape, Position argument, const std::vector<Value>& values);
  Value logarithm(const Tape& tape, Position argument, const std::vector<Value>& values);
  /// ±1. A value that has one sign at all real points must have it here too.
  int sign(Position argument, Value value) const;
  Value square_root(Value a) const;

 protected:
  /// Its value comes from elsewhere: to draw it again would change nothing.
  virtual bool is_fixed(Expr) const { return false; }

 private:
  /// What is known of a node with a sign to meet.
  struct Asking {
    std::vector<Expr> symbols;  // below it; first those that fewest earlier nodes see
    Value argument = 0;         // when its sign was wrong last
    Expr drawn_again;           // then
  };
  Asking& asking(Position at);
  Expr symbol_to_draw_again(const Redraw& redraw);
  bool has_sign(Position argument, Value value, int sign) const;
  Value power(const Tape& tape, Position at, const std::vector<Value>& values);
  Value positive_power(Value base, std::uint64_t exponent) const;
  bool is_never_positive(Position argument) const;
  bool stands_in_a_piece(Position at) const { return at < hints_.in_a_piece.size() && hints_.in_a_piece[at]; }
  Value free_power(Value base, const Rational& exponent) const;
  Value positive(Value a) const;
  std::uint64_t exponent_of(const Rational& c) const;
  std::uint64_t exponent_of(const Tape& tape, Position at, const std::vector<Value>& values);
  std::optional<Value> exponential_of_inverse(const Tape& tape, Position rest, const std::vector<Value>& values) const;
  Value opaque(Kind kind, Value x) const;
  Value lambert_w(Value x) const;
  void multiply_exponential(const Tape& tape, Position at, const std::vector<Value>& values, Value& product);
  void rotate(const Tape& tape, Position at, const std::vector<Value>& values, Angle& angle);
  Angle direction(const Tape& tape, Position at, const std::vector<Value>& values);
  Value angle_of(Angle direction) const;
  Value absolute_logarithm(const Tape& tape, Position at, const std::vector<Value>& values);
  Value logarithm_of_number(const Rational& value) const;
  Value term_key(const Tape& tape, const TermView& term, const std::vector<Value>& values) const;
  std::uint64_t residue_of(const Rational& c, const PrimeField& group) const;

  Angle turned(Angle a, Angle b) const;
  Angle turned(Angle a, std::uint64_t times) const;
  Angle opposite(Angle a) const { return {a.cosine, field_.negate(a.sine)}; }
  Angle random_direction(std::uint64_t key) const;
  void choose_generators();
  void choose_right_angles();

  PrimeField field_, exponents_, turns_;  // modulo p, q, r
  PrimeTriple primes_;
  const FieldHints& hints_;
  std::uint64_t seed_;
  bool free_roots_ = false;
  Value generator_ = 0;  // of the positive numbers
  Angle turn_{};         // of the rotations of order r
  Angle root_{};         // rotation by 2π/m
  std::unordered_map<NodeId, std::uint64_t> drawn_again_;
  std::unordered_map<Position, Asking> asking_;         // that were mended
  std::unordered_map<Position, Angle> angles_, units_;  // of arguments and of their basis elements, at this point
};

}  // namespace maupertuis::evaluation

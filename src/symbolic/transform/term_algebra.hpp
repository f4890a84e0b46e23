#pragma once
#include <maupertuis/expression.hpp>

#include "symbolic/transform/key_table.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

/// Sparse polynomials for the readable form.
///
/// Pushing expressions around is too slow and not canonical: a product of sums of sines has one value and many trees.
/// Here a term is a rational coefficient, a monomial (atoms to rational powers) and one harmonic, the sine or cosine
/// of a rational combination of angles:
///
///     -1/2 · m l^2 θ' · cos(2θ - φ)
///
/// Products of harmonics become sums at once, so that equal trigonometric polynomials are equal vectors of terms.
/// Monomials and harmonics are interned; a term key is two 32-bit numbers, and products of keys are remembered.
namespace maupertuis::terms {

using AtomId = std::uint32_t;
using MonomialId = std::uint32_t;
using HarmonicId = std::uint32_t;

/// Thrown inside the passes when the form would exceed its budget (or an exponent its range); never leaves them.
struct TooManyTerms {};

/// A small exact rational: an exponent, or the multiple of an angle. Always in lowest terms, den > 0.
struct Fraction {
  std::int32_t num = 0, den = 1;

  bool is_zero() const { return num == 0; }
  bool is_integer() const { return den == 1; }
  friend bool operator==(Fraction, Fraction) = default;
};
Fraction fraction(std::int64_t num, std::int64_t den = 1);  // throws TooManyTerms beyond 2^20
bool fits_fraction(const Rational& value);
Fraction to_fraction(const Rational& value);
Fraction operator+(Fraction a, Fraction b);
Fraction operator-(Fraction a, Fraction b);
Fraction operator*(Fraction a, Fraction b);
Fraction operator/(Fraction a, Fraction b);
bool operator<(Fraction a, Fraction b);
/// The largest g with a/g and b/g integers; gcd(0, b) = |b|.
Fraction gcd(Fraction a, Fraction b);
Rational to_rational(Fraction f);

struct Factor {
  AtomId atom;
  Fraction exponent;
  friend bool operator==(const Factor&, const Factor&) = default;
};
using Monomial = std::vector<Factor>;  // ascending atoms, no zero exponents

struct Frequency {
  NodeId angle;  // an expression of one term: θ, Ω t, π
  Fraction multiple;
  friend bool operator==(const Frequency&, const Frequency&) = default;
};
struct Harmonic {
  bool sine = false;
  std::vector<Frequency> argument;  // ascending angles, the first multiple positive; empty: cos 0 = 1
  friend bool operator==(const Harmonic&, const Harmonic&) = default;
};

struct Term {
  MonomialId monomial;
  HarmonicId harmonic;
  Rational coefficient;
};
using Polynomial = std::vector<Term>;  // ascending (monomial, harmonic), no zero coefficients

enum class AtomKind : std::uint8_t {
  Symbol,
  Function,     // a function that is no polynomial; its arguments are kept as polynomials
  Base,         // a sum under a negative or fractional power; its one argument is the sum
  Exponential,  // exp(x) of one term x: exp(a + b) is a product, so that exponentials cancel
  Harmonic,     // sin or cos of one angle as an indeterminate of the power form
};

struct Atom {
  Expr expr;  // canonical
  AtomKind kind = AtomKind::Symbol;
  std::vector<Polynomial> arguments;  // Function, Base, Exponential
  Expr shown;                         // what a reader sees; the canonical expression until a pass sets it
};

/// Two numbers of monomials or harmonics as one.
inline std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) { return (std::uint64_t{a} << 32) | b; }

/// Owns the atoms, monomials and harmonics that polynomials of one context refer to.
class TermAlgebra {
 public:
  TermAlgebra(Context& context, std::size_t term_budget);

  Context& context() const { return *context_; }
  std::size_t budget() const { return budget_; }

  AtomId atom(Expr e, AtomKind kind, std::vector<Polynomial> arguments = {});
  const Atom& info(AtomId id) const { return atoms_[id]; }
  void show(AtomId id, Expr shown);
  /// How the collected argument of an exponential is shown; the flat sum by default.
  void show_exponents(std::function<Expr(const Polynomial&)> form) { exponent_form_ = std::move(form); }
  std::size_t atom_count() const { return atoms_.size(); }

  const Monomial& monomial(MonomialId id) const { return monomials_[id]; }
  MonomialId intern(const Monomial& monomial);
  MonomialId product(MonomialId a, MonomialId b);
  MonomialId power(MonomialId a, Fraction exponent);
  MonomialId quotient(MonomialId a, MonomialId b) { return product(a, power(b, {-1, 1})); }

  const Harmonic& harmonic(HarmonicId id) const { return harmonics_[id]; }
  /// coefficient · harmonic of any argument, brought to normal form (sign, multiples of π/2).
  Term harmonic_term(bool sine, std::vector<Frequency> argument, Rational coefficient);
  /// cos a cos b = ½ cos(a − b) + ½ cos(a + b), …: two terms with monomial 1, of which one may be 0.
  using HarmonicProduct = std::array<Term, 2>;
  const HarmonicProduct& harmonic_product(HarmonicId a, HarmonicId b);

  Polynomial constant(const Rational& value) const;
  Polynomial of_atom(AtomId id, Fraction exponent = {1, 1});
  Polynomial add(const Polynomial& a, const Polynomial& b) const;
  Polynomial scale(const Polynomial& a, const Rational& factor) const;
  Polynomial multiply(const Polynomial& a, const Polynomial& b);
  Polynomial times_monomial(const Polynomial& a, MonomialId monomial);
  /// Any rational exponent; sums under negative or fractional powers become Base atoms.
  Polynomial power(const Polynomial& a, Fraction exponent);
  /// Sorts and collects raw terms, and multiplies out whole powers of Base atoms.
  Polynomial normalized(std::vector<Term> raw);

  /// The expression of a polynomial, term by term; `shown` selects what atoms look like.
  Expr expression(const Polynomial& p, bool shown = false);
  Expr expression(MonomialId monomial, bool shown = false);
  Expr expression_of_harmonic(HarmonicId harmonic);
  Expr angle_expression(const std::vector<Frequency>& argument) const;

 private:
  struct KeyHash {
    std::size_t operator()(const Monomial& m) const;
    std::size_t operator()(const Harmonic& h) const;
  };
  HarmonicId intern(const Harmonic& harmonic);
  bool has_whole_base_power(const Monomial& monomial) const;
  Polynomial with_bases_multiplied_out(const Term& term);
  Polynomial power_of_term(const Term& term, Fraction exponent);
  Polynomial power_of_number(const Rational& value, Fraction exponent);
  Polynomial power_of_sum(const Polynomial& sum, Fraction exponent);
  Expr exponential(const Monomial& monomial, bool shown);
  std::vector<Expr> factors_without_exponentials(const Monomial& monomial, bool shown) const;

  Context* context_;
  std::size_t budget_;
  std::size_t work_ = 0;  // products of terms so far
  std::function<Expr(const Polynomial&)> exponent_form_;
  std::vector<Atom> atoms_;
  std::unordered_map<NodeId, AtomId> atom_ids_;
  std::vector<Monomial> monomials_;
  std::vector<char> whole_base_power_;  // by monomial: a Base atom stands in it with an exponent of at least 1
  std::unordered_map<Monomial, MonomialId, KeyHash> monomial_ids_;
  KeyTable products_;  // of monomials
  std::vector<Harmonic> harmonics_;
  std::unordered_map<Harmonic, HarmonicId, KeyHash> harmonic_ids_;
  KeyTable harmonic_product_places_;
  std::vector<HarmonicProduct> harmonic_products_;
  // Expressions made before, by harmonic and by monomial without exponentials; `shown_monomials_` until an atom is
  // shown otherwise.
  std::vector<Expr> harmonic_expressions_, monomial_expressions_, shown_monomials_;
};

/// The terms as bytes, to be looked up by.
std::string key_text(const Polynomial& p);

/// gcd of the coefficients, positive; 1 for an empty polynomial.
Rational rational_content(const Polynomial& p);

}  // namespace maupertuis::terms

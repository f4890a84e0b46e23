#pragma once
#include <maupertuis/transform.hpp>

#include "symbolic/transform/factor.hpp"
#include "symbolic/transform/polynomial_of.hpp"
#include "symbolic/transform/reading_cost.hpp"

#include <string>

/// The choice between equal forms. Every function here returns an expression equal to the polynomial it is given;
/// they differ in how terms are grouped and in how sines and cosines are written, and the cheapest to read wins.
namespace maupertuis::terms {

class CandidateChooser {
 public:
  CandidateChooser(Context& context, const ReadingOrder& order, std::size_t term_budget);

  TermAlgebra& algebra() { return algebra_; }
  ReadingCost& cost() { return cost_; }

  /// Reads an expression (TimeDerivative nodes expanded) and prepares what its atoms look like.
  Polynomial read(Expr e);

  /// The cheapest form of all.
  Expr best(const Polynomial& p);
  /// The cheapest sum of terms without a factor common to all: forces stay apart, as in a free-body diagram.
  Expr best_terms(const Polynomial& p);

  Expr flat_sum(const std::vector<Expr>& parts);

  void set_own(Expr coordinate) { own_ = coordinate; }
  /// True for q', q'' as factors.
  bool is_rate(AtomId atom) const;

 private:
  struct Choice {
    Expr value;
    double cost = 0;
  };
  void consider(Choice& best, Expr candidate);

  /// Σ over parameter monomials, each with the best form of what it multiplies: I1 sin² θ + I3 cos² θ.
  Expr by_parameters(const Polynomial& p);
  /// Σ over functions of angles, each with its coefficient factored: (m1 + m2) g l1 sin θ1 + m2 g l2 sin θ2.
  Expr by_functions(const Polynomial& p);
  /// Σ over velocity monomials, each with its coefficient's best form: 1/2 m r^2 θ'^2 + 1/2 m r'^2.
  Expr by_velocities(const Polynomial& p);

  /// s (what s multiplies) + the rest, for the parameter s that occurs most: m2 (l1^2 + a^2 + 2 l1 a cos θ) + I.
  /// `apart`: only where what s multiplies has one function of angles. Empty where no parameter occurs twice.
  Expr by_one_parameter(const Polynomial& p, bool apart);
  /// k (r − l)² for k r² − 2 k l r + k l², r a root. Empty where there is no such root.
  Polynomial with_roots(const Polynomial& p);

  /// What all terms stand over, if a sum is in it; else 1.
  MonomialId common_denominator(const Polynomial& p);
  Expr content_outside(Expr e);
  /// The number that all coefficients are multiples of; 1 where they would be longer without it.
  static Rational readable_content(const Polynomial& p);

  bool has_rates_inside_functions(const Polynomial& p) const;
  std::vector<std::pair<Fraction, Polynomial>> by_rate_degree(const Polynomial& p) const;

  /// One polynomial in the cheapest of its trigonometric bases, flat or factored, without regrouping.
  Expr best_basis(const Polynomial& p);
  Expr search_basis(const Polynomial& p);
  Expr flat(const Polynomial& p) { return algebra_.expression(p, true); }
  Expr without_content(const Polynomial& p);
  Expr factored(const Polynomial& p);
  Factored factored_parts(const Polynomial& p);
  Expr product_of(Factored parts);
  void take_in_long_coefficient(Factored& parts);

  Expr search_best(const Polynomial& p);
  enum class Part { Parameter, Rate, Other };
  Part part_of(AtomId atom) const;
  bool is_parametric(const Polynomial& p) const;
  MonomialId select(MonomialId monomial, Part part);
  template <class KeyOf>
  Expr grouped(const Polynomial& p, KeyOf key_of);

  /// −1 if the sum reads better with the opposite sign: the first coordinate, else the first parameter, is positive.
  int reading_sign(const Polynomial& sum) const;
  void prepare_atoms();

  TermAlgebra algebra_;
  PolynomialReader reader_;
  ReadingCost cost_;
  std::unordered_map<NodeId, std::size_t> ranks_;  // of symbols: coordinates, then parameters
  Expr own_;
  std::size_t prepared_ = 0;  // atoms whose shown form is set
  std::unordered_map<std::string, Expr> known_bases_, known_best_;
  std::unordered_map<std::string, Factored> known_factors_;
};

}  // namespace maupertuis::terms

#include "symbolic/transform/term_algebra.hpp"

#include <array>

/// From the term algebra back to expressions.
namespace maupertuis::terms {

Expr TermAlgebra::angle_expression(const std::vector<Frequency>& argument) const {
  std::vector<Expr> terms;
  for (const Frequency& f : argument) terms.push_back(to_rational(f.multiple) * Expr(context_, f.angle));
  return context_->sum(terms);
}

Expr TermAlgebra::expression_of_harmonic(HarmonicId id) {
  const Harmonic& h = harmonics_[id];
  if (h.argument.empty()) return context_->number(1);
  const Expr argument = angle_expression(h.argument);
  return h.sine ? sin(argument) : cos(argument);
}

/// All exponentials of a monomial as one: exp(a)^2 exp(b)^-1 = exp(2a − b).
Expr TermAlgebra::exponential(const Monomial& monomial, bool shown) {
  Polynomial exponent;
  for (const Factor& f : monomial)
    if (atoms_[f.atom].kind == AtomKind::Exponential)
      exponent = add(exponent, scale(atoms_[f.atom].arguments.front(), to_rational(f.exponent)));
  return apply(Kind::Exp, shown && exponent_form_ ? exponent_form_(exponent) : expression(exponent, shown));
}

Expr TermAlgebra::expression(MonomialId id, bool shown) {
  const Monomial monomial = monomials_[id];
  std::vector<Expr> factors;
  bool has_exponential = false;
  for (const Factor& f : monomial) {
    if (atoms_[f.atom].kind == AtomKind::Exponential) {
      has_exponential = true;
      continue;
    }
    factors.push_back(pow(shown ? atoms_[f.atom].shown : atoms_[f.atom].expr, to_rational(f.exponent)));
  }
  if (has_exponential) factors.push_back(exponential(monomial, shown));
  return context_->product(factors);
}

Expr TermAlgebra::expression(const Polynomial& p, bool shown) {
  std::vector<Expr> terms;
  terms.reserve(p.size());
  for (const Term& term : p) {
    const std::array factors{context_->number(term.coefficient), expression(term.monomial, shown),
                             expression_of_harmonic(term.harmonic)};
    terms.push_back(context_->product(factors));
  }
  return context_->sum(terms);
}

}  // namespace maupertuis::terms

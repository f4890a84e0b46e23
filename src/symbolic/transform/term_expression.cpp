#include "symbolic/transform/term_algebra.hpp"

#include <algorithm>
#include <array>

/// From the term algebra back to expressions.
namespace maupertuis::terms {
namespace {

/// Made at first use: a search for the best form writes the same monomials and angles thousands of times.
template <typename Make>
Expr remembered(std::vector<Expr>& known, std::size_t id, Make make) {
  if (known.size() <= id) known.resize(id + 1);
  if (!known[id]) known[id] = make();
  return known[id];
}

}  // namespace

void TermAlgebra::show(AtomId id, Expr shown) {
  atoms_[id].shown = shown;
  shown_monomials_.clear();
}

Expr TermAlgebra::angle_expression(const std::vector<Frequency>& argument) const {
  std::vector<Expr> terms;
  for (const Frequency& f : argument) terms.push_back(to_rational(f.multiple) * Expr(context_, f.angle));
  return context_->sum(terms);
}

Expr TermAlgebra::expression_of_harmonic(HarmonicId id) {
  const Harmonic& h = harmonics_[id];
  if (h.argument.empty()) return context_->number(1);
  return remembered(harmonic_expressions_, id, [&] {
    const Expr argument = angle_expression(h.argument);
    return h.sine ? sin(argument) : cos(argument);
  });
}

/// All exponentials of a monomial as one: exp(a)^2 exp(b)^-1 = exp(2a − b).
Expr TermAlgebra::exponential(const Monomial& monomial, bool shown) {
  Polynomial exponent;
  for (const Factor& f : monomial)
    if (atoms_[f.atom].kind == AtomKind::Exponential)
      exponent = add(exponent, scale(atoms_[f.atom].arguments.front(), to_rational(f.exponent)));
  return apply(Kind::Exp, shown && exponent_form_ ? exponent_form_(exponent) : expression(exponent, shown));
}

std::vector<Expr> TermAlgebra::factors_without_exponentials(const Monomial& monomial, bool shown) const {
  std::vector<Expr> factors;
  for (const Factor& f : monomial)
    if (const Atom& atom = atoms_[f.atom]; atom.kind != AtomKind::Exponential)
      factors.push_back(pow(shown ? atom.shown : atom.expr, to_rational(f.exponent)));
  return factors;
}

Expr TermAlgebra::expression(MonomialId id, bool shown) {
  const auto is_exponential = [&](const Factor& f) { return atoms_[f.atom].kind == AtomKind::Exponential; };
  if (std::any_of(monomials_[id].begin(), monomials_[id].end(), is_exponential)) {
    const Monomial monomial = monomials_[id];  // the form of an exponent is chosen anew and may make more monomials
    std::vector<Expr> factors = factors_without_exponentials(monomial, shown);
    factors.push_back(exponential(monomial, shown));
    return context_->product(factors);
  }
  return remembered(shown ? shown_monomials_ : monomial_expressions_, id, [&] {
    return context_->product(factors_without_exponentials(monomials_[id], shown));
  });
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

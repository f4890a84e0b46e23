#include "symbolic/transform/term_algebra.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>

/// Powers in the term algebra. Whole powers are multiplied out; a sum under any other power becomes an atom whose
/// exponent the monomials carry, so that r · r^-1 cancels and r^2 of a radical r = (x² + y²)^(1/2) is x² + y².
namespace maupertuis::terms {

Polynomial TermAlgebra::power(const Polynomial& a, Fraction exponent) {
  if (exponent.is_zero()) return constant(1);
  if (a.empty()) {
    if (exponent.num < 0) throw TooManyTerms{};  // 1/0: left as it stands
    return {};
  }
  if (a.size() == 1 && (a[0].harmonic == 0 || !exponent.is_integer() || exponent.num < 0))
    return power_of_term(a[0], exponent);
  if (!exponent.is_integer() || exponent.num < 0) return power_of_sum(a, exponent);
  Polynomial result = constant(1), square = a;
  for (std::int32_t n = exponent.num; n > 0; n /= 2) {
    if (n % 2 != 0) result = multiply(result, square);
    if (n > 1) square = multiply(square, square);
  }
  return result;
}

Polynomial TermAlgebra::power_of_number(const Rational& value, Fraction exponent) {
  if (exponent.is_integer()) {
    if (std::abs(exponent.num) > 512) throw TooManyTerms{};
    return constant(maupertuis::pow(value, exponent.num));
  }
  if (const auto root = value.sign() > 0 ? exact_root(value, exponent.den) : std::nullopt)
    return power_of_number(*root, Fraction{exponent.num, 1});
  return of_atom(atom(context_->number(value), AtomKind::Base, {constant(value)}), exponent);
}

Polynomial TermAlgebra::power_of_term(const Term& term, Fraction exponent) {
  if (exponent.is_integer()) {
    Polynomial result = power_of_number(term.coefficient, exponent);
    if (term.harmonic != 0) {
      const AtomId trig = atom(expression_of_harmonic(term.harmonic), AtomKind::Harmonic);
      result = multiply(result, of_atom(trig, exponent));
    }
    return times_monomial(result, power(term.monomial, exponent));
  }
  if (term.monomial == 0 && term.harmonic == 0) return power_of_number(term.coefficient, exponent);
  const Monomial& m = monomials_[term.monomial];
  const bool bare = term.harmonic == 0 && term.coefficient.is_one() && m.size() == 1;
  // x^(1/2), or a power whose base cannot be negative; (x²)^(1/2) is |x| and stays an atom.
  if (bare && (m[0].exponent == Fraction{1, 1} || m[0].exponent.den % 2 == 0))
    return of_atom(m[0].atom, m[0].exponent * exponent);
  if (bare && atoms_[m[0].atom].kind == AtomKind::Exponential) return of_atom(m[0].atom, m[0].exponent * exponent);
  return power_of_sum({term}, exponent);
}

Polynomial TermAlgebra::power_of_sum(const Polynomial& sum, Fraction exponent) {
  // The content leaves the sum, so that (2x + 2y)^-1 and (x + y)^-1 share their atom.
  Rational content = rational_content(sum);
  if (exponent.is_integer() && sum.front().coefficient.sign() < 0) content = -content;
  Polynomial outside = power_of_number(content, exponent);
  Polynomial inside = scale(sum, Rational(1) / content);
  if (exponent.is_integer()) {
    Monomial common = monomials_[inside.front().monomial];
    for (const Term& term : inside) {
      const Monomial& m = monomials_[term.monomial];
      std::erase_if(common, [&](Factor& f) {
        const auto same = std::find_if(m.begin(), m.end(), [&](const Factor& g) { return g.atom == f.atom; });
        if (same == m.end() || (same->exponent.num < 0) != (f.exponent.num < 0)) return true;
        if ((same->exponent < f.exponent) == (f.exponent.num > 0)) f.exponent = same->exponent;
        return false;
      });
    }
    const MonomialId shared = intern(common);
    outside = times_monomial(outside, power(shared, exponent));
    inside = times_monomial(inside, power(shared, {-1, 1}));
  }
  const AtomId base = atom(expression(inside), AtomKind::Base, {inside});
  return multiply(outside, of_atom(base, exponent));
}

}  // namespace maupertuis::terms

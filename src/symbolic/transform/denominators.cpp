#include "symbolic/transform/denominators.hpp"
#include "symbolic/transform/factor.hpp"

#include <algorithm>
#include <map>

namespace maupertuis::terms {
namespace {

Fraction exponent_of(const Monomial& m, AtomId atom) {
  const auto place = std::find_if(m.begin(), m.end(), [&](const Factor& f) { return f.atom == atom; });
  return place == m.end() ? Fraction{0, 1} : place->exponent;
}

Fraction fractional_part(Fraction f) {
  const std::int32_t floor = f.num >= 0 ? f.num / f.den : -((-f.num + f.den - 1) / f.den);
  return f - Fraction{floor, 1};
}

/// Σ terms with exponents of one class modulo 1, as numerator · base^lowest, cancelled.
Polynomial combined_class(TermAlgebra& algebra, const Polynomial& terms, AtomId base) {
  Fraction lowest = exponent_of(algebra.monomial(terms.front().monomial), base);
  for (const Term& t : terms) {
    const Fraction e = exponent_of(algebra.monomial(t.monomial), base);
    if (e < lowest) lowest = e;
  }
  if (lowest.num >= 0) return terms;
  const Polynomial up = algebra.of_atom(base, Fraction{-lowest.num, lowest.den});
  Polynomial numerator = algebra.multiply(terms, up);
  const Polynomial divisor = algebra.info(base).arguments.front();
  while (lowest.num < 0) {
    Polynomial quotient = numerator.size() < 2 ? Polynomial{} : exact_quotient(algebra, numerator, divisor);
    if (quotient.empty()) break;
    numerator = std::move(quotient);
    lowest = lowest + Fraction{1, 1};
  }
  return lowest.is_zero() ? numerator : algebra.multiply(numerator, algebra.of_atom(base, lowest));
}

}  // namespace

Polynomial over_common_denominators(TermAlgebra& algebra, const Polynomial& p) {
  std::vector<AtomId> bases;
  for (const Term& t : p)
    for (const Factor& f : algebra.monomial(t.monomial))
      if (algebra.info(f.atom).kind == AtomKind::Base && f.exponent.num < 0) bases.push_back(f.atom);
  std::sort(bases.begin(), bases.end());
  bases.erase(std::unique(bases.begin(), bases.end()), bases.end());
  Polynomial result = p;
  for (const AtomId base : bases) {
    const auto less = [](Fraction a, Fraction b) { return a < b; };
    std::map<Fraction, Polynomial, decltype(less)> classes(less);
    for (const Term& t : result) classes[fractional_part(exponent_of(algebra.monomial(t.monomial), base))].push_back(t);
    Polynomial combined;
    for (const auto& [part, terms] : classes) combined = algebra.add(combined, combined_class(algebra, terms, base));
    result = std::move(combined);
  }
  return result;
}

}  // namespace maupertuis::terms

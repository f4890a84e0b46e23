#include "symbolic/transform/factor.hpp"
#include "symbolic/transform/small_polynomial.hpp"

#include <algorithm>
#include <unordered_map>

namespace maupertuis::terms {
namespace {

constexpr std::size_t most_terms = 64;
constexpr std::size_t most_variables = 16;

/// Numbers the atoms and harmonics of polynomials, with exponents scaled to whole numbers.
class Variables {
 public:
  Variables(TermAlgebra& algebra, std::initializer_list<const Polynomial*> polynomials) : algebra_(&algebra) {
    for (const Polynomial* p : polynomials)
      for (const Term& t : *p) {
        for (const Factor& f : algebra.monomial(t.monomial)) add(f.atom, f.exponent);
        if (t.harmonic != 0 && harmonics_.emplace(t.harmonic, count()).second)
          names_.push_back({true, t.harmonic, {1, 1}});
      }
    if (count() > most_variables) throw NotWorthIt{};
  }

  /// Precondition: no negative exponents.
  SmallPolynomial small(const Polynomial& p) const {
    SmallPolynomial result;
    for (const Term& t : p) {
      Exponents e(count(), 0);
      for (const Factor& f : algebra_->monomial(t.monomial)) {
        const std::size_t v = atoms_.at(f.atom);
        const Fraction whole = f.exponent / names_[v].unit;
        if (whole.num < 0 || whole.num > 200 || !whole.is_integer()) throw NotWorthIt{};
        e[v] = static_cast<std::int16_t>(whole.num);
      }
      if (t.harmonic != 0) e[harmonics_.at(t.harmonic)] = 1;
      result.emplace(std::move(e), t.coefficient);
    }
    return result;
  }

  Polynomial large(const SmallPolynomial& p) const {
    std::vector<Term> raw;
    for (const auto& [e, c] : p) {
      Monomial monomial;
      HarmonicId harmonic = 0;
      for (std::size_t v = 0; v < count(); ++v) {
        if (e[v] == 0) continue;
        if (!names_[v].is_harmonic) {
          monomial.push_back({names_[v].id, names_[v].unit * Fraction{e[v], 1}});
        } else {
          if (harmonic != 0 || e[v] > 1) throw NotWorthIt{};
          harmonic = names_[v].id;
        }
      }
      std::sort(monomial.begin(), monomial.end(), [](const Factor& a, const Factor& b) { return a.atom < b.atom; });
      raw.push_back({algebra_->intern(monomial), harmonic, c});
    }
    return algebra_->normalized(std::move(raw));
  }

 private:
  struct Name {
    bool is_harmonic;
    std::uint32_t id;
    Fraction unit;
  };
  std::size_t count() const { return names_.size(); }
  void add(AtomId atom, Fraction exponent) {
    const auto [place, fresh] = atoms_.emplace(atom, count());
    if (fresh) names_.push_back({false, atom, {0, 1}});
    Fraction& unit = names_[place->second].unit;
    unit = terms::gcd(unit, exponent);
  }

  TermAlgebra* algebra_;
  std::unordered_map<AtomId, std::size_t> atoms_;
  std::unordered_map<HarmonicId, std::size_t> harmonics_;
  std::vector<Name> names_;
};

}  // namespace

MonomialId lowest_powers(TermAlgebra& algebra, const Polynomial& p) {
  std::unordered_map<AtomId, std::pair<Fraction, std::size_t>> lowest;  // and in how many terms
  for (const Term& t : p)
    for (const Factor& f : algebra.monomial(t.monomial)) {
      const auto [place, fresh] = lowest.try_emplace(f.atom, f.exponent, 0);
      if (f.exponent < place->second.first) place->second.first = f.exponent;
      ++place->second.second;
    }
  Monomial result;
  for (const auto& [atom, seen] : lowest) {
    const bool everywhere = seen.second == p.size();
    if (everywhere ? !seen.first.is_zero() : seen.first.num < 0) result.push_back({atom, seen.first});
  }
  std::sort(result.begin(), result.end(), [](const Factor& a, const Factor& b) { return a.atom < b.atom; });
  return algebra.intern(result);
}

MonomialId common_monomial(TermAlgebra& algebra, const Polynomial& p) {
  Monomial common = algebra.monomial(p.front().monomial);
  for (const Term& term : p) {
    const Monomial& m = algebra.monomial(term.monomial);
    std::erase_if(common, [&](Factor& f) {
      const auto same = std::find_if(m.begin(), m.end(), [&](const Factor& g) { return g.atom == f.atom; });
      if (same == m.end() || (same->exponent.num < 0) != (f.exponent.num < 0)) return true;
      if ((same->exponent < f.exponent) == (f.exponent.num > 0)) f.exponent = same->exponent;
      return false;
    });
  }
  return algebra.intern(common);
}

Factored factor(TermAlgebra& algebra, const Polynomial& p) {
  Factored result;
  result.coefficient = rational_content(p);
  result.monomial = common_monomial(algebra, p);
  Polynomial rest = algebra.scale(algebra.times_monomial(p, algebra.power(result.monomial, {-1, 1})),
                                  Rational(1) / result.coefficient);
  if (rest.size() == 1 && rest[0].harmonic == 0 && rest[0].monomial == 0) {
    result.coefficient *= rest[0].coefficient;
    return result;
  }
  if (rest.size() <= most_terms) {
    try {
      // Negative powers that not every term has go to the front for the time of factoring.
      const MonomialId lowest = lowest_powers(algebra, rest);
      const Polynomial whole = algebra.times_monomial(rest, algebra.power(lowest, {-1, 1}));
      const Variables variables(algebra, {&whole});
      Rational content = 1;
      const SmallPolynomial primitive_part = primitive(variables.small(whole), content);
      const std::vector<SmallFactor> found = factors(primitive_part);
      if (found.size() > 1 || (found.size() == 1 && found[0].multiplicity > 1)) {
        std::vector<Factored::Part> parts;
        for (const SmallFactor& f : found) parts.push_back({variables.large(f.value), f.multiplicity});
        result.parts = std::move(parts);
        result.coefficient *= content;
        result.monomial = algebra.product(result.monomial, lowest);
        result.split = true;
        return result;
      }
    } catch (const NotWorthIt&) {
    } catch (const TooManyTerms&) {
    }
  }
  result.parts.push_back({std::move(rest), 1});
  return result;
}

Polynomial exact_quotient(TermAlgebra& algebra, const Polynomial& p, const Polynomial& divisor) {
  if (p.size() > 4 * most_terms || divisor.size() > most_terms) return {};
  try {
    const MonomialId low_p = lowest_powers(algebra, p), low_d = lowest_powers(algebra, divisor);
    const Polynomial whole_p = algebra.times_monomial(p, algebra.power(low_p, {-1, 1}));
    const Polynomial whole_d = algebra.times_monomial(divisor, algebra.power(low_d, {-1, 1}));
    const Variables variables(algebra, {&whole_p, &whole_d});
    const auto result = quotient(variables.small(whole_p), variables.small(whole_d));
    if (!result) return {};
    return algebra.times_monomial(variables.large(*result), algebra.quotient(low_p, low_d));
  } catch (const NotWorthIt&) {
    return {};
  } catch (const TooManyTerms&) {
    return {};
  }
}

Polynomial with_square_of_root(TermAlgebra& algebra, const Polynomial& p, AtomId base, AtomId root) {
  Polynomial rational, result;
  for (const Term& t : p) {
    Monomial m = algebra.monomial(t.monomial);
    const auto place = std::find_if(m.begin(), m.end(), [&](const Factor& f) { return f.atom == base; });
    if (place == m.end()) {
      rational.push_back(t);
      continue;
    }
    const Fraction exponent = place->exponent * Fraction{2, 1};
    m.erase(place);
    const Polynomial rest{Term{algebra.intern(m), t.harmonic, t.coefficient}};
    result = algebra.add(result, algebra.multiply(rest, algebra.of_atom(root, exponent)));
  }
  const Polynomial radicand = algebra.info(base).arguments.front();
  if (rational.size() > most_terms || radicand.size() > most_terms) return {};
  try {
    const MonomialId lowest = lowest_powers(algebra, rational);
    const Polynomial whole = algebra.times_monomial(rational, algebra.power(lowest, {-1, 1}));
    const Variables variables(algebra, {&whole, &radicand});
    const Division division = divide(variables.small(whole), variables.small(radicand));
    if (division.quotient.empty()) return {};
    const Polynomial squares =
        algebra.multiply(variables.large(division.quotient), algebra.of_atom(root, Fraction{2, 1}));
    const Polynomial found = algebra.add(squares, variables.large(division.rest));
    return algebra.add(result, algebra.times_monomial(found, lowest));
  } catch (const NotWorthIt&) {
    return {};
  }
}

}  // namespace maupertuis::terms

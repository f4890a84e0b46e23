#include "symbolic/transform/term_algebra.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>

namespace maupertuis::terms {
namespace {

void mix(std::size_t& seed, std::uint64_t value) { seed ^= value + 0x9E3779B97F4A7C15ull + (seed << 6) + (seed >> 2); }

std::uint64_t key(const Term& t) { return pair_key(t.monomial, t.harmonic); }
bool same_key(const Term& a, const Term& b) { return key(a) == key(b); }
constexpr auto key_less = [](const Term& a, const Term& b) { return key(a) < key(b); };  // std::sort inlines it

/// Terms in the order of their first appearance, like ones added up as they come: a product of sums of sines has ten
/// times as many terms as are left of it.
class LikeTerms {
 public:
  void add(MonomialId monomial, HarmonicId harmonic, const Rational& coefficient) {
    std::uint32_t& place = places_[pair_key(monomial, harmonic)];
    if (place != KeyTable::none) {
      terms_[place].coefficient += coefficient;
      return;
    }
    place = static_cast<std::uint32_t>(terms_.size());
    terms_.push_back({monomial, harmonic, coefficient});
  }
  std::vector<Term> take() {
    std::erase_if(terms_, [](const Term& t) { return t.coefficient.is_zero(); });
    return std::move(terms_);
  }

 private:
  std::vector<Term> terms_;
  KeyTable places_;
};

}  // namespace

std::size_t TermAlgebra::KeyHash::operator()(const Monomial& m) const {
  std::size_t seed = m.size();
  for (const Factor& f : m) {
    mix(seed, f.atom);
    mix(seed, pair_key(static_cast<std::uint32_t>(f.exponent.num), static_cast<std::uint32_t>(f.exponent.den)));
  }
  return seed;
}

std::size_t TermAlgebra::KeyHash::operator()(const Harmonic& h) const {
  std::size_t seed = h.sine;
  for (const Frequency& f : h.argument) {
    mix(seed, f.angle);
    mix(seed, pair_key(static_cast<std::uint32_t>(f.multiple.num), static_cast<std::uint32_t>(f.multiple.den)));
  }
  return seed;
}

TermAlgebra::TermAlgebra(Context& context, std::size_t term_budget) : context_(&context), budget_(term_budget) {
  intern(Monomial{});
  intern(Harmonic{});
}

AtomId TermAlgebra::atom(Expr e, AtomKind kind, std::vector<Polynomial> arguments) {
  const auto [place, fresh] = atom_ids_.try_emplace(e.id(), static_cast<AtomId>(atoms_.size()));
  if (fresh) atoms_.push_back({e, kind, std::move(arguments), e});
  return place->second;
}

// --------------------------------------------------------------------------------------------------- monomials

bool TermAlgebra::has_whole_base_power(const Monomial& monomial) const {
  return std::any_of(monomial.begin(), monomial.end(), [&](const Factor& f) {
    return atoms_[f.atom].kind == AtomKind::Base && f.exponent.num >= f.exponent.den;
  });
}

MonomialId TermAlgebra::intern(const Monomial& monomial) {
  const auto [place, fresh] = monomial_ids_.try_emplace(monomial, static_cast<MonomialId>(monomials_.size()));
  if (fresh) {
    monomials_.push_back(monomial);
    whole_base_power_.push_back(has_whole_base_power(monomial));
  }
  return place->second;
}

MonomialId TermAlgebra::product(MonomialId a, MonomialId b) {
  if (a == 0) return b;
  if (b == 0) return a;
  if (a > b) std::swap(a, b);
  std::uint32_t& known = products_[pair_key(a, b)];
  if (known != KeyTable::none) return known;
  const Monomial &x = monomials_[a], &y = monomials_[b];
  Monomial merged;
  merged.reserve(x.size() + y.size());
  std::size_t i = 0, j = 0;
  while (i < x.size() || j < y.size()) {
    if (j == y.size() || (i < x.size() && x[i].atom < y[j].atom))
      merged.push_back(x[i++]);
    else if (i == x.size() || y[j].atom < x[i].atom)
      merged.push_back(y[j++]);
    else {
      const Fraction exponent = x[i].exponent + y[j].exponent;
      if (!exponent.is_zero()) merged.push_back({x[i].atom, exponent});
      ++i, ++j;
    }
  }
  return known = intern(merged);
}

MonomialId TermAlgebra::power(MonomialId a, Fraction exponent) {
  Monomial raised = monomials_[a];
  for (Factor& f : raised) f.exponent = f.exponent * exponent;
  if (exponent.is_zero()) raised.clear();
  return intern(raised);
}

// --------------------------------------------------------------------------------------------------- polynomials

Polynomial TermAlgebra::constant(const Rational& value) const {
  if (value.is_zero()) return {};
  return {Term{0, 0, value}};
}

Polynomial TermAlgebra::of_atom(AtomId id, Fraction exponent) { return {Term{intern(Monomial{{id, exponent}}), 0, 1}}; }

Polynomial TermAlgebra::normalized(std::vector<Term> raw) {
  std::sort(raw.begin(), raw.end(), key_less);
  Polynomial result;
  bool whole_powers = false;
  for (std::size_t i = 0; i < raw.size();) {
    Term merged = std::move(raw[i++]);
    for (; i < raw.size() && same_key(raw[i], merged); ++i) merged.coefficient += raw[i].coefficient;
    if (merged.coefficient.is_zero()) continue;
    whole_powers |= whole_base_power_[merged.monomial] != 0;
    result.push_back(std::move(merged));
  }
  if (result.size() > budget_) throw TooManyTerms{};
  if (!whole_powers) return result;
  Polynomial expanded;
  for (const Term& term : result)
    expanded = add(expanded, whole_base_power_[term.monomial] ? with_bases_multiplied_out(term) : Polynomial{term});
  return expanded;
}

Polynomial TermAlgebra::with_bases_multiplied_out(const Term& term) {
  Monomial rest;
  Polynomial result = constant(1);
  for (Factor f : Monomial(monomials_[term.monomial])) {
    if (atoms_[f.atom].kind == AtomKind::Base && f.exponent.num >= f.exponent.den) {
      const Fraction whole{f.exponent.num / f.exponent.den, 1};
      result = multiply(result, power(Polynomial(atoms_[f.atom].arguments.front()), whole));
      f.exponent = f.exponent - whole;
    }
    if (!f.exponent.is_zero()) rest.push_back(f);
  }
  return multiply(result, Polynomial{Term{intern(rest), term.harmonic, term.coefficient}});
}

Polynomial TermAlgebra::add(const Polynomial& a, const Polynomial& b) const {
  Polynomial result;
  result.reserve(a.size() + b.size());
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && key_less(a[i], b[j])))
      result.push_back(a[i++]);
    else if (i == a.size() || key_less(b[j], a[i]))
      result.push_back(b[j++]);
    else {
      Rational total = a[i].coefficient + b[j].coefficient;
      if (!total.is_zero()) result.push_back({a[i].monomial, a[i].harmonic, std::move(total)});
      ++i, ++j;
    }
  }
  if (result.size() > budget_) throw TooManyTerms{};
  return result;
}

Polynomial TermAlgebra::scale(const Polynomial& a, const Rational& factor) const {
  if (factor.is_zero()) return {};
  Polynomial result = a;
  for (Term& term : result) term.coefficient *= factor;
  return result;
}

Polynomial TermAlgebra::times_monomial(const Polynomial& a, MonomialId monomial) {
  std::vector<Term> raw = a;
  for (Term& term : raw) term.monomial = product(term.monomial, monomial);
  return normalized(std::move(raw));
}

Polynomial TermAlgebra::multiply(const Polynomial& a, const Polynomial& b) {
  // Far beyond the budget like terms cannot be expected to save the day; below, collecting decides. The work as a
  // whole is bounded too: a large system must not take seconds before its form turns out to be too long.
  work_ += a.size() * b.size();
  if (a.size() * b.size() > 16 * budget_ || work_ > 250 * budget_) throw TooManyTerms{};
  LikeTerms terms;
  for (const Term& x : a) {
    for (const Term& y : b) {
      const MonomialId monomial = product(x.monomial, y.monomial);
      const Rational coefficient = x.coefficient * y.coefficient;
      if (x.harmonic == 0 || y.harmonic == 0) {
        terms.add(monomial, x.harmonic | y.harmonic, coefficient);
        continue;
      }
      for (const Term& h : harmonic_product(x.harmonic, y.harmonic))
        if (!h.coefficient.is_zero()) terms.add(monomial, h.harmonic, coefficient * h.coefficient);
    }
  }
  std::vector<Term> left = terms.take();
  if (left.size() > budget_) throw TooManyTerms{};  // before they are sorted
  return normalized(std::move(left));
}

std::string key_text(const Polynomial& p) {
  std::string key;
  for (const Term& t : p) {
    key.append(reinterpret_cast<const char*>(&t.monomial), sizeof t.monomial);
    key.append(reinterpret_cast<const char*>(&t.harmonic), sizeof t.harmonic);
    key += t.coefficient.to_string() + ';';
  }
  return key;
}

Rational rational_content(const Polynomial& p) {
  // gcd(a/b, c/d) of fractions in lowest terms, by Euclid's algorithm on exact rationals.
  const auto euclid = [](Rational a, Rational b) {
    while (!b.is_zero()) {
      const auto quotient = (a / b).small();
      if (!quotient) return Rational(1);
      Rational rest = a + b * Rational(-(quotient->numerator / quotient->denominator));
      a = std::move(b);
      b = std::move(rest);
    }
    return abs(a);
  };
  Rational content = 0;
  for (const Term& term : p) content = euclid(abs(term.coefficient), content);
  return content.is_zero() ? Rational(1) : content;
}

}  // namespace maupertuis::terms

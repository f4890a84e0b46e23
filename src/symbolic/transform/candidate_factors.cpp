#include "symbolic/transform/candidates.hpp"

#include <maupertuis/integral_symbol.hpp>

#include <algorithm>

/// Factored candidates, and the signs that their sums get.
namespace maupertuis::terms {

int CandidateChooser::reading_sign(const Polynomial& sum) const {
  constexpr std::size_t late = 1u << 20;
  std::size_t first = ~std::size_t{0};
  int sign = 1;
  for (const Term& t : sum) {
    std::size_t rank = 4 * late;
    bool is_function = t.harmonic != 0;
    if (t.monomial == 0 && t.harmonic == 0) rank = 2 * late;
    for (const Factor& f : algebra_.monomial(t.monomial)) {
      const Expr e = algebra_.info(f.atom).expr;
      if (e.is(Kind::Power) && f.exponent.num > 0)
        rank = std::min(rank, late);  // r - l for a root r
      else
        is_function |= !e.is_symbol() || f.exponent.num < 0;
      if (!e.is_symbol() || f.exponent.num < 0) continue;
      std::size_t symbol_rank = late + late / 2 + e.id() % (late / 2);
      if (e.role() == Role::Coordinate && is_integral(e.name())) {  // p - q B y, but x p_y - y p_x
        symbol_rank = algebra_.monomial(t.monomial).size() == 1 && !t.harmonic ? 0 : late + late / 4;
      } else if (e.role() == Role::Coordinate) {
        const Expr position = e.context().symbol(e.name(), Role::Coordinate);
        const auto place = ranks_.find(position.id());
        symbol_rank = place == ranks_.end() ? late : place->second + 1;
        if (own_ && position == own_) symbol_rank = 0;
        if (e.order() > 0) symbol_rank += late + late / 4;  // c^2 - v^2
      } else if (const auto place = ranks_.find(e.id()); place != ranks_.end()) {
        symbol_rank = late + place->second;
      }
      rank = std::min(rank, symbol_rank);
    }
    if (is_function) rank += 3 * late;  // 1 - l0/r, l - a cos θ: what is no function leads
    if (rank < first) {
      first = rank;
      sign = t.coefficient.sign();
    }
  }
  return sign;
}

Rational CandidateChooser::readable_content(const Polynomial& p) {
  constexpr std::size_t at_a_glance = 4;
  const Rational content = rational_content(p);
  if (content.is_one()) return content;
  std::size_t before = 0, after = digits_of(content), longest = after;
  for (const Term& t : p) {
    const std::size_t digits = digits_of(t.coefficient / content);
    before += digits_of(t.coefficient);
    after += digits;
    longest = std::max(longest, digits);
  }
  return longest > at_a_glance && after >= before ? Rational(1) : content;
}

/// Flat, but for the numeric factor: 2 (a + b), so that a coefficient that is multiplied on later meets it.
Expr CandidateChooser::without_content(const Polynomial& p) {
  if (p.size() < 2) return flat(p);
  const Rational content = readable_content(p);
  return algebra_.context().number(content) * flat(algebra_.scale(p, Rational(1) / content));
}

/// 1.99999985 x − 0.00000005 y, not 0.00000005 (39999997 x − y): no number in front that makes others longer.
void CandidateChooser::take_in_long_coefficient(Factored& parts) {
  for (Factored::Part& part : parts.parts) {
    if (part.multiplicity != 1) continue;
    Polynomial whole = algebra_.scale(part.sum, parts.coefficient);
    if (readable_content(whole) == abs(parts.coefficient)) return;
    part.sum = std::move(whole);
    parts.coefficient = 1;
    return;
  }
}

Expr CandidateChooser::factored(const Polynomial& p) {
  Factored parts = factored_parts(p);
  Choice choice;
  consider(choice, product_of(parts));
  // (d + x)/d for 1 + x/d: with the denominators in front.
  if (!parts.split && !parts.parts.empty()) {
    const MonomialId lowest = lowest_powers(algebra_, parts.parts.front().sum);
    if (lowest != 0) {
      parts.parts.front().sum = algebra_.times_monomial(parts.parts.front().sum, algebra_.power(lowest, {-1, 1}));
      parts.monomial = algebra_.product(parts.monomial, lowest);
      consider(choice, product_of(parts));
    }
  }
  return choice.value;
}

/// The same sums of masses stand in many places: what is left without number and monomial is factored once.
Factored CandidateChooser::factored_parts(const Polynomial& p) {
  const Rational content = rational_content(p);
  const MonomialId common = common_monomial(algebra_, p);
  const Polynomial rest =
      algebra_.scale(algebra_.times_monomial(p, algebra_.power(common, {-1, 1})), Rational(1) / content);
  const std::string key = key_text(rest);
  auto known = known_factors_.find(key);
  if (known == known_factors_.end()) known = known_factors_.emplace(key, factor(algebra_, rest)).first;
  Factored result = known->second;
  result.coefficient *= content;
  result.monomial = algebra_.product(result.monomial, common);
  return result;
}

Expr CandidateChooser::product_of(Factored parts) {
  take_in_long_coefficient(parts);
  std::vector<Expr> factors{algebra_.expression(parts.monomial, true)};
  for (Factored::Part& part : parts.parts) {
    const int sign = reading_sign(part.sum);
    if (sign < 0) {
      part.sum = algebra_.scale(part.sum, -1);
      if (part.multiplicity % 2 != 0) parts.coefficient = -parts.coefficient;
    }
    factors.push_back(pow(flat(part.sum), Rational(part.multiplicity)));
  }
  factors.push_back(algebra_.context().number(parts.coefficient));
  return algebra_.context().product(factors);
}

}  // namespace maupertuis::terms

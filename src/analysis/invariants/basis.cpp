#include "analysis/invariants/basis.hpp"

#include <algorithm>

namespace maupertuis::invariants {
namespace {

template <class Chosen>
bool any_symbol(Expr e, Chosen chosen) {
  const auto symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(), chosen);
}

/// base^(k/d) as (base^(±1/d), |k|).
std::pair<Expr, int> atom_and_exponent(Expr factor) {
  const PowerOf power = split_power(factor);
  const auto parts = power.exponent.small();
  if (!parts || std::abs(parts->numerator) > 64) return {factor, 1};
  const std::int64_t sign = parts->numerator < 0 ? -1 : 1;
  return {pow(power.base, Rational(sign, parts->denominator)), static_cast<int>(sign * parts->numerator)};
}

}  // namespace

bool is_parametric(Expr e) {
  return !any_symbol(e, [](Expr s) {
    return s.role() != Role::Parameter && s.role() != Role::Constant && s.role() != Role::Auxiliary;
  });
}
bool depends_on_coordinates(Expr e) {
  return any_symbol(e, [](Expr s) { return s.role() == Role::Coordinate && s.order() == 0; });
}
bool depends_on_velocities(Expr e) {
  return any_symbol(e, [](Expr s) { return s.role() == Role::Coordinate && s.order() > 0; });
}
bool depends_on_time_itself(Expr e) {
  return any_symbol(e, [](Expr s) { return s.role() == Role::Time; });
}

Monomial product(const Monomial& a, const Monomial& b) {
  Monomial out;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].generator < b[j].generator))
      out.push_back(a[i++]);
    else if (i == a.size() || b[j].generator < a[i].generator)
      out.push_back(b[j++]);
    else {
      out.push_back({a[i].generator, a[i].exponent + b[j].exponent});
      ++i, ++j;
    }
  }
  return out;
}

int degree(const Monomial& m) {
  int sum = 0;
  for (const Factor& f : m) sum += f.exponent;
  return sum;
}

Monomial Generators::add(Expr value) {
  const auto [it, is_new] = index_.emplace(value, static_cast<std::uint32_t>(values_.size()));
  if (is_new) values_.push_back(value);
  return {{it->second, 1}};
}

Monomial Generators::add_factors(Expr e) {
  Monomial out;
  const auto take = [&](Expr factor) {
    if (is_parametric(factor)) return;
    const auto [atom, exponent] = atom_and_exponent(factor);
    Monomial one = add(atom);
    one[0].exponent = exponent;
    out = product(out, one);
  };
  if (!e.is(Kind::Product))
    take(e);
  else
    for (std::size_t i = 0; i < e.size(); ++i) take(e[i]);
  return out;
}

Expr Generators::expression(const Monomial& m) const {
  std::vector<Expr> factors;
  for (const Factor& f : m) factors.push_back(pow(values_[f.generator], Rational(f.exponent)));
  return factors.empty() ? context_.number(1) : context_.product(factors);
}

}  // namespace maupertuis::invariants

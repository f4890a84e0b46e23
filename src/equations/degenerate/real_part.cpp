#include "equations/degenerate/real_part.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>
#include <map>

namespace maupertuis {
namespace {

std::vector<Expr> parts_of(Expr e, Kind kind) {
  if (!e.is(kind)) return {e};
  std::vector<Expr> out;
  for (std::size_t i = 0; i < e.size(); ++i)
    for (const Expr& inner : parts_of(e[i], kind)) out.push_back(inner);
  return out;
}

bool has_any(Expr e, const ExprVector& symbols) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (std::find(symbols.begin(), symbols.end(), s) != symbols.end()) return true;
  return false;
}

Expr base_of(Expr factor) { return factor.is(Kind::Power) && factor[1].is_number() ? factor[0] : factor; }
Rational exponent_of(Expr factor) {
  return factor.is(Kind::Power) && factor[1].is_number() ? factor[1].number() : Rational(1);
}

/// e times what stands below its terms' bars, so that no term has a negative power.
Expr without_bars(Expr e) {
  std::vector<std::pair<Expr, Rational>> bars;
  const std::vector<Expr> terms = parts_of(e, Kind::Sum);
  for (const Expr& term : terms)
    for (const Expr& factor : parts_of(term, Kind::Product)) {
      const Rational power = -exponent_of(factor);
      if (power.sign() <= 0) continue;
      const auto known =
          std::find_if(bars.begin(), bars.end(), [&](const auto& bar) { return bar.first == base_of(factor); });
      if (known == bars.end())
        bars.emplace_back(base_of(factor), power);
      else
        known->second = std::max(known->second, power);
    }
  if (bars.empty()) return e;
  std::vector<Expr> raised;
  for (Expr term : terms) {
    for (const auto& [bar, power] : bars) term = term * pow(bar, power);
    raised.push_back(term);
  }
  return e.context().sum(raised);
}

/// The factors that all terms have in common, as they stand in the first: r² of r² θ' − r² z.
Expr common_factor(Expr e) {
  const std::vector<Expr> terms = parts_of(e, Kind::Sum);
  Expr out = e.context().number(1);
  if (terms.size() < 2) return out;
  for (const Expr& factor : parts_of(terms.front(), Kind::Product)) {
    if (factor.is_number()) continue;
    Rational least = exponent_of(factor);
    for (const Expr& term : terms) {
      Rational here = 0;
      for (const Expr& other : parts_of(term, Kind::Product))
        if (base_of(other) == base_of(factor)) here = exponent_of(other);
      least = std::min(least, here);
    }
    if (least.sign() > 0) out = out * pow(base_of(factor), least);
  }
  return out;
}

/// Divides by the common number of all terms, with the first of them positive.
Expr without_common_number(Expr e) {
  const std::vector<Expr> terms = parts_of(e, Kind::Sum);
  const Rational first = split_coefficient(terms.front()).coefficient;
  if (terms.size() == 1) return split_coefficient(e).rest;
  const bool common = std::all_of(terms.begin(), terms.end(), [&](Expr term) {
    return (split_coefficient(term).coefficient / first).is_integer();
  });
  const Rational by = common ? first : Rational(first.sign());
  std::vector<Expr> out;
  for (const Expr& term : terms) out.push_back(term / by);
  return e.context().sum(out);
}

/// x² + 3 y² → x, y; empty where it is no such sum.
ExprVector squares_in(Expr e, const ExprVector& states) {
  const std::vector<Expr> terms = parts_of(e, Kind::Sum);
  if (terms.size() < 2) return {};
  ExprVector out;
  int sign = 0;
  for (const Expr& term : terms) {
    const ScaledTerm scaled = split_coefficient(term);
    if (sign != 0 && scaled.coefficient.sign() != sign) return {};
    sign = scaled.coefficient.sign();
    const Rational half = exponent_of(scaled.rest) / Rational(2);
    if (!scaled.rest.is(Kind::Power) || !half.is_integer() || half.sign() <= 0 || !has_any(scaled.rest, states))
      return {};
    out.push_back(base_of(scaled.rest));
  }
  return out;
}

}  // namespace

ExprVector real_parts(Expr e, const ReadingOrder& order, const ExprVector& states) {
  Context& context = e.context();
  const ReadableForm first = readable(expand_time_derivatives(e), order);
  Expr form = without_bars(first.intermediates.empty() ? first.value : e);
  const ReadableForm second = readable(form, order);
  if (second.intermediates.empty()) form = second.value;
  std::vector<Expr> factors = parts_of(form, Kind::Product);
  if (const Expr common = common_factor(form); !common.is_one()) {
    std::vector<Expr> terms;
    for (const Expr& term : parts_of(form, Kind::Sum)) terms.push_back(term / common);
    factors = parts_of(common, Kind::Product);
    factors.push_back(context.sum(terms));
  }
  Expr product = context.number(1);
  for (const Expr& factor : factors) {
    if (!has_any(factor, states) || factor.is(Kind::Exp) || exponent_of(factor).sign() < 0) continue;
    product = product * base_of(factor);
  }
  if (product.is_one()) return {form.is_number() ? context.number(1) : form};  // nothing in it can vanish
  if (const ExprVector squares = squares_in(product, states); !squares.empty()) {
    ExprVector out;
    for (const Expr& base : squares)
      for (const Expr& part : real_parts(base, order, states)) out.push_back(part);
    return out;
  }
  return {without_common_number(product)};
}

}  // namespace maupertuis

#include "equations/degenerate/real_part.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <map>
#include <optional>

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

/// exp(2 x) is the second power of exp(x).
Expr base_of(Expr factor) {
  if (factor.is(Kind::Exp)) return apply(Kind::Exp, split_coefficient(factor[0]).rest);
  return factor.is(Kind::Power) && factor[1].is_number() ? factor[0] : factor;
}
Rational exponent_of(Expr factor) {
  if (factor.is(Kind::Exp)) return split_coefficient(factor[0]).coefficient;
  return factor.is(Kind::Power) && factor[1].is_number() ? factor[1].number() : Rational(1);
}

using Powers = std::vector<std::pair<Expr, Rational>>;

/// A term times a power of a base, which a factor of it may be a power of, too.
Expr times_power(Expr term, Expr base, const Rational& power) {
  Rational whole = power;
  Expr others = term.context().number(1);
  for (const Expr& factor : parts_of(term, Kind::Product))
    if (base_of(factor) == base)
      whole = whole + exponent_of(factor);
    else
      others = others * factor;
  return others * (base.is(Kind::Exp) ? apply(Kind::Exp, whole * base[0]) : pow(base, whole));
}

Expr times_powers(Expr e, const Powers& powers, int sign) {
  std::vector<Expr> out;
  for (Expr term : parts_of(e, Kind::Sum)) {
    for (const auto& [base, power] : powers) term = times_power(term, base, Rational(sign) * power);
    out.push_back(term);
  }
  return e.context().sum(out);
}

/// e times what stands below its terms' bars, so that no term has a negative power.
Expr without_bars(Expr e) {
  Powers bars;
  for (const Expr& term : parts_of(e, Kind::Sum))
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
  return times_powers(e, bars, 1);
}

/// The factors that all terms have in common, as they stand in the first: r² of r² θ' − r² z.
Powers common_powers(Expr e) {
  const std::vector<Expr> terms = parts_of(e, Kind::Sum);
  Powers out;
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
    if (least.sign() > 0) out.emplace_back(base_of(factor), least);
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

Expr readable_whole(Expr e, const ReadingOrder& order) {
  const ReadableForm form = readable(e, order);
  return form.intermediates.empty() ? form.value : e;
}

struct Square {
  Rational factor;
  Expr base;
};

/// a s² + b s + c with a number a is a (s + b/(2a))² and a rest without s.
std::optional<std::pair<Square, Expr>> completed_square(Expr e, Expr s) {
  const Expr slope = differentiate(e, s), curvature = differentiate(slope, s);
  if (!curvature.is_number() || curvature.is_zero()) return std::nullopt;
  const ExprMap at_zero{{s, e.context().number(0)}};
  const Rational a = curvature.number() / Rational(2);
  const Expr b = substitute(slope, at_zero), c = substitute(e, at_zero);
  return std::pair(Square{a, s + b / (Rational(2) * a)}, c - b * b / (Rational(4) * a));
}

/// x² − 2 x y + 3 y² as (x − y)² + 2 y²; empty where squares of states are not all that is in it.
std::vector<Square> completed_squares(Expr e, const ExprVector& states, const ReadingOrder& order) {
  std::vector<Square> out;
  Expr left = e;
  while (!vanishes_identically(left)) {
    std::optional<std::pair<Square, Expr>> next;
    for (const Expr& s : states)
      if (!next && has_any(left, {s})) next = completed_square(left, s);
    if (!next) return {};
    out.push_back(next->first);
    left = readable_whole(next->second, order);
  }
  return out;
}

std::optional<Rational> root_of(const Rational& x, Context& context) {
  const Expr root = sqrt(context.number(x));
  return root.is_number() ? std::optional(root.number()) : std::nullopt;
}

/// The zeros of a sum that is quadratic: of squares of one sign the bases, of a difference of two its two factors.
ExprVector quadratic_parts(Expr e, const ExprVector& states, const ReadingOrder& order) {
  const std::vector<Square> squares = completed_squares(e, states, order);
  if (squares.empty()) return {};
  const int sign = squares.front().factor.sign();
  ExprVector bases;
  for (const Square& square : squares)
    if (square.factor.sign() == sign) bases.push_back(square.base);
  if (bases.size() == squares.size()) return bases;
  if (squares.size() != 2) return {};
  const auto root = root_of(-squares[1].factor / squares[0].factor, e.context());
  if (!root) return {};
  return {readable_whole(squares[0].base - *root * squares[1].base, order) *
          readable_whole(squares[0].base + *root * squares[1].base, order)};
}

}  // namespace

ExprVector real_parts(Expr e, const ReadingOrder& order, const ExprVector& states) {
  Context& context = e.context();
  const Expr form = readable_whole(without_bars(readable_whole(expand_time_derivatives(e), order)), order);
  std::vector<Expr> factors = parts_of(form, Kind::Product);
  if (const Powers common = common_powers(form); !common.empty()) {
    factors.assign(1, times_powers(form, common, -1));
    for (const auto& [base, power] : common) factors.push_back(base);
  }
  Expr product = context.number(1);
  for (const Expr& factor : factors) {
    if (!has_any(factor, states) || factor.is(Kind::Exp) || exponent_of(factor).sign() < 0) continue;
    product = product * without_common_number(base_of(factor));
  }
  if (product.is_one()) return {form.is_number() ? context.number(1) : form};  // nothing in it can vanish
  if (const ExprVector squares = squares_in(product, states); !squares.empty()) {
    ExprVector out;
    for (const Expr& base : squares)
      for (const Expr& part : real_parts(base, order, states)) out.push_back(part);
    return out;
  }
  if (product.is(Kind::Sum)) {
    const ExprVector parts = quadratic_parts(product, states, order);
    if (parts.size() == 1 && parts.front().is(Kind::Product)) return parts;
    ExprVector out;
    for (const Expr& base : parts)
      for (const Expr& part : real_parts(base, order, states)) out.push_back(part);
    if (!out.empty()) return out;
  }
  return {without_common_number(product)};
}

}  // namespace maupertuis

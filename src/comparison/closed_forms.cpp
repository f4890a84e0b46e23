#include "comparison/closed_forms.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

Expr with_zeros(Expr e, std::span<const Expr> symbols) {
  ExprMap zeros;
  for (const Expr& s : symbols) zeros.emplace(s, e.context().number(0));
  return substitute(e, zeros);
}

ExprVector coordinates_in(Expr e) {
  ExprVector out;
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate) out.push_back(s);
  return out;
}

/// √e with the perfect squares drawn out: √(4 l²) = 2 l where l > 0.
Expr root_of(Expr e, const AtStart& at_start) {
  Context& context = e.context();
  const auto factor_root = [&](Expr factor) -> Expr {
    if (const Rational* number = factor.number_or_null()) {
      const auto exact = number->sign() > 0 ? exact_root(*number, 2) : std::nullopt;
      return exact ? context.number(*exact) : sqrt(factor);
    }
    const auto [base, exponent] = split_power(factor);
    const auto whole = exponent.as_integer();
    if (!whole || *whole % 2 != 0) return sqrt(factor);
    const Expr root = pow(base, Rational(*whole / 2));
    return at_start(root) < 0 ? -root : root;
  };
  if (e.is(Kind::Sum)) {  // what cancels in it may leave one term
    const Expr collected = expand(e);
    if (!collected || collected.is(Kind::Sum)) return sqrt(e);
    e = collected;
  }
  if (!e.is(Kind::Product)) return factor_root(e);
  Expr out = context.number(1);
  for (std::size_t i = 0; i < e.size(); ++i) out = out * factor_root(e[i]);
  return out;
}

/// φ as ½ Σ h_i (x_i − c_i)² − k in the coordinates `chosen`.
std::optional<Ellipsoid> ellipsoid_in(Expr relation, const ExprVector& chosen, const AtStart& at_start) {
  Context& context = relation.context();
  Ellipsoid out;
  out.coordinates = chosen;
  const ExprVector slopes = gradient(relation, chosen);
  ExprVector curvatures;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t k = i; k < chosen.size(); ++k) {
      const Expr second = differentiate(slopes[i], chosen[k]);
      if (k != i && !vanishes_identically(second)) return std::nullopt;
      if (k == i) curvatures.push_back(second);
    }
  Expr size = -with_zeros(relation, chosen);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (holds_coordinates(curvatures[i]) || holds_time(curvatures[i]) || at_start(curvatures[i]) == 0)
      return std::nullopt;
    out.centre.push_back(-with_zeros(slopes[i], chosen) / curvatures[i]);
    size = size + context.number(Rational(1, 2)) * curvatures[i] * pow(out.centre[i], 2);
  }
  for (const Expr& other : coordinates_in(size))
    if (!vanishes_identically(differentiate(size, other))) return std::nullopt;
  size = with_zeros(size, coordinates_in(size));
  out.round = true;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Expr square = context.number(2) * size / curvatures[i];
    if (!(at_start(square) > 0)) return std::nullopt;
    out.radii.push_back(root_of(square, at_start));
    out.round = out.round && out.radii[i] == out.radii[0];
  }
  return out;
}

}  // namespace

bool holds_coordinates(Expr e) { return !coordinates_in(e).empty(); }

bool holds_time(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Time || s.role() == Role::Input) return true;
  return false;
}

Expr without_root(Expr relation) {
  if (!relation.is(Kind::Sum)) return relation;
  std::vector<Expr> rest;
  Expr root;
  for (std::size_t i = 0; i < relation.size(); ++i) {
    const auto [base, exponent] = split_power(split_coefficient(relation[i]).rest);
    if (!root && exponent == Rational(1, 2) && holds_coordinates(base))
      root = relation[i];
    else
      rest.push_back(relation[i]);
  }
  if (!root || rest.empty()) return relation;
  const Expr other = sum_of(rest, relation.context());
  return holds_coordinates(other) ? relation : pow(root, 2) - pow(other, 2);
}

std::optional<LinearSolution> solve_linear(Expr relation, Expr coordinate, const AtStart& at_start) {
  const Expr slope = differentiate(relation, coordinate);
  if (holds_coordinates(slope) || holds_time(slope)) return std::nullopt;
  const double pivot = at_start(slope);
  if (!(std::abs(pivot) > 0)) return std::nullopt;
  return LinearSolution{coordinate, -with_zeros(relation, {&coordinate, 1}) / slope, pivot};
}

std::optional<Line> find_line(Expr relation, std::span<const Expr> candidates, const AtStart& at_start) {
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t k = i + 1; k < candidates.size(); ++k) {
      const ExprVector xy{candidates[i], candidates[k]}, normal = gradient(relation, xy);
      if (holds_coordinates(normal[0]) || holds_coordinates(normal[1])) continue;
      const Expr square = normal[0] * normal[0] + normal[1] * normal[1];
      if (!(at_start(square) > 0)) continue;
      const bool unit = vanishes_identically(square - Rational(1));
      const Expr one = relation.context().number(1), size = unit ? one : sqrt(square);
      const Expr offset = with_zeros(relation, xy) / (unit ? one : square);
      return Line{xy, {-offset * normal[0], -offset * normal[1]}, {normal[1] / size, -normal[0] / size}};
    }
  return std::nullopt;
}

std::optional<Ellipsoid> find_ellipsoid(Expr relation, std::span<const Expr> candidates, const AtStart& at_start) {
  const std::size_t n = candidates.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        if (auto found = ellipsoid_in(relation, {candidates[i], candidates[j], candidates[k]}, at_start)) return found;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      if (auto found = ellipsoid_in(relation, {candidates[i], candidates[j]}, at_start)) return found;
  return std::nullopt;
}

}  // namespace maupertuis::comparison

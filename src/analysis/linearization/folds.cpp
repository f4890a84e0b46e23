#include "analysis/linearization/folds.hpp"

#include "analysis/linearization/dense.hpp"

#include <maupertuis/size_of_terms.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

/// What rounding of their terms may leave of the forces along a direction; 0 where the rows hold something else.
double rounding_along(const PointEquations::Impl& e, const OperatingPoint& rest, const Vector& direction) {
  constexpr double operations = 8;
  const Bindings at = values_at(e, rest);
  double out = 0;
  for (std::size_t i = 0; i < e.balance_rows.size(); ++i) {
    const Expr& row = e.balance_rows[i];
    const std::vector<Expr> symbols = symbols_of({&row, 1});
    if (std::any_of(symbols.begin(), symbols.end(), [&](Expr s) { return at.count(s) == 0; })) return 0;
    out += std::abs(direction[static_cast<Index>(i)]) * evaluate(size_of_terms(row), at);
  }
  return std::isfinite(out) ? operations * std::numeric_limits<double>::epsilon() * out : 0;
}

struct Along {
  double force = 0, stiffness = 0;  // dᵀ R, dᵀ K d
};

/// Multipliers follow the place: those of the rest would leave their change as a force.
Along look(PointEquations::Impl& e, OperatingPoint point, const Vector& direction) {
  RowsAtPoint rows = e.at(e.balance, point);
  if (e.m > 0 && rows.value.allFinite() && rows.by_multipliers.allFinite()) {
    const Vector change = least_squares(rows.by_multipliers, -rows.value, 1e-11).x;
    for (std::size_t k = 0; k < e.m; ++k) point.multipliers[k] += change[static_cast<Index>(k)];
    rows = e.at(e.balance, point);
  }
  return {direction.dot(rows.value), direction.dot(rows.by_q * direction)};
}

}  // namespace

Curvature curvature_at_rest(PointEquations::Impl& e, const OperatingPoint& rest, const Vector& direction) {
  constexpr double nearest = 1e-13, farthest = 1e-3,  // of the sizes of coordinates
      most_change = 1e3;
  const std::vector<double> sizes = typical_sizes(*e.system, {rest.t, rest.q, rest.v});
  double longest = 0;
  for (std::size_t i = 0; i < e.n; ++i)
    longest = std::max(longest, std::abs(direction[static_cast<Index>(i)]) / sizes[i]);
  const double stiffness = look(e, rest, direction).stiffness, rounding = rounding_along(e, rest, direction);
  const Curvature sign = stiffness > 0 ? Curvature::Positive : Curvature::Negative;
  if (!(longest > 0) || !std::isfinite(stiffness)) return sign;
  for (const double way : {1.0, -1.0})
    for (double length = nearest; length < farthest; length *= 2) {
      OperatingPoint near = rest;
      for (std::size_t i = 0; i < e.n; ++i) near.q[i] += way * length / longest * direction[static_cast<Index>(i)];
      const Along there = look(e, near, direction);
      if (!(std::abs(there.force) <= rounding)) break;
      const double ratio = there.stiffness / stiffness;  // of (r² − 1)⁶ never negative, and anything at all
      if (!(ratio > 0 && ratio < most_change)) return Curvature::Undecided;
    }
  return sign;
}

}  // namespace maupertuis

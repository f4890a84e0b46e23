#include "analysis/linearization/modes_in_digits.hpp"

#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/close_evaluation.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {

namespace {

constexpr std::size_t most_coordinates = 12;  // the time goes with the third power, the formulas with the second

/// Of one matrix.
bool is_lost(const ExprVector& entries, const Bindings& at) {
  constexpr double usual = 64 * std::numeric_limits<double>::epsilon();
  const CloseEvaluation::Values found = CloseEvaluation(entries).in_double([&](Expr symbol) { return at.at(symbol); });
  double largest = 0, error = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    largest = std::max(largest, std::abs(found.values[i]));
    if (std::isfinite(found.errors[i])) error = std::max(error, found.errors[i]);
  }
  return error > usual * largest && largest > 0;
}

}  // namespace

bool is_lost_in_entries(const PointEquations& equations, const OperatingPoint& point) {
  const PointEquations::Impl& e = equations.impl();
  if (e.n > most_coordinates) return false;
  const Bindings at = values_at(e, point);
  for (const Expr Coordinate::*symbol : {&Coordinate::q, &Coordinate::velocity, &Coordinate::acceleration}) {
    ExprVector unknowns, entries;
    for (const Coordinate& c : e.system->coordinates) unknowns.push_back(c.*symbol);
    for (const Expr& row : e.balance_rows)
      for (const Expr& entry : gradient(row, unknowns)) entries.push_back(entry);
    if (is_lost(entries, at)) return true;
  }
  return false;
}

std::optional<std::vector<PreciseMode>> modes_in_digits(const PointEquations& equations, const Equilibrium& rest) {
  const PointEquations::Impl& e = equations.impl();
  if (!rest.at_rest || !e.is_autonomous() || e.m > 0 || e.n > most_coordinates || rest.point.turning.rows > 0)
    return std::nullopt;
  if (!switches_of(e.balance_rows).empty()) return std::nullopt;
  RowsOfMotion motion;
  for (const Expr& row : substitute(e.balance_rows, exact_parameters(e))) motion.rows.push_back(row);
  for (const Coordinate& c : e.system->coordinates) {
    motion.q.push_back(c.q);
    motion.v.push_back(c.velocity);
    motion.a.push_back(c.acceleration);
  }
  return precise_modes(motion, values_at(e, rest.point),
                       typical_sizes(*e.system, {rest.point.t, rest.point.q, rest.point.v}));
}

}  // namespace maupertuis

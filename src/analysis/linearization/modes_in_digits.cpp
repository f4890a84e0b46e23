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

/// Of the rows of the balance by q, then q̇, then q̈: one matrix behind the other.
const CloseEvaluation& entries_of(const PointEquations::Impl& e) {
  if (e.entries_of_balance) return *e.entries_of_balance;
  ExprVector entries;
  for (const Expr Coordinate::*symbol : {&Coordinate::q, &Coordinate::velocity, &Coordinate::acceleration}) {
    ExprVector unknowns;
    for (const Coordinate& c : e.system->coordinates) unknowns.push_back(c.*symbol);
    for (const Expr& row : e.balance_rows)
      for (const Expr& entry : gradient(row, unknowns)) entries.push_back(entry);
  }
  return e.entries_of_balance.emplace(entries);
}

/// Of one matrix.
bool is_lost(std::span<const double> values, std::span<const double> errors) {
  constexpr double usual = 64 * std::numeric_limits<double>::epsilon();
  double largest = 0, error = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    largest = std::max(largest, std::abs(values[i]));
    if (std::isfinite(errors[i])) error = std::max(error, errors[i]);
  }
  return error > usual * largest && largest > 0;
}

}  // namespace

bool is_lost_in_entries(const PointEquations& equations, const OperatingPoint& point) {
  const PointEquations::Impl& e = equations.impl();
  if (e.n > most_coordinates) return false;
  const Bindings at = values_at(e, point);
  const CloseEvaluation::Values found = entries_of(e).in_double([&](Expr symbol) { return at.at(symbol); });
  const std::span<const double> values(found.values), errors(found.errors);
  const std::size_t size = e.n * e.n;
  for (std::size_t block = 0; block < 3; ++block)
    if (is_lost(values.subspan(block * size, size), errors.subspan(block * size, size))) return true;
  return false;
}

void restore_entries(const PointEquations& equations, const OperatingPoint& point, RowsAtPoint& balance) {
  if (!point.input_rates.empty() || !is_lost_in_entries(equations, point)) return;
  const PointEquations::Impl& e = equations.impl();
  const Bindings at = values_at(e, point);
  const std::vector<double> values = entries_of(e)([&](Expr symbol) { return at.at(symbol); }).values;
  using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto n = static_cast<Index>(e.n);
  const double* block = values.data();
  for (Matrix* of : {&balance.by_q, &balance.by_v, &balance.by_a}) {
    *of = Eigen::Map<const ByRows>(block, n, n);
    block += n * n;
  }
}

namespace {

/// Whether each constraint has its force, and those on velocities are kept by whatever rests, φ_q and ψ_q̇ being all
/// that is asked of neighbours.
bool constrains_plainly(const PointEquations::Impl& e) {
  const std::vector<Constraint>& all = e.system->constraints;
  if (e.relations.kernel.size() > 0) return false;
  if (std::any_of(all.begin(), all.end(), [](const Constraint& c) { return c.forceless; })) return false;
  ExprMap at_rest;
  for (const Coordinate& c : e.system->coordinates) at_rest.emplace(c.velocity, e.system->context->number(0));
  const ExprVector on_velocities(e.kept_rows.begin() + static_cast<std::ptrdiff_t>(e.holonomic), e.kept_rows.end());
  const ExprVector resting = substitute(on_velocities, at_rest);
  return std::all_of(resting.begin(), resting.end(), [](const Expr& row) { return row.is_zero(); });
}

RowsOfMotion exact_rows(const PointEquations::Impl& e) {
  const ExprMap exact = exact_parameters(e);
  RowsOfMotion out;
  out.rows = substitute(e.balance_rows, exact);
  for (const Coordinate& c : e.system->coordinates) {
    out.q.push_back(c.q);
    out.v.push_back(c.velocity);
    out.a.push_back(c.acceleration);
  }
  for (const Constraint& c : e.system->constraints) out.multipliers.push_back(c.multiplier);
  out.positions = substitute(e.kept_rows, exact);
  out.positions.resize(e.holonomic);
  return out;
}

}  // namespace

std::optional<std::vector<PreciseMode>> modes_in_digits(const PointEquations& equations, const Equilibrium& rest) {
  const PointEquations::Impl& e = equations.impl();
  if (!rest.at_rest || !e.is_autonomous() || e.n > most_coordinates || rest.point.turning.rows > 0) return std::nullopt;
  if (!constrains_plainly(e) || !switches_of(e.balance_rows).empty() || !switches_of(e.kept_rows).empty())
    return std::nullopt;
  return precise_modes(exact_rows(e), values_at(e, rest.point),
                       typical_sizes(*e.system, {rest.point.t, rest.point.q, rest.point.v}));
}

}  // namespace maupertuis

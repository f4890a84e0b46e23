#include "system/elaboration.hpp"

#include <maupertuis/quaternion_coordinates.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// A point of steady motion that gives rates: `at θ = 90 deg, ω1 = 2 rad/s`. The velocities follow from them, from the
/// other rates of the model and the constraints, which are 0 there, and from velocities that stay 0.
namespace maupertuis::elaboration {
namespace {

/// Σ_j slopes_j q̇_j = value, in parameters and numbers.
struct PointRow {
  ExprVector slopes;  // [n]
  Expr value;
};

/// Rows for the velocities, brought to a form with a pivot column each.
class PointRows {
 public:
  explicit PointRows(Elaboration& e) : e_(e) {}

  /// False where it is a combination of the rows before it.
  bool add(PointRow row) {
    for (const auto& [column, other] : rows_) reduce(row, other, column);
    std::size_t best = 0;
    double largest = 0, size = 1e-300;
    for (std::size_t j = 0; j < row.slopes.size(); ++j) {
      const double x = std::abs(number_at(row.slopes[j]));
      if (x > largest) largest = x, best = j;
      size = std::max(size, x);
    }
    constexpr double rounding = 1e-12;
    if (!(largest > rounding)) return false;
    const Expr pivot = row.slopes[best];
    for (Expr& s : row.slopes) s = s / pivot;
    row.value = row.value / pivot;
    for (auto& [column, other] : rows_) reduce(other, row, best);
    rows_.emplace_back(best, std::move(row));
    return true;
  }

  /// q̇, once there are as many rows as velocities.
  std::vector<std::pair<std::size_t, Expr>> velocities() const {
    std::vector<std::pair<std::size_t, Expr>> out;
    for (const auto& [column, row] : rows_) out.emplace_back(column, row.value);
    return out;
  }

  double number_at(Expr e) const { return maupertuis::evaluate(e, e_.values); }

 private:
  void reduce(PointRow& row, const PointRow& by, std::size_t column) const {
    const Expr factor = row.slopes[column];
    constexpr double rounding = 1e-14;
    if (std::abs(number_at(factor)) < rounding) {
      row.slopes[column] = e_.context.number(0);
      return;
    }
    for (std::size_t j = 0; j < row.slopes.size(); ++j)
      row.slopes[j] = j == column ? e_.context.number(0) : row.slopes[j] - factor * by.slopes[j];
    row.value = row.value - factor * by.value;
  }

  Elaboration& e_;
  std::vector<std::pair<std::size_t, PointRow>> rows_;
};

const StartValue* given_at(const std::vector<StartValue>& values, std::size_t coordinate) {
  for (const StartValue& v : values)
    if (v.order == 0 && v.coordinate == coordinate) return &v;
  return nullptr;
}

/// A body turned by a quaternion of which the point says nothing has the axes of space; where it gives some of x, y, z,
/// the others are 0 and w makes the norm 1.
void complete_quaternions(Elaboration& e, Span span, std::vector<StartValue>& values) {
  for (const auto& [w, x, y, z] : quaternion_coordinates(e.system())) {
    if (given_at(values, w)) continue;
    Expr rest = e.number(1);
    for (const std::size_t i : {x, y, z}) {
      const StartValue* v = given_at(values, i);
      if (v) rest = rest - pow(v->value, 2);
      if (!v) values.push_back({i, 0, e.number(0), span, {}, 1});
    }
    values.push_back({w, 0, sqrt(rest), span, {}, 1});
  }
}

/// The coordinates of the point; where it says nothing 0.
ExprMap configuration(Elaboration& e, const std::vector<StartValue>& values) {
  ExprMap at;
  for (std::size_t i = 0; i < e.system().coordinates.size(); ++i) {
    const StartValue* v = given_at(values, i);
    at.emplace(e.system().coordinates[i].q, v ? v->value : e.context.number(0));
  }
  at.emplace(e.context.time(), e.context.number(0));
  return at;
}

/// What a rate depends on keeps the place at which the velocities were found, or the rate would be another one.
void hold_places_of_rates(Elaboration& e, const std::vector<StartCondition>& rates, std::vector<StartValue>& values) {
  for (const StartCondition& r : rates) {
    const Expr formula = expand_time_derivatives(r.formula);
    for (const Expr& s : symbols_of({&formula, 1}))
      for (std::size_t i = 0; i < e.system().coordinates.size(); ++i)
        if (e.system().coordinates[i].q == s && !given_at(values, i))
          values.push_back({i, 0, e.number(0), r.span, {}, 1});
  }
}

PointRow row_at(Elaboration& e, Expr rate, Expr value, const ExprMap& at) {
  ExprVector velocities;
  ExprMap at_rest;
  for (const Coordinate& c : e.system().coordinates) {
    velocities.push_back(c.velocity);
    at_rest.emplace(c.velocity, e.context.number(0));
  }
  const Expr expanded = expand_time_derivatives(rate);
  return {substitute(substitute(gradient(expanded, velocities), at_rest), at),
          value - substitute(substitute(expanded, at_rest), at)};
}

Expr rate_of(Elaboration&, const Constraint& c) {
  return c.level == Constraint::Level::Velocity ? c.value : total_time_derivative(c.value);
}

}  // namespace

bool add_velocities_of_rates(Elaboration& e, const std::vector<StartCondition>& rates,
                             std::vector<StartValue>& values) {
  if (rates.empty()) return true;
  complete_quaternions(e, rates.front().span, values);
  hold_places_of_rates(e, rates, values);
  const ExprMap at = configuration(e, values);
  PointRows rows(e);
  for (const StartCondition& r : rates)
    if (!rows.add(row_at(e, r.formula, r.value, at))) {
      e.diagnostics.error("E0223", r.span,
                          fmt::format("no velocity gives `{}` this value there", e.texts.slice(r.span)),
                          "At this configuration it is a combination of the other rates that are given, or no velocity "
                          "changes it.",
                          "Leave it out, or give another configuration: at a pole of angles rates fail.");
      return false;
    }
  for (const StartValue& v : values)
    if (v.order == 1) rows.add(row_at(e, e.system().coordinates[v.coordinate].velocity, v.value, at));
  const Expr zero = e.number(0);
  for (const Constraint& c : e.system().constraints) rows.add(row_at(e, rate_of(e, c), zero, at));
  for (const Rate& r : e.system().rates) rows.add(row_at(e, r.value, zero, at));
  for (const Coordinate& c : e.system().coordinates) rows.add(row_at(e, c.velocity, zero, at));
  for (const auto& [coordinate, velocity] : rows.velocities()) {
    const bool given = std::any_of(values.begin(), values.end(),
                                   [c = coordinate](const StartValue& v) { return v.order == 1 && v.coordinate == c; });
    constexpr double rounding = 1e-14;
    if (!given && std::abs(rows.number_at(velocity)) > rounding)
      values.push_back({coordinate, 1, velocity, rates.front().span, {}, 1});
  }
  return true;
}

}  // namespace maupertuis::elaboration

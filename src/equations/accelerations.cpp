#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/linear_system.hpp>
#include <maupertuis/scattered_point.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis {
namespace {

/// The same elimination in numbers, at one point, with the largest term of each entry: an entry that is far from 0
/// beside it does not vanish, and what it costs to see that does not grow with the formula. Where the point tells
/// nothing the zero test decides. (Were a pivot 0 all the same, the quotient would have no value anywhere, and no proof
/// would come.)
class AtOnePoint {
 public:
  explicit AtOnePoint(const ExprMatrix& m) : columns_(m.columns) {
    values_ = evaluate(m.entries, scattered_point(symbols_of(m.entries)));
    for (const double v : values_) {
      sizes_.push_back(std::abs(v));
      known_ = known_ && std::isfinite(v);
    }
  }

  bool sees_nonzero(std::size_t row, std::size_t column) const {
    constexpr double cancelled = 1e-5;
    const std::size_t at = row * columns_ + column;
    return known_ && std::isfinite(values_[at]) && std::abs(values_[at]) > cancelled * sizes_[at];
  }
  /// From then on the zero test alone: the pivot is no number here that could be divided by.
  void give_up() { known_ = false; }
  void swap_rows(std::size_t a, std::size_t b) {
    for (std::size_t k = 0; k < columns_; ++k) {
      std::swap(values_[a * columns_ + k], values_[b * columns_ + k]);
      std::swap(sizes_[a * columns_ + k], sizes_[b * columns_ + k]);
    }
  }
  void eliminate(std::size_t row, std::size_t pivot) {
    if (!known_) return;
    const double factor = values_[row * columns_ + pivot] / values_[pivot * columns_ + pivot];
    for (std::size_t k = pivot + 1; k < columns_; ++k) {
      const double term = factor * values_[pivot * columns_ + k];
      values_[row * columns_ + k] -= term;
      double& size = sizes_[row * columns_ + k];
      size = std::max(size, std::abs(term));
    }
  }

 private:
  std::size_t columns_;
  std::vector<double> values_, sizes_;
  bool known_ = true;
};

/// Brings a row with a nonzero entry in `column` to place `column`; false if there is none.
bool choose_pivot(ExprMatrix& m, std::size_t column, AtOnePoint& numbers) {
  for (std::size_t row = column; row < m.rows; ++row) {
    const Expr e = m.at(row, column);
    if (e.is_zero()) continue;
    const bool seen = numbers.sees_nonzero(row, column);
    if (!seen && !e.is_number() && !e.is_symbol() && zero_test(e).verdict != Verdict::Nonzero) continue;
    if (!seen) numbers.give_up();
    if (row == column) return true;
    for (std::size_t k = 0; k < m.columns; ++k) std::swap(m.at(row, k), m.at(column, k));
    numbers.swap_rows(row, column);
    return true;
  }
  return false;
}

/// Rows that are linear in `unknowns` as an augmented matrix: [∂rows/∂unknowns | −rows(unknowns = 0)].
ExprMatrix augmented_matrix(const ExprVector& rows, const ExprVector& unknowns, Context& context) {
  ExprMap at_rest;
  for (const Expr& unknown : unknowns) at_rest.emplace(unknown, context.number(0));
  const ExprVector expanded = expand_time_derivatives(rows);
  const ExprVector rest = substitute(expanded, at_rest);
  ExprMatrix matrix{rows.size(), unknowns.size() + 1, {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Expr& entry : gradient(expanded[i], unknowns)) matrix.entries.push_back(entry);
    matrix.entries.push_back(-rest[i]);
  }
  return matrix;
}

ExprVector acceleration_symbols(const MechanicalSystem& system) {
  ExprVector symbols;
  for (const Coordinate& c : system.coordinates) symbols.push_back(c.acceleration);
  return symbols;
}

}  // namespace

std::optional<ExprVector> solve_linear(ExprMatrix m) {
  const std::size_t n = m.rows;
  if (n == 0) return ExprVector{};
  AtOnePoint numbers(m);
  for (std::size_t column = 0; column < n; ++column) {
    interrupt_of(m.at(0, 0).context()).throw_if_asked();
    if (!choose_pivot(m, column, numbers)) return std::nullopt;
    for (std::size_t row = column + 1; row < n; ++row) {
      if (m.at(row, column).is_zero()) continue;
      const Expr factor = m.at(row, column) / m.at(column, column);
      for (std::size_t k = column + 1; k <= n; ++k) m.at(row, k) = m.at(row, k) - factor * m.at(column, k);
      numbers.eliminate(row, column);
    }
  }
  ExprVector solution(n);
  for (std::size_t i = n; i-- > 0;) {
    Expr value = m.at(i, n);
    for (std::size_t k = i + 1; k < n; ++k) value = value - m.at(i, k) * solution[k];
    solution[i] = value / m.at(i, i);
  }
  return solution;
}

std::optional<ExprVector> accelerations(const ExprVector& residual, const MechanicalSystem& system) {
  return solve_linear(augmented_matrix(residual, acceleration_symbols(system), *system.context));
}

std::optional<ExprVector> accelerations(const EquationsOfMotion& equations) {
  if (!equations.system->constrained()) return accelerations(equations.residual, *equations.system);
  auto motion = accelerations_and_multipliers(equations);
  return motion ? std::optional(std::move(motion->accelerations)) : std::nullopt;
}

std::optional<ConstrainedMotion> accelerations_and_multipliers(const ExprVector& balance,
                                                               const ExprVector& constraint_accelerations,
                                                               const MechanicalSystem& system) {
  ExprVector rows = balance, unknowns = acceleration_symbols(system);
  rows.insert(rows.end(), constraint_accelerations.begin(), constraint_accelerations.end());
  for (const Constraint& c : system.constraints) unknowns.push_back(c.multiplier);
  const auto solution = solve_linear(augmented_matrix(rows, unknowns, *system.context));
  if (!solution) return std::nullopt;
  const auto first_multiplier = solution->begin() + static_cast<std::ptrdiff_t>(system.coordinates.size());
  return ConstrainedMotion{{solution->begin(), first_multiplier}, {first_multiplier, solution->end()}};
}

std::optional<ConstrainedMotion> accelerations_and_multipliers(const EquationsOfMotion& equations) {
  return accelerations_and_multipliers(equations.balance(), equations.constraint_accelerations, *equations.system);
}

}  // namespace maupertuis

#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/linear_system.hpp>

#include <utility>

namespace maupertuis {
namespace {

bool is_pivot(Expr e) {
  return !e.is_zero() && (e.is_number() || e.is_symbol() || zero_test(e).verdict == Verdict::Nonzero);
}

/// Brings a row with a nonzero entry in `column` to place `column`; false if there is none.
bool choose_pivot(ExprMatrix& m, std::size_t column) {
  for (std::size_t row = column; row < m.rows; ++row) {
    if (!is_pivot(m.at(row, column))) continue;
    for (std::size_t k = 0; row != column && k < m.columns; ++k) std::swap(m.at(row, k), m.at(column, k));
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
  for (std::size_t column = 0; column < n; ++column) {
    if (!choose_pivot(m, column)) return std::nullopt;
    for (std::size_t row = column + 1; row < n; ++row) {
      if (m.at(row, column).is_zero()) continue;
      const Expr factor = m.at(row, column) / m.at(column, column);
      for (std::size_t k = column + 1; k <= n; ++k) m.at(row, k) = m.at(row, k) - factor * m.at(column, k);
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

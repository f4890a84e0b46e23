#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <utility>

namespace maupertuis {
namespace {

/// M and h of a residual that is linear in q̈: M = ∂R/∂q̈, h = R(q̈ = 0), as one augmented matrix [M | −h].
ExprMatrix augmented_matrix(const ExprVector& residual, const MechanicalSystem& system) {
  const std::size_t n = system.coordinates.size();
  ExprVector symbols;
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) {
    symbols.push_back(c.acceleration);
    at_rest.emplace(c.acceleration, system.context->number(0));
  }
  const ExprVector expanded = expand_time_derivatives(residual);
  const ExprVector h = substitute(expanded, at_rest);
  ExprMatrix matrix{n, n + 1, {}};
  for (std::size_t i = 0; i < n; ++i) {
    for (const Expr& entry : gradient(expanded[i], symbols)) matrix.entries.push_back(entry);
    matrix.entries.push_back(-h[i]);
  }
  return matrix;
}

bool is_pivot(Expr e) { return !e.is_zero() && (e.is_number() || e.is_symbol() || zero_test(e).verdict == Verdict::Nonzero); }

/// Brings a row with a nonzero entry in `column` to place `column`; false if there is none.
bool choose_pivot(ExprMatrix& m, std::size_t column) {
  for (std::size_t row = column; row < m.rows; ++row) {
    if (!is_pivot(m.at(row, column))) continue;
    for (std::size_t k = 0; k < m.columns; ++k) std::swap(m.at(row, k), m.at(column, k));
    return true;
  }
  return false;
}

}  // namespace

std::optional<ExprVector> accelerations(const ExprVector& residual, const MechanicalSystem& system) {
  ExprMatrix m = augmented_matrix(residual, system);
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

std::optional<ExprVector> accelerations(const EquationsOfMotion& equations) {
  return accelerations(equations.residual, *equations.system);
}

}  // namespace maupertuis

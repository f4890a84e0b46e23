#include "comparison/differences.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

/// Below this, relative to the largest entry of its column, an entry is no pivot: a repeated constraint.
constexpr double pivot_threshold = 1e-9;

/// [A_Aᵀ | R_A] with the numbers of A_Aᵀ beside it.
class Elimination {
 public:
  Elimination(const ExprMatrix& a, const ExprVector& residual, const Bindings& at) : at_(at) {
    for (std::size_t i = 0; i < residual.size(); ++i) {
      ExprVector row;
      for (std::size_t k = 0; k < a.rows; ++k) row.push_back(a.at(k, i));
      row.push_back(residual[i]);
      rows_.push_back(std::move(row));
      open_.push_back(i);
    }
    for (std::size_t k = 0; k < a.rows; ++k) columns_.push_back(k);
    scale_.assign(a.rows, 0);
    for (const auto& row : rows_)
      for (std::size_t k = 0; k < a.rows; ++k) scale_[k] = std::max(scale_[k], std::abs(number(row[k])));
  }

  Differences carry_out() {
    while (!columns_.empty() && step()) {
    }
    Differences out;
    for (const std::size_t i : open_) {
      out.values.push_back(rows_[i].back());
      out.coordinates.push_back(i);
    }
    return out;
  }

 private:
  double number(Expr e) const { return evaluate(e, at_); }

  /// One pivot, the largest; false where none is left.
  bool step() {
    double best = pivot_threshold;
    std::size_t row = 0, column = 0;
    for (const std::size_t i : open_)
      for (const std::size_t k : columns_) {
        if (rows_[i][k].is_zero() || scale_[k] == 0) continue;
        const double size = std::abs(number(rows_[i][k])) / scale_[k];
        if (size > best) best = size, row = i, column = k;
      }
    if (best == pivot_threshold) return false;
    open_.erase(std::find(open_.begin(), open_.end(), row));
    columns_.erase(std::find(columns_.begin(), columns_.end(), column));
    for (const std::size_t i : open_) {
      if (rows_[i][column].is_zero()) continue;
      const Expr factor = rows_[i][column] / rows_[row][column];
      for (const std::size_t k : columns_) rows_[i][k] = rows_[i][k] - factor * rows_[row][k];
      rows_[i].back() = rows_[i].back() - factor * rows_[row].back();
    }
    return true;
  }

  const Bindings& at_;
  std::vector<ExprVector> rows_;
  std::vector<std::size_t> open_, columns_;
  std::vector<double> scale_;
};

}  // namespace

Differences without_multipliers(const EquationsOfMotion& a, const PullBack& pull_back, const Bindings& at) {
  const ExprVector residual = pull_back(expand_time_derivatives(a.residual));
  ExprMatrix matrix = constraint_matrix(a);
  matrix.entries = pull_back(matrix.entries);
  return Elimination(matrix, residual, at).carry_out();
}

ExprVector work_differences(const EquationsOfMotion& a, const EquationsOfMotion& b, const PullBack& pull_back) {
  const MechanicalSystem& system = *b.system;
  const ExprVector of_a = pull_back(expand_time_derivatives(a.residual));
  const ExprVector of_b = with_constants_as_numbers(
      system, expand_time_derivatives(in_terms_of_motion(system, expand_time_derivatives(b.residual))));
  ExprVector q;
  for (const Coordinate& c : system.coordinates) q.push_back(c.q);
  std::vector<ExprVector> terms(q.size());
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const ExprVector slopes = gradient(pull_back.positions()[i], q);
    for (std::size_t k = 0; k < q.size(); ++k) terms[k].push_back(slopes[k] * of_a[i]);
  }
  ExprVector out;
  for (std::size_t k = 0; k < q.size(); ++k) out.push_back(system.context->sum(terms[k]) - of_b[k]);
  return out;
}

ExprVector mapped_constraints(const MechanicalSystem& a, const PullBack& pull_back) {
  ExprVector values;
  for (const Constraint& c : a.constraints) values.push_back(c.value);
  return pull_back(values);
}

}  // namespace maupertuis::comparison

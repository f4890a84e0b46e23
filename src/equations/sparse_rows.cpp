#include "equations/sparse_rows.hpp"

#include "equations/row_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace maupertuis {
namespace {

constexpr double acceptable_pivot = 0.1;  // of the largest entry of a row, where another column leaves less to do

/// Every row is reduced by the pivots before it; what is left of it gives the next pivot, in a column that few later
/// rows know. What was taken off each row is kept, so that a row of which nothing is left is known as a combination.
class Elimination {
 public:
  explicit Elimination(const SparseRows& matrix)
      : matrix_(matrix),
        later_rows_(matrix.columns, 0),
        pivot_of_(matrix.columns, none),
        values_(matrix.columns, 0),
        present_(matrix.columns, false) {
    for (const SparseRows::Row& row : matrix.rows)
      for (const auto& entry : row) ++later_rows_[entry.first];
  }

  RowDependence carry_out() {
    RowDependence out;
    for (std::size_t i = 0; i < matrix_.rows.size(); ++i) {
      const SparseRows::Row taken_off = reduce(matrix_.rows[i]);
      for (const auto& entry : matrix_.rows[i]) --later_rows_[entry.first];
      const std::size_t column = choose_pivot(norm(matrix_.rows[i]));
      if (column == none) {
        out.dependent.push_back({i, in_given_rows(taken_off, out.independent)});
        clear();
        continue;
      }
      pivot_of_[column] = pivots_.size();
      const double value = values_[column];
      pivots_.push_back({column, value, take_row(), taken_off});
      out.independent.push_back(i);
    }
    return out;
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  struct Pivot {
    std::size_t column;
    double value;               // of the row there
    SparseRows::Row row;        // reduced
    SparseRows::Row taken_off;  // given row = this row + Σ factor · earlier reduced rows
  };

  /// Leaves the reduced row in the work space; the factors by ascending pivots.
  SparseRows::Row reduce(const SparseRows::Row& row) {
    for (const auto& [column, value] : row) add(column, value);
    SparseRows::Row factors;
    while (!waiting_.empty()) {
      const std::size_t k = waiting_.top();
      waiting_.pop();
      const Pivot& pivot = pivots_[k];
      const double value = values_[pivot.column];
      if (value == 0) continue;  // waited twice
      const double factor = value / pivot.value;
      for (const auto& [column, entry] : pivot.row) add(column, -factor * entry);
      values_[pivot.column] = 0;
      factors.emplace_back(k, factor);
    }
    return factors;
  }

  void add(std::size_t column, double value) {
    if (!present_[column]) {
      present_[column] = true;
      touched_.push_back(column);
      if (pivot_of_[column] != none) waiting_.push(pivot_of_[column]);
    } else if (pivot_of_[column] != none && values_[column] == 0) {
      waiting_.push(pivot_of_[column]);
    }
    values_[column] += value;
  }

  std::size_t choose_pivot(double length) const {
    double largest = 0;
    for (const std::size_t column : touched_) largest = std::max(largest, std::abs(values_[column]));
    if (!(largest > rank_tolerance * length)) return none;
    std::size_t best = none;
    const auto better = [&](std::size_t a, std::size_t b) {
      if (later_rows_[a] != later_rows_[b]) return later_rows_[a] < later_rows_[b];
      return std::abs(values_[a]) > std::abs(values_[b]);
    };
    for (const std::size_t column : touched_)
      if (std::abs(values_[column]) >= acceptable_pivot * largest && (best == none || better(column, best)))
        best = column;
    return best;
  }

  SparseRows::Row take_row() {
    SparseRows::Row row;
    for (const std::size_t column : touched_)
      if (values_[column] != 0) row.emplace_back(column, values_[column]);
    clear();
    return row;
  }

  void clear() {
    for (const std::size_t column : touched_) values_[column] = 0, present_[column] = false;
    touched_.clear();
  }

  /// Σ factor · reduced rows as a combination of the given rows that they came from.
  SparseRows::Row in_given_rows(const SparseRows::Row& of_reduced, const std::vector<std::size_t>& independent) const {
    std::vector<double> weights(pivots_.size(), 0);
    for (const auto& [k, factor] : of_reduced) weights[k] = factor;
    SparseRows::Row out;
    for (std::size_t k = pivots_.size(); k-- > 0;) {
      if (weights[k] == 0) continue;
      out.emplace_back(independent[k], weights[k]);
      for (const auto& [earlier, factor] : pivots_[k].taken_off) weights[earlier] -= weights[k] * factor;
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

  const SparseRows& matrix_;
  std::vector<std::size_t> later_rows_;  // [columns] that know the column
  std::vector<std::size_t> pivot_of_;    // [columns]
  std::vector<Pivot> pivots_;
  // The row that is reduced.
  std::vector<double> values_;
  std::vector<bool> present_;
  std::vector<std::size_t> touched_;
  std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> waiting_;  // pivots whose column it has
};

}  // namespace

double norm(const SparseRows::Row& row) {
  double sum = 0;
  for (const auto& entry : row) sum += entry.second * entry.second;
  return std::sqrt(sum);
}

RowDependence dependence_of(const SparseRows& matrix) { return Elimination(matrix).carry_out(); }

std::size_t sparse_rank(const SparseRows& matrix) { return dependence_of(matrix).independent.size(); }

}  // namespace maupertuis

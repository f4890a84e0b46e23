#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace maupertuis {

/// Rows of numbers by elimination, one after the other: whether the next one is a combination of those before it, to
/// 1e-9 of its largest entry. Cost O(rows · columns) a row. Rows are as long as each other.
class IndependentRows {
 public:
  /// True where it is no combination of the others; then it is one of them.
  bool add(std::vector<double> row) {
    const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
    if (row.empty()) return false;
    const double size = std::abs(*std::max_element(row.begin(), row.end(), smaller));
    for (const auto& [pivot, other] : rows_) {
      const double factor = row[pivot];
      for (std::size_t k = 0; k < row.size(); ++k) row[k] -= factor * other[k];
    }
    const auto largest = std::max_element(row.begin(), row.end(), smaller);
    constexpr double rounding = 1e-9;
    if (!(std::abs(*largest) > rounding * size)) return false;
    const auto pivot = static_cast<std::size_t>(largest - row.begin());
    const double scale = *largest;
    for (double& x : row) x /= scale;
    rows_.emplace_back(pivot, std::move(row));
    return true;
  }
  std::size_t rank() const { return rows_.size(); }

 private:
  std::vector<std::pair<std::size_t, std::vector<double>>> rows_;  // column of the pivot, which is 1; row
};

}  // namespace maupertuis

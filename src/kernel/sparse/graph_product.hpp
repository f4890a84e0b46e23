#pragma once
#include "kernel/sparse/lifted_system.hpp"

namespace maupertuis::sparse {

/// M₀ x along the tangent graph, from the entries of its lifted system.
class GraphProduct {
 public:
  explicit GraphProduct(const LiftedSystem& system);

  /// out = M₀ x; [unknowns] each.
  void multiply(std::span<const double> entries, std::span<const double> x, std::span<double> out);

  /// rest = b − M₀ x. Returns its largest part in units of a bound of the rounding errors with which it was computed
  /// (running error analysis: N. J. Higham, Accuracy and Stability of Numerical Algorithms, §3.3): below 1, x cannot be
  /// told from an exact solution. Tangents that are known too are compared in the same way: those of cells below
  /// `known`, at cells[cell_of_column[…]].
  double remainder(std::span<const double> entries, std::span<const double> x, std::span<const double> b,
                   std::span<double> rest, const double* cells = nullptr,
                   std::span<const std::uint32_t> cell_of_column = {}, std::size_t known = 0);

 private:
  struct Row {
    std::uint32_t column;       // whose unknown it gives; none: b
    std::uint32_t residual;     // index in b
    std::uint32_t first, last;  // in row_entries_
  };
  struct RowEntry {
    std::uint32_t entry, column;
  };
  struct WithError {
    double value, error;  // and a bound of its rounding error
  };

  std::vector<Row> rows_;
  std::vector<RowEntry> row_entries_;
  std::vector<WithError> z_;  // [columns]
};

}  // namespace maupertuis::sparse

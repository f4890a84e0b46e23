#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace maupertuis {

/// A matrix of few entries, in numbers, by rows.
struct SparseRows {
  using Row = std::vector<std::pair<std::size_t, double>>;  // column and value, each column once
  std::size_t columns = 0;
  std::vector<Row> rows;
};

double norm(const SparseRows::Row& row);

/// A row that is a combination of rows before it.
struct DependentRow {
  std::size_t row = 0;
  SparseRows::Row combination;  // of independent rows, ascending; none: the row vanishes
};

struct RowDependence {
  std::vector<std::size_t> independent;  // rows that are no combination of those before them: as many as the rank
  std::vector<DependentRow> dependent;
};

/// By elimination, row by row. The rows come scaled: what is left of one below `rank_tolerance` of its length counts as
/// nothing. Cost: proportional to the entries where the rows are those of a chain or a tree.
RowDependence dependence_of(const SparseRows& matrix);

/// The rank, likewise.
std::size_t sparse_rank(const SparseRows& matrix);

}  // namespace maupertuis

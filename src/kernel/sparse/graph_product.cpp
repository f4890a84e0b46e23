#include "kernel/sparse/graph_product.hpp"

#include <cmath>
#include <limits>

namespace maupertuis::sparse {
namespace {
constexpr std::uint32_t none = ~std::uint32_t{0};
}  // namespace

/// The tangents slot by slot, then what is b.
GraphProduct::GraphProduct(const LiftedSystem& system) : z_(system.size) {
  const std::size_t n = system.size;
  std::vector<std::vector<std::uint32_t>> entries(n);
  for (std::uint32_t e = 0; e < system.entries.size(); ++e) entries[system.entries[e].row].push_back(e);
  std::vector<std::uint32_t> column(n, none), residual(n, none);
  for (const std::uint32_t e : system.minus_one) {
    column[system.entries[e].row] = system.entries[e].column;
    std::erase(entries[system.entries[e].row], e);
  }
  for (std::uint32_t i = 0; i < system.row_of_residual.size(); ++i) residual[system.row_of_residual[i]] = i;
  std::vector<std::uint32_t> order;
  for (const std::uint32_t row : system.rows_of_slots)
    if (residual[row] == none) order.push_back(row);
  order.insert(order.end(), system.row_of_residual.begin(), system.row_of_residual.end());
  for (const std::uint32_t row : order) {
    const auto first = static_cast<std::uint32_t>(row_entries_.size());
    for (const std::uint32_t e : entries[row]) row_entries_.push_back({e, system.entries[e].column});
    rows_.push_back({column[row], residual[row], first, static_cast<std::uint32_t>(row_entries_.size())});
  }
}

void GraphProduct::multiply(std::span<const double> entries, std::span<const double> x, std::span<double> out) {
  for (std::size_t i = 0; i < x.size(); ++i) z_[i].value = x[i];
  for (const Row& row : rows_) {
    double sum = 0;
    for (std::uint32_t k = row.first; k < row.last; ++k)
      sum += entries[row_entries_[k].entry] * z_[row_entries_[k].column].value;
    (row.residual == none ? z_[row.column].value : out[row.residual]) = sum;
  }
}

double GraphProduct::remainder(std::span<const double> entries, std::span<const double> x, std::span<const double> b,
                               std::span<double> rest, const double* cells,
                               std::span<const std::uint32_t> cell_of_column, std::size_t known) {
  constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
  for (std::size_t i = 0; i < x.size(); ++i) z_[i] = {x[i], 0};
  double worst = 0;
  for (const Row& row : rows_) {
    double sum = 0, size = 0, error = 0;
    for (std::uint32_t k = row.first; k < row.last; ++k) {
      const double factor = entries[row_entries_[k].entry];
      const WithError& z = z_[row_entries_[k].column];
      sum += factor * z.value;
      size += std::abs(factor * z.value);
      error += std::abs(factor) * z.error;
    }
    error += unit * size;
    double left = 0;
    if (row.residual == none) {
      z_[row.column] = {sum, error};
      if (known > 0 && cell_of_column[row.column] < known) left = cells[cell_of_column[row.column]] - sum;
    } else {
      left = rest[row.residual] = b[row.residual] - sum;
    }
    if (!(std::abs(left) <= worst * error)) worst = std::abs(left) / error;
  }
  return worst;
}

}  // namespace maupertuis::sparse

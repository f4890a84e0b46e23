#include <maupertuis/jacobian.hpp>
#include <maupertuis/require.hpp>

#include "symbolic/transform/reverse_sweep.hpp"

#include <algorithm>
#include <limits>

namespace maupertuis {

SparseGradient::SparseGradient(std::span<const Expr> symbols) : places_(places_of(symbols)) {}

std::vector<SparseGradient::Entry> SparseGradient::operator()(Expr e) const {
  MAUP_REQUIRE(!e.context().has_time_derivative(e.id()));
  std::vector<Entry> entries;
  for (const auto& [id, adjoint] : reverse_sweep(e, places_))
    if (const auto place = places_.find(id); place != places_.end()) entries.push_back({place->second, adjoint});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
  return entries;
}

std::optional<std::vector<DerivativeEntry>> sparse_jacobian(std::span<const Expr> rows, std::span<const Expr> symbols,
                                                            std::size_t most) {
  const SparseGradient gradient(symbols);
  std::vector<DerivativeEntry> entries;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const auto& [column, value] : gradient(rows[row])) entries.push_back({row, column, value});
    if (entries.size() > most) return std::nullopt;
  }
  return entries;
}

std::vector<DerivativeEntry> jacobian(std::span<const Expr> rows, std::span<const Expr> symbols) {
  return *sparse_jacobian(rows, symbols, std::numeric_limits<std::size_t>::max());
}

}  // namespace maupertuis

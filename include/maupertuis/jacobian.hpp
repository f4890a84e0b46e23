#pragma once
#include <maupertuis/expression.hpp>

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace maupertuis {

/// ∂e/∂symbols without its zeros, for many e: the symbols are looked up where they stand in e, not gone through.
class SparseGradient {
 public:
  explicit SparseGradient(std::span<const Expr> symbols);

  struct Entry {
    std::size_t column = 0;  // the place of the symbol
    Expr value;
  };
  /// By ascending columns; the same expressions as `gradient` gives. Cost O(nodes of e).
  /// Precondition: no TimeDerivative node in e.
  std::vector<Entry> operator()(Expr e) const;

 private:
  std::unordered_map<NodeId, std::size_t> places_;
};

/// An entry of a matrix of derivatives that is not 0 as it stands.
struct DerivativeEntry {
  std::size_t row = 0, column = 0;
  Expr value;
};

/// ∂rows_i/∂symbols_j without its zeros, by rows, then columns. Cost O(nodes below each row), not O(rows · symbols).
std::vector<DerivativeEntry> jacobian(std::span<const Expr> rows, std::span<const Expr> symbols);

/// The same, or nothing where it has more than `most` entries: told at the price of the first `most`.
std::optional<std::vector<DerivativeEntry>> sparse_jacobian(std::span<const Expr> rows, std::span<const Expr> symbols,
                                                            std::size_t most);

}  // namespace maupertuis

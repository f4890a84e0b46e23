#include "kernel/workspace/full_matrix.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::workspace {
namespace {

/// A point alone needs M₀ but no tangents besides: beyond this the instructions that M₀ goes through are fewer.
constexpr std::size_t most_swept_at_point = 8;

}  // namespace

FullMatrix::FullMatrix(const Expansion& x, const ResidualPlaces& residual, Tangents& tangents)
    : x_(x), residual_(residual), tangents_(tangents), in_eights_(can_be_fetched_in_eights()) {}

const std::vector<double>& FullMatrix::values() {
  if (!std::exchange(is_known_, true)) find();
  return values_;
}

void FullMatrix::find() {
  const std::size_t n = x_.unknowns;
  values_.resize(n * n);
  if (tangents_.are_of_each() && (!alone_ || n <= most_swept_at_point)) return find_by_tangents();
  if (edges_.empty()) {
    block_tangents_.assign(x_.program.slots * 8, 0.0);
    edges_ = sparse::edges_of_mass(x_.program);
  }
  for (std::size_t d = 0; d < n; d += 8) {
    sweep_block(d);
    for (std::size_t i = 0; i < n; ++i)
      fetch(i, block_tangents_.data() + residual_.slots[i] * 8, 1, d, std::min(n, d + 8));
  }
}

/// Which corrections need anyway.
void FullMatrix::find_by_tangents() {
  tangents_.find_of_each();
  if (in_eights_) return fetch_eights();
  for (std::size_t i = 0; i < x_.unknowns; ++i)
    fetch(i, tangents_.of(0) + residual_.slots[i], x_.memory.stride, 0, x_.unknowns);
}

/// The tangents of the residual in 8 directions.
void FullMatrix::sweep_block(std::size_t first) {
  std::fill_n(block_tangents_.begin(), x_.unknowns * 8, 0.0);
  for (std::size_t d = 0; d < 8 && first + d < x_.unknowns; ++d) block_tangents_[(first + d) * 8 + d] = 1;
  reference::tangents<8>(x_.memory, block_tangents_.data(), edges_);
}

/// Whether the residuals are side by side, in whole vectors, and all depend on q̈.
bool FullMatrix::can_be_fetched_in_eights() const {
  const auto follows = [this](Slot slot) { return x_.program.tangent_lags[slot] == 2; };
  return tangents_.are_of_each() && x_.unknowns > 0 && x_.unknowns % packed::lanes == 0 && residual_.side_by_side &&
         std::all_of(residual_.slots.begin(), residual_.slots.end(), follows);
}

/// Tangents are the columns of M₀.
void FullMatrix::fetch_eights() {
  for (std::size_t d = 0; d < x_.unknowns; d += packed::lanes)
    for (std::size_t i = 0; i < x_.unknowns; i += packed::lanes)
      x_.engine.transpose(tangents_.of(d) + residual_.slots[i], x_.memory.stride, values_.data() + i * x_.unknowns + d,
                          x_.unknowns);
}

/// Row i of M₀ from its tangents in the directions `first` to `last` − 1.
void FullMatrix::fetch(std::size_t i, const double* column, std::size_t step, std::size_t first, std::size_t last) {
  double *const row = values_.data() + i * x_.unknowns, *const end = row + last;
  if (x_.program.tangent_lags[residual_.slots[i]] != 2) return std::fill(row + first, end, 0.0);
#pragma GCC unroll 4
  for (double* entry = row + first; entry != end; ++entry, column += step) *entry = *column;
}

bool FullMatrix::has_symmetric_pattern() {
  if (!symmetric_pattern_) symmetric_pattern_ = sparse::has_symmetric_pattern(x_.kernel.program());
  return *symmetric_pattern_;
}

}  // namespace maupertuis::workspace

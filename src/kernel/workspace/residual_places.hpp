#pragma once
#include "kernel/workspace/expansion.hpp"

namespace maupertuis::workspace {

/// Where the residual R stands in a row of coefficients.
struct ResidualPlaces {
  explicit ResidualPlaces(const Expansion& x);

  /// row += other, of the residual.
  void add(const packed::Engine& engine, double* row, const double* other) const;

  std::span<const Slot> slots;  // [unknowns]
  bool side_by_side = true;     // slots[i] = slots[0] + i
  /// Slots from the residual's first vector to its last, if no coefficients that later orders read are among them, and
  /// no more besides than the residual has: the residual can then be added in vectors. Else `first` = `last`.
  Slot first = 0, last = 0;
};

}  // namespace maupertuis::workspace

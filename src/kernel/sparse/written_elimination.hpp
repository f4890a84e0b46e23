#pragma once
#include "kernel/sparse/elimination.hpp"
#include "kernel/straight_line/builder.hpp"

/// The elimination of a lifted system as nodes of a straight line.
namespace maupertuis::sparse {

struct WrittenSystem {
  const LiftedSystem& system;
  const std::vector<Pivot>& pivots;
  std::span<const straight::Value> entries;     // [entries]
  std::span<const straight::Value> usual_size;  // [pivots]
  double least_share;                           // of a pivot in what it was computed from and in its usual size
};

/// x [columns] with M₀ x = b; b: [unknowns]. Every pivot that is no literal is checked. Each right side follows its
/// pivots, so that factors and solution do not wait for each other.
std::vector<straight::Value> write_solution(straight::Builder& to, const WrittenSystem& written,
                                            std::span<const straight::Value> b);

}  // namespace maupertuis::sparse

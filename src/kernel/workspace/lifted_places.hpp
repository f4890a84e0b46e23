#pragma once
#include "kernel/packed/layout.hpp"
#include "kernel/sparse/sparse_solver.hpp"

#include <vector>

namespace maupertuis::workspace {

/// Where the numbers of a lifted system stand in the rows of a packed program.
struct LiftedPlaces {
  using AllWanted = std::vector<sparse::SparseSolver::Wanted>;

  LiftedPlaces(const sparse::LiftedSystem& system, const packed::PackedProgram& packed, std::size_t stride);

  /// What a solution gives: the columns that are wanted, and q̈ in the blocks that copy coordinates.
  AllWanted wanted(const sparse::LiftedSystem& system) const;

  std::size_t stored;                         // cells of tangents
  std::vector<std::uint32_t> residual;        // [unknowns]
  std::vector<std::uint32_t> cell_of_column;  // [columns] slots of the packed program, then cells of their own
  AllWanted copies;                           // of q̈ in the cells of blocks
  std::vector<Slot> number;                   // [slots]
};

}  // namespace maupertuis::workspace

#pragma once
#include "kernel/sparse/lifted_system.hpp"

/// In which order a sparse matrix is eliminated, and what fills in.
///
/// The unknowns fall into groups, one a coordinate: the tangents that are nearest to it in the graph. A link of a chain is a group, with its
/// point, its force and its angle. Groups are eliminated whole, those with few neighbours first (Markowitz's rule for blocks: rows that
/// they touch times columns that they touch), and those of equal cost that do not touch each other in one round. A chain is eliminated from
/// its tip, which is the recursion of articulated bodies; a tree from all its tips at once; a loop leaves a small full part.
///
/// Within a group the unknown of a row is its pivot wherever that is large enough: where M₀ is definite this is a block elimination of a
/// definite matrix, which needs no exchange of rows. No pivot is exchanged later, so each must be large in its column at every
/// one of several sampled states.
///
/// Parts (parts.hpp) are eliminated before all else, group by group and all parts in turn. What two parts leave of the group between them is
/// not definite in the order of the rows' own unknowns, (1 + Λ I) with definite Λ and I, but it is in another one: there the pivot is
/// what keeps its sign at all states and is largest where it is least.
namespace maupertuis::sparse {

struct Pivot {
  std::uint32_t row, column, round;    // pivots of a round do not wait for each other
  std::uint32_t part;                  // 0: of none; else its number and 1
  double size;                         // the largest at the sampled states
  std::vector<std::uint32_t> rows;     // below it in its column: of L
  std::vector<std::uint32_t> columns;  // beside it in its row: of U
};

struct EliminationOptions {
  double least_own_share = 1e-3;  // of the pivot in the largest entry of its column, where it is the row's own unknown
  double least_share = 0.05;      // of any other
};

/// `samples`: [states][entries] values, at most 16 states; the first one counts most. In order of rounds; nothing where no
/// acceptable pivot is left.
std::optional<std::vector<Pivot>> eliminate(const LiftedSystem& system, const std::vector<std::vector<double>>& samples,
                                            const EliminationOptions& options,
                                            const std::vector<std::vector<std::uint32_t>>& parts = {});

}  // namespace maupertuis::sparse

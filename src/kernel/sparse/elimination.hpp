#pragma once
#include "kernel/sparse/lifted_system.hpp"

/// The order in which a sparse matrix is eliminated, and the entries that come into being on the way.
///
/// Unknowns are eliminated in groups, one for each coordinate: the coordinate itself with those tangents that are
/// nearest to it in the graph. In a chain a group is a link, with its angle, its point and the force on that. The group
/// with the smallest border goes first (rows that it touches times columns that it touches: Markowitz's rule for
/// groups). Groups of equal cost that do not touch each other share a round, in which none waits for another. So
///
///     a chain   tip → … → root      is eliminated link by link, which is the recursion of articulated bodies
///     a tree    tips → … → root     from all its tips at once
///     a loop                        leaves a small full matrix
///
/// Within a group the pivot of a row is the unknown that the row is for, wherever that entry is large enough: where M₀
/// is definite no exchange of rows is needed then. Pivots are not exchanged later, so each has to be large in its
/// column at every one of several sampled states.
///
/// Parts of a chain (parts.hpp), where there are any, go before all else. The group between two parts then has the
/// matrix 1 + Λ I, with definite Λ and I, whose diagonal may vanish: there the pivot is the entry that keeps its sign
/// at all states and is largest where it is least.
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

/// `samples`: [states][entries] values, at most 16 states; the first one counts most. In order of rounds; nothing where
/// no acceptable pivot is left.
std::optional<std::vector<Pivot>> eliminate(const LiftedSystem& system, const std::vector<std::vector<double>>& samples,
                                            const EliminationOptions& options,
                                            const std::vector<std::vector<std::uint32_t>>& parts = {});

}  // namespace maupertuis::sparse

#pragma once
#include "kernel/sparse/lifted_system.hpp"

/// Parts of a system that are eliminated side by side, a lane of a vector each. The coordinates of a chain, or of any
/// system that is long and narrow as one (a *strip*), stand in levels by their distance from an end. Single levels (·)
/// separate parts of equal length, and some are left over at the ends:
///
///     end | part 1 | · | part 2 | · | part 3 | · | part 4 | end        levels from the first to the last
///
///           lane 0       lane 1       lane 2       lane 3              the k-th levels of all parts share a vector
///
/// Whether parts are alike, so that this can be done, shows when their elimination is written down (straight::widen).
namespace maupertuis::sparse {

/// The nearest coordinate of each column, in the graph whose edges are the entries between the columns that rows belong
/// to.
std::vector<std::uint32_t> nearest_coordinates(const LiftedSystem& system);

/// [parts][turns] coordinates, in the order in which a part is eliminated; no parts where what separates them takes
/// longer than they save. `first`: the coordinate at the end where the elimination begins.
std::vector<std::vector<std::uint32_t>> cut_into_parts(const LiftedSystem& system, std::uint32_t first);

/// How the coordinates of a long and narrow system are cut into eight parts.
struct Strip {
  std::vector<std::vector<std::uint32_t>> parts;  // [8][turns] as cut_into_parts(), from the first level on
  std::vector<std::uint32_t> level;               // [coordinates]
  std::size_t levels = 0;
  /// of coordinates: turn by turn, a lane for each part, then the separators, then what lies at the ends
  std::vector<std::uint32_t> order;
  std::size_t whole = 0;  // of `order`: those that stand in eights

  /// Whether an elimination that begins there meets the last level first.
  bool ends_at(std::uint32_t coordinate) const { return 2 * level[coordinate] > levels; }
};

/// No parts where that takes longer than it saves, or levels differ.
Strip strip_of(const Program& program);

}  // namespace maupertuis::sparse

#pragma once
#include "kernel/straight_line/straight_line.hpp"

#include <map>
#include <optional>

namespace maupertuis::straight {

/// The places of the numbers of an array that one straight line writes and another reads, and nobody else: factors, for
/// instance, between factorization and solution. Since nobody else cares, numbers that belong to the lanes of a vector
/// are placed side by side:
///
///     by index    f0 f1 f2 f3 f4 f5        part 1 reads f0 and f2, part 2 reads f3 and f5
///     placed      f0 f3 | f2 f5 | … f4 f1  one vector load for f0 f3, one for f2 f5
class Places {
 public:
  explicit Places(std::size_t size) : place_(size, none), top_(static_cast<std::uint32_t>(size)) {}

  /// Of one number; lanes fill the array from below, single numbers from above.
  std::uint32_t place(std::uint32_t index) { return place_[index] == none ? place_[index] = --top_ : place_[index]; }
  /// Side by side, if none of them has a place yet.
  void place_together(const std::vector<std::uint32_t>& indices);
  bool is_placed(std::uint32_t index) const { return place_[index] != none; }

 private:
  std::vector<std::uint32_t> place_;
  std::uint32_t bottom_ = 0, top_;
};

/// By array.
using Rearranged = std::map<std::uint32_t, Places*>;

/// Parts of a line that do the same with different numbers become one part whose numbers are vectors, a lane for each:
///
///     part 1:  x1 = a1 b1         part 2:  x2 = a2 b2               (x1 x2) = (a1 a2) (b1 b2)
///              y1 = x1 + c                 y2 = x2 + c      →       (y1 y2) = (x1 x2) + (c c)
///
/// Parts are alike if their sums follow each other with the same terms, as far as these are of the part itself. What
/// they read besides is the same for all, or is gathered from wherever it stands. Nothing comes back where parts are
/// not alike, or wait for each other. Stores to numbers of `written` that have no place are left out: nobody reads
/// them.
std::optional<StraightLine> widen(const StraightLine& line, const Rearranged& read, const Rearranged& written);

/// `line` for `lanes` right sides at once: its numbers of the arrays `read` and `written` stand for `lanes` numbers
/// that follow each other. What depends on none of `read` is not stored. Precondition: nothing in it is wide.
StraightLine in_columns(StraightLine line, std::uint32_t read, std::uint32_t written, std::uint32_t lanes);

}  // namespace maupertuis::straight

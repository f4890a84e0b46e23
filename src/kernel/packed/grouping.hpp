#pragma once
#include "kernel/packed/collapse.hpp"
#include "kernel/packed/layout.hpp"

#include <vector>

namespace maupertuis::packed {

/// Instructions of one shape and level: none waits for another.
struct Group {
  std::vector<std::size_t> steps;  // in the order of lanes
  int level = 0;
  bool stored = false;
  bool packs = false;       // worth vectors
  bool down = false;        // a running sum from the last lane to the first
  bool in_strands = false;  // a running sum in eight parts, a lane each
  /// lanes before the first step that stay empty, so that operands stand in the same lanes
  std::size_t front = 0;
};

/// Groups in order of execution, each ordered so that operands of one group come from neighbouring results of another.
/// Like terms of the products of a group come to like places; running sums that wait for each other are given up.
std::vector<Group> group_steps(const Program& program, std::vector<Step>& steps, const LaneOrder& order);

}  // namespace maupertuis::packed

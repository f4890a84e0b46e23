#pragma once
#include "simulation/mode_library.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace maupertuis::hybrid {

using Watch = ModeWatch;

/// An event that is met here: its function goes on from 0.
struct Zero {
  std::size_t event;
  std::uint8_t order;  // of the root: 2 where the function comes to 0 and goes back
  bool moved = false;  // by what is set or hit here, or by forces: then its value tells whether it is still 0
};

/// What a step has met, to be settled before the next one.
struct Met {
  std::vector<std::size_t> hit;  // contacts whose gap came to 0
  std::vector<Watch> left;       // conditions of the mode that end here
  std::vector<const ModelEvent*> sets;
  std::vector<int> ways;  // [sets] in which their functions come to 0 along the run: 1 rising, −1 falling
  std::vector<Zero> at_zero;
  double hidden = 0;       // for how long rounding hides the roots of gaps that are met
  double hidden_sets = 0;  // … and those of events that set the state
  bool begins = false;

  bool changes_state() const { return !hit.empty() || !sets.empty(); }
  bool is_empty() const { return !changes_state() && left.empty(); }
  const Zero* zero_of(std::size_t event) const;
  /// Whether a condition of the mode ends here.
  bool ends(const Watch& watch) const;
  bool ends(Watch::What what, std::size_t index) const;
  bool comes_to_limit(std::size_t friction) const { return ends(Watch::What::Hold, friction); }
  bool lets_go(std::size_t contact) const { return ends(Watch::What::Force, contact); }
};

/// Whether one of these events sets a coordinate.
bool sets_positions(const std::vector<const ModelEvent*>& events);

}  // namespace maupertuis::hybrid

#pragma once
#include "integrator/taylor/motion_state.hpp"
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches.hpp"

#include <maupertuis/integrator.hpp>

#include <optional>
#include <vector>

namespace maupertuis::taylor {

/// Where a step ends at a switch or an event.
struct Crossing {
  double x = 1;  // fraction of the step
  bool found = false;
  std::vector<std::size_t> roots;  // switches, then events
  std::vector<int> directions;     // [roots] 1: rising, −1: falling, 0: touching
  std::vector<Watched> after;      // the same, as the step leaves them
};

/// The switch functions and events of a motion: on which sides they are, and where along a step they first leave them.
class WatchedFunctions {
 public:
  WatchedFunctions(const Kernel& kernel, const KernelWorkspace& work);

  void start();
  bool empty() const { return switches.empty() && events.empty(); }
  void set_sides(KernelWorkspace& work) const {
    if (!switches.empty()) copy_sides(work);
  }
  /// Signs of the switch functions at the start, zeros left open: enough for the values there. A function within
  /// another comes before it. Under sides that are not those of the state forces may have no value (log|x|), but switch
  /// functions do.
  void choose_first_sides(KernelWorkspace& work, const MotionState& state);
  /// The first roots of the step of length h that the workspace holds. Switches may change at jumps too, events not.
  Crossing first_crossing(const KernelWorkspace& work, const Compensated& t, double h);
  /// An event that begins at a zero of this order: its side is the one that the motion goes to.
  void put_at_zero(std::size_t event, std::uint8_t order) { events[event] = {0, true, order}; }
  /// The sides that events take as the motion of the workspace begins, judged over h: 0 where all that they do is lost
  /// in rounding.
  struct Side {
    std::int8_t side;
    double reach;  // of the function over the length that was judged
  };
  std::vector<Side> sides_of_events(const KernelWorkspace& work, double h) const;
  /// The sides that a step leaves behind; how many switches changed, and which event was met, go to the result.
  void leave(const Crossing& crossing, Step& result);

  std::vector<Watched> switches, events;

 private:
  void copy_sides(KernelWorkspace& work) const;

  std::optional<RootSearch> roots_;  // where something is watched
};

}  // namespace maupertuis::taylor

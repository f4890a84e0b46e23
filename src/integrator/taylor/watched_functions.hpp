#pragma once
#include "integrator/taylor/met_roots.hpp"
#include "integrator/taylor/motion_state.hpp"
#include "integrator/taylor/switches.hpp"

#include <maupertuis/integrator.hpp>

#include <optional>
#include <vector>

namespace maupertuis::taylor {

/// A root of an event within a step that does not end there.
struct PassedRoot {
  double x = 0;  // fraction of the step
  std::size_t event = 0;
  int direction = 0;  // 1: rising, −1: falling, 0: touching
  double hidden = 0;  // of the step: by how much rounding may have moved it
  std::uint8_t order = 1;
};

/// Where a step ends, and what it passes on the way.
struct Crossing : MetRoots<double> {
  std::vector<PassedRoot> passed;   // in time order
  std::vector<std::size_t> turned;  // switches before it that only what is watched depends on
  double followed = 1;  // of the step: so far a function was followed that swings in it more often than can be told
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
  /// Whether the sides of now are those of all motions through this place.
  bool know_sides() const;
  /// Signs of the switch functions at the start, zeros left open: enough for the values there. A function within
  /// another comes before it. Under sides that are not those of the state forces may have no value (log|x|), but switch
  /// functions do.
  void choose_first_sides(KernelWorkspace& work, const MotionState& state);
  /// How each event is treated, see TaylorStepper::EventTreatment.
  void treat(std::span<const TaylorStepper::EventTreatment> treatments) { kinks_.treat(treatments); }
  /// The first roots of the step of length h that the workspace holds. Switches may change at jumps too, events not.
  Crossing first_crossing(const KernelWorkspace& work, const Compensated& t, double h);
  /// An event that begins at a zero of this order: its side is the one that the motion goes to.
  void put_at_zero(std::size_t event, std::uint8_t order) { events[event] = {0, true, order}; }
  /// The sides that events take as the motion of the workspace begins, judged over h: 0 where all that they do is lost
  /// in rounding.
  struct Side {
    std::int8_t side;
    double reach;  // of the function over the length that was judged; clear of zero: the size of its terms
  };
  std::vector<Side> sides_of_events(const KernelWorkspace& work, double h) const;
  /// The sides that a step leaves behind; how many switches changed, and which events were met, go to the result.
  /// length: of the step before it was shortened.
  void leave(const Crossing& crossing, double length, Step& result);
  bool ends_step(std::size_t event) const { return kinks_.ends_step(event); }
  bool tells_touches(std::size_t event) const { return kinks_.tells_touches(event); }

  std::vector<Watched> switches, events;

 private:
  void copy_sides(KernelWorkspace& work) const;
  std::optional<RootOf<double>> first_root(std::size_t index, Watched& watched, double from, double until,
                                           bool wants_touching, bool wants_jumps, Crossing& out);
  void search_part(const KernelWorkspace& work, double h, double from, double limit, Crossing& out);
  void search(const KernelWorkspace& work, double h, double from, Crossing& out);
  void note_first(const KernelWorkspace& work, std::size_t event, double h, double from, double limit, Crossing& out);
  void pass(const KernelWorkspace& work, double h, double begin, std::span<const Watched> begins, Crossing& out);
  bool is_unread(const Crossing& crossing) const;
  bool turns_unread(const KernelWorkspace& work, double h, Crossing& out);

  Kinks<double> kinks_;
  std::optional<RootSearch> roots_;         // where something is watched
  std::vector<bool> is_unread_;             // [switches] nothing of the motion depends on the side
  bool follow_places_ = false;              // no switch reads velocities
  double last_found_ = 0;                   // how far the last root was searched for, in time; 0: to the end
  double together_ = 0;                     // of the step: what rounding does not tell apart
  std::vector<Watched> searched_;           // [events] where the search of now has come to
  std::vector<bool> passes_;                // [events] it passes roots that end no step, of an event that ends steps
  mutable std::vector<std::int8_t> sides_;  // scratch
};

}  // namespace maupertuis::taylor

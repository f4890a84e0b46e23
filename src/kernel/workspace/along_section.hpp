#pragma once
#include "kernel/reference/reference.hpp"

#include <cstdint>
#include <vector>

namespace maupertuis::workspace {

/// What follows a motion without being part of it: switch functions, integrands, events. In an expansion values at the
/// point itself are all found; later coefficients of events, of which few come near zero, only of those that are asked
/// for. At a point alone, of which accelerations and observables are wanted, events are found when one is asked for.
class AlongSection {
 public:
  explicit AlongSection(const Program& program);

  /// Whether nothing follows the stages after the first.
  bool ends_at_first() const { return later_.empty(); }
  bool empty() const { return program_.runs[Along].empty(); }
  /// An expansion begins: the later coefficients of events are those of another. `is_point`: up to stage 0 alone.
  void begin(bool is_point);
  /// After the solution of a stage.
  void run(reference::Memory& memory, int stage) const;
  /// All of it at the point, where events were left out.
  void need_point(reference::Memory& memory);
  /// All coefficients of an event up to a stage; once in an expansion.
  void need_event(reference::Memory& memory, std::size_t event, int last_stage);

 private:
  std::vector<std::uint32_t> makers_of(Slot slot);
  std::vector<Run> runs_of(const std::vector<bool>& chosen) const;

  const Program& program_;
  std::vector<std::uint32_t> maker_;                  // [slots] its instruction in the section
  std::vector<Run> later_;                            // what is run at all stages
  std::vector<Run> without_events_;                   // what is run at a point alone: that, and what observables read
  bool is_point_ = false, has_events_ = true;         // this expansion
  std::vector<bool> is_later_;                        // [instructions] whether it is among them
  std::vector<bool> seen_;                            // [instructions] scratch
  std::vector<std::vector<std::uint32_t>> of_event_;  // [events] the others that it needs, in order
  std::vector<bool> has_makers_;                      // [events] whether they have been looked for
  std::vector<std::uint32_t> known_;                  // [events] the last expansion that they are known of
  std::uint32_t expansion_ = 1;
};

}  // namespace maupertuis::workspace

#pragma once
#include "kernel/reference/reference.hpp"

#include <cstdint>
#include <vector>

namespace maupertuis::workspace {

/// What follows a motion without being part of it: switch functions, integrands, events. Values at the point itself
/// are all found; later coefficients of events, of which few come near zero, only of those that are asked for.
class AlongSection {
 public:
  explicit AlongSection(const Program& program);

  /// Whether nothing follows the stages after the first.
  bool ends_at_first() const { return later_.empty(); }
  bool empty() const { return program_.runs[Along].empty(); }
  /// An expansion begins: the later coefficients of events are those of another.
  void begin();
  /// After the solution of a stage.
  void run(reference::Memory& memory, int stage) const;
  /// All coefficients of an event up to a stage; once in an expansion.
  void need_event(reference::Memory& memory, std::size_t event, int last_stage);

 private:
  std::vector<std::uint32_t> makers_of(Slot slot);

  const Program& program_;
  std::vector<std::uint32_t> maker_;                  // [slots] its instruction in the section
  std::vector<Run> later_;                            // what is run at all stages
  std::vector<bool> is_later_;                        // [instructions] whether it is among them
  std::vector<bool> seen_;                            // [instructions] scratch
  std::vector<std::vector<std::uint32_t>> of_event_;  // [events] the others that it needs, in order
  std::vector<bool> has_makers_;                      // [events] whether they have been looked for
  std::vector<std::uint32_t> known_;                  // [events] the last expansion that they are known of
  std::uint32_t expansion_ = 1;
};

}  // namespace maupertuis::workspace

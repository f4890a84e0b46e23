#pragma once
#include "kernel/packed/grouping.hpp"
#include "kernel/packed/layout.hpp"

#include <array>

namespace maupertuis::packed {

/// Where slots go: coordinates; corrected slots by lag; the other slots of Dynamics; everything else. Packs begin at
/// multiples of 8.
struct Numbering {
  std::vector<Slot> number;  // [slots as they were]; no_slot: sums were written over it
  std::array<Slot, 3> stored_end{};
  std::size_t slots = 0;
};

Numbering number_slots(const Program& program, const std::vector<Step>& steps, const std::vector<Group>& groups);

struct Renumbered {
  Program program;
  std::vector<std::uint32_t> index;  // [steps] of their instructions
};

/// `program` with the instructions of the groups in section Dynamics, and new numbers everywhere. `constants`: with
/// those that were appended for the steps.
Renumbered renumber(const Program& program, Program constants, const std::vector<Step>& steps,
                    const std::vector<Group>& groups, const Numbering& numbering);

}  // namespace maupertuis::packed

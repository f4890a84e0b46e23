#include "kernel/reference/point_section.hpp"

#include <algorithm>

namespace maupertuis::reference {
namespace {

/// The highest order at which each slot is read; −1: it is not.
class NeededOrders {
 public:
  explicit NeededOrders(const Program& program) : program_(program), of_slot_(program.slots, -1) {
    for (const Slot slot : program.observables) need(slot, 0);
    for (auto run = program.runs[AtPoint].rbegin(); run != program.runs[AtPoint].rend(); ++run)
      for (std::uint32_t i = run->last; i-- > run->first;) pass(program.instructions[i]);
  }

  int of(const Instruction& i) const {
    return std::max(of_slot_[i.out], i.second == no_slot ? -1 : of_slot_[i.second]);
  }

 private:
  void need(Slot slot, int order) {
    if (slot != no_slot) of_slot_[slot] = std::max(of_slot_[slot], order);
  }

  void pass(const Instruction& i) {
    const int order = of(i);
    if (order < 0) return;
    need(i.a, order + (i.op == Op::Derivative ? 1 : 0));
    need(i.b, order);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      // y_k = Σ j w_{k−j} u_j/k of a function: its differential is not read at order 0.
      need(term.a, i.op == Op::Function ? order - 1 : order + static_cast<int>(term.shift));
      need(term.b, order);
    }
  }

  const Program& program_;
  std::vector<int> of_slot_;
};

}  // namespace

PointSection::PointSection(const Program& program) {
  const NeededOrders needed(program);
  for (const Run& run : program.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const int highest = needed.of(program.instructions[i]);
      if (highest < 0) continue;
      const bool goes_on =
          !parts_.empty() && i > run.first && parts_.back().highest == highest && parts_.back().run.last == i;
      if (!goes_on) parts_.push_back({{run.op, run.lag, i, i}, highest});
      parts_.back().run.last = i + 1;
    }
}

bool PointSection::follows_acceleration() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.run.lag == 2; });
}

void PointSection::run(Memory& memory, int stage) const {
  for (const Part& part : parts_) {
    const int order = stage + 2 - part.run.lag;
    if (order >= 0 && order <= part.highest) run_instructions(memory, part.run, order);
  }
}

}  // namespace maupertuis::reference

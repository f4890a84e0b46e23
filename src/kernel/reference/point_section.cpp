#include "kernel/reference/point_section.hpp"

#include "kernel/program/point_orders.hpp"

#include <algorithm>

namespace maupertuis::reference {

PointSection::PointSection(const Program& program) {
  const std::vector<int> orders = point_orders(program);
  for (const Run& run : program.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const int highest = orders[i];
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

#include "kernel/workspace/residual_places.hpp"

#include <algorithm>

namespace maupertuis::workspace {

ResidualPlaces::ResidualPlaces(const Expansion& x) : slots(x.program.residual) {
  if (slots.empty()) return;
  for (std::size_t i = 0; i < slots.size(); ++i) side_by_side = side_by_side && slots[i] == slots[0] + i;
  const auto [lowest, highest] = std::minmax_element(slots.begin(), slots.end());
  const Slot begin = *lowest / packed::lanes * packed::lanes, end = static_cast<Slot>(packed::padded(*highest + 1));
  const auto& stored_end = x.program.stored_end;
  const bool stands_alone = begin >= packed::padded(*std::max_element(stored_end.begin(), stored_end.end()));
  if (stands_alone && end - begin <= 2 * x.padded_unknowns()) first = begin, last = end;
}

void ResidualPlaces::add(const packed::Engine& engine, double* row, const double* other) const {
  if (first != last)
    engine.add(row + first, other + first, 1, last - first);
  else
    for (const Slot slot : slots) row[slot] += other[slot];
}

}  // namespace maupertuis::workspace

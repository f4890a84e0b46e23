#include "kernel/workspace/lifted_places.hpp"

namespace maupertuis::workspace {

LiftedPlaces::LiftedPlaces(const sparse::LiftedSystem& system, const packed::PackedProgram& packed, std::size_t stride)
    : stored(packed.program.stored_end[2]),
      residual(packed.program.residual.begin(), packed.program.residual.end()),
      number(packed.number) {
  for (std::uint32_t column = 0; column < system.size; ++column) {
    const Slot slot = packed.number[system.slot_of_column[column]];
    cell_of_column.push_back(slot != no_slot ? slot : static_cast<std::uint32_t>(stride + column));
  }
  for (const packed::Block& block : packed.blocks)
    if (packed.copies_coordinates(block))
      for (std::uint32_t lane = 0; lane < packed::lanes; ++lane)
        copies.push_back({block.slots[lane], block.first + lane});
}

LiftedPlaces::AllWanted LiftedPlaces::wanted(const sparse::LiftedSystem& system) const {
  AllWanted out;
  for (std::uint32_t column = 0; column < system.size; ++column)
    if (system.wanted[column]) out.push_back({cell_of_column[column], cell_of_column[column]});
  out.insert(out.end(), copies.begin(), copies.end());
  return out;
}

}  // namespace maupertuis::workspace

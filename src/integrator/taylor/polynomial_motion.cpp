#include "integrator/taylor/polynomial_motion.hpp"

#include <algorithm>

namespace maupertuis::taylor {
namespace {

/// The order of an expansion that knows all coefficients of a slot of this degree.
int order_for(const Program& program, Slot slot, int degree) {
  return degree - 1 + std::max<int>(0, program.lags[slot]);
}

/// Of functions that are no polynomials along the motion pieces are followed.
constexpr int order_in_pieces = 10;
/// What begins at a zero is told by its derivatives up to the third.
constexpr int least_order = 3;

}  // namespace

StepControl control_of(const Program& program, const StepControl& usual) {
  if (!moves_on_parabolas(program)) return usual;
  StepControl out = usual;
  out.is_exact = true;
  const std::vector<int> degrees = degrees_in_time(program, 2);
  int order = least_order;
  for (const auto* slots : {&program.switch_slots, &program.events, &program.integrands})
    for (const Slot slot : *slots) {
      const bool ends = degrees[slot] < not_polynomial;
      if (!ends && slots == &program.integrands) return out;
      order = std::max(order, ends ? order_for(program, slot, degrees[slot]) : order_in_pieces);
    }
  out.order = std::min(usual.order, order);
  return out;
}

std::vector<bool> functions_that_end(const Program& program, int order, std::span<const Slot> slots) {
  std::vector<bool> out(slots.size(), false);
  if (!moves_on_parabolas(program)) return out;
  const std::vector<int> degrees = degrees_in_time(program, 2);
  for (std::size_t i = 0; i < slots.size(); ++i)
    out[i] = degrees[slots[i]] < not_polynomial && order_for(program, slots[i], degrees[slots[i]]) <= order;
  return out;
}

}  // namespace maupertuis::taylor

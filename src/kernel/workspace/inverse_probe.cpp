#include "kernel/workspace/inverse_probe.hpp"

#include <cmath>
#include <limits>

namespace maupertuis::workspace {
namespace {

/// What the inverse may leave of a right side: beyond, the sparse factors solve better.
constexpr double largest_rest_of_inverse = 1e-11;

}  // namespace

void InverseProbe::make_room() {
  right_side_.assign(x_.memory.stride, 0.0);
  largest_rest_.assign(x_.memory.stride, std::numeric_limits<double>::infinity());
}

bool InverseProbe::holds(const Inverse& inverse, StageUnknowns& unknowns, Tangents& tangents) {
  if (!is_set_) set(inverse);
  inverse.solve(right_side_.data(), unknowns.data());
  tangents.find_along(unknowns.values());
  const double* const left = tangents.along();
  const auto [first, last] = std::pair(residual_.first, residual_.last);
  if (first != last)
    return x_.engine.cancel(left + first, right_side_.data() + first, largest_rest_.data() + first, last - first);
  bool solves = true;
  for (const Slot slot : residual_.slots) solves &= std::abs(left[slot] + right_side_[slot]) <= largest_rest_[slot];
  return solves;
}

/// Numbers of any sign, in the measure that the inverse gives a coordinate where it is asked first and has one for
/// each.
void InverseProbe::set(const Inverse& inverse) {
  std::uint32_t random = 1;
  is_set_ = true;
  for (std::size_t i = 0; i < x_.unknowns; ++i) {
    random = random * 1664525u + 1013904223u;
    const double part = (random & 0x10000) != 0 ? -1 - random * 0x1p-32 : 1 + random * 0x1p-32;
    const Slot slot = residual_.slots[i];
    right_side_[slot] = part / std::sqrt(std::abs(inverse.diagonal(i)));
    is_set_ &= std::isfinite(right_side_[slot]);
    largest_rest_[slot] = largest_rest_of_inverse * std::abs(right_side_[slot]);
  }
}

}  // namespace maupertuis::workspace

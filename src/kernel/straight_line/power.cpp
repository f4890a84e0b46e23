#include "kernel/straight_line/power.hpp"

#include <cmath>

namespace maupertuis::straight {

Value power(Builder& to, Value a, Value p) {
  constexpr double most_halves = 8;
  const double twice = to.is_literal(p) ? 2 * to.literal_of(p) : 0;
  const bool is_half = std::abs(twice) <= most_halves && std::abs(std::remainder(twice, 2)) == 1;
  if (!is_half) return to.call(Kind::Power, a, p);
  Value result = to.root(a);
  for (double halves = std::abs(twice); halves > 1; halves -= 2) result = to.product(1, a, result);
  return twice < 0 ? to.reciprocal(result) : result;
}

}  // namespace maupertuis::straight

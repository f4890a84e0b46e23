#pragma once

namespace maupertuis {

/// xⁿ by squares, n ≥ 0: a fraction of the cost of std::pow, to some roundings.
inline double whole_power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 != 0) result *= x;
  return result;
}

}  // namespace maupertuis

#pragma once
#include <cmath>
#include <limits>

namespace maupertuis {

/// erf(x) = 2/√π ∫₀ˣ exp(−s²) ds.
inline double error_function(double x) { return std::erf(x); }

/// exp(−x²), right to some units in the last place for large x too: x² is rounded, and exp takes that times x². So
/// x = a + b, where a has so few digits that a² is exact: x² = a² + (x − a) (x + a).
template <class Real>
Real gaussian(const Real& x) {
  using std::exp;
  const Real a = static_cast<float>(x);
  return exp(-a * a) * exp((a - x) * (a + x));
}

/// erf(x) of a real type of more digits than double: 2/√π exp(−x²) (x + 2 x³/3 + 4 x⁵/(3·5) + …), whose terms all have
/// one sign, so that none takes digits of another; some 2 x² + digits of them. ±1 where they differ from 1 by less than
/// rounding.
/// Source: M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions (1964), 7.1.6.
template <class Real>
Real error_function(const Real& x) {
  using std::abs, std::atan, std::sqrt;
  static const Real half_root_of_pi = sqrt(atan(Real(1)));
  using Limits = std::numeric_limits<Real>;
  const Real square = x * x;
  if (square > 0.7 * Limits::digits) return Real(x > 0 ? 1 : -1);
  Real term = x, sum = x;
  for (int odd = 3; abs(term) > abs(sum) * Limits::epsilon() / 4; odd += 2) sum += term *= 2 * square / odd;
  return sum * gaussian(x) / half_root_of_pi;
}

}  // namespace maupertuis

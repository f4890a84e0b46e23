#include <maupertuis/lambert_w.hpp>

namespace maupertuis {
namespace {

// 1/e in two parts: next to −1/e the sum x + 1/e needs more digits than one double holds.
constexpr double inverse_e = 0x1.78b56362cef38p-2, rest_of_inverse_e = -0x1.ca8a4270fadf5p-57;

/// In powers of p = √(2(e x + 1)), for p < 0.004.
/// Source: R. M. Corless et al., Adv. Comput. Math. 5 (1996), eq. 4.22.
double near_the_end(double p) {
  return -1 +
         p * (1 + p * (-1.0 / 3 +
                       p * (11.0 / 72 + p * (-43.0 / 540 +
                                             p * (769.0 / 17280 + p * (-221.0 / 8505 + p * (680863.0 / 43545600)))))));
}

/// A few digits, for x > −0.36787 and not 0.
long double roughly(long double x) {
  if (x < -0.25L) {
    const long double p = std::sqrt(2 * (std::exp(1.0L) * x + 1));
    return -1 + p * (1 + p * (-1.0L / 3 + p * 11 / 72));
  }
  const long double log = std::log1p(x);
  return log * (1 - std::log1p(log) / (2 + log));
}

}  // namespace

double lambert_w(double x) {
  if (x == 0 || !(x < std::numeric_limits<double>::infinity())) return x;  // also NaN
  const double above_end = (x + inverse_e) + rest_of_inverse_e;
  if (above_end < 0) return std::numeric_limits<double>::quiet_NaN();
  const double p = std::sqrt(2 * 2.718281828459045235 * above_end);
  if (p < 0.004) return near_the_end(p);
  return static_cast<double>(lambert_w_near<long double>(roughly(x), x));
}

}  // namespace maupertuis

#include "fields/lane_sines.hpp"

#include "fields/wide_lanes.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace maupertuis {
namespace {

constexpr double farthest = 1e6;

inline std::uint64_t bits_of(double x) {
  std::uint64_t out;
  std::memcpy(&out, &x, sizeof out);
  return out;
}
inline double number_of(std::uint64_t bits) {
  double out;
  std::memcpy(&out, &bits, sizeof out);
  return out;
}

MAUP_LANES bool all_near(const double* x, std::size_t n) {
  int far = 0;
  for (std::size_t i = 0; i < n; ++i) far |= std::abs(x[i]) < farthest ? 0 : 1;
  return far == 0;
}

/// x = k π/2 + r with |r| ≤ π/4: π/2 in three parts, the first two of 33 bits, so that k times them is exact. Then
/// Taylor's polynomials, whose next terms are below 1e-19, and ± sin r or ± cos r by k mod 4.
MAUP_LANES void near_sines(double* out, const double* x, std::size_t n, std::uint64_t quarter) {
  constexpr double two_by_pi = 0.63661977236758134308, rounds = 0x1.8p52;  // x + rounds ends in the digits of k
  constexpr double half_pi[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
  for (std::size_t i = 0; i < n; ++i) {
    const double shifted = x[i] * two_by_pi + rounds, k = shifted - rounds;
    const double r = ((x[i] - k * half_pi[0]) - k * half_pi[1]) - k * half_pi[2], r2 = r * r;
    double s = 1 / 355687428096000.0;  // 1/17!
    s = s * r2 - 1 / 1307674368000.0;
    s = s * r2 + 1 / 6227020800.0;
    s = s * r2 - 1 / 39916800.0;
    s = s * r2 + 1 / 362880.0;
    s = s * r2 - 1 / 5040.0;
    s = s * r2 + 1 / 120.0;
    s = s * r2 - 1 / 6.0;
    s = r + r * (r2 * s);
    double c = 1 / 20922789888000.0;  // 1/16!
    c = c * r2 - 1 / 87178291200.0;
    c = c * r2 + 1 / 479001600.0;
    c = c * r2 - 1 / 3628800.0;
    c = c * r2 + 1 / 40320.0;
    c = c * r2 - 1 / 720.0;
    c = c * r2 + 1 / 24.0;
    const double half = 0.5 * r2, most = 1 - half;
    c = most + ((1 - most - half) + r2 * r2 * c);
    const std::uint64_t turn = bits_of(shifted) + quarter;
    const std::uint64_t sine = bits_of(s), cosine = bits_of(c);
    const std::uint64_t odd = 0 - (turn & 1);
    out[i] = number_of(((sine & ~odd) | (cosine & odd)) ^ (turn & 2) << 62);
  }
}

}  // namespace

void set_sines(double* out, const double* x, std::size_t n, bool cosine) {
  if (all_near(x, n)) return near_sines(out, x, n, cosine ? 1 : 0);
  for (std::size_t i = 0; i < n; ++i) out[i] = cosine ? std::cos(x[i]) : std::sin(x[i]);
}

}  // namespace maupertuis

// Part of engine_code.hpp: the polynomials that an expansion gives.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Powers of τ apart by their remainders mod 4, each by Horner's rule, so that a quarter of the operations wait for each other.
void increments(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* dq, double* dv) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const Vector t = all(tau), square = t * t, fourth = square * square;
  for (std::size_t i = 0; i < count; i += lanes) {
    Vector q[4] = {all(0), all(0), all(0), all(0)}, v[4] = {all(0), all(0), all(0), all(0)};
    int k = 2 + (degree - 2) / 4 * 4;
    const double* c = first + k * step + static_cast<std::ptrdiff_t>(i);
    for (int r = 0; r < 4; ++r)
      if (k + r <= degree) q[r] = load(c + r * step), v[r] = q[r] * all(k + r);
    for (k -= 4, c -= 4 * step; k >= 2; k -= 4, c -= 4 * step)
#pragma GCC unroll 4
      for (int r = 0; r < 4; ++r) {
        const Vector next = load(c + r * step);
        q[r] = q[r] * fourth + next, v[r] = v[r] * fourth + next * all(k + r);
      }
    save(dq + i, ((q[0] + q[1] * t) + (q[2] + q[3] * t) * square) * t);
    save(dv + i, ((v[0] + v[1] * t) + (v[2] + v[3] * t) * square) * t);
  }
}

inline double least_lane(Vector v, std::size_t count) {
  const auto fold = [&v](Places places) {
    const Vector other = __builtin_shuffle(v, places);
    v = other < v ? other : v;
  };
  if (count > 4) fold(Places{4, 5, 6, 7, 0, 1, 2, 3});
  if (count > 2) fold(Places{2, 3, 0, 1, 6, 7, 4, 5});
  if (count > 1) fold(Places{1, 0, 3, 2, 5, 4, 7, 6});
  return v[0];
}

/// Early orders first: they are there while the last coefficients are still waited for.
double radius(const double* first, std::size_t stride, std::size_t count, int order, double h) {
  constexpr double widened = 0.32192809488736235;  // log₂ 1.25
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const Vector infinity = all(__builtin_huge_val());
  const int lowest = order > 6 ? order - 5 : order > 2 ? 2 : order - 1;
  Vector least = infinity;
  for (std::size_t i = 0; i < count; i += lanes) {
    const double* const c = first + i;
    const auto velocity = [&](int k) { return absolute(load(c + (k + 1) * step)) * all(k + 1); };
    Vector size = all(0x1p-52 / h) * absolute(load(c));
    double power = 1;
    for (int k = 0; k <= 3 && k <= order - 2; ++k, power *= h) size = larger(size, velocity(k) * all(power));
    const auto used = lane_numbers < all(static_cast<double>(count - i));
    const Vector inverse = all(1) / (used ? size : all(1));
    for (int k = lowest; k <= order; ++k) {
      const Vector ratio = velocity(k) * inverse;
      const Vector exponent = rough_log2<Vector, Places>(ratio) * all(-1.0 / k) + all(k < order - 1 ? widened : 0);
      least = (used & (ratio > 0) & (exponent < least)) ? exponent : least;
    }
  }
  const double exponent = least_lane(least, count);
  if (!(exponent > -900.0 / order)) return __builtin_nan("");  // a ratio to nothing
  return exponent < __builtin_huge_val() ? rough_exp2<double, long long>(exponent) : exponent;
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

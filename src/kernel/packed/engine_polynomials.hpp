// Part of engine_code.hpp: the polynomials that an expansion gives.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Even and odd powers apart, each by Horner's rule, so that half as many operations wait for each other.
void increments(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* dq, double* dv) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const Vector t = all(tau), square = t * t;
  for (std::size_t i = 0; i < count; i += lanes) {
    Vector q_even = all(0), q_odd = all(0), v_even = all(0), v_odd = all(0);
    int k = degree;
    const double* c = first + k * step + static_cast<std::ptrdiff_t>(i);
    if (k % 2 == 1) q_odd = load(c), v_odd = q_odd * all(k), --k, c -= step;
    for (; k > 2; k -= 2, c -= 2 * step) {
      const Vector even = load(c), odd = load(c - step);
      q_even = q_even * square + even, v_even = v_even * square + even * all(k);
      q_odd = q_odd * square + odd, v_odd = v_odd * square + odd * all(k - 1);
    }
    const Vector second = load(c);
    q_even = q_even * square + second, v_even = v_even * square + second * all(2);
    save(dq + i, (q_even + q_odd * t) * t);
    save(dv + i, (v_even + v_odd * t) * t);
  }
}

inline Vector larger(Vector x, Vector y) { return x > y ? x : y; }
inline Vector absolute(Vector x) { return x < 0 ? -x : x; }

inline double largest_lane(Vector v, std::size_t count) {
  const auto fold = [&v](Places places) {
    const Vector other = __builtin_shuffle(v, places);
    v = larger(v, other);
  };
  if (count > 4) fold(Places{4, 5, 6, 7, 0, 1, 2, 3});
  if (count > 2) fold(Places{2, 3, 0, 1, 6, 7, 4, 5});
  if (count > 1) fold(Places{1, 0, 3, 2, 5, 4, 7, 6});
  return v[0];
}

bool decay(const double* first, std::size_t stride, std::size_t count, int order, int lowest, double h, double* largest) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  constexpr int most = 8;
  Vector ratio[most];
  for (int k = order; k >= lowest; --k) ratio[order - k] = all(0);
  for (std::size_t i = 0; i < count; i += lanes) {
    const double* const c = first + i;
    const auto velocity = [&](int k) { return absolute(load(c + (k + 1) * step)) * all(k + 1); };
    Vector size = all(0x1p-52 / h) * absolute(load(c));
    double power = 1;
    for (int k = 0; k <= 3 && k <= order - 2; ++k, power *= h) size = larger(size, velocity(k) * all(power));
    const Vector inverse = all(1) / (lane_numbers < all(static_cast<double>(count - i)) ? size : all(1));
    for (int k = order; k >= lowest; --k) {
      const Vector last = velocity(k);
      const Vector share = last * inverse;  // infinite where the size is 0 and the velocity is not
      ratio[order - k] = larger(ratio[order - k], share == share ? share : all(0));
    }
  }
  bool defined = true;
  for (int k = order; k >= lowest; --k) {
    const double value = largest_lane(ratio[order - k], count);
    defined = defined && value < __builtin_huge_val();
    largest[order - k] = value;
  }
  return defined;
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

// Part of engine_code.hpp: the polynomials that an expansion gives.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// Powers of τ apart by their remainders mod 4, each by Horner's rule, so that a quarter of the operations wait for
/// each other.
void increments(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* dq,
                double* dv) {
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

/// Σ_{k≥2} k (k − 1) c_k τ^{k−2}, powers apart as above.
void accelerations(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* a) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const Vector t = all(tau), square = t * t, fourth = square * square;
  for (std::size_t i = 0; i < count; i += lanes) {
    Vector sum[4] = {all(0), all(0), all(0), all(0)};
    for (int k = 2 + (degree - 2) / 4 * 4; k >= 2; k -= 4) {
      const double* const c = first + k * step + static_cast<std::ptrdiff_t>(i);
#pragma GCC unroll 4
      for (int r = 0; r < 4; ++r)
        if (k + r <= degree) sum[r] = sum[r] * fourth + load(c + r * step) * all((k + r) * (k + r - 1));
    }
    save(a + i, (sum[0] + sum[1] * t) + (sum[2] + sum[3] * t) * square);
  }
}

/// Σ_{k≥1} weights[s][k] |c_k| for s = 0, 1, 2; odd and even k apart, so that half of the operations wait for each
/// other.
void sizes(const double* first, std::size_t stride, std::size_t count, int degree, const double* weights,
           double* sizes) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const std::size_t orders = static_cast<std::size_t>(degree) + 1, padded = (count + lanes - 1) / lanes * lanes;
  for (std::size_t i = 0; i < count; i += lanes) {
    Vector sum[2][3] = {{all(0), all(0), all(0)}, {all(0), all(0), all(0)}};
    const double* const c = first + i;
    const auto add = [&](int parity, int k) {
      const Vector size = absolute(load(c + k * step));
#pragma GCC unroll 3
      for (std::size_t s = 0; s < 3; ++s)
        sum[parity][s] += size * all(weights[s * orders + static_cast<std::size_t>(k)]);
    };
    for (int k = 1; k < degree; k += 2) add(0, k), add(1, k + 1);
    if (degree % 2 != 0) add(0, degree);
    for (std::size_t s = 0; s < 3; ++s) save(sizes + s * padded + i, sum[0][s] + sum[1][s]);
  }
}

/// hi + lo += b − lo by Knuth's TwoSum.
template <class V>
void add_compensated(V& hi, V& lo, V b) {
  const V sum = hi + b, part = sum - hi;
  lo = (hi - (sum - part)) + (b - part), hi = sum;
}

/// Eight numbers hi and lo that stand pair by pair.
inline void load_pairs(const double* p, Vector& hi, Vector& lo) {
  const Vector a = load(p), b = load(p + lanes);
  hi = shuffled<0, 2, 4, 6, 8, 10, 12, 14>(a, b), lo = shuffled<1, 3, 5, 7, 9, 11, 13, 15>(a, b);
}
inline void save_pairs(double* p, Vector hi, Vector lo) {
  save(p, shuffled<0, 8, 1, 9, 2, 10, 3, 11>(hi, lo)), save(p + lanes, shuffled<4, 12, 5, 13, 6, 14, 7, 15>(hi, lo));
}

/// What is added to lo may be fused with its product: TwoSum takes it as one number.
void add_increments(std::size_t count, double tau, const double* dq, const double* dv, const double* q, const double* v,
                    double* q_out, double* v_out) {
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    Vector q_hi, q_lo, v_hi, v_lo;
    load_pairs(q + 2 * i, q_hi, q_lo), load_pairs(v + 2 * i, v_hi, v_lo);
    add_compensated(q_hi, q_lo, q_lo + (load(dq + i) + (v_hi + v_lo)) * all(tau));
    add_compensated(v_hi, v_lo, v_lo + load(dv + i));
    save_pairs(q_out + 2 * i, q_hi, q_lo), save_pairs(v_out + 2 * i, v_hi, v_lo);
  }
  for (; i < count; ++i) {
    double q_hi = q[2 * i], q_lo = q[2 * i + 1], v_hi = v[2 * i], v_lo = v[2 * i + 1];
    add_compensated(q_hi, q_lo, q_lo + (dq[i] + (v_hi + v_lo)) * tau);
    add_compensated(v_hi, v_lo, v_lo + dv[i]);
    q_out[2 * i] = q_hi, q_out[2 * i + 1] = q_lo, v_out[2 * i] = v_hi, v_out[2 * i + 1] = v_lo;
  }
}

inline double least_lane(Vector v) {
  const auto fold = [&v](Vector other) { v = other < v ? other : v; };
  fold(shuffled<4, 5, 6, 7, 0, 1, 2, 3>(v));
  fold(shuffled<2, 3, 0, 1, 6, 7, 4, 5>(v));
  fold(shuffled<1, 0, 3, 2, 5, 4, 7, 6>(v));
  return v[0];
}

/// The radius of convergence, from the largest coefficient of each order. Coordinates are measured by their own size,
/// so that units do not decide. A logarithm is slow, so it is taken once an order and not once a coefficient. The
/// orders are gone through from the lowest: the processor can begin with them while the last coefficients are being
/// computed.
double radius(const double* first, std::size_t stride, std::size_t count, int order, double h) {
  constexpr double widened = 0.32192809488736235;  // log₂ 1.25
  constexpr int most = 6;
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const int lowest = order > most ? order - (most - 1) : order > 2 ? 2 : order - 1, orders = order - lowest + 1;
  Vector largest[most] = {all(0), all(0), all(0), all(0), all(0), all(0)};
  for (std::size_t i = 0; i < count; i += lanes) {
    const double* const c = first + i;
    const auto velocity = [&](int k) { return absolute(load(c + (k + 1) * step)) * all(k + 1); };
    Vector size = all(0x1p-52 / h) * absolute(load(c));
    double power = 1;
    for (int k = 0; k <= 3 && k <= order - 2; ++k, power *= h) size = larger(size, velocity(k) * all(power));
    const auto used = lane_numbers < all(static_cast<double>(count - i));
    const Vector inverse = used ? all(1) / (used ? size : all(1)) : all(0);
#pragma GCC unroll 6
    for (int r = 0; r < most; ++r)
      if (r < orders) largest[r] = larger(velocity(lowest + r) * inverse, largest[r]);
  }
  Vector least = all(__builtin_huge_val());
  for (int r = 0; r < orders; ++r) {
    const int k = lowest + r;
    const Vector exponent = rough_log2<Vector, Places>(largest[r]) * all(-1.0 / k) + all(k < order - 1 ? widened : 0);
    least = (largest[r] > 0) & (exponent < least) ? exponent : least;
  }
  const double exponent = least_lane(least);
  if (!(exponent > -900.0 / order)) return __builtin_nan("");  // a ratio to nothing
  return exponent < __builtin_huge_val() ? rough_exp2<double, long long>(exponent) : exponent;
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE

#pragma once
#include "kernel/series/vector.hpp"

/// The recurrences of kernel/series/rules.hpp for W lanes, with products fused into sums. `step`: from one order of a
/// slot to the next, in doubles; sums in two chains where one would make the processor wait.
namespace maupertuis::lanes {
namespace {

using namespace series;

template <int W>
struct Series {
  const double* first;
  std::ptrdiff_t step;
  Vec<W> operator[](int k) const { return Vec<W>::load(first + k * step); }
};

/// (a b)_k; from the middle outward, so that the newest coefficients come last.
template <int W>
inline Vec<W> product(Series<W> a, Series<W> b, int k) {
  const int pairs = (k + 1) / 2;
  Vec<W> rising = Vec<W>::all(0), falling = rising;
  if (k % 2 == 0) rising = a[k / 2] * b[k / 2];
  const double *a_low = a.first + (pairs - 1) * a.step, *b_low = b.first + (pairs - 1) * b.step;
  const double *a_high = a.first + (k + 1 - pairs) * a.step, *b_high = b.first + (k + 1 - pairs) * b.step;
  for (int left = pairs; left > 0; --left) {
    rising = fma(Vec<W>::load(a_low), Vec<W>::load(b_high), rising);
    falling = fma(Vec<W>::load(a_high), Vec<W>::load(b_low), falling);
    a_low -= a.step, b_low -= b.step, a_high += a.step, b_high += b.step;
  }
  return rising + falling;
}

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
template <int W>
inline Vec<W> self_product(Series<W> a, int k, int first) {
  Vec<W> sum = Vec<W>::all(0);
  for (int j = (k - 1) / 2; j >= first; --j) sum = fma(a[j], a[k - j], sum);
  sum = sum + sum;
  if (k % 2 == 0 && k / 2 >= first) sum = fma(a[k / 2], a[k / 2], sum);
  return sum;
}

/// (a²)_k
template <int W>
inline Vec<W> square(Series<W> a, int k) {
  return k == 0 ? a[0] * a[0] : self_product(a, k, 0);
}

/// Σ_{j=1..k} j u_j w_{k−j} / k
template <int W>
inline Vec<W> integral(Series<W> w, Series<W> u, int k) {
  Vec<W> sum = Vec<W>::all(0);
  for (int j = 1; j <= k; ++j) sum = fma(u[j] * static_cast<double>(j), w[k - j], sum);
  return sum / Divisor(k);
}

/// The coefficients of (y, z) with dy = z du, dz = ± y du, but for the sign.
template <int W>
inline void integral_pair(Series<W> y, Series<W> z, Series<W> u, int k, Vec<W>& y_k, Vec<W>& z_k) {
  Vec<W> sum_y = Vec<W>::all(0), sum_z = sum_y;
  const double *up = u.first + u.step, *y_down = y.first + (k - 1) * y.step, *z_down = z.first + (k - 1) * z.step;
  double weight = 1;
  for (int left = k; left > 0; --left) {
    const Vec<W> du = Vec<W>::load(up) * weight;
    sum_y = fma(du, Vec<W>::load(z_down), sum_y);
    sum_z = fma(du, Vec<W>::load(y_down), sum_z);
    up += u.step, y_down -= y.step, z_down -= z.step, weight += 1;
  }
  const Divisor by_order(k);
  y_k = sum_y / by_order;
  z_k = sum_z / by_order;
}

/// y = a/b: (a_k − Σ_{j=1..k} b_j y_{k−j}) / b_0
template <int W>
inline Vec<W> quotient(const Vec<W>& a_k, Series<W> b, Series<W> y, int k) {
  Vec<W> sum = Vec<W>::all(0);
  for (int j = 1; j <= k; ++j) sum = fma(b[j], y[k - j], sum);
  return (a_k - sum) / b[0];
}

/// y = √u: (u_k − Σ_{j=1..k−1} y_j y_{k−j}) / (2 y_0)
template <int W>
inline Vec<W> square_root(Series<W> u, Series<W> y, int k) {
  return (u[k] - self_product(y, k, 1)) / (y[0] + y[0]);
}

/// y = u^p: Σ_{j=1..k} (p j − (k − j)) u_j y_{k−j} / (k u_0)
template <int W>
inline Vec<W> power(Series<W> u, Series<W> y, const Vec<W>& p, int k) {
  Vec<W> sum = Vec<W>::all(0);
  for (int j = 1; j <= k; ++j) sum = fma(p * static_cast<double>(j) - static_cast<double>(k - j), u[j] * y[k - j], sum);
  return sum / (u[0] * static_cast<double>(k));
}

}  // namespace
}  // namespace maupertuis::lanes

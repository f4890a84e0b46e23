#pragma once
#include <cstddef>

/// The recurrences of truncated power series: given the coefficients of the operands up to order k and of the result
/// up to order k − 1, the coefficient of order k ≥ 1 (docs/theory/taylor.md derives them).
///
/// Generic over the scalar. Sums run from the middle outward in two chains, so that the newest coefficients, for which
/// a processor may still be waiting, come last.
namespace maupertuis::jet {

/// The coefficients of one slot in the layout [order][slot].
template <class T>
struct Column {
  const T* first;
  std::size_t stride;
  const T& operator[](int k) const { return first[static_cast<std::size_t>(k) * stride]; }
};

/// (a b)_k = Σ_{j=0..k} a_j b_{k−j}
template <class T>
T product(Column<T> a, Column<T> b, int k) {
  int low = (k - 1) / 2, high = k - low;
  T rising = T(0), falling = T(0);
  if (k % 2 == 0) rising = a[k / 2] * b[k / 2];
  if (k == 0) return rising;
  const T *a_low = &a[low], *a_high = &a[high], *b_low = &b[low], *b_high = &b[high];
  for (;;) {
    rising += *a_low * *b_high;
    falling += *a_high * *b_low;
    if (low-- == 0) break;
    a_low -= a.stride, b_low -= b.stride, a_high += a.stride, b_high += b.stride;
  }
  return rising + falling;
}

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
template <class T>
T self_product(Column<T> a, int k, int first) {
  T sum = T(0);
  for (int j = (k - 1) / 2; j >= first; --j) sum += a[j] * a[k - j];
  sum += sum;
  if (k % 2 == 0 && k / 2 >= first) sum += a[k / 2] * a[k / 2];
  return sum;
}

/// (a²)_k
template <class T>
T square(Column<T> a, int k) {
  return k == 0 ? a[0] * a[0] : self_product(a, k, 0);
}

/// Σ_{j=1..k} j u_j w_{k−j}, in two chains
template <class T>
T weighted_product(Column<T> w, Column<T> u, int k) {
  const T *rising = &u[1], *falling = &w[k - 1];
  const auto up = static_cast<std::ptrdiff_t>(u.stride);
  T odd = T(0), even = T(0), j = T(1);
  for (int left = k; left > 0; left -= 2) {
    odd += j * *rising * *falling;
    if (left == 1) break;
    even += (j + T(1)) * rising[up] * falling[-up];
    j += T(2), rising += 2 * up, falling -= 2 * up;
  }
  return odd + even;
}

/// The coefficient of y with dy = w du: Σ_{j=1..k} (j/k) u_j w_{k−j}
template <class T>
T integral(Column<T> w, Column<T> u, int k) {
  return weighted_product(w, u, k) / T(k);
}

/// Both coefficients of (y, z) with dy = z du, dz = ± y du.
template <class T>
void integral_pair(Column<T> y, Column<T> z, Column<T> u, int k, T sign, T& y_k, T& z_k) {
  const auto up = static_cast<std::ptrdiff_t>(u.stride);
  const T *from_u = &u[1], *from_y = &y[k - 1], *from_z = &z[k - 1];
  T sum_y = T(0), sum_z = T(0), j = T(1);
  for (int left = k; left > 0; --left) {
    const T du = j * *from_u;
    sum_y += du * *from_z;
    sum_z += du * *from_y;
    j += T(1), from_u += up, from_y -= up, from_z -= up;
  }
  y_k = sum_y / T(k);
  z_k = sign * sum_z / T(k);
}

/// y = a/b: (a_k − Σ_{j=1..k} b_j y_{k−j}) / b_0
template <class T>
T quotient(const T& a_k, Column<T> b, Column<T> y, int k) {
  T sum = T(0);
  for (int j = 1; j <= k; ++j) sum += b[j] * y[k - j];
  return (a_k - sum) / b[0];
}

/// y = √u: (u_k − Σ_{j=1..k−1} y_j y_{k−j}) / (2 y_0)
template <class T>
T square_root(Column<T> u, Column<T> y, int k) {
  return (u[k] - self_product(y, k, 1)) / (y[0] + y[0]);
}

/// y = u^p: Σ_{j=1..k} (p j − (k − j)) u_j y_{k−j} / (k u_0), from u y' = p u' y
template <class T>
T power(Column<T> u, Column<T> y, const T& p, int k) {
  T sum = T(0);
  for (int j = 1; j <= k; ++j) sum += (p * T(j) - T(k - j)) * (u[j] * y[k - j]);
  return sum / (T(k) * u[0]);
}

}  // namespace maupertuis::jet

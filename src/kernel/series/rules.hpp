#pragma once
#include <cstddef>

/// The recurrences of truncated power series: given the coefficients of the operands up to order k and of the result
/// up to order k − 1, the coefficient of order k ≥ 1 (docs/theory/taylor.md derives them).
///
/// Generic over the scalar. Sums run from the middle outward in two chains, so that the newest coefficients, for which
/// a processor may still be waiting, come last.
namespace maupertuis::series {

/// The coefficients of one slot in the layout [order][slot].
template <class T>
struct Column {
  const T* first;
  std::size_t stride;
  const T& operator[](int k) const { return first[static_cast<std::size_t>(k) * stride]; }
};

/// Where the pairs (j, k − j) of a convolution of order k lie: the same for all columns.
struct Pairing {
  Pairing(int k, std::size_t row)
      : stride(static_cast<std::ptrdiff_t>(row)), pairs((k + 1) / 2), has_middle(k % 2 == 0) {
    low = (pairs - 1) * stride;
    high = (k + 1 - pairs) * stride;
    middle = k / 2 * stride;
  }
  std::ptrdiff_t stride;
  int pairs;
  bool has_middle;
  std::ptrdiff_t low, high;  // of the innermost pair
  std::ptrdiff_t middle;
};

/// (a b)_k = Σ_{j=0..k} a_j b_{k−j}
template <class T>
T product(const T* a, const T* b, const Pairing& pairing) {
  T rising = T(0), falling = T(0);
  if (pairing.has_middle) rising = a[pairing.middle] * b[pairing.middle];
  std::ptrdiff_t low = pairing.low, high = pairing.high;
  for (int left = pairing.pairs; left > 0; --left) {
    rising += a[low] * b[high];
    falling += a[high] * b[low];
    low -= pairing.stride, high += pairing.stride;
  }
  return rising + falling;
}

template <class T>
T product(Column<T> a, Column<T> b, int k) {
  return product(a.first, b.first, Pairing(k, a.stride));
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

/// Σ_{j=1..k} j u_j w_{k−j}
template <class T>
T weighted_product(Column<T> w, Column<T> u, int k) {
  const auto stride = static_cast<std::ptrdiff_t>(u.stride);
  T sum = T(0), j = T(1);
  for (std::ptrdiff_t up = stride, down = (k - 1) * stride; down >= 0; up += stride, down -= stride, j += T(1))
    sum += (j * u.first[up]) * w.first[down];
  return sum;
}

/// The coefficient of y with dy = w du: Σ_{j=1..k} (j/k) u_j w_{k−j}
template <class T>
T integral(Column<T> w, Column<T> u, int k) {
  return weighted_product(w, u, k) / T(k);
}

/// Both coefficients of (y, z) with dy = z du, dz = ± y du.
template <class T>
void integral_pair(Column<T> y, Column<T> z, Column<T> u, int k, T sign, T& y_k, T& z_k) {
  const auto stride = static_cast<std::ptrdiff_t>(u.stride);
  T sum_y = T(0), sum_z = T(0), j = T(1);
  for (std::ptrdiff_t up = stride, down = (k - 1) * stride; down >= 0; up += stride, down -= stride, j += T(1)) {
    const T du = j * u.first[up];
    sum_y += du * z.first[down];
    sum_z += du * y.first[down];
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

}  // namespace maupertuis::series

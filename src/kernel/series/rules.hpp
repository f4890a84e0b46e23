#pragma once
#include <cmath>
#include <cstddef>

/// The recurrences of truncated power series: given the coefficients of the operands up to order k and of the result
/// up to order k − 1, the coefficient of order k ≥ 1 (docs/theory/taylor.md derives them).
///
/// Generic over the scalar, which may be a vector of numbers that have nothing to do with each other (Vec). Sums run
/// from the middle outward in two chains, so that the newest coefficients, for which a processor may still be waiting,
/// come last.
namespace maupertuis::series {

// What vectors do in their own way (kernel/series/lane_rules.hpp has their overloads).

/// sum += a b
template <class T>
void add_product(T& sum, const T& a, const T& b) {
  sum += a * b;
}
/// x / k
template <class T>
T over_order(const T& x, int k) {
  return x / T(k);
}
/// Whichever the condition takes: the other one may be undefined.
template <class T>
T chosen(const T& condition, const T& where_not_zero, const T& where_zero) {
  return condition == 0 ? where_zero : where_not_zero;
}
template <class T>
void sine_cosine(const T& x, T& sine, T& cosine) {
  using std::sin, std::cos;
  sine = sin(x);
  cosine = cos(x);
}

/// The coefficients of one slot in the layout [order][slot].
template <class T>
struct Column {
  const T* first;
  std::size_t stride;
  const T& operator[](int k) const { return first[static_cast<std::size_t>(k) * stride]; }
};

/// Where the pairs (j, k − j) of a convolution of order k lie: the same for all columns. (A template, so that what is
/// compiled for vectors stays in its own file.)
template <class T>
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
T product(const T* a, const T* b, const Pairing<T>& pairing) {
  T rising = T(0), falling = T(0);
  if (pairing.has_middle) rising = a[pairing.middle] * b[pairing.middle];
  std::ptrdiff_t low = pairing.low, high = pairing.high;
  for (int left = pairing.pairs; left > 0; --left) {
    add_product(rising, a[low], b[high]);
    add_product(falling, a[high], b[low]);
    low -= pairing.stride, high += pairing.stride;
  }
  return rising + falling;
}

template <class T>
T product(Column<T> a, Column<T> b, int k) {
  return product(a.first, b.first, Pairing<T>(k, a.stride));
}

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
template <class T>
T self_product(Column<T> a, int k, int first) {
  T sum = T(0);
  for (int j = (k - 1) / 2; j >= first; --j) add_product(sum, a[j], a[k - j]);
  sum = sum + sum;
  if (k % 2 == 0 && k / 2 >= first) add_product(sum, a[k / 2], a[k / 2]);
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
  for (std::ptrdiff_t up = stride, down = (k - 1) * stride; down >= 0; up += stride, down -= stride, j = j + T(1))
    add_product(sum, j * u.first[up], w.first[down]);
  return sum;
}

/// The coefficient of y with dy = w du: Σ_{j=1..k} (j/k) u_j w_{k−j}
template <class T>
T integral(Column<T> w, Column<T> u, int k) {
  return over_order(weighted_product(w, u, k), k);
}

/// Both coefficients of (y, z) with dy = z du, dz = ± y du.
template <class T>
void integral_pair(Column<T> y, Column<T> z, Column<T> u, int k, T sign, T& y_k, T& z_k) {
  const auto stride = static_cast<std::ptrdiff_t>(u.stride);
  T sum_y = T(0), sum_z = T(0), j = T(1);
  for (std::ptrdiff_t up = stride, down = (k - 1) * stride; down >= 0; up += stride, down -= stride, j = j + T(1)) {
    const T du = j * u.first[up];
    add_product(sum_y, du, z.first[down]);
    add_product(sum_z, du, y.first[down]);
  }
  y_k = over_order(sum_y, k);
  z_k = over_order(sign * sum_z, k);
}

/// y = a/b: (a_k − Σ_{j=1..k} b_j y_{k−j}) / b_0
template <class T>
T quotient(const T& a_k, Column<T> b, Column<T> y, int k) {
  T sum = T(0);
  for (int j = 1; j <= k; ++j) add_product(sum, b[j], y[k - j]);
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
  for (int j = 1; j <= k; ++j) add_product(sum, p * T(j) - T(k - j), u[j] * y[k - j]);
  return sum / (T(k) * u[0]);
}

}  // namespace maupertuis::series

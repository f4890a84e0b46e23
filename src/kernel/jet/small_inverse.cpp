#include "kernel/jet/small_inverse.hpp"

#include <array>
#include <cmath>

namespace maupertuis::jet {
namespace {

constexpr std::size_t most = 16;
constexpr double least_pivot = 1e-10, symmetry = 1e-12;

using Square = std::array<std::array<double, most>, most>;

/// L below the diagonal, 1/d on it.
bool factor(std::span<const double> m, std::size_t n, Square& l) {
  for (std::size_t j = 0; j < n; ++j) {
    double d = m[j * n + j];
    const double least = least_pivot * d;
    std::array<double, most> scaled{};
    for (std::size_t k = 0; k < j; ++k) {
      scaled[k] = l[j][k] / l[k][k];  // L_jk d_k
      d -= l[j][k] * scaled[k];
    }
    if (!(d > least)) return false;
    l[j][j] = 1 / d;
    for (std::size_t i = j + 1; i < n; ++i) {
      const double below = m[i * n + j], above = m[j * n + i];
      const double difference = below - above;
      if (!(difference * difference <= symmetry * symmetry * m[i * n + i] * m[j * n + j])) return false;
      double sum = below;
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * scaled[k];
      l[i][j] = sum * l[j][j];
    }
  }
  return true;
}

/// L⁻¹ in place, below a unit diagonal that is not stored.
void invert_triangle(Square& l, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = l[i][j];
      for (std::size_t k = j + 1; k < i; ++k) sum += l[i][k] * l[k][j];
      l[i][j] = -sum;
    }
}

}  // namespace

bool negative_inverse(std::span<const double> matrix, std::size_t n, double* inverse, std::size_t stride) {
  Square l;
  if (n > most || !factor(matrix, n, l)) return false;
  invert_triangle(l, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = (i == j ? 1 : l[i][j]) * l[i][i];
      for (std::size_t k = i + 1; k < n; ++k) sum += l[k][i] * l[k][j] * l[k][k];
      inverse[i * stride + j] = inverse[j * stride + i] = -sum;
    }
  return true;
}

}  // namespace maupertuis::jet

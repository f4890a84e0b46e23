#include "linear_algebra/quadrature.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace maupertuis {

std::pair<double, double> legendre(int n, double x) {
  double before = 1, p = x;
  if (n == 0) return {1, 0};
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
    before = p;
    p = next;
  }
  return {p, n * (before - x * p) / (1 - x * x)};
}

GaussRule::GaussRule(int points) {
  const auto n = static_cast<std::size_t>(points);
  x.resize(n), w.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    double at = -std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (points + 0.5));
    for (int k = 0; k < 100; ++k) {
      const auto [value, slope] = legendre(points, at);
      at -= value / slope;
      if (std::abs(value / slope) < 1e-16) break;
    }
    const double slope = legendre(points, at).second;
    x[i] = at, w[i] = 2 / ((1 - at * at) * slope * slope);
  }
}

Lobatto::Lobatto(int p) : order(p), x(static_cast<std::size_t>(p) + 1), w(x.size()), derivative(x.size() * x.size()) {
  const std::size_t n = x.size();
  x.front() = -1, x.back() = 1;
  for (std::size_t i = 1; i + 1 < n; ++i) {  // zeros of P_p' by Newton's method on (1 − x²) P_p'
    double at = -std::cos(std::numbers::pi * static_cast<double>(i) / p);
    for (int k = 0; k < 100; ++k) {
      const auto [value, slope] = legendre(p, at);
      const double change = (1 - at * at) * slope / (p * (p + 1) * value);
      at += change;
      if (std::abs(change) < 1e-17) break;
    }
    x[i] = at;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double value = i == 0 ? (p % 2 ? -1.0 : 1.0) : i + 1 == n ? 1.0 : legendre(p, x[i]).first;
    w[i] = 2 / (p * (p + 1) * value * value);
  }
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0;
    for (std::size_t m = 0; m < n; ++m) {
      if (m == j) continue;
      double product = 1 / (x[m] - x[j]);
      for (std::size_t k = 0; k < n; ++k)
        if (k != m && k != j) product *= (x[j] - x[k]) / (x[m] - x[k]);
      sum += derivative[j * n + m] = product;
    }
    derivative[j * n + j] = -sum;
  }
}

void Lobatto::at(double xi, std::vector<double>& value, std::vector<double>& slope) const {
  const std::size_t n = x.size();
  value.assign(n, 0), slope.assign(n, 0);
  for (std::size_t m = 0; m < n; ++m) {
    double product = 1;
    for (std::size_t k = 0; k < n; ++k)
      if (k != m) product *= (xi - x[k]) / (x[m] - x[k]);
    value[m] = product;
    for (std::size_t l = 0; l < n; ++l) {
      if (l == m) continue;
      double term = 1 / (x[m] - x[l]);
      for (std::size_t k = 0; k < n; ++k)
        if (k != m && k != l) term *= (xi - x[k]) / (x[m] - x[k]);
      slope[m] += term;
    }
  }
}

/// The other points are zeros of P_{n−1} + P_n.
Radau::Radau(int points) : x(static_cast<std::size_t>(points), -1), w(x.size()) {
  const double n = points;
  w.front() = 2 / (n * n);
  for (std::size_t i = 1; i < x.size(); ++i) {
    double at = -std::cos(2 * std::numbers::pi * static_cast<double>(i) / (2 * n - 1));
    for (int k = 0; k < 100; ++k) {
      const auto [below, slope_below] = legendre(points - 1, at);
      const auto [value, slope] = legendre(points, at);
      const double change = -(below + value) / (slope_below + slope);
      at += change;
      if (std::abs(change) < 1e-17) break;
    }
    const double below = legendre(points - 1, at).first;
    x[i] = at, w[i] = (1 - at) / (n * n * below * below);
  }
}

}  // namespace maupertuis

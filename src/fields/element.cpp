#include "fields/element.hpp"

#include <cmath>

namespace maupertuis {
namespace {

/// d^k/dx^k P_0 … P_n at x, for k = 0 … order: [k][n]. From (2n + 1) P_n = P'_{n+1} − P'_{n−1}.
std::vector<std::vector<double>> legendre_with_derivatives(int n, int order, double x) {
  const auto count = static_cast<std::size_t>(n) + 1;
  std::vector<std::vector<double>> p(static_cast<std::size_t>(order) + 1, std::vector<double>(count, 0));
  p[0][0] = 1;
  if (n > 0) p[0][1] = x;
  for (std::size_t i = 2; i < count; ++i) {
    const auto m = static_cast<double>(i);
    p[0][i] = ((2 * m - 1) * x * p[0][i - 1] - (m - 1) * p[0][i - 2]) / m;
  }
  for (std::size_t k = 1; k < p.size(); ++k)
    for (std::size_t i = 1; i < count; ++i)
      p[k][i] = (i > 1 ? p[k][i - 2] : 0) + (2 * static_cast<double>(i) - 1) * p[k - 1][i - 1];
  return p;
}

}  // namespace

Element::Element(bool smooth, int degree) : smooth_(smooth), degree_(degree) {}

void Element::at(double xi, int k, double* out) const {
  const auto power = [&](int n) {  // d^k/dξ^k ξ^n
    double c = 1;
    for (int i = 0; i < k; ++i) c *= n - i;
    return n < k ? 0.0 : c * std::pow(xi, n - k);
  };
  const double one = power(0), x = power(1);
  if (smooth_) {
    const double x2 = power(2), x3 = power(3);
    out[0] = (2 * one - 3 * x + x3) / 4, out[1] = (one - x - x2 + x3) / 4;
    out[2] = (2 * one + 3 * x - x3) / 4, out[3] = (-one - x + x2 + x3) / 4;
  } else {
    out[0] = (one - x) / 2, out[1] = (one + x) / 2;
  }
  // ∫P_n = (P_{n+1} − P_{n−1})/(2n + 1), once or twice; derivatives of them are those of Legendre's polynomials.
  const auto p = legendre_with_derivatives(degree_, k, xi);
  const std::vector<double>& d = p[static_cast<std::size_t>(k)];
  const auto once = [&](std::size_t n) { return (d[n + 1] - d[n - 1]) / (2 * static_cast<double>(n) + 1); };
  const std::size_t first = smooth_ ? 2 : 1;
  for (std::size_t i = 0; i < inner(); ++i) {
    const std::size_t n = i + first;
    out[2 * at_end() + i] = smooth_ ? (once(n + 1) - once(n - 1)) / (2 * static_cast<double>(n) + 1) : once(n);
  }
}

void Element::project(const GaussRule& rule, const std::vector<double>& highest, double* inner_out) const {
  const std::size_t first = smooth_ ? 2 : 1;
  for (std::size_t i = 0; i < inner(); ++i) inner_out[i] = 0;
  for (std::size_t q = 0; q < rule.x.size(); ++q) {
    const auto p = legendre_with_derivatives(degree_, 0, rule.x[q]);
    for (std::size_t i = 0; i < inner(); ++i) {
      const std::size_t n = i + first;
      inner_out[i] += (2 * static_cast<double>(n) + 1) / 2 * rule.w[q] * p[0][n] * highest[q];
    }
  }
}

}  // namespace maupertuis

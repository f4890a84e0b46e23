#pragma once
#include <utility>
#include <vector>

namespace maupertuis {

/// P_n and P_n' at x; P_n' where |x| < 1.
std::pair<double, double> legendre(int n, double x);

/// Gauss's rule on [−1, 1]: exact for polynomials of degree 2n − 1.
struct GaussRule {
  explicit GaussRule(int points);
  std::vector<double> x, w;  // ascending
};

/// Gauss-Lobatto-Legendre points of [−1, 1] with their weights and the derivatives of Lagrange's polynomials there.
struct Lobatto {
  explicit Lobatto(int order);
  int order;                       // of the polynomials; order + 1 points
  std::vector<double> x, w;        // [order + 1]
  std::vector<double> derivative;  // ℓ_m'(x_j) at [j · (order + 1) + m]; rows sum to 0

  /// ℓ_m(ξ) and ℓ_m'(ξ) for all m.
  void at(double xi, std::vector<double>& value, std::vector<double>& slope) const;
};

/// Gauss-Radau's rule: as many points, −1 among them and 1 not, exact up to the degree 2 · points − 2.
struct Radau {
  explicit Radau(int points);
  std::vector<double> x, w;  // ascending
};

}  // namespace maupertuis

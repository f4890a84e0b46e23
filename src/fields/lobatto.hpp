#pragma once
#include <vector>

namespace maupertuis {

/// Gauss-Lobatto-Legendre points of [−1, 1] with their weights and the derivatives of Lagrange's polynomials there.
struct Lobatto {
  explicit Lobatto(int order);
  int order;                       // of the polynomials; order + 1 points
  std::vector<double> x, w;        // [order + 1]
  std::vector<double> derivative;  // ℓ_m'(x_j) at [j · (order + 1) + m]; rows sum to 0

  /// ℓ_m(ξ) and ℓ_m'(ξ) for all m.
  void at(double xi, std::vector<double>& value, std::vector<double>& slope) const;
};

}  // namespace maupertuis

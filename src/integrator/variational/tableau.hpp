#pragma once
#include <cstddef>
#include <vector>

namespace maupertuis::variational {

/// Coefficients of a Galerkin variational integrator on s nodes, as the pair of Runge-Kutta methods that it is.
/// In long double: rounded coefficients would be another method, whose energy drifts.
struct Tableau {
  std::size_t stages = 0;
  std::vector<long double> c, b;  // [s] nodes and weights on [0, 1]
  std::vector<long double> a;     // [s × s] of q: ∫₀^{c_i} ℓ_j
  std::vector<long double> dual;  // [s × s] of p: b_j (1 − a_ji / b_i), what makes the pair symplectic
  std::vector<long double> quadrature_nodes, quadrature_weights;  // of Gauss on [0, 1], for integrals of ℓ_j
  long double at(const std::vector<long double>& m, std::size_t i, std::size_t j) const { return m[i * stages + j]; }
  /// ℓ_j(x) and ∫₀ˣ ℓ_j for the polynomials of Lagrange on the nodes.
  long double basis(std::size_t j, long double x) const;
  long double basis_integral(std::size_t j, long double x) const;
};

/// Order 2s; the Gauss collocation method.
Tableau gauss(std::size_t stages);
/// Order 2s − 2; the nodes hold both ends: Lobatto IIIA for q, IIIB for p. Precondition: stages ≥ 2.
Tableau lobatto(std::size_t stages);

}  // namespace maupertuis::variational

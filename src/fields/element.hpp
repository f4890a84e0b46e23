#pragma once
#include "linear_algebra/quadrature.hpp"

#include <cstddef>
#include <vector>

namespace maupertuis {

/// The functions of one element of a field of one space variable, on ξ in [−1, 1], polynomials of a degree p.
///
/// Continuous elements (C⁰): u at both ends, linear, and the integrals of Legendre's polynomials P_1 … P_{p−1}, which
/// vanish at both ends. Smooth elements (C¹, for densities with u_xx, p ≥ 3): u and du/dξ at both ends, Hermite's
/// cubics, and the double integrals of P_2 … P_{p−2}, which vanish there with their slopes. So the highest derivatives
/// that an energy holds are orthogonal polynomials, and neighbours share what stands at their common end alone.
///
/// Order of the functions: left end (u, then du/dξ), right end, inner ones.
class Element {
 public:
  Element(bool smooth, int degree);
  bool smooth() const { return smooth_; }
  int degree() const { return degree_; }
  std::size_t at_end() const { return smooth_ ? 2 : 1; }
  std::size_t inner() const { return static_cast<std::size_t>(degree_) + 1 - 2 * at_end(); }
  std::size_t size() const { return static_cast<std::size_t>(degree_) + 1; }

  /// d^k/dξ^k of all functions at ξ.
  void at(double xi, int k, double* out) const;
  /// The inner coefficients of the polynomial that has u at the ends (C¹: and du/dξ) and is nearest to the function in
  /// the mean square of its highest derivative of an energy, `highest` = d²u/dξ² (C⁰: du/dξ), given at the points of a
  /// rule. It is the solution of the beam (string) under the function's own load: exact at the ends.
  void project(const GaussRule& rule, const std::vector<double>& highest, double* inner) const;

 private:
  bool smooth_;
  int degree_;
};

}  // namespace maupertuis

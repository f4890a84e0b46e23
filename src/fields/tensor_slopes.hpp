#pragma once
#include "linear_algebra/quadrature.hpp"

#include <vector>

namespace maupertuis {

/// A matrix of one element of Gauss-Lobatto points, along one direction of many elements at once: D, which gives the
/// derivative, or the stiffness K_jm = −1/w_j Σ_i w_i D_ij D_im, which gives the second derivative with what the ends
/// of the element add, by parts.
///
/// The points lie evenly about the middle, so that sums and differences of opposite values are multiplied apart, which
/// halves the work: D makes odd functions of even ones, K leaves them even. Rows of both sum to zero: what is even acts
/// on differences alone, which keeps digits.
class EvenOddProduct {
 public:
  static EvenOddProduct slopes(const Lobatto& rule);
  static EvenOddProduct stiffness(const Lobatto& rule);
  /// to = base + scale · matrix · u, `base` may be null: nothing then. Values of one element lie `stride` apart, those
  /// of `count` elements side by side. `to` is neither of the others.
  void apply(double* to, const double* base, const double* u, double scale, std::size_t stride,
             std::size_t count) const;

 private:
  EvenOddProduct(const std::vector<double>& matrix, int order, bool keeps_even);

  int p_;
  bool keeps_even_;
  std::vector<double> even_, odd_;  // [half rows × half], factors of sums and of differences
};

}  // namespace maupertuis

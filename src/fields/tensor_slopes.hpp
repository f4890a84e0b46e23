#pragma once
#include "linear_algebra/quadrature.hpp"

#include <vector>

namespace maupertuis {

/// The derivative along one direction of many elements at once.
///
/// Gauss-Lobatto points lie evenly about the middle, so that sums and differences of opposite values are differentiated
/// apart, which halves the work. Rows of the matrix sum to zero: what is even acts on differences alone, which keeps
/// digits.
class EvenOddSlopes {
 public:
  explicit EvenOddSlopes(const Lobatto& rule);
  /// to = base + scale · D u, `base` may be null: nothing then. Values of one element lie `stride` apart, those of
  /// `count` elements side by side. `to` is neither of the others.
  void apply(double* to, const double* base, const double* u, double scale, std::size_t stride,
             std::size_t count) const;

 private:
  int p_;
  std::vector<double> even_, odd_;  // [half rows × half], factors of sums and of differences
};

}  // namespace maupertuis

#pragma once
#include "analysis/action/functional.hpp"

namespace maupertuis::action {

/// Polynomials of one degree on [−1, 1] by their values at the Gauss-Lobatto nodes, and Gauss's points at which the
/// action is summed: these never lie at an end, where L may be infinite.
struct Rule {
  explicit Rule(Index degree);

  Index degree;
  Vector nodes;           // [p + 1]
  Vector points, weights; // [p + 2] Gauss-Legendre
  Matrix value, slope;    // [p + 2 × p + 1] nodes → values, derivatives at the points
  Matrix node_slope;      // [p + 1 × p + 1] nodes → derivatives at the nodes
  Matrix legendre;        // [p + 1 × p + 1] nodes → coefficients of Legendre polynomials

  /// Weights of the nodes for the value (derivative) at ξ.
  Vector value_at(double xi) const;
  Vector slope_at(double xi) const;

 private:
  Vector barycentric_;
};

}  // namespace maupertuis::action

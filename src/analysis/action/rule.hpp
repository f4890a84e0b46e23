#pragma once
#include "analysis/action/functional.hpp"

#include <memory>

namespace maupertuis::action {

/// Whether the polynomials of an element have the derivative 0 at an end, as a path in s has where it runs slowly:
/// there L is infinite at the end, and a slope would carry Newton's method across it.
enum class Flat { Nowhere, AtBegin, AtEnd };

/// Polynomials of one degree on [−1, 1] by their values at the Gauss-Lobatto nodes, and Gauss's points at which the
/// action is summed: these never lie at an end, where L may be infinite.
struct Rule {
  explicit Rule(Index degree, Flat flat = Flat::Nowhere);

  Index degree;
  Index anchor = 0;  // the node at the end where L may be infinite: values near there are told as differences from it
  Vector nodes;      // [p + 1]
  Vector points, weights;  // [p + 2] Gauss-Legendre
  Matrix value, slope;     // [p + 2 × p + 1] nodes → values, derivatives at the points
  Matrix node_slope;       // [p + 1 × p + 1] nodes → derivatives at the nodes
  Matrix legendre;         // [p + 1 × p + 1] nodes → coefficients of Legendre polynomials
  Matrix lumping;  // [p + 1 × p + 1] ∫ ℓ_i ℓ_j less what the sum over the nodes (Gauss-Lobatto) makes of it

  /// Weights of the nodes for the value (derivative) at ξ.
  Vector value_at(double xi) const;
  Vector slope_at(double xi) const;

  /// The same for the first and for the last element of a path that runs slowly there. Null in a flat rule itself.
  std::shared_ptr<const Rule> flat_begin, flat_end;

 private:
  struct Basis {
    Vector value, slope;
  };
  Basis flat_basis(double xi) const;
  Basis flat_begin_of(double xi) const;
  Vector wide_value(long double xi) const;
  Vector wide_slope(long double xi) const;
  Flat flat_;
  Vector barycentric_;
};

}  // namespace maupertuis::action

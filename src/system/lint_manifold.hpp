#pragma once
#include "system/lint.hpp"

namespace maupertuis::lint_rules {

using Row = std::vector<double>;
using Matrix = std::vector<Row>;  // rows

/// The states that the constraints allow, in numbers. Without constraints every state is one.
class Manifold {
 public:
  explicit Manifold(const Subject& s);

  /// Moves the coordinates and velocities of `point` onto the constraints, by Gauss-Newton with least changes. False
  /// where it does not get there.
  bool reach(Bindings& point) const;
  /// A = ∂φ/∂q, ∂ψ/∂q̇ [m × n] at a point.
  Matrix rows(const Bindings& point) const;

 private:
  bool settle(Bindings& point, const ExprVector& unknowns, const ExprVector& values, const ExprVector& jacobian) const;

  ExprVector coordinates_, velocities_;       // [n]
  ExprVector positions_, position_jacobian_;  // φ, ∂φ/∂q
  ExprVector rates_, rate_jacobian_;          // dφ/dt and ψ, by q̇; the jacobian is A
};

/// Directions that both matrices of n columns send to zero, by elimination: few entries each. `scales` [n]: units of
/// the coordinates.
std::vector<Row> null_vectors(Matrix rows, const Row& scales);

/// M on the directions that the constraints leave.
struct ReducedMass {
  std::vector<Row> null;  // directions without kinetic energy, [n] each
  bool positive = true;
};
/// M [n × n], A [m × n]. Units are scaled away: the diagonal of M to 1.
ReducedMass reduce(const Matrix& mass, const Matrix& constraints);

}  // namespace maupertuis::lint_rules

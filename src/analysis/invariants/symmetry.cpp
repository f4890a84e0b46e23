#include "analysis/invariants/symmetry.hpp"

namespace maupertuis::invariants {

std::optional<ExprVector> symmetry_of(Expr integral, const MotionRows& rows) {
  const MechanicalSystem& system = *rows.system;
  ExprVector velocities, residual;
  for (const Coordinate& c : system.coordinates) velocities.push_back(c.velocity);
  const ExprVector slopes = gradient(integral, velocities);
  // The solver of the equations of motion, with q̈ as the unknowns.
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    Expr row = -slopes[i];
    for (std::size_t j = 0; j < velocities.size(); ++j)
      row = row + rows.mass.at(i, j) * system.coordinates[j].acceleration;
    residual.push_back(row);
  }
  return accelerations(residual, system);
}

}  // namespace maupertuis::invariants

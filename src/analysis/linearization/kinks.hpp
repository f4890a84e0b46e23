#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <string>
#include <vector>

namespace maupertuis {

/// The equations in force on one side of the switches that a point lies on.
struct OneSide {
  std::string where;  // "x > 0"
  PointEquations equations;
  double residual = 0;  // of rest at the point on this side, as Equilibrium::residual
};

/// The sides of a point at which the equations, or their first derivatives, are not those of its other side: a kink of
/// the potential, dry friction at rest. Empty where all sides agree, or no switch passes through the point.
std::vector<OneSide> sides_at(const PointEquations& equations, const Equilibrium& x,
                              const std::vector<Translation>& translations);

}  // namespace maupertuis

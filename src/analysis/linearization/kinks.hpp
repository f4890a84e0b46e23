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

/// How many formulas switch at the point; n of them part its neighbourhood into up to 2ⁿ sides.
std::size_t switches_at(const PointEquations& equations, const Equilibrium& x);
constexpr std::size_t most_switches = 6;  // whose sides are looked at

/// The sides of a point at which the equations, or their first derivatives, are not those of its other side: a kink of
/// the potential, dry friction at rest. Empty where all sides agree, or no switch passes through the point; one side
/// without a name where all sides agree with each other and the formula on the switch itself does not.
std::vector<OneSide> sides_at(const PointEquations& equations, const Equilibrium& x,
                              const std::vector<Translation>& translations);

/// Whether the stiffness grows without bound, as that of |x|^p with 1 < p < 2 or of x² log x² does at 0: what stands in
/// place of its value is how far from the point rounding has left it. Asked beside the point, ever nearer; ways on
/// which it has no value are left out.
bool is_stiffness_unbounded(const PointEquations& equations, const OperatingPoint& point);

}  // namespace maupertuis

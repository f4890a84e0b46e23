#pragma once
#include "analysis/linearization/matrices.hpp"
#include "analysis/linearization/point_equations.hpp"

namespace maupertuis {

/// What a second derivative of the potential at a computed rest says of the rest itself.
enum class Curvature { Positive, Negative, Undecided };

/// A rest is known as far as the force along `direction` [n] can be told from rounding of its terms. At a fold, where
/// rests come together in pairs and vanish, and at an inflection that is a long way: then the second derivative along
/// the direction, dᵀ K d, has the sign of an accident. Undecided where it vanishes or changes its sign on that way.
/// Cost: two evaluations of the equations and their derivatives for each doubling of the way; one pair as a rule.
Curvature curvature_at_rest(PointEquations::Impl& e, const OperatingPoint& rest, const Vector& direction);

}  // namespace maupertuis

#pragma once
#include <maupertuis/linearization.hpp>

namespace maupertuis {

/// A state as a point at which nothing moves, without forces of contacts.
OperatingPoint point_at_rest(const PointEquations& equations, const MotionState& start);

/// The contacts that touch where the forces push a system that may only move into its gaps, g ≥ 0, without inertia and
/// friction: downhill from `from` to a place where the potential is least, if it comes to one. By quadratic programs,
/// each over the forces, the stiffness and the gaps to first order at the place before, with steps of typical sizes (R.
/// B. Wilson's method, damped as K. Levenberg's). A guess at which contacts press in a rest; it proves nothing.
/// `equations`: of the system with open contacts.
std::vector<bool> touching_at_lowest_place(const EquationsOfMotion& equations, const MechanicalSystem& with_contacts,
                                           const OperatingPoint& from);

}  // namespace maupertuis

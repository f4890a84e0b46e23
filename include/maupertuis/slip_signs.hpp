#pragma once
#include <maupertuis/mechanical_system.hpp>

namespace maupertuis {

/// A function of the slip v_t of a friction in the plane, like its limit, as it is where v_t > 0 (`forwards`) or
/// v_t < 0: |c v_t| is |c| (±v_t), sign(c v_t) is ±sign c, and of what else v_t = 0 decides its branch is there, if c
/// is a number. So a law of friction by |v_t| goes on up to the instant at which the slip stops. Else the function
/// itself.
Expr on_side_of_slip(const MechanicalSystem& system, const Friction& friction, Expr function, bool forwards);

/// The largest force of a friction that slides, or would slide, forwards or backwards: a coefficient, friction.kinetic
/// or static_, times the normal force; where that is empty, the coefficient is the force itself.
Expr limit_of_friction(const MechanicalSystem& system, const Friction& friction, Expr coefficient, Expr normal,
                       bool forwards);

}  // namespace maupertuis

#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/motion_functions.hpp>

#include <span>

namespace maupertuis {

/// What a run wants to know of a motion besides the motion: in q, q', q'', λ, t, inputs and parameters.
struct WantedFunctions {
  std::vector<Expr> observables, events, integrands;
  bool has_wide_range = false;  // of numbers, beyond that of double
};

/// The equations of a system as functions at points, for methods that do not expand the motion in powers of time.
MotionFunctions motion_functions(const EquationsOfMotion& equations, const WantedFunctions& wanted);

/// p, ṗ and the constraints for the variational method. Where a body's orientation is a quaternion, ½ c φ̇² with c = tr
/// I / 3 is added to L, and the same with a typical inertia where a constraint ties a coordinate without kinetic
/// energy: it vanishes with its first derivatives on the constraint φ = 0, so that the motion and λ stay the same, and
/// M becomes regular.
VariationalFunctions variational_functions(const EquationsOfMotion& equations, const WantedFunctions& wanted);

}  // namespace maupertuis

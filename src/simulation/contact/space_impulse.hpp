#pragma once
#include "linear_algebra/dense.hpp"

namespace maupertuis {

/// One contact with friction in space at an impact. Directions: normal, then two tangents at right angles.
struct SpaceImpact {
  Eigen::Matrix3d response;  // W: what impulses change in (v_n, v_t1, v_t2)
  Eigen::Vector3d velocity;  // before; v_n < 0
  double friction = 0, static_friction = 0, restitution = 0;
  bool sticking = false;  // it never slides
};

/// The impulse (Λ, Λ_t1, Λ_t2), followed along its normal part: dv/dΛ = W (1, −μ v_t/|v_t|) while it slides, v_t = 0
/// while friction holds it, and the work of Λ in restitution is e² times that in compression (W. J. Stronge, Impact
/// Mechanics, 3.4 and 4.2). The hodograph of v_t is followed to 1e-13 of the speeds. Cost: some 100 evaluations,
/// thousands near a stop.
Eigen::Vector3d impulse_in_space(const SpaceImpact& impact);

}  // namespace maupertuis

#pragma once
#include "analysis/action/directions.hpp"

namespace maupertuis::action {

/// The second variation on a mesh: how many of its eigenvalues, relative to ∫ (ξ' |M| ξ' + ξ |M| ξ/T²) dt, are
/// negative, and how many are zero to rounding: of a translation, which free ends can allow, ∫ ξ' |M| ξ' dt alone is
/// zero as well.
struct Inertia {
  std::size_t negative = 0, nullity = 0;
  double nearest = 0;  // no other eigenvalue lies within ± this
};

/// Restricted to the directions that the ends, φ = 0 and the integral constraints allow. The inner nodes of each
/// element are eliminated first (Haynsworth: inertias add up), then one eigenproblem of the nodes between elements is
/// left. Precondition: the trial is stationary.
Inertia inertia_of(Functional& functional, const Trial& trial, const FixedEnds& fixed, const Vector& least);

/// Whether M, of L with q'' that by q'', is positive definite on the directions that φ = 0 allows, at the nodes.
bool convex_along(Functional& functional, const Trial& trial);

}  // namespace maupertuis::action

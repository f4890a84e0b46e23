#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/orbits.hpp>

/// What the multipliers say of stability, as far as what the geometry asks of dΦ_T lets them be believed.
namespace maupertuis::orbits {

/// How far from the unit circle a multiplier may lie by the errors of dΦ_T that are known of: closure and `error`.
double width_of_circle(const FloquetResult& result);

/// Volumes that do not shrink let nothing attract: that a Lagrangian alone, or any motion without divergence, attracts
/// is never said. `Undecided` where the multipliers contradict the divergence, or where dΦ_T misses its geometry and no
/// multiplier is clearly outside the circle.
OrbitalStability stability_of(const FloquetResult& result);

/// W1402 where dΦ_T misses its geometry by more than rounding.
void warn_of_error(const FloquetResult& result, Diagnostics& diagnostics);

}  // namespace maupertuis::orbits

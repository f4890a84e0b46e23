#pragma once
#include <maupertuis/mechanical_system.hpp>

namespace maupertuis {

/// N/λ: the force with which a contact presses, by its multiplier, where the places of the masses that it moves tell
/// it. It is |d| of the d with d·∂(r − r')/∂q = ∂g/∂q for all coordinates q, where it presses a mass at r, or two apart
/// that are at r and r' (d'Alembert's principle for the force λ d on the one and −λ d on the other). Coordinates that
/// turn a body take torques and are left out. Empty where this does not determine d. In q, t and parameters. Cost: zero
/// tests, some for each coordinate that moves these masses.
Expr normal_force_per_multiplier(const MechanicalSystem& system, const Contact& contact);

}  // namespace maupertuis

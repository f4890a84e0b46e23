#pragma once
#include "drawing/outlines.hpp"

namespace maupertuis::drawing {

/// Arrows of torsion springs, of V = … and D = …, and of `force q = …`: these act on coordinates, and each is shown at
/// what its coordinate moves, as the force or torque there that does the same work. Those that no single arrow stands
/// for are named in `plan.unplaced`: "V on s", "torsion spring θ", "U".
void add_forces_on_coordinates(const MechanicalSystem& system, Plan& plan);

}  // namespace maupertuis::drawing

#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace maupertuis {

/// The coordinates (w, x, y, z) of each body and frame with `rotation quaternion`, whose norm is a constraint.
std::vector<std::array<std::size_t, 4>> quaternion_coordinates(const MechanicalSystem& system);

}  // namespace maupertuis

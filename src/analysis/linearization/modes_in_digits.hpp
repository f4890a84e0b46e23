#pragma once
#include <maupertuis/linearization.hpp>
#include <maupertuis/precise_modes.hpp>

namespace maupertuis {

/// Eigenvalues at a rest without constraints, from the exact values of the parameters. Nothing where there are too many
/// coordinates, switches in the equations, or a singular M.
std::optional<std::vector<PreciseMode>> modes_in_digits(const PointEquations& equations, const Equilibrium& rest);

}  // namespace maupertuis

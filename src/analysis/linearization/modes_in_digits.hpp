#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/linearization.hpp>
#include <maupertuis/precise_modes.hpp>

namespace maupertuis {

/// Eigenvalues at a rest, from the exact values of the parameters. Nothing where there are too many coordinates,
/// switches in the equations or constraints, constraints on velocities that states of rest need not keep, relations
/// without a force (of degenerate Lagrangians), or a singular M.
std::optional<std::vector<PreciseMode>> modes_in_digits(const PointEquations& equations, const Equilibrium& rest);

/// Whether rounding of the formulas themselves makes more of an entry of M, D or K at a point than that of numbers as
/// large as their largest: of 10¹⁰ (cos b − 1 + b²/2) at b = 0.001 double knows three digits. Of no more coordinates
/// than modes_in_digits takes.
bool is_lost_in_entries(const PointEquations& equations, const OperatingPoint& point);

/// Where that is so, the derivatives of the balance in 100 digits, rounded once.
void restore_entries(const PointEquations& equations, const OperatingPoint& point, RowsAtPoint& balance);

}  // namespace maupertuis

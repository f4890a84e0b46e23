#pragma once
#include <maupertuis/kernel.hpp>

#include <span>

namespace maupertuis::taylor {

/// What the evaluation of a constraint leaves by rounding, relative to the sizes of its terms.
inline constexpr double rounding_of_constraints = 1e-14;

/// The largest of φ, and of dφ/dt or ψ, at the point of the workspace, each divided by the sizes of its terms and by how
/// far they change in a step of length h, so that a constraint such as y = 0 has a measure too.
double constraint_error(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h);

/// How far corrections of q and q̇ go, relative to q̇ and to what it moves in a step of length h, in the metric of the diagonal
/// of M.
double correction_size(const KernelWorkspace& work, std::span<const double> dq, std::span<const double> dv, double h);

}  // namespace maupertuis::taylor

#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/kernel.hpp>

#include <cstddef>

namespace maupertuis::tangent {

/// The motion and `columns` directions along it as one system of n (1 + columns) coordinates: q, δ₁q, δ₂q, …, with the
/// multipliers and constraints of the motion first, then those of each direction. M of the whole is block-triangular.
KernelSource extended_source(const EquationsOfMotion& equations, std::size_t columns);

}  // namespace maupertuis::tangent

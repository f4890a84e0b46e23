#pragma once
#include "kernel/sparse/lifted_system.hpp"

namespace maupertuis::reference {

/// The entries of a lifted system at some states around (t, q, q̇), for the choice of pivots: angles anywhere, lengths
/// up to twice as long, other velocities; most of them hold multiples of a right angle, where a sine or cosine vanishes
/// that a pivot must not depend on. The same states at every call. States where a value is infinite or undefined are
/// left out.
std::vector<std::vector<double>> sampled_entries(const Program& program, const sparse::LiftedSystem& system,
                                                 std::span<const double> constants, double t, std::span<const double> q,
                                                 std::span<const double> v);

bool is_finite(std::span<const double> values);

}  // namespace maupertuis::reference

#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace maupertuis::invariants {

/// A bound of the number of point symmetries of the action (ξ(t), or ξ(q,t) where L is not natural; η(q,t); f up to a
/// constant).
///
/// Taylor coefficients of ξ, η, f at a random point of (q, t) over a prime field must satisfy the determining equation
/// and its derivatives. Where the coefficients of order ≤ j of all solutions fix those of order j + 1, a symmetry obeys
/// a closed linear system of first order along each path, so that one with no coefficient up to j is 0: the number of
/// free coefficients bounds the dimension. The order rises until the bound is what was `found` or the size is exceeded.
/// Nothing where no such j was met.
std::optional<std::size_t> symmetry_bound(const EquationsOfMotion& equations, bool natural, std::size_t found,
                                          std::uint64_t seed);

}  // namespace maupertuis::invariants

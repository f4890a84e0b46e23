#pragma once
#include <maupertuis/fields.hpp>

#include <optional>

namespace maupertuis {

struct SideFit {
  /// Which derivative of a wave jumps where the start does not fit the sides of its domain, and where the jump runs in:
  /// 0 the field itself, 1 its slope, …; nothing up to the fourth.
  std::optional<int> jump;
  double tail = 0;  // what jumps that are too small to count may make of the field from node to node, beside its size
};

/// How a start fits the sides.
///
/// φ = g at a side asks for D_t^k (φ − g) = 0 at the start for every k, the derivatives in time beyond the first being
/// those that the equations say; a natural side for D_t^k (p + F) = 0, a place with bodies for D_t^k of the condition
/// there. A time derivative of a field with curvatures is worth two in space. u = x (1 − x) between held ends has u'' =
/// −2 at both, where nothing moves: its curvature jumps. Meshes gain by halving their cells what that derivative lets
/// them. The lowest one that counts: of tails of pulses, where less than 1e-5 of the condition does not hold, those
/// that are seen from node to node, `spacing` apart. What is given has the branches that it has until `until`. Fields
/// without inertia, in which no waves run, fit. Cost: milliseconds.
SideFit fit_of_sides(const FieldEquations& equations, double begin, double until, double spacing);

}  // namespace maupertuis

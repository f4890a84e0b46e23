#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace maupertuis::taylor {

/// A coordinate that rests, and what rounding of forces that balance makes of its acceleration.
struct AtRest {
  std::size_t coordinate;
  double rounding;
};

/// Coordinates that constraints tie together and that all rest over a step of length h, but for what rounding leaves of
/// forces that balance: with q̈ off by some ε of what the forces would do alone a long step would carry them away by its
/// square.
///
///     Σ_k |coefficient k of q̇_i| h^k  ≤  16 ε usual_i h
///
/// `usual`: [n] the largest accelerations that forces make in the run, or would make if they did not balance; empty
/// where they are not known: then nothing rests. Of what a constraint ties together all rests, or nothing.
std::vector<AtRest> resting(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                            std::span<const double> usual);

}  // namespace maupertuis::taylor

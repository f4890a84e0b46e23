#pragma once
#include "integrator/taylor/constraint_error.hpp"

#include <cstddef>
#include <vector>

namespace maupertuis::taylor {

/// A coordinate whose forces balance over a step, what rounding of these makes of its acceleration, and whether its
/// velocity is rounding too.
struct Balanced {
  std::size_t coordinate;
  double rounding;
  bool rests;
};

/// Coordinates that constraints tie together, and whose accelerations all are nothing but what rounding leaves of
/// forces that balance: off by some ε of what the forces would do alone, one long step would carry them away by its
/// square.
///
///     Σ_{k≥1} |coefficient k of q̇_i| h^k  ≤  16 ε a_i h
///     |q̇_i|  ≤  16 ε max(v_i, a_i h')                      at rest: h' is the step before
///
/// Where the constraints leave a freedom, a force along it may be as small and real: then what is left of the forces,
///
///     |(M q̈)_i|  ≤  16 ε Σ_j |A_ji λ_j|
///
/// has to be rounding of those that cancel too.
///
/// `usual`: the largest velocities v and accelerations a in the run, the latter of forces that balance too; empty where
/// they are not known: then nothing is left out. What a constraint ties together is treated alike.
std::vector<Balanced> balanced(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints, double h,
                               double step_before, const UsualSizes& usual);

}  // namespace maupertuis::taylor

#pragma once
#include "comparison/motions.hpp"
#include "comparison/pull_back.hpp"

namespace maupertuis::comparison {

/// A state of B at which one of the two descriptions has energies and forces, and the other has not.
struct DomainGap {
  MotionState state;  // of B
  bool of_a = false;  // A is the one that is defined there
};

/// log x² and 2 log x have one derivative and are two functions. Looks at points on both sides of every border that a
/// root, a logarithm or an inverse function draws in L, D, Q of A (mapped) or B; only where the map itself is defined,
/// and on B's constraints.
std::optional<DomainGap> domain_gap(const MechanicalSystem& a, const PullBack& pull_back, const Model& b,
                                    const EquationsOfMotion& b_equations, const Motions& motions);

}  // namespace maupertuis::comparison

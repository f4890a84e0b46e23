#pragma once
#include "analysis/invariants/basis.hpp"
#include "analysis/invariants/motion_sampler.hpp"

#include <maupertuis/equations_of_motion.hpp>

namespace maupertuis::invariants {

/// The functions of position and time that occur in the equations of a system, from which bases are built.
struct Atoms {
  std::vector<Monomial> coordinates;  // q_i
  std::vector<Monomial> functions;    // sines and cosines, inverse powers, … of q (perhaps with t)
  std::vector<Monomial> products;     // what stands beside velocities and parameters in the terms of L
  std::vector<Monomial> potentials;   // those of the terms of L without velocities
  std::vector<Monomial> time;         // e^{gt}, sin Wt, … of t alone
  bool natural = true;                // L is a polynomial of the velocities of degree 2
};

/// Those of L, of the forces and of the constraints; sin q and cos q for angles that occur nowhere; e^{λt} of uncoupled
/// linear equations.
Atoms collect_atoms(const EquationsOfMotion& equations, Generators& generators);

/// Those of `candidates` that are not combinations of 1 and of earlier ones, as functions of all symbols but the
/// parameters. Precondition: no velocities in them.
std::vector<Monomial> independent_functions(const MotionRows& rows, const Generators& generators,
                                            const std::vector<Monomial>& candidates, std::uint64_t seed);

}  // namespace maupertuis::invariants

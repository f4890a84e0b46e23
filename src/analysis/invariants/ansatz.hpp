#pragma once
#include "analysis/invariants/atoms.hpp"
#include "analysis/invariants/world.hpp"

#include <cstdint>
#include <vector>

namespace maupertuis::invariants {

/// Everything that the bases of a system are built from.
struct Ansatz {
  Generators generators;
  Atoms atoms;
  World world;
  Expr energy;                 // h_E
  ExprVector momenta;          // p
  ExprVector velocities;       // q̇_i; of a single rigid body its rates ω
  ExprVector directions;       // of a single rigid body: the vertical in body axes; else empty
  bool constant_mass = false;  // M holds no coordinates: affine displacements suffice
  bool explicit_time = false;  // t in L, Q, D or a constraint
  bool reversible = false;     // the motion run backwards is a motion: odd and even integrals apart
};
Ansatz make_ansatz(const EquationsOfMotion& equations, const MotionRows& rows);

/// I = −ξ h_E + η·p − f, the charges of point symmetries up to gauge: ξ(t), η(q,t), f(q,t) combinations of monomials
/// and atoms; ξ(q,t) where L is no quadratic polynomial of the velocities. The richest of some such bases that has at
/// most `largest` functions, down to constant η alone; empty where none has.
Basis noether_basis(Ansatz& ansatz, const MotionRows& rows, std::size_t largest, std::uint64_t seed);

/// Polynomials of the velocities up to a degree with functions of position as coefficients. The richest that has at
/// most `largest` functions; where none has, no monomials, and the size of the poorest in `needed`.
struct PolynomialBases {
  std::vector<Basis> bases;  // one, or the even and the odd part
  std::size_t needed = 0;    // functions of the poorest; where they are many, with those that depend on others
};
PolynomialBases polynomial_bases(Ansatz& ansatz, const MotionRows& rows, int degree, std::size_t largest,
                                 std::uint64_t seed);

}  // namespace maupertuis::invariants

#pragma once
#include <maupertuis/linearization.hpp>

#include <complex>
#include <optional>
#include <vector>

/// The linear-quadratic regulator of a linearization: docs/theory/linearization.md.
namespace maupertuis {

/// u = u₀ − F x minimizes ∫ (xᵀQ x + wᵀR w) dt along ẋ = A x + B w, with w = u − u₀.
struct Regulator {
  RealMatrix gain;      // F = R⁻¹BᵀP [k × s], in SI
  RealMatrix cost;      // P [s × s]: xᵀP x is the least cost from x
  double residual = 0;  // |AᵀP + P A − P B R⁻¹ BᵀP + Q|, relative to the sum of the norms of its terms
  std::vector<std::complex<double>>
      poles;  // [s] eigenvalues of A − B F, ascending by real part; all have negative real parts
};

/// Whether this build has LAPACK, which the regulator needs.
bool has_lapack();

/// P from the stable invariant subspace of the Hamiltonian matrix [A  −B R⁻¹Bᵀ; −Q  −Aᵀ], by LAPACK's ordered real
/// Schur form (dgees with a selection). Nothing, and a diagnostic: E1310 no inputs, E1311 Q or R of wrong size or not
/// definite, E1312 a mode that grows or stays and that the inputs do not reach, E1313 one that stays and that Q does
/// not see, E1314 the equation is not solved to the digits that are promised, E1315 no LAPACK, E1316 inputs that act by
/// their rates. Shapes: Q [s × s] symmetric, not negative; R [k × k] symmetric, positive; s = f + g states. Reference:
/// Laub, A Schur method for solving algebraic Riccati equations, IEEE Trans. Automat. Control 24 (1979).
std::optional<Regulator> linear_quadratic_regulator(const Linearization& linearization, const RealMatrix& q,
                                                    const RealMatrix& r, Diagnostics& diagnostics);

}  // namespace maupertuis

#pragma once
#include "linear_algebra/cone_problem.hpp"

#include <optional>

namespace maupertuis {

struct ConeForces {
  Eigen::VectorXd forces, accelerations;  // λ; free + W λ
  double residual = 0;                    // how far from the cone's conditions, of the largest force
};

/// λ_n ≥ 0 ⟂ a_n ≥ 0, |λ_t| ≤ μ λ_n, and where a_t ≠ 0 λ_t = −μ λ_n a_t/|a_t|: with De Saxcé's term the complementarity
/// of λ and (a_n + μ |a_t|, a_t) over second-order cones (V. Acary and B. Brogliato, Numerical Methods for Nonsmooth
/// Dynamical Systems, 2008, ch. 13). By Gauss-Seidel over the contacts, then by a semismooth Newton method on the
/// projections (P. Alart and A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353). Nothing where it does not
/// converge to 1e-10. Cost: some ten solutions of a linear system of the size of W.
std::optional<ConeForces> cone_forces(const ConeProblem& problem);

}  // namespace maupertuis

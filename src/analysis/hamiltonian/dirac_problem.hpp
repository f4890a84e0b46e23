#pragma once
#include "analysis/hamiltonian/legendre.hpp"

#include <maupertuis/constraint_algorithm.hpp>
#include <maupertuis/constraint_manifold.hpp>

namespace maupertuis::phase_space {

/// What Dirac's algorithm works with: brackets, H, and what the total Hamiltonian H + u φ − λ φ_k adds to it. Lets and
/// inputs are put in.
struct PhaseSpaceAlgebra {
  /// Brackets alone.
  explicit PhaseSpaceAlgebra(const Hamiltonian& h) : momenta(h.momenta), order(h.order) {
    for (const Coordinate& c : h.system->coordinates) positions.push_back(c.q);
    states = positions;
    states.insert(states.end(), momenta.begin(), momenta.end());
  }
  /// `energy` is empty where H is not known, or something has no place in it.
  PhaseSpaceAlgebra(const Hamiltonian& h, const EquationsOfMotion& equations);

  ExprVector positions, momenta, states;  // q [n], p [n], (q, p) [2n]
  ReadingOrder order;
  Expr energy;          // H
  ExprVector primary;   // φ(q, p, t)
  ExprVector of_model;  // holonomic constraints φ_k(q, t)

  Expr bracket(Expr a, Expr b) const;
  LinearCondition rate(Expr constraint) const;
  /// Both states with velocities.
  ConstraintProblem problem(const Bindings& center, const Bindings& start, const ExprVector& momentum_values) const;
};

}  // namespace maupertuis::phase_space

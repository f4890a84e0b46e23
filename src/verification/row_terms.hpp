#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <vector>

namespace maupertuis {

/// Whether the search for the form of a formula that reads best ends in a moment.
bool is_short_enough(Expr e);

/// What a term of a derived equation comes from.
enum class TermOrigin {
  Inertia,                 // M_ii q̈_i
  Coupling,                // M_ij q̈_j
  Velocity,                // of T or L, with velocities in it: Coriolis, centrifugal, gyroscopic
  PrescribedMotion,        // −∂T0/∂q_i, of the part of T without velocities: what q is measured from moves
  PrescribedAcceleration,  // ∂²L1/∂t∂q̇_i, of the part of L linear in q̇: what q is measured from accelerates
  Potential,               // ∂V/∂q_i
  Dissipation,             // ∂D/∂q̇_i
  Force,                   // −Q_i
  Constraint,              // −(Aᵀλ)_i
};

/// One term of the left side of R_i − (Aᵀλ)_i = 0, with q̈ left in.
struct RowTerm {
  TermOrigin origin = TermOrigin::Inertia;
  Expr value;          // no sum
  std::size_t of = 0;  // Coupling: the coordinate; Constraint: which
};

/// The terms of the equation of a coordinate, as a reader would write them, products distributed. `mass` is M.
/// Empty where a part of it is too long to be read.
std::vector<RowTerm> row_terms(const EquationsOfMotion& equations, const ExprMatrix& mass, std::size_t row);

}  // namespace maupertuis

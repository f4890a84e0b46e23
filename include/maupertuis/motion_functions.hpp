#pragma once
#include <maupertuis/function_kernel.hpp>

#include <cstddef>

/// A motion as functions at points: what the variational and the stiff method are given instead of expressions.
namespace maupertuis {

/// Inputs of every kernel here: q [n], v [n], a [n], λ [m], t, in this order.
///
///     balance(q,v,a,λ,t) = M a + h − Aᵀλ = 0,     accelerations(q,v,a,t) = A a − b = 0
///     rates(q,v,t) = dφ/dt or ψ = 0,              positions(q,t) = φ = 0
struct MotionFunctions {
  std::size_t freedoms = 0, constraints = 0;       // n, m
  bool holonomic = true;                           // no constraint between velocities
  DifferentiableKernel balance;                    // [n]
  DifferentiableKernel accelerations;              // [m]
  DifferentiableKernel balance_by_unknowns;        // the same with derivatives by a and λ alone: M and −Aᵀ
  DifferentiableKernel accelerations_by_unknowns;  // … A
  DifferentiableKernel rates;                      // [m]
  DifferentiableKernel positions;                  // [m]; 0 for a constraint between velocities
  FunctionKernel constraint_scales;  // [2m] Σ |terms| of φ, then of the rates: what their rounding is measured against
  FunctionKernel observables, events, integrands;

  std::size_t inputs() const { return 3 * freedoms + constraints + 1; }
  std::size_t v_at(std::size_t i) const { return freedoms + i; }
  std::size_t a_at(std::size_t i) const { return 2 * freedoms + i; }
  std::size_t lambda_at(std::size_t k) const { return 3 * freedoms + k; }
  std::size_t t_at() const { return 3 * freedoms + constraints; }
};

/// What Hamilton's principle needs besides: p = ∂L/∂v and ṗ = ∂L/∂q + F + Aᵀλ with F = Q − ∂D/∂v.
struct VariationalFunctions {
  MotionFunctions motion;
  DifferentiableKernel momenta;  // [n]
  DifferentiableKernel forces;   // [n]
};

}  // namespace maupertuis

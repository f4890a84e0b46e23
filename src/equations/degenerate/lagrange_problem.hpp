#pragma once
#include <maupertuis/constraint_algorithm.hpp>
#include <maupertuis/equations_of_motion.hpp>

namespace maupertuis {

/// The constraint algorithm's problem on Lagrange's side, without its `center`: states (q, q̇), unknowns (q̈, λ); rows
/// R − Aᵀλ, A q̈ − b, and dχ/dt of the gauges.
ConstraintProblem lagrange_problem(const EquationsOfMotion& equations, bool with_gauges);

}  // namespace maupertuis

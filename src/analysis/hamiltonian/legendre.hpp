#pragma once
#include <maupertuis/hamiltonian.hpp>

namespace maupertuis::phase_space {

/// What a Legendre transform is made from.
struct LegendreProblem {
  const MechanicalSystem& system;
  const ReadingOrder& order;
  Expr lagrangian;                    // in q, q', t and inputs
  std::vector<std::size_t> replaced;  // coordinates whose velocities become momenta
  const ExprVector& momenta;          // p [n], symbols
};

/// The transform of some or all velocities: −L + Σ p q̇ in p. Groups of coordinates are transformed one by one.
LegendreTransform legendre_transform(const LegendreProblem& problem);

/// A group whose part of L is quadratic in q̇. `mass` and `shift` are filled; the rest is found here.
void transform_quadratic(LegendreBlock& block, const LegendreProblem& problem);

/// L = c √w + b·q̇ + the rest with w = a₀ + ½ q̇ᵀG q̇, as of the relativistic particle. With π = p − b, Π = πᵀG⁻¹π:
///
///     w = a₀ / (1 − 2Π/c²),   q̇ = (2/c) √w G⁻¹π,   H = −c √a₀ √(1 − 2Π/c²)
///
/// Where a₀ = 0 the equations do not depend on how the path is run through: 2Π = c² is a primary constraint, H = 0.
struct RootLagrangian {
  Expr root, coefficient;  // √w as it stands in L, and c
  Expr at_rest;            // a₀
  ExprMatrix metric;       // G
  ExprVector shift;        // b
};
std::optional<RootLagrangian> root_lagrangian(const LegendreProblem& problem,
                                              const std::vector<std::size_t>& coordinates);
void transform_root(LegendreBlock& block, const RootLagrangian& root, const LegendreProblem& problem);

/// Whether e vanishes identically: proved, or not found to be anything else.
bool may_vanish(Expr e);
/// p_i − b_i of a group.
ExprVector reduced_momenta(const LegendreBlock& block, const LegendreProblem& problem);
/// {a, b} = Σ ∂a/∂q ∂b/∂p − ∂a/∂p ∂b/∂q of functions of q, p and t; a shared DAG.
Expr bracket_of(Expr a, Expr b, const ExprVector& positions, const ExprVector& momenta);
/// A bracket as it is shown: 0 where it vanishes identically.
ReadableForm shown_bracket(Expr bracket, const ReadingOrder& order);
/// [N | c]
ExprMatrix augmented(const ExprMatrix& matrix, const ExprVector& column);

}  // namespace maupertuis::phase_space

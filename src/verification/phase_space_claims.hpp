#pragma once
#include <maupertuis/hamiltonian.hpp>
#include <maupertuis/verification.hpp>

namespace maupertuis {

/// expect hamiltonian = H, expect routhian of φ = R, expect bracket (A, B) = C: identities in q, p, t and, for the
/// Routhian, the velocities that stay.
void decide_phase_space(const expectation::Hamiltonian& e, const EquationsOfMotion& equations,
                        ExpectationResult& result);
void decide_phase_space(const expectation::Routhian& e, const EquationsOfMotion& equations, ExpectationResult& result);
void decide_phase_space(const expectation::Bracket& e, const EquationsOfMotion& equations, ExpectationResult& result);

/// e with ∂L/∂q̇ in place of the momenta.
Expr with_momenta(Expr e, const EquationsOfMotion& equations);

}  // namespace maupertuis

#pragma once
#include <maupertuis/hamiltonian.hpp>

namespace maupertuis::phase_space {

/// The canonical equations z' = f(z, t) with z = (q, p), as a kernel of second order: its coordinates are the integrals
/// of z over time, on which nothing depends, its velocities z, and its residual Z'' − f(Z', t). M is the identity.
/// Observables: H. `constraints`: indices of those in force. Precondition: regular().
Kernel canonical_kernel(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations,
                        const std::vector<std::size_t>& constraints);

}  // namespace maupertuis::phase_space

#pragma once
#include "analysis/invariants/ansatz.hpp"

#include <maupertuis/invariants.hpp>

namespace maupertuis::invariants {

/// d(I)/dt for the charges of L alone that forces, dissipation or constraints change: (Q − ∂D/∂q̇ + Aᵀλ)·δq, with λ as
/// symbols. Nothing where neither act, or where L has no symmetries.
void add_balance_laws(Invariants& result, Ansatz& ansatz, const EquationsOfMotion& equations,
                      const InvariantsOptions& options);

}  // namespace maupertuis::invariants

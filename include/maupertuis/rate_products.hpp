#pragma once
#include <maupertuis/expression.hpp>

#include <span>

namespace maupertuis {

/// A Lagrangian in which products of two velocities with a sine or cosine of their angles are products of rates:
///
///     θ' φ' cos(θ − φ) = d/dt sin θ · d/dt sin φ + d/dt cos θ · d/dt cos φ,    x' θ' cos θ = x' · d/dt sin θ
///
/// the form that it has where points are given, r̈ · ∂r/∂q; Lagrange's equations of it need fewer products, those of the
/// double pendulum 8 instead of 10. The same function of q, q̇ and t: terms whose expansions do not agree, that would
/// have more than some dozens of terms or have rates already are left as they are. `coordinates`: symbols of order 0.
/// Cost: O(nodes), and that of the expansions of terms that hold a sine or cosine and two velocities.
Expr with_rate_products(Expr lagrangian, std::span<const Expr> coordinates);

}  // namespace maupertuis

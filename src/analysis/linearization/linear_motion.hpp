#pragma once
#include "analysis/linearization/point_equations.hpp"

#include <maupertuis/modes.hpp>

namespace maupertuis {

/// Whether the equations of motion are linear while inputs are held: the derivatives of R and of the constraints by
/// q, q̇, q̈ and λ are constants; proved. Precondition: t does not stand in them.
bool is_linear(const PointEquations::Impl& equations);

/// Whether all motions of a linear system stay bounded for certain, but for its zero eigenvalues, which are not looked
/// at. With M ξ̈ + G ξ̇ + K ξ = 0, M and K symmetric, G skew, λ and −λ̄ are eigenvalues together. One that lies on the
/// imaginary axis within its error, no other within that, is its own mirror image: on the axis, and simple. Where
/// several are one within errors, λ = iω, they are on the axis and without Jordan chains if the form
///
///     φᴴ (2ω M − i G) φ,       the sign of the energy of these modes,
///
/// is definite on their shapes (Krein; Gelfand and Lidskii). That K is symmetric and C skew is proved without
/// constraints, or follows from forces with a potential. Precondition: is_linear.
bool oscillates_for_certain(const PointEquations::Impl& equations, const Linearization& linearization,
                            const std::vector<Mode>& modes);

}  // namespace maupertuis

#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <span>

namespace maupertuis {

/// Whether ∂/∂t of all of them and of what switches them vanishes identically, parameters that are 0 taken as such:
/// cos²(Ω t) + sin²(Ω t) is free of t, and so is F sin(Ω t) where F = 0. Precondition: no TimeDerivative nodes.
bool free_of_time(std::span<const Expr> expressions, const MechanicalSystem& system);

}  // namespace maupertuis

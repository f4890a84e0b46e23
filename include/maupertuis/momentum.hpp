#pragma once
#include <maupertuis/mechanical_system.hpp>

#include <string>

namespace maupertuis {

/// The name of the momentum conjugate to a coordinate: p_θ; P_θ or momentum_θ where the model has that name already.
std::string momentum_name(const MechanicalSystem& system, std::size_t coordinate);
/// p as a symbol, the rate of its integral (integral_symbol.hpp): it stands where a velocity stood.
Expr momentum_symbol(const MechanicalSystem& system, std::size_t coordinate);
/// p' as a symbol, the left side of a canonical equation.
Expr momentum_rate_symbol(const MechanicalSystem& system, std::size_t coordinate);

}  // namespace maupertuis

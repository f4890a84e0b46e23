#pragma once
#include <maupertuis/equations_of_motion.hpp>

namespace maupertuis {

/// R − Aᵀλ [n] as EquationsOfMotion::balance(), in the form that needs the fewest products along a motion: of a
/// Lagrangian that is given whole, by rates of sines and cosines (rate_products.hpp).
ExprVector motion_balance(const EquationsOfMotion& equations);

}  // namespace maupertuis

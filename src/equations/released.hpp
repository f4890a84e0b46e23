#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>

namespace maupertuis {

/// The generalized force of constraint that holds a parameter p at its value: the work of inertia less that of all
/// other forces in the displacement ∂r/∂p. Empty where the model does not say how its energies depend on ṗ; then
/// `reason`.
struct HoldingForce {
  Expr value;
  std::string reason;
};
HoldingForce holding_force(const EquationsOfMotion& equations, const Parameter& parameter);

}  // namespace maupertuis

#pragma once
#include "simulation/function_kernels.hpp"

#include <maupertuis/kernel.hpp>

namespace maupertuis {

/// The kernel of the motion of a system: its parameters in the order of the system, and what is wanted along the motion.
Kernel motion_kernel(const EquationsOfMotion& equations, const WantedFunctions& wanted);

}  // namespace maupertuis

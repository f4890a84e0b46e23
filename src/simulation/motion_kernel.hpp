#pragma once
#include "simulation/function_kernels.hpp"

#include <maupertuis/kernel.hpp>

namespace maupertuis {

/// What the kernel of the motion is built from, with what is wanted along it.
KernelSource motion_source(const EquationsOfMotion& equations, const WantedFunctions& wanted);

/// The kernel of the motion of a system: its parameters in the order of the system, and what is wanted along the
/// motion.
Kernel motion_kernel(const EquationsOfMotion& equations, const WantedFunctions& wanted);

}  // namespace maupertuis

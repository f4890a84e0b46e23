#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/kernel.hpp>

#include <vector>

namespace maupertuis {

/// A system as numbers, for TaylorStepper and advance_ensemble.
struct MotionKernel {
  Kernel kernel;                   // coordinates and parameters in the order of the system; constraints with it
  std::vector<double> parameters;  // [p] the values of the model, SI
  std::size_t energy_terms = 0;    // the first observables: the terms of h_E, J; it is conserved where no power is exchanged
};

/// Cost: that of build_kernel.
MotionKernel motion_kernel(const EquationsOfMotion& equations);

}  // namespace maupertuis

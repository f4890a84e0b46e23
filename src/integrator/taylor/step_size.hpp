#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>

namespace maupertuis::taylor {

struct StepControl {
  int order = 20;       // of the polynomial of q̇
  double factor = 0.13; // of the estimated radius of convergence
};

/// Order and safety factor that a tolerance asks for; an order of 0 follows from the tolerance.
StepControl step_control(double tolerance, int order);

/// How far the polynomial in the workspace may be followed, > 0; infinite for a motion that is a polynomial itself.
/// `previous`: an earlier step length, or 0 if there is none.
double step_size(const KernelWorkspace& work, std::size_t freedoms, const StepControl& control, double previous);

}  // namespace maupertuis::taylor

#pragma once
#include <maupertuis/kernel.hpp>

#include <cstddef>
#include <vector>

namespace maupertuis::taylor {

struct StepControl {
  int order = 20;         // of the polynomial of q̇
  double factor = 0.13;   // of the estimated radius of convergence
  bool is_exact = false;  // nothing of a motion is left out, however long its step is
};

/// Order and safety factor that a tolerance asks for; an order of 0 follows from the tolerance.
StepControl step_control(double tolerance, int order);

/// How far the polynomial in the workspace may be followed, > 0; infinite for a motion that is a polynomial itself.
/// `previous`: an earlier step length, or 0 if there is none.
double step_size(const KernelWorkspace& work, std::size_t freedoms, const StepControl& control, double previous);

/// At most h (finite), and so short that the series of the multipliers converge. Next to a singular configuration λ may
/// have a pole where q has none; beyond it the coefficients of q are nothing but what is left of those of λ by
/// cancellation.
double step_within_multipliers(const KernelWorkspace& work, std::size_t freedoms, std::size_t constraints,
                               const StepControl& control, double h);

/// At most h (finite), and so short that the series of the integrals along the motion converge: a power made of sines
/// may have a series that ends far from where that of a parabola does. `sizes`: [integrals] the largest that their
/// integrands have been so far, which grow here; what is rounding of them asks for nothing.
double step_within_integrals(const KernelWorkspace& work, std::vector<double>& sizes, const StepControl& control,
                             double h);

}  // namespace maupertuis::taylor

#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/kernel.hpp>

#include <span>
#include <vector>

namespace maupertuis {

/// What the kernel of a motion without contacts and friction is lowered from: coordinates, parameters, R − Aᵀλ,
/// multipliers and constraints in the order of the system, with lets and inputs put in; without observables, events and
/// integrands.
KernelSource motion_source(const EquationsOfMotion& equations);

/// The values of all parameters in the order of system.parameters, SI.
std::vector<double> parameter_values(const MechanicalSystem& system);

/// A system as numbers, for TaylorStepper and advance_ensemble.
struct MotionKernel {
  Kernel kernel;                   // coordinates and parameters in the order of the system; constraints with it
  std::vector<double> parameters;  // [p] the values of the model, SI
  std::size_t energy_terms = 0;    // the first observables: the terms of h_E, J; conserved where no power is exchanged
};

/// `events`: functions of q, q', t whose roots end steps. Cost: that of build_kernel. Of a degenerate Lagrangian that
/// determines a motion: of `equations.determined`, whose constraints the starts have to keep.
/// Throws std::invalid_argument where the model has contacts or friction, which no kernel knows:
/// advance_ensemble(model, …) of ensemble_through_modes.hpp, MotionThroughModes and `simulate` do. Events of the model
/// are not in it either.
MotionKernel motion_kernel(const EquationsOfMotion& equations, std::span<const Expr> events = {});
/// The same while all contacts are open and nothing rubs.
MotionKernel free_motion_kernel(const EquationsOfMotion& equations, std::span<const Expr> events = {});

}  // namespace maupertuis

#pragma once
#include "simulation/function_kernels.hpp"
#include "simulation/method.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/stiff.hpp>
#include <maupertuis/variational.hpp>

#include <memory>

/// The methods of runs without contacts, friction and events, from the equations of a system.
namespace maupertuis {

/// The options with a method: where none is asked for that of the model's `method`, or Automatic. Its step and order go
/// with it wherever they are not asked for either and the method is the same.
SimulationOptions with_method_of(const Model& model, SimulationOptions options);

/// Those of Taylor's steps among the options of a run, or of many.
template <class Options>
TaylorOptions taylor_options(const Options& options) {
  TaylorOptions out;
  out.tolerance = options.tolerance;
  out.order = options.order;
  out.maximum_steps = options.maximum_steps;
  out.interrupt = options.interrupt;
  out.backend = options.backend;
  out.cache = options.cache;
  return out;
}

/// Nothing, with a diagnostic, for constraints between velocities (E0720), without a positive step (E0721), and for an
/// order that there is none of (E0722).
std::unique_ptr<Method> variational_method(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                           const VariationalOptions& options, Diagnostics& diagnostics);

/// Nothing, with a diagnostic, for a tolerance that is no number between 0 and 1 (E0724).
std::unique_ptr<Method> stiff_method(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                     const StiffOptions& options, Diagnostics& diagnostics);

/// The same to go on with from a state where steps have been of a length. Nothing, without a diagnostic, unless what
/// keeps them short dies out.
std::unique_ptr<Method> stiff_method_from(const Sample& state, double length, const EquationsOfMotion& equations,
                                          const WantedFunctions& wanted, const StiffOptions& options,
                                          Diagnostics& diagnostics);
double stiff_tolerance(const SimulationOptions& options);
StiffOptions stiff_options(const SimulationOptions& options);

/// The method that the options name, Taylor's where it is Automatic. Nothing, with a diagnostic, as above, and for a
/// length of variational steps of which a run of this duration has far too many (E0721).
std::unique_ptr<Method> method_of_run(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                      const SimulationOptions& options, double duration, Diagnostics& diagnostics);

}  // namespace maupertuis

#include "simulation/methods.hpp"

#include "simulation/motion_kernel.hpp"

#include <fmt/format.h>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/rounded_value.hpp>

#include <cmath>

namespace maupertuis {
namespace {

const Constraint* between_velocities(const MechanicalSystem& system) {
  for (const Constraint& c : system.constraints)
    if (c.level == Constraint::Level::Velocity) return &c;
  return nullptr;
}

}  // namespace

SimulationOptions with_method_of(const Model& model, SimulationOptions options) {
  const MethodChoice choice = model.experiment.method.value_or(MethodChoice{});
  if (options.method.value_or(choice.method) == choice.method) {
    if (options.order == 0) options.order = choice.order;
    if (options.step == 0 && choice.step)
      options.step =
          rounded_value(in_terms_of_motion(model.system, {&choice.step, 1}).front(), parameter_bindings(model.system));
  }
  options.method = options.method.value_or(choice.method);
  return options;
}

std::unique_ptr<Method> variational_method(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                           const VariationalOptions& options, Diagnostics& diagnostics) {
  const bool has_step = options.step > 0 && std::isfinite(options.step);
  if (equations.degenerate) {
    diagnostics.error("E0731", std::nullopt, "the variational method does not take a degenerate Lagrangian",
                      "Its steps follow from the momenta at their ends, which must determine the velocities.",
                      "Use the default method; it keeps what the Lagrangian asks of the state to rounding.");
    return nullptr;
  }
  if (const Constraint* velocities = between_velocities(*equations.system)) {
    diagnostics.error(
        "E0720", velocities->span, "the variational method does not take this constraint between velocities",
        "Such a constraint follows the principle of d'Alembert and Lagrange, which is no variational principle: "
        "there is no symplectic form that a step could preserve.",
        "Use the default method; it keeps the constraint to rounding.");
  }
  if (!has_step) {
    diagnostics.error(
        "E0721", std::nullopt, "the variational method needs the length of its step",
        "Its conservation laws hold because all steps are alike; a step that a tolerance changes would lose them.",
        "Give a positive time, some twentieth of the shortest period: --step 10ms.");
  }
  if (options.order < 2 || options.order > 12 || options.order % 2 != 0) {
    diagnostics.error(
        "E0722", std::nullopt, fmt::format("there is no variational step of order {}", options.order),
        "The orders of steps on Gauss and Lobatto nodes are even; beyond 12 rounding is all that is left.",
        "Choose 2, 4, 6, 8, 10 or 12.");
  }
  if (diagnostics.has_errors()) return nullptr;
  return method_of(
      VariationalStepper(variational_functions(equations, wanted), parameter_values(*equations.system), options));
}

namespace {

bool is_tolerance(double tolerance, Diagnostics& diagnostics) {
  if (tolerance > 0 && tolerance < 1) return true;
  diagnostics.error(
      "E0724", std::nullopt, fmt::format("{:g} is no relative tolerance", tolerance),
      "The error of a step is compared with the size of each coordinate and velocity times the tolerance.",
      "Choose a number between 0 and 1, such as 1e-10.");
  return false;
}

/// Coordinates of one unit share a number; angles count as none of the numbers.
std::vector<std::size_t> kinds_of(const MechanicalSystem& system) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
    const Coordinate& c = system.coordinates[i];
    std::size_t like = 0;
    while (like < i && !(system.coordinates[like].dimension == c.dimension &&
                         (system.coordinates[like].kind == "angle") == (c.kind == "angle")))
      ++like;
    out.push_back(like);
  }
  return out;
}

StiffStepper stiff_stepper(const EquationsOfMotion& equations, const WantedFunctions& wanted, StiffOptions options) {
  options.kinds = kinds_of(*equations.system);
  return {motion_functions(equations, wanted), parameter_values(*equations.system), options};
}

}  // namespace

std::unique_ptr<Method> stiff_method(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                     const StiffOptions& options, Diagnostics& diagnostics) {
  if (!is_tolerance(options.tolerance, diagnostics)) return nullptr;
  return method_of(stiff_stepper(equations, wanted, options));
}

std::unique_ptr<Method> stiff_method_from(const Sample& state, double length, const EquationsOfMotion& equations,
                                          const WantedFunctions& wanted, const StiffOptions& options,
                                          Diagnostics& diagnostics) {
  if (!is_tolerance(options.tolerance, diagnostics)) return nullptr;
  StiffStepper stepper = stiff_stepper(equations, wanted, options);
  if (!stepper.fast_parts_die_out(state.t, state.q, state.v, length)) return nullptr;
  return method_of(std::move(stepper));
}

namespace {

std::unique_ptr<Method> taylor_method(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                      const SimulationOptions& options) {
  // Code of few coordinates finds the energy with all else; of many, at each step, it would be a fifth of a run.
  constexpr std::size_t few = 8, observed_steps = 4;
  const Kernel kernel = motion_kernel(equations, wanted);
  TaylorOptions of_steps = taylor_options(options);
  if (kernel.freedoms() > few && kernel.switches().empty()) of_steps.observed_steps = observed_steps;
  return method_of(TaylorStepper(kernel, parameter_values(*equations.system), of_steps));
}

/// Steps of one length: whether a run has so many. Those that are too many by a little are made, up to its last.
bool has_as_many_steps(const VariationalOptions& options, double duration, Diagnostics& diagnostics) {
  constexpr double hopeless = 100;
  const double length = std::abs(duration), most = static_cast<double>(options.maximum_steps);
  if (!(options.step > 0) || !(length / options.step > hopeless * most)) return true;
  diagnostics.error("E0721", std::nullopt, fmt::format("steps of {:g} s are too short for this run", options.step),
                    fmt::format("Some 10^{:.0f} of them lie within its {:g} s, and a run has {:.0g}.",
                                std::log10(length) - std::log10(options.step), length, most),
                    "Give a longer one, some twentieth of the shortest period.");
  return false;
}

}  // namespace

double stiff_tolerance(const SimulationOptions& options) {
  return options.tolerance != 0 ? options.tolerance : StiffOptions{}.tolerance;
}

StiffOptions stiff_options(const SimulationOptions& options) {
  StiffOptions out;
  out.tolerance = stiff_tolerance(options);
  out.maximum_steps = options.maximum_steps;
  out.interrupt = options.interrupt;
  return out;
}

std::unique_ptr<Method> method_of_run(const EquationsOfMotion& equations, const WantedFunctions& wanted,
                                      const SimulationOptions& options, double duration, Diagnostics& diagnostics) {
  if (options.method == StepMethod::Stiff) return stiff_method(equations, wanted, stiff_options(options), diagnostics);
  if (options.method != StepMethod::Variational) return taylor_method(equations, wanted, options);
  VariationalOptions out;
  out.step = options.step;
  if (options.order != 0) out.order = options.order;
  out.maximum_steps = options.maximum_steps;
  out.interrupt = options.interrupt;
  if (!has_as_many_steps(out, duration, diagnostics)) return nullptr;
  return variational_method(equations, wanted, out, diagnostics);
}

}  // namespace maupertuis

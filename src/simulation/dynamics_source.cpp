#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include "simulation/function_kernels.hpp"
#include "simulation/motion_balance.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

bool holds_inputs(Expr root) {
  const auto order = topological_order({&root, 1});
  return std::any_of(order.begin(), order.end(),
                     [](const Expr& e) { return e.is_symbol() && e.role() == Role::Input; });
}

/// Definitions as expressions; inputs stay symbols.
std::vector<Expr> without_definitions(const MechanicalSystem& system, std::span<const Expr> expressions) {
  ExprMap replacements;
  for (const Definition& d : system.definitions)
    if (d.symbol) replacements.emplace(d.symbol, d.value);
  return substitute(expressions, replacements);
}

}  // namespace

DynamicsSource dynamics_source(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  DynamicsSource out;
  KernelSource& kernel = out.kernel;
  for (const Coordinate& c : system.coordinates) kernel.coordinates.push_back(c.q);
  for (const Parameter& p : system.parameters) kernel.parameters.push_back(p.symbol);
  out.parameters = parameter_values(system);
  // A parameter does not change with time, so that d/dt must be carried out where it meets an input.
  const bool moves = holds_inputs(equations.lagrangian);
  for (const Input& input : system.inputs) {
    Expr symbol = input.symbol;
    for (int order = 0; order <= (moves ? 2 : 0); ++order, symbol = system.context->time_derivative(symbol)) {
      out.inputs.push_back(kernel.parameters.size());
      kernel.parameters.push_back(symbol);
      out.parameters.push_back(0);
    }
  }
  const ExprVector balance = motion_balance(equations);
  kernel.residual = without_definitions(system, moves ? expand_time_derivatives(balance) : balance);
  kernel.multipliers = equations.multipliers;
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    const Constraint& c = system.constraints[i];
    const Expr value = without_definitions(system, {&c.value, 1}).front();
    kernel.constraints.push_back({value, c.level == Constraint::Level::Position ? 0 : 1, system.constraint_label(i)});
  }
  return out;
}

}  // namespace maupertuis

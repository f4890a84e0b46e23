#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
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

/// How many rates of an input the forces take: two at least where L depends on it, since d/dt meets it there, and more
/// where L depends on its rates, as with a point that moves with one.
int rates_of(const Input& input, const ExprVector& inside_lagrangian, const ExprVector& inside_residual) {
  const auto highest = [&](const ExprVector& symbols) {
    int order = -1;
    for (const Expr& s : symbols)
      if (s.role() == Role::Input && s.name() == input.symbol.name()) order = std::max(order, s.order());
    return order;
  };
  return std::max(highest(inside_lagrangian) >= 0 ? 2 : 0, highest(inside_residual));
}

}  // namespace

DynamicsSource dynamics_source(const EquationsOfMotion& given) {
  check_one_mode(*given.system, "dynamics_source");
  const ExpressionLock lock(*given.system->context);
  const EquationsOfMotion& equations = solvable_equations(given);
  const MechanicalSystem& system = *equations.system;
  DynamicsSource out;
  KernelSource& kernel = out.kernel;
  for (const Coordinate& c : system.coordinates) kernel.coordinates.push_back(c.q);
  for (const Parameter& p : system.parameters) kernel.parameters.push_back(p.symbol);
  out.parameters = parameter_values(system);
  // A parameter does not change with time, so that d/dt must be carried out where it meets an input.
  const ExprVector lagrangian = without_definitions(system, {&equations.lagrangian, 1});
  const ExprVector balance = motion_balance(equations);
  kernel.residual =
      without_definitions(system, holds_inputs(lagrangian.front()) ? expand_time_derivatives(balance) : balance);
  const ExprVector of_lagrangian = symbols_of(lagrangian), of_residual = symbols_of(kernel.residual);
  for (const Input& input : system.inputs) {
    Expr symbol = input.symbol;
    for (int order = 0; order <= rates_of(input, of_lagrangian, of_residual);
         ++order, symbol = system.context->time_derivative(symbol)) {
      out.inputs.push_back(kernel.parameters.size());
      kernel.parameters.push_back(symbol);
      out.parameters.push_back(0);
    }
  }
  kernel.multipliers = equations.multipliers;
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    const Constraint& c = system.constraints[i];
    const Expr value = without_definitions(system, {&c.value, 1}).front();
    kernel.constraints.push_back({value, c.level == Constraint::Level::Position ? 0 : 1, system.constraint_label(i)});
  }
  return out;
}

}  // namespace maupertuis

#include "analysis/action/fields.hpp"

namespace maupertuis::action {
namespace {

Coordinate coordinate(Context& context, const std::string& name) {
  Coordinate out;
  out.name = name;
  out.q = context.symbol(name, Role::Coordinate, 0);
  out.velocity = context.symbol(name, Role::Coordinate, 1);
  out.acceleration = context.symbol(name, Role::Coordinate, 2);
  return out;
}

Constraint rate_constraint(Context& context, const std::string& name, Expr value) {
  Constraint out;
  out.level = Constraint::Level::Velocity;
  out.name = name;
  out.value = value;
  out.multiplier = context.symbol("lambda_of_" + name, Role::Multiplier);
  out.reaction = context.symbol("reaction_of_" + name, Role::Multiplier);
  return out;
}

}  // namespace

std::optional<EquationsOfMotion> weighted_equations(const EquationsOfMotion& equations, const Vector& multipliers) {
  if (multipliers.size() == 0) return equations;
  auto system = std::make_shared<MechanicalSystem>(*equations.system);
  system->written = nullptr;
  Context& context = *system->context;
  ExprVector weights;
  for (std::size_t i = 0; i < system->integral_constraints.size(); ++i) {
    system->coordinates.push_back(coordinate(context, "integral_weight_" + std::to_string(i + 1)));
    weights.push_back(system->coordinates.back().q);
  }
  Expr added = context.number(0);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const IntegralConstraint& c = system->integral_constraints[i];
    added = added + weights[i] * c.integrand;
    const std::string number = std::to_string(i + 1);
    const Coordinate so_far = coordinate(context, "integral_so_far_" + number);
    system->coordinates.push_back(so_far);
    system->constraints.push_back(
        rate_constraint(context, "integral_weight_" + number, context.time_derivative(weights[i])));
    system->constraints.push_back(rate_constraint(context, "integral_so_far_" + number, so_far.velocity - c.integrand));
  }
  EnergyTerm term{added, "integral constraints", {}};
  if (system->lagrangian_given)
    system->lagrangian_given->value = system->lagrangian_given->value + added;
  else
    system->lagrangian_extra.push_back(term);
  system->integral_constraints.clear();
  Diagnostics unheard;
  return euler_lagrange(std::move(system), unheard);
}

}  // namespace maupertuis::action

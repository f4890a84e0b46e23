#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/jacobian.hpp>

#include <array>

namespace maupertuis {
namespace {

ExprVector symbols_of_order(const MechanicalSystem& system, int order) {
  ExprVector symbols;
  for (const Coordinate& c : system.coordinates)
    symbols.push_back(order == 0 ? c.q : order == 1 ? c.velocity : c.acceleration);
  return symbols;
}

/// ∂e/∂t + Σ (∂e/∂u) u̇: the rate of change of e by time and inputs alone, at fixed q and q̇.
Expr explicit_rate(Expr e) {
  Context& context = e.context();
  ExprVector symbols{context.time()};
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Input) symbols.push_back(s);
  const auto derivatives = gradient(e, symbols);
  ExprVector terms{derivatives.front()};
  for (std::size_t i = 1; i < symbols.size(); ++i)
    terms.push_back(derivatives[i] * context.time_derivative(symbols[i]));
  return context.sum(terms);
}

Expr dot(const ExprVector& a, const ExprVector& b, Context& context) {
  ExprVector terms;
  for (std::size_t i = 0; i < a.size(); ++i) terms.push_back(a[i] * b[i]);
  return context.sum(terms);
}

/// λ, Aᵀλ and the derivatives of the constraints. Aᵀλ is the gradient of Σ λφ by q, or of Σ λψ by q̇ (d'Alembert and
/// Lagrange; Chetaev where ψ is not linear), so that it costs no more than the constraints.
void add_constraints(EquationsOfMotion& equations, const MechanicalSystem& system, const ExprVector& q,
                     const ExprVector& velocities) {
  if (!system.constrained()) return;
  Context& context = *system.context;
  ExprVector on_positions, on_velocities;
  for (const Constraint& c : system.constraints) {
    const bool position = c.level == Constraint::Level::Position;
    (position ? on_positions : on_velocities).push_back(c.multiplier * c.value);
    const Expr rate = position ? context.time_derivative(c.value) : c.value;
    equations.multipliers.push_back(c.multiplier);
    equations.constraint_rates.push_back(rate);
    equations.constraint_accelerations.push_back(context.time_derivative(rate));
  }
  const auto by_q = gradient(context.sum(on_positions), q),
             by_velocity = gradient(context.sum(on_velocities), velocities);
  for (std::size_t i = 0; i < q.size(); ++i) equations.constraint_forces.push_back(by_q[i] + by_velocity[i]);
}

/// λ·A q̇ on the constraints, where A q̇ = −∂φ/∂t, or q̇·∂ψ/∂q̇ − ψ: zero for constraints that do no work.
Expr constraint_power(const MechanicalSystem& system, const ExprVector& velocities) {
  Context& context = *system.context;
  const SparseGradient by_velocities(velocities);
  const auto work = [&](Expr value) {
    ExprVector terms;
    for (const auto& [i, entry] : by_velocities(value)) terms.push_back(velocities[i] * entry);
    return context.sum(terms);
  };
  ExprVector terms;
  for (const Constraint& c : system.constraints) {
    if (c.level == Constraint::Level::Position)
      terms.push_back(-(c.multiplier * explicit_rate(c.value)));
    else
      terms.push_back(c.multiplier * (work(c.value) - c.value));
  }
  return context.sum(terms);
}

}  // namespace

ExprVector EquationsOfMotion::balance() const {
  if (constraint_forces.empty()) return residual;
  ExprVector out;
  for (std::size_t i = 0; i < residual.size(); ++i) out.push_back(residual[i] - constraint_forces[i]);
  return out;
}

std::optional<EquationsOfMotion> euler_lagrange(std::shared_ptr<const MechanicalSystem> system,
                                                Diagnostics& diagnostics) {
  Context& context = *system->context;
  const ExprVector q = symbols_of_order(*system, 0), velocities = symbols_of_order(*system, 1);

  EquationsOfMotion equations;
  equations.order = reading_order(*system);
  equations.lagrangian = system->lagrangian();
  equations.lagrangian_expanded = expand_time_derivatives(equations.lagrangian);
  equations.generalized_forces = expand_time_derivatives(system->generalized_forces());
  equations.dissipative_terms = gradient(expand_time_derivatives(system->dissipation_function()), velocities);

  equations.residual = variational_residual(equations.lagrangian, q);
  for (std::size_t i = 0; i < q.size(); ++i) {
    const std::array terms{equations.residual[i], equations.dissipative_terms[i], -equations.generalized_forces[i]};
    equations.residual[i] = context.sum(terms);
  }

  equations.momenta = gradient(equations.lagrangian_expanded, velocities);
  equations.energy_function = dot(velocities, equations.momenta, context) - equations.lagrangian_expanded;
  equations.power = dot(equations.generalized_forces, velocities, context) -
                    dot(equations.dissipative_terms, velocities, context) -
                    explicit_rate(equations.lagrangian_expanded) + constraint_power(*system, velocities);
  add_constraints(equations, *system, q, velocities);
  if (system->written)
    if (auto written = euler_lagrange(system->written, diagnostics))
      equations.written = std::make_shared<const EquationsOfMotion>(std::move(*written));
  equations.system = std::move(system);
  return equations;
}

ExprMatrix mass_matrix(const EquationsOfMotion& equations) {
  const ExprVector velocities = symbols_of_order(*equations.system, 1);
  const std::size_t n = velocities.size();
  ExprMatrix m{n, n, ExprVector(n * n, equations.system->context->number(0))};
  for (const auto& [row, column, value] : jacobian(equations.momenta, velocities)) m.entries[row * n + column] = value;
  return m;
}

ExprVector bias(const EquationsOfMotion& equations) {
  ExprMap at_rest;
  Context& context = *equations.system->context;
  for (const Coordinate& c : equations.system->coordinates) at_rest.emplace(c.acceleration, context.number(0));
  return substitute(expand_time_derivatives(equations.residual), at_rest);
}

ExprMatrix constraint_matrix(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const ExprVector q = symbols_of_order(system, 0), velocities = symbols_of_order(system, 1);
  const SparseGradient by_q(q), by_velocities(velocities);
  ExprMatrix a{system.constraints.size(), q.size(),
               ExprVector(system.constraints.size() * q.size(), system.context->number(0))};
  for (std::size_t k = 0; k < a.rows; ++k) {
    const Constraint& c = system.constraints[k];
    for (const auto& [column, value] : (c.level == Constraint::Level::Position ? by_q : by_velocities)(c.value))
      a.entries[k * a.columns + column] = value;
  }
  return a;
}

ExprVector constraint_bias(const EquationsOfMotion& equations) {
  ExprMap at_rest;
  Context& context = *equations.system->context;
  for (const Coordinate& c : equations.system->coordinates) at_rest.emplace(c.acceleration, context.number(0));
  ExprVector b = substitute(expand_time_derivatives(equations.constraint_accelerations), at_rest);
  for (Expr& entry : b) entry = -entry;
  return b;
}

}  // namespace maupertuis

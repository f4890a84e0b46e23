#include "simulation/function_kernels.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

/// Lowers functions of one system, all with the inputs that MotionFunctions tells.
class Lowering {
 public:
  explicit Lowering(const EquationsOfMotion& equations) : system_(*equations.system) {
    for (const Coordinate& c : system_.coordinates) {
      inputs_.push_back(c.q);
      velocities_.push_back(c.velocity);
    }
    inputs_.insert(inputs_.end(), velocities_.begin(), velocities_.end());
    for (const Coordinate& c : system_.coordinates) inputs_.push_back(c.acceleration);
    inputs_.insert(inputs_.end(), equations.multipliers.begin(), equations.multipliers.end());
    inputs_.push_back(system_.context->time());
    for (const Parameter& p : system_.parameters) parameters_.push_back(p.symbol);
  }

  FunctionKernel function(std::span<const Expr> expressions) const { return build_function(source(expressions)); }
  DifferentiableKernel differentiable(std::span<const Expr> expressions) const {
    return build_differentiable(source(expressions));
  }
  /// With derivatives by a and λ alone.
  DifferentiableKernel by_unknowns(std::span<const Expr> expressions) const {
    return build_differentiable(source(expressions), 2 * velocities_.size(), inputs_.size() - 1);
  }
  const ExprVector& velocities() const { return velocities_; }
  ExprVector positions() const {
    return {inputs_.begin(), inputs_.begin() + static_cast<std::ptrdiff_t>(velocities_.size())};
  }

 private:
  FunctionSource source(std::span<const Expr> expressions) const {
    return {inputs_, parameters_, expand_time_derivatives(in_terms_of_motion(system_, expressions))};
  }

  const MechanicalSystem& system_;
  ExprVector inputs_, velocities_, parameters_;
};

/// Σ |terms| of the sum itself
Expr size_of_outer_terms(Expr e) {
  ExprVector sizes;
  if (e.is(Kind::Sum))
    for (std::size_t i = 0; i < e.size(); ++i) sizes.push_back(apply(Kind::Abs, e[i]));
  else
    sizes.push_back(apply(Kind::Abs, e));
  return e.context().sum(sizes);
}

MotionFunctions lower_motion(const Lowering& lowering, const EquationsOfMotion& equations,
                             const WantedFunctions& wanted) {
  const MechanicalSystem& system = *equations.system;
  MotionFunctions out;
  out.freedoms = system.coordinates.size();
  out.constraints = system.constraints.size();
  ExprVector positions;
  for (const Constraint& c : system.constraints) {
    const bool position = c.level == Constraint::Level::Position;
    out.holonomic &= position;
    positions.push_back(position ? c.value : system.context->number(0));
  }
  out.balance = lowering.differentiable(equations.balance());
  out.accelerations = lowering.differentiable(equations.constraint_accelerations);
  out.balance_by_unknowns = lowering.by_unknowns(equations.balance());
  out.accelerations_by_unknowns = lowering.by_unknowns(equations.constraint_accelerations);
  out.rates = lowering.differentiable(equations.constraint_rates);
  out.positions = lowering.differentiable(positions);
  ExprVector scales;
  for (const Expr& e : positions) scales.push_back(size_of_outer_terms(e));
  for (const Expr& e : equations.constraint_rates) scales.push_back(size_of_outer_terms(expand_time_derivatives(e)));
  out.constraint_scales = lowering.function(scales);
  out.observables = lowering.function(wanted.observables);
  out.events = lowering.function(wanted.events);
  out.integrands = lowering.function(wanted.integrands);
  return out;
}

/// Whether the constraint holds a coordinate that has no kinetic energy of its own.
bool holds_massless(const EquationsOfMotion& equations, const Constraint& c) {
  for (std::size_t i = 0; i < equations.momenta.size(); ++i)
    if (equations.momenta[i].is_zero() && !differentiate(c.value, equations.system->coordinates[i].q).is_zero())
      return true;
  return false;
}

/// The largest inertia at rest at q = 0, by numbers: only its order matters.
Expr typical_inertia(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  Bindings at = parameter_bindings(system);
  for (const Coordinate& c : system.coordinates) at.insert({{c.q, 0.0}, {c.velocity, 0.0}});
  double largest = 0;
  for (std::size_t i = 0; i < equations.momenta.size(); ++i) {
    const Expr entry = differentiate(equations.momenta[i], system.coordinates[i].velocity);
    const double value = evaluate(in_terms_of_motion(system, {&entry, 1}).front(), at);
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  return pow(system.context->number(2), Rational(std::clamp(exponent, -40, 40)));
}

/// ½ c φ̇² for the constraints without which M is singular: the norms of quaternions, and what ties coordinates without
/// kinetic energy.
Expr rates_that_make_regular(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  ExprVector terms{system.context->number(0)};
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    const Constraint& c = system.constraints[k];
    const Expr square = pow(equations.constraint_rates[k], 2);
    if (const Body* body = c.body.empty() ? nullptr : system.find_body(c.body)) {
      Expr trace = system.context->number(0);
      for (std::size_t i = 0; i < body->inertia.rows; ++i) trace = trace + body->inertia.at(i, i);
      terms.push_back(Rational(1, 6) * (trace * square));
    } else if (c.level == Constraint::Level::Position && holds_massless(equations, c)) {
      terms.push_back(Rational(1, 2) * (typical_inertia(equations) * square));
    }
  }
  return system.context->sum(terms);
}

}  // namespace

MotionFunctions motion_functions(const EquationsOfMotion& equations, const WantedFunctions& wanted) {
  return lower_motion(Lowering(equations), equations, wanted);
}

VariationalFunctions variational_functions(const EquationsOfMotion& equations, const WantedFunctions& wanted) {
  const Lowering lowering(equations);
  const Expr lagrangian = expand_time_derivatives(equations.lagrangian_expanded + rates_that_make_regular(equations));
  VariationalFunctions out;
  out.motion = lower_motion(lowering, equations, wanted);
  out.momenta = lowering.differentiable(gradient(lagrangian, lowering.velocities()));
  ExprVector forces = gradient(lagrangian, lowering.positions());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i] = forces[i] + equations.generalized_forces[i] - equations.dissipative_terms[i];
    if (!equations.constraint_forces.empty()) forces[i] = forces[i] + equations.constraint_forces[i];
  }
  out.forces = lowering.differentiable(forces);
  return out;
}

std::vector<double> parameter_values(const MechanicalSystem& system) {
  std::vector<double> values;
  for (const Parameter& p : system.parameters) values.push_back(p.si_value);
  return values;
}

}  // namespace maupertuis

#include "equations/released.hpp"

#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

bool stands_in(Expr symbol, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

bool is_given(const EnergyTerm& term) { return term.origin.find(' ') == std::string::npos; }  // "T", "V += …"

/// Σ a·∂r/∂p
Expr work(const ExprVector& force, const ExprVector& position, Expr p) {
  ExprVector terms;
  for (std::size_t k = 0; k < position.size(); ++k) terms.push_back(force[k] * differentiate(position[k], p));
  return p.context().sum(terms);
}

/// ∂θ/∂p [3] or [1] in world axes, from ∂R/∂p Rᵀ.
ExprVector turn_by(const ExprMatrix& rotation, Expr p) {
  const auto entry = [&](std::size_t i, std::size_t j) {
    ExprVector terms;
    for (std::size_t k = 0; k < rotation.columns; ++k)
      terms.push_back(differentiate(rotation.at(i, k), p) * rotation.at(j, k));
    return p.context().sum(terms);
  };
  if (rotation.rows == 2) return {entry(1, 0)};
  return {entry(2, 1), entry(0, 2), entry(1, 0)};
}

/// d/dt(I ω)·∂θ/∂p, with the inertia turned to the world.
Expr work_of_rotation(const Body& body, Expr p) {
  Context& context = p.context();
  const ExprVector turn = turn_by(body.rotation, p);
  const std::size_t n = turn.size();
  ExprVector terms;
  for (std::size_t i = 0; i < n; ++i) {
    ExprVector momentum;
    if (n == 1)
      momentum.push_back(body.inertia.entries[0] * body.angular_velocity[0]);
    else  // R (I ω), ω in body axes
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < n; ++k)
          momentum.push_back(body.rotation.at(i, j) * (body.inertia.at(j, k) * body.angular_velocity[k]));
    if (!turn[i].is_zero()) terms.push_back(total_time_derivative(context.sum(momentum)) * turn[i]);
  }
  return context.sum(terms);
}

Expr work_of_inertia(const MechanicalSystem& s, Expr p) {
  Context& context = *s.context;
  ExprVector terms;
  const auto add = [&](Expr mass, const ExprVector& position) {
    ExprVector force;
    for (const Expr& x : position) force.push_back(mass * total_time_derivative(total_time_derivative(x)));
    terms.push_back(work(force, position, p));
  };
  for (const Point& point : s.points)
    if (point.mass) add(point.mass, point.position);
  for (const Body& body : s.bodies) {
    if (body.mass) add(body.mass, body.position);
    terms.push_back(work_of_rotation(body, p));
  }
  return context.sum(terms);
}

Expr work_of_torque(const MechanicalSystem& s, const AppliedForce& f, Expr p) {
  ExprVector turn(f.components.size(), s.context->number(0));
  const auto add = [&](const std::string& name, int sign) {
    const Body* body = s.find_body(name);
    if (!body) return;
    const ExprVector own = turn_by(body->rotation, p);
    for (std::size_t k = 0; k < own.size() && k < turn.size(); ++k) turn[k] = turn[k] + Rational(sign) * own[k];
  };
  add(f.target, 1);
  if (!f.reaction_on.empty()) add(f.reaction_on, -1);
  ExprVector terms;
  for (std::size_t k = 0; k < turn.size(); ++k) terms.push_back(f.components[k] * turn[k]);
  return s.context->sum(terms);
}

Expr work_of_forces(const MechanicalSystem& s, Expr p) {
  ExprVector terms;
  for (const AppliedForce& f : s.forces) {
    if (f.kind == AppliedForce::Kind::OnPoint) terms.push_back(work(f.components, f.lever, p));
    if (f.kind == AppliedForce::Kind::Torque) terms.push_back(work_of_torque(s, f, p));
  }
  for (const Constraint& c : s.constraints)
    if (c.level == Constraint::Level::Position) terms.push_back(c.multiplier * differentiate(c.value, p));
  return s.context->sum(terms);
}

/// D with a symbol in the place of every d/dt, and what the symbols stand for.
struct SplitDissipation {
  Expr outer;
  std::vector<std::pair<Expr, Expr>> rates;  // symbol, the node d/dt u
};

SplitDissipation split_dissipation(Expr dissipation) {
  SplitDissipation split;
  ExprMap symbols;
  for (const Expr& node : topological_order({&dissipation, 1})) {
    if (!node.is(Kind::TimeDerivative)) continue;
    const Expr rate = node.context().symbol("rate " + std::to_string(node.id()), Role::Auxiliary);
    symbols.emplace(node, rate);
    split.rates.emplace_back(rate, node);
  }
  split.outer = substitute(dissipation, symbols);
  return split;
}

/// ∂D/∂ṗ of a damper, ½ c (d|r|/dt)²: ∂/∂ṗ of d/dt u is ∂u/∂p.
Expr work_of_damper(Expr dissipation, Expr p) {
  const SplitDissipation split = split_dissipation(dissipation);
  ExprMap back;
  for (const auto& [rate, node] : split.rates) back.emplace(rate, expand_time_derivatives(node));
  ExprVector terms;
  for (const auto& [rate, node] : split.rates)
    terms.push_back(substitute(differentiate(split.outer, rate), back) * differentiate(node[0], p));
  return p.context().sum(terms);
}

/// Why the force that holds p cannot be known; empty if it can.
std::string obstacle(const MechanicalSystem& s, const Parameter& parameter) {
  const auto refuse = [&](const char* what) {
    return fmt::format(
        "{} gives no reaction here: {} holds it, and does not say how it would change if {} changed in time.",
        parameter.name, what, parameter.name);
  };
  const auto holds = [&](const std::vector<EnergyTerm>& terms, bool given_alone) {
    return std::any_of(terms.begin(), terms.end(), [&](const EnergyTerm& term) {
      return (!given_alone || is_given(term)) && stands_in(parameter.symbol, term.value);
    });
  };
  for (const AppliedForce& force : s.forces)
    if (force.kind == AppliedForce::Kind::Generalized)
      return fmt::format(
          "{0} gives no reaction here: the force on {1} is given per coordinate, which does not say what work it does "
          "when {0} changes.",
          parameter.name, force.target);
  if (s.lagrangian_given) return refuse("the given L");
  if (holds(s.kinetic, true)) return refuse("the given T");
  if (holds(s.generalized_potential, false)) return refuse("U");
  if (holds(s.lagrangian_extra, false)) return refuse("what is added to L");
  for (const EnergyTerm& term : s.dissipation)  // in front of a d/dt it may have stood behind it
    if (stands_in(parameter.symbol, split_dissipation(term.value).outer)) return refuse("D");
  return {};
}

}  // namespace

HoldingForce holding_force(const EquationsOfMotion& equations, const Parameter& parameter) {
  const MechanicalSystem& s = *equations.system;
  const Expr p = parameter.symbol;
  if (std::string reason = obstacle(s, parameter); !reason.empty()) return {{}, std::move(reason)};
  ExprVector terms{work_of_inertia(s, p), differentiate(expand_time_derivatives(s.potential_energy()), p),
                   -work_of_forces(s, p)};
  for (const EnergyTerm& term : s.dissipation) terms.push_back(work_of_damper(term.value, p));
  return {s.context->sum(terms), {}};
}

}  // namespace maupertuis

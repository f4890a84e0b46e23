#include "simulation/given_forces.hpp"

#include <fmt/format.h>

namespace maupertuis {

Expr GivenForces::parameter() {
  Parameter p;
  p.name = fmt::format("given {}", ++count_);
  p.symbol = own_.context->symbol(p.name, Role::Parameter);
  own_.parameters.push_back(p), in_mode_.parameters.push_back(p);
  return p.symbol;
}

Expr GivenForces::polynomial(int degree, Expr since) {
  ExprVector coefficients;
  for (int power = 0; power <= degree; ++power) coefficients.push_back(parameter());
  Expr out = coefficients.back();
  for (int power = degree; power-- > 0;) out = out * since + coefficients[static_cast<std::size_t>(power)];
  return out;
}

template <class Lever>
void GivenForces::add(Expr force, Lever&& lever) {
  for (std::size_t i = 0; i < work_.size(); ++i) work_[i] = work_[i] + force * lever(own_.coordinates[i]);
}

void GivenForces::preload(const ContactMode& mode) {
  const Expr since = own_.context->time() - parameter();
  for (std::size_t i = 0; i < mode.closed.size(); ++i)
    if (mode.closed[i]) {
      const Expr gap = own_.contacts[i].gap, force = polynomial(preload_degree, since);
      add(force, [&](const Coordinate& c) { return differentiate(gap, c.q); });
      all_[own_.contacts[i].multiplier] = own_.contacts[i].multiplier + force;
    }
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (mode.friction[i] != FrictionState::Stick) continue;
    const Friction& f = friction_of(own_, i);
    for (std::size_t k = 0; k < f.slip.size(); ++k) {
      const Expr force = polynomial(preload_degree, since);
      add(force, [&](const Coordinate& c) { return differentiate(f.slip[k], c.velocity); });
      all_[f.multipliers[k]] = f.multipliers[k] + force;
    }
  }
  for (const Constraint& c : own_.constraints) {
    const bool is_position = c.level == Constraint::Level::Position;
    const Expr force = polynomial(preload_degree, since);
    if (c.forceless) continue;
    add(force, [&](const Coordinate& x) { return differentiate(c.value, is_position ? x.q : x.velocity); });
    all_[c.multiplier] = c.multiplier + force;
  }
  with_given_multipliers();
}

/// Friction that slides by a force of which a part is given.
void GivenForces::with_given_multipliers() {
  for (AppliedForce& force : in_mode_.forces) force.components = substitute(force.components, all_);
}

void GivenForces::direct(std::size_t i, int degree, ExprVector& rubbed) {
  const Friction& f = own_.contacts[i].friction;
  const Expr since = own_.context->time() - parameter(), most = f.kinetic * own_.contacts[i].multiplier;
  for (std::size_t k = 0; k < f.slip.size(); ++k) {
    const Expr direction = polynomial(degree, since);
    add(-(most * direction), [&](const Coordinate& c) { return differentiate(f.slip[k], c.velocity); });
    all_[f.multipliers[k]] = -(most * direction);
    rubbed.push_back(most * direction * f.slip[k]);
  }
}

MechanicalSystem GivenForces::system() {
  for (std::size_t i = 0; i < work_.size(); ++i) {
    if (work_[i].is_zero()) continue;
    AppliedForce force;
    force.kind = AppliedForce::Kind::Generalized;
    force.target = own_.coordinates[i].name;
    force.coordinate = i;
    force.components = {work_[i]};
    in_mode_.forces.push_back(std::move(force));
  }
  return in_mode_;
}

}  // namespace maupertuis

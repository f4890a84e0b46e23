#include "verification/pitfalls.hpp"

#include <maupertuis/evaluate.hpp>

/// Each function below derives the equations with one classic mistake in them (Goldstein ch. 1, exercises; the usual
/// list of teachers). A claim that follows from such equations, and not from the right ones, made that mistake.
namespace maupertuis {
namespace {

class MistakenDerivations {
 public:
  explicit MistakenDerivations(const EquationsOfMotion& equations)
      : equations_(equations), system_(*equations.system), context_(*system_.context) {
    for (const Coordinate& c : system_.coordinates) {
      q_.push_back(c.q);
      velocities_.push_back(c.velocity);
    }
    kinetic_ = expand_time_derivatives(system_.kinetic_energy());
    potential_ = expand_time_derivatives(system_.potential_energy());
  }

  std::vector<Pitfall> all() {
    const auto& d = equations_.dissipative_terms;
    const auto& forces = equations_.generalized_forces;
    const std::vector<TermOrigin> of_kinetic{TermOrigin::Inertia, TermOrigin::Coupling, TermOrigin::Velocity,
                                             TermOrigin::PrescribedMotion};
    add("the term ∂T/∂q is missing: T depends on the coordinates as well as on the velocities",
        without(gradient(kinetic_, q_), +1), {TermOrigin::Velocity, TermOrigin::PrescribedMotion});
    add("a part of the total time derivative is missing: d/dt ∂L/∂q' acts through q as well as through q'",
        without(transport(), -1), {TermOrigin::Velocity});
    add("V has the wrong sign: L is T − V", lagrangian_with(kinetic_, -potential_), {TermOrigin::Potential});
    add("T has no factor ½: the kinetic energy of a particle is ½ m v²",
        lagrangian_with(kinetic_ * Rational(2), potential_), of_kinetic);
    add("T has a factor ½ too many", lagrangian_with(kinetic_ / Rational(2), potential_), of_kinetic);
    add("V has a factor 2 too many: the energy of a spring is ½ k x²",
        lagrangian_with(kinetic_, potential_ * Rational(2)), {TermOrigin::Potential});
    add("V has a factor ½ too many", lagrangian_with(kinetic_, potential_ / Rational(2)), {TermOrigin::Potential});
    if (any(d)) {
      add("the dissipation was left out: +∂D/∂q' belongs to the left side", without(d, -1), {TermOrigin::Dissipation});
      add("the dissipation has the wrong sign: it enters as +∂D/∂q' on the left side", without(d, -2),
          {TermOrigin::Dissipation});
      add("D has no factor ½: linear damping c is D = ½ c q'²", without(d, +1), {TermOrigin::Dissipation});
      add("D has a factor ½ too many", without(halves(d), -1), {TermOrigin::Dissipation});
    }
    if (any(forces)) {
      add("a force was left out: Q belongs to the right side", without(forces, +1), {TermOrigin::Force});
      add("a force has the wrong sign: Q stands on the right side", without(forces, +2), {TermOrigin::Force});
    }
    add("a velocity was written as its coordinate: v² of a pendulum is (l θ')², not (l θ)²",
        coordinates_for_velocities());
    for (const Coordinate& c : system_.coordinates) add_momentum_put_into_lagrangian(c);
    return std::move(pitfalls_);
  }

 private:
  static bool any(const ExprVector& terms) {
    for (const Expr& e : terms)
      if (!e.is_zero()) return true;
    return false;
  }

  void add(std::string sentence, ExprVector residual, std::vector<TermOrigin> about = {}) {
    pitfalls_.push_back({std::move(sentence), std::move(residual), std::move(about)});
  }

  /// The right residual plus `factor` times the terms.
  ExprVector without(const ExprVector& terms, int factor) const {
    ExprVector residual = equations_.residual;
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = residual[i] + Rational(factor) * terms[i];
    return residual;
  }

  static ExprVector halves(const ExprVector& terms) {
    ExprVector out;
    for (const Expr& e : terms) out.push_back(e / Rational(2));
    return out;
  }

  /// (∂²L/∂q̇∂q) q̇: what d/dt ∂L/∂q̇ has through the coordinates.
  ExprVector transport() const {
    ExprVector out;
    for (const Expr& momentum : equations_.momenta) {
      const auto derivatives = gradient(momentum, q_);
      ExprVector terms;
      for (std::size_t j = 0; j < q_.size(); ++j) terms.push_back(derivatives[j] * velocities_[j]);
      out.push_back(context_.sum(terms));
    }
    return out;
  }

  ExprVector with_forces(ExprVector residual) const {
    for (std::size_t i = 0; i < residual.size(); ++i)
      residual[i] = residual[i] + equations_.dissipative_terms[i] - equations_.generalized_forces[i];
    return residual;
  }

  ExprVector lagrangian_with(Expr kinetic, Expr potential) const {
    return with_forces(variational_residual(kinetic - potential, q_));
  }

  ExprVector coordinates_for_velocities() const {
    ExprMap map;
    for (std::size_t i = 0; i < q_.size(); ++i) map.emplace(velocities_[i], q_[i]);
    ExprVector residual;
    for (const Expr& force : gradient(substitute(kinetic_, map) - potential_, q_)) residual.push_back(-force);
    return with_forces(residual);
  }

  /// L with the velocity of a cyclic coordinate replaced by its value from p = const before the derivatives are taken.
  /// (The Routhian is the right way; Goldstein §8.3.)
  void add_momentum_put_into_lagrangian(const Coordinate& cyclic) {
    if (q_.size() < 2 || !vanishes_identically(differentiate(equations_.lagrangian_expanded, cyclic.q))) return;
    const std::size_t index = static_cast<std::size_t>(&cyclic - system_.coordinates.data());
    const Expr momentum = equations_.momenta[index];
    const Expr inertia = differentiate(momentum, cyclic.velocity);
    if (vanishes_identically(inertia) || !vanishes_identically(differentiate(inertia, cyclic.velocity))) return;
    const Expr p = context_.symbol("p_" + cyclic.name, Role::Auxiliary);
    const Expr rest = substitute(momentum, {{cyclic.velocity, context_.number(0)}});
    const Expr reduced = substitute(equations_.lagrangian_expanded, {{cyclic.velocity, (p - rest) / inertia}});
    ExprVector residual = with_forces(variational_residual(reduced, q_));
    for (Expr& row : residual) row = substitute(expand_time_derivatives(row), {{p, momentum}});
    residual[index] = equations_.residual[index];
    add("the conserved momentum of " + cyclic.name +
            " was put into L before the derivatives were taken: that changes the sign of its effective potential (the "
            "Routhian does it right), or its sign is a slip",
        std::move(residual));
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  Context& context_;
  ExprVector q_, velocities_;
  Expr kinetic_, potential_;
  std::vector<Pitfall> pitfalls_;
};

}  // namespace

std::vector<Pitfall> pitfalls(const EquationsOfMotion& equations) { return MistakenDerivations(equations).all(); }

}  // namespace maupertuis

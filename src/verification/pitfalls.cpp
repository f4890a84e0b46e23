#include "verification/pitfalls.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>

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
    others_ = equations_.lagrangian_expanded - kinetic_ + potential_;
  }

  std::vector<Pitfall> all(bool of_parts) {
    const auto& d = equations_.dissipative_terms;
    const auto& forces = equations_.generalized_forces;
    add("the term ∂T/∂q is missing: T depends on the coordinates as well as on the velocities",
        without(gradient(kinetic_, q_), +1), {TermOrigin::Velocity, TermOrigin::PrescribedMotion});
    add("a part of the total time derivative is missing: d/dt ∂L/∂q' acts through q as well as through q'",
        without(transport(), -1), {TermOrigin::Velocity});
    add_time_derivative_without_t();
    add("V has the wrong sign: L is T − V", lagrangian_with(kinetic_, -potential_), {TermOrigin::Potential});
    add_factors();
    add_parts_left_out();
    add_generalized_potential_left_out();
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
    if (of_parts) add_parts_of_potential();
    add_throughout();
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
  void add_made_throughout(std::string sentence, ExprVector residual) {
    pitfalls_.push_back({std::move(sentence), std::move(residual), {}, true});
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

  /// What L has beside T and V, as a generalized potential, stays.
  ExprVector lagrangian_with(Expr kinetic, Expr potential) const {
    return with_forces(variational_residual(kinetic - potential + others_, q_));
  }

  /// ∂²L/∂t∂q̇: what d/dt ∂L/∂q̇ has through t alone, where something moves in a prescribed way.
  void add_time_derivative_without_t() {
    ExprMap no_accelerations;
    for (const Coordinate& c : system_.coordinates) no_accelerations.emplace(c.acceleration, context_.number(0));
    ExprVector terms;
    const ExprVector by_coordinates = transport();
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const Expr whole = expand_time_derivatives(total_time_derivative(equations_.momenta[i]));
      terms.push_back(substitute(whole, no_accelerations) - by_coordinates[i]);
    }
    if (std::all_of(terms.begin(), terms.end(), [](const Expr& e) { return vanishes_identically(e); })) return;
    add("a part of the total time derivative is missing: ∂L/∂q' holds t as well, and d/dt acts through it: what moves "
        "in a prescribed way accelerates",
        without(terms, -1), {TermOrigin::Velocity, TermOrigin::PrescribedMotion, TermOrigin::PrescribedAcceleration});
  }

  /// Where L is T − V and nothing else acts, twice T and half of V give the same equations.
  void add_factors() {
    const std::vector<TermOrigin> of_kinetic{TermOrigin::Inertia, TermOrigin::Coupling, TermOrigin::Velocity,
                                             TermOrigin::PrescribedMotion, TermOrigin::PrescribedAcceleration};
    const std::vector<TermOrigin> of_potential{TermOrigin::Potential};
    const std::string spring = has_spring() ? ": the energy of a spring is ½ k x²" : "";
    // What acts beside T: where it is one thing, its factor cannot be told from that of T.
    const bool forced = any(equations_.dissipative_terms) || any(equations_.generalized_forces),
               has_v = !vanishes_identically(potential_), has_others = !vanishes_identically(others_);
    const ExprVector twice_t = lagrangian_with(kinetic_ * Rational(2), potential_),
                     half_t = lagrangian_with(kinetic_ / Rational(2), potential_);
    if (!forced && has_v != has_others) {
      const std::string name = has_v ? "V" : system_.lagrangian_given ? "what L has beside T" : "U";
      std::vector<TermOrigin> of_both = of_kinetic;
      of_both.push_back(TermOrigin::Potential);
      add("T has no factor ½ (the kinetic energy of a particle is ½ m v²), or " + name + " has a factor ½ too many",
          twice_t, of_both);
      add(name + " has a factor 2 too many" + spring + (spring.empty() ? "," : ";") + " or T has a factor ½ too many",
          half_t, of_both);
      return;
    }
    add("T has no factor ½: the kinetic energy of a particle is ½ m v²", twice_t, of_kinetic);
    add("T has a factor ½ too many", half_t, of_kinetic);
    add("V has a factor 2 too many" + spring, lagrangian_with(kinetic_, potential_ * Rational(2)), of_potential);
    add("V has a factor ½ too many", lagrangian_with(kinetic_, potential_ / Rational(2)), of_potential);
  }

  /// A spring of the model, or a term of V such as ½ k x², with k a parameter alone.
  bool has_spring() const {
    for (const Link& link : system_.links)
      if (link.kind == Link::Kind::Spring) return true;
    const MechanicalSystem& shown = *equations_.shown().system;
    const Expr potential = expand_time_derivatives(shown.potential_energy());
    for (const Coordinate& c : shown.coordinates) {
      const Expr stiffness = expand(differentiate(differentiate(potential, c.q), c.q));
      if (!stiffness) continue;
      for (std::size_t k = 0; k < (stiffness.is(Kind::Sum) ? stiffness.size() : 1); ++k) {
        const Expr term = stiffness.is(Kind::Sum) ? stiffness[k] : stiffness;
        const std::vector<Expr> symbols = symbols_of({&term, 1});
        if (symbols.size() == 1 && symbols[0].role() != Role::Coordinate &&
            vanishes_identically(differentiate(differentiate(term, symbols[0]), symbols[0])))
          return true;
      }
    }
    return false;
  }

  /// Parts of T that are easily forgotten: what bodies have of their rotation, or of the motion of their centre of
  /// mass; or a term ½ I ω² of a formula.
  void add_parts_left_out() {
    const MechanicalSystem& shown = *equations_.shown().system;
    Expr rotation = context_.number(0), motion = context_.number(0);
    std::size_t parts = 0;
    for (const EnergyTerm& t : shown.kinetic) {
      const Expr value = expand_time_derivatives(t.value);
      for (std::size_t k = 0; k < (value.is(Kind::Sum) ? value.size() : 1); ++k, ++parts) {
        const Expr term = value.is(Kind::Sum) ? value[k] : value;
        const bool turns = t.origin == "T" ? holds_moment_of_inertia(shown, term) : t.origin.starts_with("rotation of");
        (turns ? rotation : motion) = (turns ? rotation : motion) + term;
      }
    }
    const auto values = shown.definition_values();
    rotation = substitute(rotation, ExprMap(values.begin(), values.end()));
    motion = substitute(motion, ExprMap(values.begin(), values.end()));
    constexpr std::size_t most_parts = 50;
    if (parts > most_parts || vanishes_identically(rotation) || vanishes_identically(motion)) return;
    add("the energy of rotation is missing from T: a body that turns has ½ I ω² beside the ½ m v² of its centre of "
        "mass",
        lagrangian_with(kinetic_ - rotation, potential_));
    add("the energy of the centre of mass is missing from T: a body that turns has ½ m v² beside its ½ I ω²",
        lagrangian_with(kinetic_ - motion, potential_));
  }

  /// A term of T with a parameter, or a `let`, that has the unit of a moment of inertia.
  static bool holds_moment_of_inertia(const MechanicalSystem& shown, Expr term) {
    if (shown.dimensionless) return false;
    const Dimension inertia = dimensions::mass() * dimensions::length() * dimensions::length();
    const auto has_unit = [&](const auto& list, const Expr& s) {
      return std::any_of(list.begin(), list.end(),
                         [&](const auto& one) { return one.symbol == s && one.dimension.same_as(inertia); });
    };
    for (const Expr& s : symbols_of({&term, 1}))
      if (has_unit(shown.parameters, s) || has_unit(shown.definitions, s)) return true;
    return false;
  }

  /// Parts of V with a name: what the model gives by a spring or by gravity, and the terms of a formula.
  std::vector<std::pair<std::string, Expr>> parts_of_potential() const {
    const MechanicalSystem& shown = *equations_.shown().system;
    const auto values = shown.definition_values();
    std::vector<std::pair<std::string, Expr>> parts;
    const auto add_part = [&](const std::string& name, const Expr& e) {
      parts.emplace_back(name, substitute(expand_time_derivatives(e), ExprMap(values.begin(), values.end())));
    };
    for (const EnergyTerm& t : shown.potential) {
      if (t.origin != "V") {
        add_part(t.origin, t.value);
        continue;
      }
      for (std::size_t k = 0; k < (t.value.is(Kind::Sum) ? t.value.size() : 1); ++k) {
        const Expr term = t.value.is(Kind::Sum) ? t.value[k] : t.value;
        add_part(to_plain(term, equations_.order), term);
      }
    }
    return parts;
  }

  /// Of one of several parts of V: that of one spring of a chain, which stands in two equations.
  void add_parts_of_potential() {
    if (system_.lagrangian_given) return;
    const auto parts = parts_of_potential();
    constexpr std::size_t most_parts = 12;
    if (parts.size() < 2 || parts.size() > most_parts) return;
    for (const auto& [name, part] : parts) {
      add(fmt::format("the force of {} in V has the wrong sign", name),
          lagrangian_with(kinetic_, potential_ - Rational(2) * part), {TermOrigin::Potential});
      add(fmt::format("the force of {} in V is missing", name), lagrangian_with(kinetic_, potential_ - part),
          {TermOrigin::Potential});
    }
  }

  void add_generalized_potential_left_out() {
    const Expr u = expand_time_derivatives(system_.total_generalized_potential());
    if (system_.lagrangian_given || u.is_zero()) return;
    const std::vector<TermOrigin> of_u{TermOrigin::Velocity, TermOrigin::Potential, TermOrigin::PrescribedMotion,
                                       TermOrigin::PrescribedAcceleration};
    add("the generalized potential U was left out: L is T − V − U, and U gives a force that depends on velocities",
        with_forces(variational_residual(equations_.lagrangian_expanded + u, q_)), of_u);
    add("U has the wrong sign: L is T − V − U",
        with_forces(variational_residual(equations_.lagrangian_expanded + u * Rational(2), q_)), of_u);
  }

  /// sin θ as θ and cos θ as 1 throughout, and products of what is small left out; sines and cosines exchanged.
  void add_throughout() {
    const ExprVector rows = simplified_rows();
    ExprMap map, exchanged;
    std::string first;
    for (const Expr& node : topological_order(rows)) {
      if (!node.is(Kind::Sin) && !node.is(Kind::Cos)) continue;
      const Expr argument = node[0];
      const std::vector<Expr> symbols = symbols_of({&argument, 1});
      if (std::none_of(symbols.begin(), symbols.end(), [](Expr s) { return s.role() == Role::Coordinate; })) continue;
      if (first.empty() && node.is(Kind::Sin))
        first = fmt::format("{} is written as {}, which holds for small angles only", to_plain(node, equations_.order),
                            to_plain(argument, equations_.order));
      map.emplace(node, node.is(Kind::Sin) ? argument : context_.number(1));
      exchanged.emplace(node, node.is(Kind::Sin) ? cos(argument) : sin(argument));
    }
    if (map.empty()) return;
    add_made_throughout(
        first.empty() ? "the cosine of a coordinate is written as 1, which holds for small angles only" : first,
        substitute(rows, map));
    add_made_throughout("the equation is linearized: it holds for small motions only", linearized(rows));
    add_made_throughout("sine and cosine are exchanged in every term, as where an angle is measured from another line",
                        substitute(rows, exchanged));
  }

  /// The left sides with sin² + cos² put together; empty where they are too long to be read.
  ExprVector simplified_rows() const {
    constexpr std::size_t most_coordinates = 10;
    if (q_.size() > most_coordinates) return {};
    const ExprMatrix mass = mass_matrix(equations_);
    ExprVector rows;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      ExprVector terms;
      for (const RowTerm& t : row_terms(equations_, mass, i))
        if (t.origin != TermOrigin::Constraint) terms.push_back(t.value);
      if (terms.empty()) return {};
      rows.push_back(context_.sum(terms));
    }
    return rows;
  }

  /// To first order about q = 0, where that is an equilibrium at all times.
  ExprVector linearized(const ExprVector& rows) const {
    ExprVector small;
    ExprMap none;
    for (const Coordinate& c : system_.coordinates)
      for (const Expr& s : {c.q, c.velocity, c.acceleration}) small.push_back(s), none.emplace(s, context_.number(0));
    ExprVector out;
    for (const Expr& row : rows) {
      const std::vector<Expr> slopes = gradient(row, small);
      ExprVector terms{substitute(row, none)};
      for (std::size_t k = 0; k < small.size(); ++k) terms.push_back(substitute(slopes[k], none) * small[k]);
      out.push_back(context_.sum(terms));
    }
    return out;
  }

  ExprVector coordinates_for_velocities() const {
    ExprMap map;
    for (std::size_t i = 0; i < q_.size(); ++i) map.emplace(velocities_[i], q_[i]);
    ExprVector residual;
    const Expr lagrangian = substitute(kinetic_, map) - potential_ + substitute(others_, map);
    for (const Expr& force : gradient(lagrangian, q_)) residual.push_back(-force);
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
  Expr kinetic_, potential_, others_;  // L = T − V + others
  std::vector<Pitfall> pitfalls_;
};

}  // namespace

std::vector<Pitfall> pitfalls(const EquationsOfMotion& equations, bool of_parts) {
  return MistakenDerivations(equations).all(of_parts);
}

}  // namespace maupertuis

#include "equations/derivation_steps.hpp"
#include "equations/constraint_steps.hpp"
#include "equations/step_writer.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array axis_names{"x", "y", "z"};

void write_coordinates(StepWriter& out) {
  out.open("Coordinates");
  std::string list;
  for (const Coordinate& c : out.system().coordinates) {
    if (!list.empty()) list += ", ";
    list += c.kind.empty() ? c.name : fmt::format("{} ({})", c.name, c.kind);
  }
  const std::size_t n = out.system().coordinates.size();
  const std::string count = fmt::format("{}: {}", list.empty() ? "none" : list, plural(n, "generalized coordinate"));
  out.sentence("choice of generalized coordinates",
               out.system().constrained()
                   ? fmt::format("{}, {}", count, counting_sentence(out.system()))
                   : fmt::format("{}, no constraints among them, so {}.", count, plural(n, "freedom")));
}

/// Positions, then velocities by the chain rule, then speeds squared, of the points that carry mass.
void write_kinematics(StepWriter& out) {
  struct Moving {
    std::string name;
    const ExprVector* position;
  };
  std::vector<Moving> moving;
  for (const Point& p : out.system().points)
    if (p.mass) moving.push_back({p.name, &p.position});
  for (const Body& b : out.system().bodies)
    if (b.mass) moving.push_back({b.name, &b.position});
  if (moving.empty()) return;

  const auto each_component = [&](auto&& write) {
    for (const Moving& point : moving)
      for (std::size_t axis = 0; axis < point.position->size(); ++axis)
        write(point.name, axis_names[axis], (*point.position)[axis]);
  };
  out.open("Positions");
  each_component([&](const std::string& name, const char* axis, Expr value) {
    out.formula(out.component(name, axis), value, "definition of the point");
  });
  out.open("Velocities");
  each_component([&](const std::string& name, const char* axis, Expr value) {
    out.formula(out.component(name, axis, 1), out.context().time_derivative(value),
                "chain rule: ṙ = Σ ∂r/∂q q' + ∂r/∂t");
  });
  out.open("Speeds");
  for (const Moving& point : moving) {
    ExprVector squares;
    for (const Expr& component : *point.position)
      squares.push_back(pow(out.context().time_derivative(component), Rational(2)));
    const Layout speed =
        layouts::labelled("v_" + point.name, layouts::indexed(layouts::name("v"), {layouts::name(point.name)}));
    out.formula(layouts::power(speed, layouts::number("2")), out.context().sum(squares),
                out.system().space_dimension == 2 ? "v² = x'² + y'²" : "v² = x'² + y'² + z'²");
  }
}

void write_angular_velocities(StepWriter& out) {
  if (out.system().bodies.empty()) return;
  out.open("Angular velocities");
  for (const Body& body : out.system().bodies) {
    const bool planar = body.angular_velocity.size() == 1;
    for (std::size_t i = 0; i < body.angular_velocity.size(); ++i) {
      out.formula(out.component(body.name, "ω", 0, planar ? "" : axis_names[i]), body.angular_velocity[i],
                  "rotation of the body, in body axes");
    }
  }
}

/// T(particle A), in print with what it belongs to below.
Layout part_of(const std::string& letter, const std::string& what) {
  return layouts::labelled(fmt::format("{}({})", letter, what),
                           layouts::indexed(layouts::name(letter), {layouts::words(what)}));
}

Layout generalized_force(const StepWriter& out, const Coordinate& c) {
  return layouts::labelled("Q_" + c.name, layouts::indexed(layouts::name("Q"), {out.symbol(c.q)}));
}

void write_energy(StepWriter& out, const char* section, const std::string& letter, const std::vector<EnergyTerm>& terms,
                  const std::string& rule) {
  if (terms.empty()) return;
  out.open(section);
  ExprVector values;
  bool given = true;  // T = …, V = … of the model, nothing from points and springs
  for (const EnergyTerm& term : terms) {
    values.push_back(term.value);
    given &= term.origin == letter;
    if (terms.size() > 1) out.formula(part_of(letter, term.origin), term.value, term.origin);
  }
  out.formula(layouts::name(letter), out.context().sum(values), given ? "as given" : rule);
}

void write_lagrangian(StepWriter& out) {
  const MechanicalSystem& s = out.system();
  write_energy(out, "Kinetic energy", "T", s.kinetic, "T = Σ ½ m v² + ½ ω·I ω");
  write_energy(out, "Potential energy", "V", s.potential, "sum over the potentials");
  write_energy(out, "Generalized potential", "U", s.generalized_potential, "velocity-dependent potential");
  write_energy(out, "Dissipation function", "D", s.dissipation, "Rayleigh's dissipation function");
  out.open("Lagrangian");
  const bool extra = !s.lagrangian_extra.empty();
  std::string rule = s.lagrangian_given ? "as given" : s.generalized_potential.empty() ? "L = T - V" : "L = T - V - U";
  if (extra) rule += ", and the terms added to L";
  out.formula(layouts::name("L"), out.equations().lagrangian_expanded, rule);
}

/// The virtual work behind each Q: F·∂r/∂q, τ·∂ω/∂q'.
void write_virtual_work(StepWriter& out) {
  const MechanicalSystem& s = out.system();
  if (s.forces.empty()) return;
  out.open("Generalized forces");
  for (const AppliedForce& force : s.forces) {
    if (force.kind == AppliedForce::Kind::Generalized) {
      out.sentence("generalized force given directly",
                   fmt::format("The force on {} is given per coordinate: its virtual work is Q δ{}.", force.target,
                               force.target));
      continue;
    }
    const bool torque = force.kind == AppliedForce::Kind::Torque;
    for (std::size_t i = 0; i < s.coordinates.size(); ++i) {
      const Coordinate& c = s.coordinates[i];
      ExprVector terms;
      for (std::size_t k = 0; k < force.components.size() && k < force.lever.size(); ++k) {
        const Expr lever = expand_time_derivatives(force.lever[k]);
        terms.push_back(force.components[k] * differentiate(lever, torque ? c.velocity : c.q));
      }
      const Expr work = out.context().sum(terms);
      if (work.is_zero()) continue;
      const std::string from = force.reaction_on.empty() ? "" : " from " + force.reaction_on;
      const std::string what = fmt::format("{} {}{}", torque ? "torque on" : "force on", force.target, from);
      out.formula(
          layouts::labelled(fmt::format("Q_{}({})", c.name, what),
                            layouts::indexed(layouts::name("Q"), {out.symbol(c.q), layouts::words(what)})),
          work,
          torque ? fmt::format("virtual work: τ·∂ω/∂{}'", c.name) : fmt::format("virtual work: F·∂r/∂{}", c.name));
    }
  }
  for (std::size_t i = 0; i < s.coordinates.size(); ++i)
    out.formula(generalized_force(out, s.coordinates[i]), out.equations().generalized_forces[i],
                "sum of the virtual works");
}

/// d/dt ∂L/∂q̇ = Σ_j (∂p/∂q̇_j q̈_j + ∂p/∂q_j q̇_j) + ∂p/∂t (+ ∂p/∂u u̇), each chain-rule term on its own.
ReadableForm total_derivative_terms(const StepWriter& out, Expr momentum) {
  Context& context = out.context();
  ReadableForm form;
  ExprVector terms;
  const auto add = [&](Expr symbol) {
    const Expr partial = differentiate(momentum, symbol);
    if (partial.is_zero()) return;
    ReadableForm coefficient = readable(partial, out.equations().order);
    if (coefficient.value.is_zero()) return;
    terms.push_back(coefficient.value * context.time_derivative(symbol));
    for (Intermediate& i : coefficient.intermediates) form.intermediates.push_back(std::move(i));
  };
  for (const Coordinate& c : out.system().coordinates) add(c.velocity);
  for (const Coordinate& c : out.system().coordinates) add(c.q);
  for (const Expr& s : symbols_of({&momentum, 1}))
    if (s.role() == Role::Input) add(s);
  add(context.time());
  form.value = context.sum(terms);
  return form;
}

void write_row(StepWriter& out, std::size_t i, const Derivation& derivation) {
  const EquationsOfMotion& eq = out.equations();
  const Coordinate& c = out.system().coordinates[i];
  const Layout L = layouts::name("L"), D = layouts::name("D"),
               by_velocity = layouts::partial(L, out.symbol(c.velocity));
  out.open("Equation of " + c.name);
  out.formula(
      by_velocity, eq.momenta[i],
      fmt::format("partial derivative, q and {} held fixed: the momentum p_{}", out.system().independent, c.name));
  const std::string t = out.system().independent, total = t == "t" ? "total time derivative" : "total derivative";
  out.as_is(layouts::rate(by_velocity, out.symbol(out.context().time()), true),
            total_derivative_terms(out, eq.momenta[i]), fmt::format("{}: chain rule through q', q and {}", total, t));
  out.formula(layouts::partial(L, out.symbol(c.q)), differentiate(eq.lagrangian_expanded, c.q),
              fmt::format("partial derivative, q' and {} held fixed", t));
  if (!eq.dissipative_terms[i].is_zero())
    out.formula(layouts::partial(D, out.symbol(c.velocity)), eq.dissipative_terms[i],
                "partial derivative of the dissipation function");
  std::string rule = fmt::format("d/d{} ∂L/∂q' − ∂L/∂q", t);
  if (!eq.dissipative_terms[i].is_zero()) rule += " + ∂D/∂q'";
  rule += eq.generalized_forces[i].is_zero() ? " = " : " = Q";
  if (derivation.constraint_forces.empty()) {
    rule += eq.generalized_forces[i].is_zero() ? "0" : "";
    out.as_is(layouts::number("0"), derivation.equations[i], "Euler-Lagrange: " + rule + ", collected and simplified");
    return;
  }
  rule += eq.generalized_forces[i].is_zero() ? "Aᵀλ" : " + Aᵀλ";
  out.as_is(lay_out(derivation.equations[i], eq.order), derivation.constraint_forces[i],
            "Lagrange with multipliers: " + rule + ", collected and simplified");
}

void write_solved(StepWriter& out) {
  out.open(out.system().constrained() ? "Solved for the accelerations and multipliers"
                                      : "Solved for the accelerations");
  bool any_left = false;
  constexpr std::size_t longest = 400;  // characters: beyond it the solved form hides more than it shows
  for (SolvedAcceleration& solved : solved_accelerations(out.equations())) {
    const Coordinate& c = out.system().coordinates[solved.coordinate];
    const bool is_short = solved.right.value && solved.right.intermediates.empty() &&
                          to_plain(solved.right.value, out.equations().order).size() <= longest;
    any_left |= !is_short;
    if (is_short)
      out.as_is(out.symbol(c.acceleration), std::move(solved.right),
                solved.coupled_with.size() == 1 ? "divided by the coefficient of " + c.name + "''" : "Cramer's rule");
  }
  if (out.system().constrained()) return write_solved_multipliers(out, any_left);
  if (any_left && !out.equations().degenerate)
    out.sentence(
        "M q'' + h = 0",
        "The coupled accelerations are long when written out; a run solves M q'' = −h numerically at every step.");
}

}  // namespace

std::vector<DerivationStep> derivation_steps(const EquationsOfMotion& equations, const Derivation& derivation,
                                             const std::vector<Reaction>& reactions) {
  StepWriter out(equations);
  write_coordinates(out);
  write_kinematics(out);
  write_angular_velocities(out);
  write_lagrangian(out);
  write_virtual_work(out);
  if (equations.system->constrained()) write_constraints(out);
  for (std::size_t i = 0; i < equations.system->coordinates.size(); ++i) write_row(out, i, derivation);
  if (equations.system->constrained()) write_constraint_accelerations(out);
  if (!equations.system->coordinates.empty()) write_solved(out);
  write_reactions(out, reactions);
  return out.take();
}

}  // namespace maupertuis

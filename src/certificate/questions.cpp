#include "certificate/questions.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::certification {
namespace {

bool starts_with(const std::string& text, std::string_view prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool comes_from_matter(const EnergyTerm& term) {
  for (const std::string_view prefix : {"particle ", "motion of body ", "rotation of body ", "gravity on "})
    if (starts_with(term.origin, prefix)) return true;
  return false;
}

/// p p/|p|², which is on the unit sphere for all p, in the place of the four numbers p.
void put_on_sphere(const ExprVector& p, ExprMap& map) {
  ExprVector squares;
  for (const Expr& component : p) squares.push_back(pow(component, Rational(2)));
  const Expr norm = p[0].context().sum(squares);
  map.emplace(p[0], (Rational(2) * squares[0] - norm) / norm);
  for (std::size_t k = 1; k < 4; ++k) map.emplace(p[k], Rational(2) * p[0] * p[k] / norm);
}

/// The four coordinates of a constraint that holds on their unit sphere.
std::optional<std::array<std::size_t, 4>> unit_quaternion(const MechanicalSystem& system, const Constraint& c) {
  const std::vector<Expr> symbols = symbols_of({&c.value, 1});
  std::vector<std::size_t> found;
  ExprVector p;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    if (const Expr q = system.coordinates[i].q; std::find(symbols.begin(), symbols.end(), q) != symbols.end()) {
      found.push_back(i);
      p.push_back(q);
    }
  if (found.size() != 4 || c.level != Constraint::Level::Position) return std::nullopt;
  ExprMap on_sphere;
  put_on_sphere(p, on_sphere);
  if (zero_test(substitute(c.value, on_sphere)).verdict != Verdict::Zero) return std::nullopt;
  return std::array<std::size_t, 4>{found[0], found[1], found[2], found[3]};
}

}  // namespace

Questions::Questions(const EquationsOfMotion& equations, bool with_matrix) : system(*equations.system) {
  lagrangian = ask(system.lagrangian());
  dissipation = ask(system.dissipation_function());
  for (const AppliedForce& f : system.forces) forces.push_back({f.kind, ask(f.components), ask(f.lever), f.coordinate});
  for (const Coordinate& c : system.coordinates) {
    velocities.push_back(ask(c.velocity));
    accelerations.push_back(ask(c.acceleration));
  }
  if (!system.lagrangian_given) ask_about_matter();

  residual = ask(equations.residual);
  momenta = ask(equations.momenta);
  generalized_forces = ask(equations.generalized_forces);
  dissipative_terms = ask(equations.dissipative_terms);
  energy_function = ask(equations.energy_function);
  power = ask(equations.power);
  if (with_matrix) {
    mass_matrix = ask(maupertuis::mass_matrix(equations).entries);
    bias = ask(maupertuis::bias(equations));
  }
  ask_about_constraints(equations, with_matrix);
  // A `let` that stays a symbol in print stands for its value.
  const ExprMap definitions = system.definition_values();
  if (!definitions.empty()) roots = substitute(roots, definitions);
  asked = roots.size();
}

evaluation::Products Questions::products() const {
  evaluation::Products out;
  for (const Expr& root : roots) out.push_back({root});
  for (const ForceQuestion& f : forces)
    for (std::size_t k = 0; k < f.lever.size(); ++k) out.push_back({roots[f.components[k]], roots[f.lever[k]]});
  for (const ParticleQuestion& p : particles)  // d/dt(m ṙ)·δr and m g·δr
    for (std::size_t k = 0; k < p.position.size(); ++k) {
      out.push_back({roots[p.mass], roots[p.position[k]], roots[p.position[k]]});
      if (!gravity.empty()) out.back().push_back(roots[gravity[k]]);
    }
  for (const BodyQuestion& body : bodies) {  // ω from Ṙ Rᵀ, d/dt(R I Rᵀ ω)·δθ
    out.emplace_back();
    for (const Root root : body.inertia) out.back().push_back(roots[root]);
    for (const Root root : body.rotation) out.back().insert(out.back().end(), 2, roots[root]);
  }
  return out;
}

Questions Questions::about(std::vector<Expr> formulas) const {
  Questions out = *this;
  out.roots = std::move(formulas);
  return out;
}

void Questions::ask_about_matter() {
  Context& context = *system.context;
  for (const Point& p : system.points)
    if (p.mass) particles.push_back({ask(p.mass), ask(p.position)});
  for (const Body& b : system.bodies) {
    if (b.mass) particles.push_back({ask(b.mass), ask(b.position)});
    if (b.inertia.rows > 0)
      bodies.push_back({ask(b.inertia.entries), ask(b.rotation.entries)});  // else it turns without effort
  }
  has_matter = !particles.empty() || !bodies.empty();
  if (!has_matter) return;
  gravity = ask(system.gravity);
  ExprVector terms;
  const auto gather = [&](const std::vector<EnergyTerm>& list, int sign) {
    for (const EnergyTerm& term : list)
      if (!comes_from_matter(term)) terms.push_back(context.number(sign) * term.value);
  };
  gather(system.kinetic, 1);
  gather(system.potential, -1);
  gather(system.generalized_potential, -1);
  gather(system.lagrangian_extra, 1);
  given_energies = ask(context.sum(terms));
}

void Questions::ask_about_constraints(const EquationsOfMotion& equations, bool with_matrix) {
  if (!system.constrained()) return;
  constraint_forces = ask(equations.constraint_forces);
  ExprMatrix a;
  ExprVector b;
  if (with_matrix) {
    a = constraint_matrix(equations);
    b = constraint_bias(equations);
  }
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    const Constraint& c = system.constraints[k];
    if (const auto four = unit_quaternion(system, c); four && !bodies.empty()) unit_quaternions.push_back(*four);
    ConstraintQuestion question{c.level,
                                ask(c.value),
                                ask(c.multiplier),
                                ask(equations.constraint_rates[k]),
                                ask(equations.constraint_accelerations[k]),
                                {},
                                0};
    for (std::size_t j = 0; j < a.columns; ++j) question.row.push_back(ask(a.at(k, j)));
    if (with_matrix) question.bias = ask(b[k]);
    constraints.push_back(std::move(question));
  }
}

const Body* Questions::body_without_rotation() const {
  ExprMap on_sphere;
  for (const std::array<std::size_t, 4>& four : unit_quaternions) {
    ExprVector p;
    for (const std::size_t i : four) p.push_back(system.coordinates[i].q);
    put_on_sphere(p, on_sphere);
  }
  for (const Body& body : system.bodies) {
    const ExprMatrix& r = body.rotation;
    ExprVector differences;  // R Rᵀ − 1
    for (std::size_t i = 0; i < r.rows; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        ExprVector terms{system.context->number(i == j ? -1 : 0)};
        for (std::size_t k = 0; k < r.columns; ++k) terms.push_back(r.at(i, k) * r.at(j, k));
        differences.push_back(substitute(system.context->sum(terms), on_sphere));
      }
    if (zero_test(differences).verdict == Verdict::Nonzero) return &body;
  }
  return nullptr;
}

Root Questions::ask(Expr e) {
  roots.push_back(e);
  return roots.size() - 1;
}

Roots Questions::ask(const ExprVector& list) {
  Roots out;
  for (const Expr& e : list) out.push_back(ask(e));
  return out;
}

}  // namespace maupertuis::certification

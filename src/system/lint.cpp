#include "system/lint.hpp"

#include <maupertuis/print.hpp>

#include <cmath>

namespace maupertuis {
namespace lint_rules {
namespace {

/// A number in (0, 1) that looks random and is the same in every run.
double scattered(std::size_t index, int attempt) {
  const double golden = 0.6180339887498949;
  const double x = static_cast<double>(index + 1) * golden + 0.37 * attempt;
  return x - std::floor(x);
}

/// An integral constraint makes L + λ G of L; any λ shows what it does to the mass matrix.
Expr multiplier_of_integral(const MechanicalSystem& s, std::size_t k) {
  return s.context->symbol("λ of integral " + std::to_string(k + 1), Role::Auxiliary);
}

Expr with_held_integrals(const MechanicalSystem& s) {
  ExprVector terms = {s.lagrangian()};
  for (std::size_t k = 0; k < s.integral_constraints.size(); ++k)
    terms.push_back(multiplier_of_integral(s, k) * s.integral_constraints[k].integrand);
  return s.context->sum(terms);
}

}  // namespace

Subject::Subject(const Model& m, const SourceText& text, Diagnostics& d)
    : model(m),
      system(m.system),
      source(text),
      diagnostics(d),
      lagrangian(expand_time_derivatives(with_held_integrals(m.system))) {
  for (const Parameter& p : system.parameters) order.parameters.push_back(p.symbol);
  for (const Coordinate& c : system.coordinates) {
    order.coordinates.push_back(c.q);
    velocities.push_back(c.velocity);
  }
  momenta = gradient(lagrangian, velocities);
}

std::string Subject::show(Expr e) const {
  const Expr expanded = expand(expand_time_derivatives(e), 200);
  if (!expanded) return {};
  const std::string text = to_plain(readable(expanded, order).value, order);
  return text.size() <= 120 ? text : std::string();
}

Bindings sample(const Subject& s, int attempt) {
  Bindings b;
  for (const Parameter& p : s.system.parameters) b[p.symbol] = p.si_value;
  const double scale = attempt % 3 == 0 ? 1 : attempt % 3 == 1 ? 0.1 : 0.01;
  for (std::size_t i = 0; i < s.freedoms(); ++i) {
    b[s.system.coordinates[i].q] = scale * (0.3 + 0.8 * scattered(2 * i, attempt));
    b[s.velocities[i]] = 0.1 * scale * scattered(2 * i + 1, attempt);
  }
  for (const StartValue& v : s.model.experiment.start) {
    const Coordinate& c = s.system.coordinates[v.coordinate];
    if (v.order == 0) b[c.q] += evaluate(v.value, b);
  }
  Context& context = *s.system.context;
  b[context.time()] = 0.3 + 0.4 * scattered(7, attempt);
  for (std::size_t k = 0; k < s.system.integral_constraints.size(); ++k)
    b[multiplier_of_integral(s.system, k)] = 0.5 + scattered(k, attempt);
  for (const Input& u : s.system.inputs) {
    b[u.symbol] = 0.5;
    for (int order = 1; order <= 4; ++order) b[context.symbol(u.name, Role::Input, order)] = std::ldexp(0.5, -order);
  }
  return b;
}

}  // namespace lint_rules

void lint(const Model& model, const SourceText& source, Diagnostics& diagnostics) {
  if (model.system.coordinates.empty()) return;
  lint_rules::Subject subject(model, source, diagnostics);
  const bool contested = lint_rules::claims(subject);  // the mass matrix may be another one than is meant
  const auto unused = lint_rules::unused_coordinates(subject);
  if (!contested && !lint_rules::mass_matrix_rules(subject, unused)) lint_rules::quaternion_norms(subject);
  lint_rules::values(subject);
  lint_rules::total_derivatives(subject);
  lint_rules::gravity_twice(subject);
  lint_rules::parts_twice(subject);
  lint_rules::energies_without_velocity(subject);
  lint_rules::negative_dissipation(subject);
  lint_rules::names_printed_alike(subject);
  lint_rules::jumps(subject);
  diagnostics.sort_by_place();
}

}  // namespace maupertuis

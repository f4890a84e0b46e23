#include <maupertuis/jacobian.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

Expr sum_of_terms(const std::vector<EnergyTerm>& terms, Context& context) {
  ExprVector values;
  for (const EnergyTerm& t : terms) values.push_back(t.value);
  return sum_of(values, context);
}

template <typename Items>
auto find_by_name(const Items& items, std::string_view name) -> const typename Items::value_type* {
  for (const auto& item : items)
    if (item.name == name) return &item;
  return nullptr;
}

}  // namespace

std::string MechanicalSystem::independent_unit() const {
  // Of models without units as well: seconds are what t is called everywhere.
  if (independent == "t" && (dimensionless || independent_dimension.same_as(dimensions::time()))) return "s";
  const std::string unit = to_string(independent_dimension);
  return unit == "1" ? std::string() : unit;
}

std::string MechanicalSystem::moment(const std::string& number) const {
  const std::string unit = independent_unit();
  return independent + " = " + number + (unit.empty() ? "" : " " + unit);
}

bool StartCondition::is_of_positions() const {
  const std::vector<Expr> held = symbols_of({&formula, 1});
  return std::none_of(held.begin(), held.end(),
                      [](const Expr& s) { return s.role() == Role::Coordinate && s.order() > 0; });
}

Expr MechanicalSystem::kinetic_energy() const { return sum_of_terms(kinetic, *context); }
Expr MechanicalSystem::potential_energy() const { return sum_of_terms(potential, *context); }
Expr MechanicalSystem::total_generalized_potential() const { return sum_of_terms(generalized_potential, *context); }
Expr MechanicalSystem::dissipation_function() const { return sum_of_terms(dissipation, *context); }

Expr MechanicalSystem::lagrangian() const {
  const Expr extra = sum_of_terms(lagrangian_extra, *context);
  if (lagrangian_given) return lagrangian_given->value + extra;
  return sum_of({kinetic_energy(), -potential_energy(), -total_generalized_potential(), extra});
}

ExprVector MechanicalSystem::generalized_forces() const {
  ExprVector q, velocities;
  for (const Coordinate& c : coordinates) {
    q.push_back(c.q);
    velocities.push_back(c.velocity);
  }
  const SparseGradient by_q(q), by_velocities(velocities);
  std::vector<ExprVector> terms(coordinates.size());
  for (const AppliedForce& f : forces) {
    if (f.kind == AppliedForce::Kind::Generalized) {
      terms[f.coordinate].push_back(f.components.front());
      continue;
    }
    const ExprVector lever = expand_time_derivatives(f.lever);
    for (std::size_t k = 0; k < lever.size(); ++k) {
      for (const auto& [i, arm] : (f.kind == AppliedForce::Kind::OnPoint ? by_q : by_velocities)(lever[k]))
        terms[i].push_back(f.components[k] * arm);
    }
  }
  ExprVector out;
  for (const ExprVector& t : terms) out.push_back(sum_of(t, *context));
  return expand_time_derivatives(out);
}

std::unordered_map<Expr, Expr, ExprHash> MechanicalSystem::definition_values() const {
  std::unordered_map<Expr, Expr, ExprHash> out;
  for (const Definition& d : definitions)
    if (d.symbol) out.emplace(d.symbol, d.value);
  return out;
}

const Coordinate* MechanicalSystem::find_coordinate(std::string_view name) const {
  return find_by_name(coordinates, name);
}
const Parameter* MechanicalSystem::find_parameter(std::string_view name) const {
  return find_by_name(parameters, name);
}
const Point* MechanicalSystem::find_point(std::string_view name) const { return find_by_name(points, name); }
const Body* MechanicalSystem::find_body(std::string_view name) const { return find_by_name(bodies, name); }
const Constraint* MechanicalSystem::find_constraint(std::string_view name) const {
  return find_by_name(constraints, name);
}

Constraint as_constraint(const Contact& contact) {
  Constraint c;
  c.name = contact.name;
  c.value = contact.gap;
  c.multiplier = contact.multiplier;
  c.reaction = contact.reaction;
  c.dimension = contact.dimension;
  c.span = contact.span;
  return c;
}

std::string MechanicalSystem::contact_label(std::size_t index) const {
  return contacts[index].name.empty() ? "contact " + std::to_string(index + 1) : contacts[index].name;
}

std::string MechanicalSystem::constraint_label(std::size_t index) const {
  const Constraint& c = constraints[index];
  if (!c.body.empty()) return "the norm of " + c.body;
  return c.name.empty() ? "constraint " + std::to_string(index + 1) : c.name;
}

}  // namespace maupertuis

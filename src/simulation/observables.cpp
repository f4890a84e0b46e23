#include "simulation/observables.hpp"

#include "simulation/energy_terms.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/momentum.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace maupertuis {
namespace {

void add_reactions(Observables& out, const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const Dimension& energy = system.lagrangian_dimension;
  const auto add = [&](std::string name, const Dimension& dimension, Expr value) {
    out.expressions.push_back(value);
    out.reactions.push_back({std::move(name), dimension});
  };
  for (const Constraint& c : system.constraints)
    if (c.name.empty() && c.body.empty())
      add(c.multiplier.name(),
          (c.level == Constraint::Level::Position ? energy : energy / system.independent_dimension) / c.dimension,
          c.multiplier);
  const auto find_contact = [&](const std::string& name) {
    return std::any_of(system.contacts.begin(), system.contacts.end(),
                       [&](const Contact& c) { return c.name == name && !name.empty(); });
  };
  const bool named = !system.releases.empty() || !system.contacts.empty() ||
                     std::any_of(system.constraints.begin(), system.constraints.end(),
                                 [](const Constraint& c) { return !c.name.empty() && !c.forceless; });
  if (!named) return;
  for (const Reaction& r : reactions(equations)) {
    const Constraint* constraint = system.find_constraint(r.name);
    if (constraint && constraint->forceless) continue;
    const bool released = r.kind == Reaction::Kind::Released;
    if (r.value && (released || constraint || find_contact(r.name)))
      add("reaction(" + r.name + ")", r.dimension, r.value);
  }
}

/// λ_t of each friction with one slip component; HybridMotion puts in what it is where it slides.
void add_frictions(Observables& out, const MechanicalSystem& system) {
  const auto add = [&](const Friction& f, const Dimension& dimension) {
    if (f.name.empty() || f.slip.size() != 1) return;
    out.expressions.push_back(f.multipliers[0]);
    out.reactions.push_back({"friction(" + f.name + ")", dimension});
  };
  for (const Contact& c : system.contacts) add(c.friction, dimensions::force());
  for (const Friction& f : system.frictions)
    for (const Coordinate& c : system.coordinates)
      if (c.name == f.name) add(f, system.lagrangian_dimension / c.dimension);
}

/// A release that the model does not determine has a symbol that no equation holds.
bool is_in_equations(const EquationsOfMotion& equations, Expr formula) {
  const MechanicalSystem& system = *equations.system;
  ExprVector forces = equations.multipliers;
  for (const Contact& c : system.contacts) {
    forces.push_back(c.multiplier);
    forces.insert(forces.end(), c.friction.multipliers.begin(), c.friction.multipliers.end());
  }
  for (const Friction& f : system.frictions) forces.insert(forces.end(), f.multipliers.begin(), f.multipliers.end());
  const std::vector<Expr> symbols = symbols_of({&formula, 1});
  return std::all_of(symbols.begin(), symbols.end(), [&](const Expr& s) {
    return s.role() != Role::Multiplier || std::find(forces.begin(), forces.end(), s) != forces.end();
  });
}

void add_asked(Observables& out, const EquationsOfMotion& equations, std::span<const AskedFormula> asked) {
  ExprMap momenta;
  for (std::size_t i = 0; i < equations.momenta.size(); ++i)
    momenta.emplace(momentum_symbol(*equations.system, i), equations.momenta[i]);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Expr of_state = substitute(asked[i].value, momenta);
    const Expr value = with_reactions(equations, {&of_state, 1}).front();
    if (!is_in_equations(equations, value)) continue;
    out.expressions.push_back(value);
    out.asked.push_back({asked_column(i), asked[i].dimension});
  }
}

void find_dependences(Observables& out, const EquationsOfMotion& equations) {
  const auto& multipliers = equations.multipliers;
  if (multipliers.empty()) return;
  for (std::size_t i = out.energy_terms + out.points; i < out.expressions.size(); ++i)
    for (const Expr& symbol : symbols_of({&out.expressions[i], 1})) {
      const auto found = std::find(multipliers.begin(), multipliers.end(), symbol);
      if (found != multipliers.end())
        out.dependences.push_back({i, static_cast<std::size_t>(found - multipliers.begin())});
    }
}

bool knows_velocity(Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [](const Expr& s) { return s.role() == Role::Coordinate && s.order() > 0; });
}

}  // namespace

Observables collect_observables(const EquationsOfMotion& equations, const Probe* probe,
                                std::span<const AskedFormula> asked) {
  Observables out;
  out.expressions = energy_terms(equations);
  out.energy_terms = out.expressions.size();
  for (const Expr& term : out.expressions) out.of_places.push_back(!knows_velocity(term));
  for (const Point& point : equations.system->points)
    out.expressions.insert(out.expressions.end(), point.position.begin(), point.position.end());
  out.points = out.expressions.size() - out.energy_terms;
  add_reactions(out, equations);
  add_frictions(out, *equations.system);
  add_asked(out, equations, asked);
  if (probe) {
    const std::vector<Expr> wanted = with_reactions(equations, probe->expressions);
    out.expressions.insert(out.expressions.end(), wanted.begin(), wanted.end());
    out.probes = wanted.size();
  }
  find_dependences(out, equations);
  return out;
}

void append_row(std::vector<double>& values, const Sample& sample, const Observables& observables) {
  values.insert(values.end(), sample.q.begin(), sample.q.end());
  values.insert(values.end(), sample.v.begin(), sample.v.end());
  const auto energies = sample.observables.begin() + static_cast<std::ptrdiff_t>(observables.energy_terms);
  const std::size_t shown = observables.points + observables.reactions.size() + observables.asked.size();
  values.insert(values.end(), energies, energies + static_cast<std::ptrdiff_t>(shown));
  values.push_back(std::accumulate(sample.observables.begin(), energies, 0.0));
}

void leave_out_undetermined(Sample& sample, const Observables& observables) {
  for (const Observables::Dependence& d : observables.dependences)
    if (std::isnan(sample.multipliers[d.constraint]))
      sample.observables[d.observable] = std::numeric_limits<double>::quiet_NaN();
}

void name_trajectory_columns(const MechanicalSystem& system, const Observables& observables,
                             std::vector<Trajectory::Column>& columns, std::vector<Trajectory::Column>& reactions) {
  const auto unit = [&](const Dimension& d) { return system.dimensionless ? std::string() : to_string(d); };
  for (const Coordinate& c : system.coordinates) columns.push_back({c.name, unit(c.dimension)});
  for (const Coordinate& c : system.coordinates)
    columns.push_back({c.name + "'", unit(c.dimension / system.independent_dimension)});
  for (const Point& p : system.points)
    for (std::size_t axis = 0; axis < p.position.size(); ++axis)
      columns.push_back({p.name + "." + "xyz"[axis], unit(dimensions::length())});
  for (const Observables::Named& r : observables.reactions) {
    // The unit of a torque is that of an energy, but nobody reads it so.
    const bool torque = r.dimension == dimensions::energy() && !system.dimensionless;
    reactions.push_back({r.name, torque ? "N m" : unit(r.dimension)});
    columns.push_back(reactions.back());
  }
  for (const Observables::Named& a : observables.asked) columns.push_back({a.name, unit(a.dimension)});
  columns.push_back({"energy", unit(system.lagrangian_dimension)});
}

}  // namespace maupertuis

#include <maupertuis/evaluate.hpp>
#include <maupertuis/normal_force.hpp>
#include <maupertuis/reactions.hpp>

#include "equations/distance_constraints.hpp"
#include "equations/released.hpp"
#include "equations/simplified.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace maupertuis {
namespace {

/// A constraint, its row of A, and the coordinates that it ties.
struct Tie {
  const MechanicalSystem& system;
  const Rods& rods;
  const Constraint& constraint;
  ExprVector row;  // [n]
  std::vector<std::size_t> coordinates;

  Context& context() const { return *system.context; }
  const Coordinate& coordinate(std::size_t k) const { return system.coordinates[coordinates[k]]; }
  bool all_of(const Dimension& dimension) const {
    return std::all_of(coordinates.begin(), coordinates.end(), [&](std::size_t i) {
      const Dimension& own = system.coordinates[i].dimension;
      return own.same_as(dimension) && own.angle() == dimension.angle();
    });
  }
};

Dimension dimension_of_multiplier(const MechanicalSystem& s, const Constraint& c) {
  const Dimension& energy = s.lagrangian_dimension;
  return (c.level == Constraint::Level::Position ? energy : energy / s.independent_dimension) / c.dimension;
}

bool is_power_of_length(Dimension d) {
  if (d.is_one()) return false;
  d.exponents[Dimension::Length] = {};
  return d.is_one();
}

/// A force or a torque: as the unit of λ, the coordinates that are tied, and the unit of φ say.
Dimension dimension_of_reaction(const Tie& tie) {
  if (tie.system.dimensionless) return {};
  const Dimension multiplier = dimension_of_multiplier(tie.system, tie.constraint);
  if (tie.all_of(dimensions::length()) || multiplier.same_as(dimensions::force())) return dimensions::force();
  if (tie.all_of(dimensions::angle()) && multiplier.same_as(dimensions::torque())) return dimensions::torque();
  return is_power_of_length(tie.constraint.dimension) ? dimensions::force() : dimensions::torque();
}

ExprVector scaled(const ExprVector& v, Expr factor) {
  ExprVector out;
  for (const Expr& component : v) out.push_back(factor * component);
  return out;
}

// --------------------------------------------------------------------------------------------------- a rod

/// −λ dφ/dd = −2 λ d dφ/d(d²); the force on the far end is λ ∂φ/∂r = 2 λ dφ/d(d²) (r − r₀).
bool as_tension(const Tie& tie, Reaction& r) {
  if (!tie.system.dimensionless && !dimensions::force().same_as(r.dimension)) return false;
  const auto rod = tie.rods.find(tie.constraint);
  if (!rod) return false;
  const Expr push = Rational(2) * tie.constraint.multiplier * rod->slope;
  r.kind = Reaction::Kind::Tension;
  r.value = -(push * rod->distance);
  ExprVector arm;
  for (std::size_t k = 0; k < rod->to.position.size(); ++k) arm.push_back(rod->to.position[k] - rod->from.position[k]);
  r.arrows.push_back({rod->to.name, rod->to.position, scaled(arm, push)});
  if (!rod->from.fixed) r.arrows.push_back({rod->from.name, rod->from.position, scaled(arm, -push)});
  r.sentence =
      fmt::format("the tension in {}, positive when it pulls {} and {} together, negative when it pushes them apart",
                  tie.constraint.name.empty() ? "the connection" : tie.constraint.name, rod->from.name, rod->to.name);
  return true;
}

// --------------------------------------------------------------------------------------- a force on one point

struct Place {
  const std::string* name;
  const ExprVector* position;
};

/// The only massive point or body whose position depends on the coordinates tied.
std::optional<Place> only_place(const Tie& tie) {
  std::vector<Place> places;
  const auto consider = [&](const std::string& name, const ExprVector& position) {
    const auto symbols = symbols_of(position);
    const bool depends = std::any_of(tie.coordinates.begin(), tie.coordinates.end(), [&](std::size_t i) {
      return std::find(symbols.begin(), symbols.end(), tie.system.coordinates[i].q) != symbols.end();
    });
    if (depends) places.push_back({&name, &position});
  };
  for (const Point& p : tie.system.points)
    if (p.mass) consider(p.name, p.position);
  for (const Body& b : tie.system.bodies) consider(b.name, b.position);
  return places.size() == 1 ? std::optional(places[0]) : std::nullopt;
}

/// F with F·∂r/∂q_i = λ A_i for all i, where the tied coordinates are Cartesian ones of one point.
bool as_contact(const Tie& tie, Reaction& r) {
  const auto place = only_place(tie);
  if (!place) return false;
  const ExprVector& position = *place->position;
  ExprVector direction(position.size(), tie.context().number(0));  // F/λ
  for (const std::size_t i : tie.coordinates)
    for (std::size_t k = 0; k < position.size(); ++k)
      direction[k] = direction[k] + tie.row[i] * differentiate(position[k], tie.system.coordinates[i].q);
  for (std::size_t i = 0; i < tie.row.size(); ++i) {
    ExprVector work{-tie.row[i]};
    for (std::size_t k = 0; k < position.size(); ++k)
      work.push_back(direction[k] * differentiate(position[k], tie.system.coordinates[i].q));
    if (!vanishes_identically(tie.context().sum(work))) return false;
  }
  for (const Body& b : tie.system.bodies)  // a coordinate that also turns a body takes part of the force as a torque
    for (const std::size_t i : tie.coordinates)
      for (const Expr& entry : b.rotation.entries)
        if (!vanishes_identically(differentiate(entry, tie.system.coordinates[i].q))) return false;
  ExprVector squares;
  for (const Expr& component : direction) squares.push_back(pow(component, Rational(2)));
  r.kind = Reaction::Kind::Contact;
  r.value = tie.constraint.multiplier * sqrt(simplified(tie.context().sum(squares)));
  r.arrows.push_back({*place->name, position, scaled(direction, tie.constraint.multiplier)});
  r.sentence = fmt::format(
      "the force on {} along the normal of the constraint, positive towards increasing left − right", *place->name);
  return true;
}

// ------------------------------------------------------------------------------------------------------ the rest

std::string word_of(const Dimension& d) {
  return d.same_as(dimensions::force()) ? "force" : d.same_as(dimensions::torque()) ? "torque" : "force of constraint";
}

void as_multiplier(const Tie& tie, Reaction& r) {
  const std::string what = tie.system.dimensionless ? "force of constraint" : word_of(r.dimension);
  r.kind = Reaction::Kind::Multiplier;
  r.value = tie.constraint.multiplier;
  r.sentence = fmt::format("the multiplier itself, a {}: positive towards increasing left − right", what);
  if (tie.coordinates.size() != 1) return;
  const Expr slope = tie.row[tie.coordinates[0]];
  const std::string& name = tie.coordinate(0).name;
  if (slope.is_one())
    r.sentence =
        fmt::format("the {} on {} that holds the constraint, positive towards increasing {}", what, name, name);
  else if ((-slope).is_one())
    r.sentence =
        fmt::format("the {} on {} that holds the constraint, positive towards decreasing {}", what, name, name);
}

/// λ |∂φ/∂q| over the coordinates whose generalized force has the unit.
void as_generalized(const Tie& tie, Reaction& r) {
  const bool force = r.dimension.same_as(dimensions::force());
  ExprVector squares;
  std::vector<std::string> names;
  for (const std::size_t i : tie.coordinates) {
    const Coordinate& c = tie.system.coordinates[i];
    if (!(dimensions::energy() / c.dimension).same_as(r.dimension)) continue;
    squares.push_back(pow(tie.row[i], Rational(2)));
    names.push_back(c.name);
  }
  if (names.empty()) {
    r.sentence = fmt::format("none of the coordinates that the constraint ties takes a {}", word_of(r.dimension));
    return;
  }
  r.kind = Reaction::Kind::Generalized;
  r.value = tie.constraint.multiplier * sqrt(simplified(tie.context().sum(squares)));
  r.sentence = fmt::format("the size of the generalized {} λ ∂φ/∂q over {}, positive towards increasing left − right",
                           force ? "force" : "torque", fmt::join(names, ", "));
}

/// It presses, or a string pulls, whatever the sense of its gap: never negative.
Reaction reaction_of_contact(const Tie& tie, const Contact& contact) {
  Reaction r;
  r.name = tie.constraint.name;
  r.symbol = tie.constraint.reaction;
  r.dimension = dimension_of_reaction(tie);
  const bool force = dimensions::force().same_as(r.dimension) || tie.system.dimensionless;
  if (!force || !as_contact(tie, r)) {
    if (tie.system.dimensionless || dimension_of_multiplier(tie.system, tie.constraint).same_as(r.dimension))
      as_multiplier(tie, r);
    else
      as_generalized(tie, r);
  }
  // As friction takes it.
  if (const Expr factor = force ? normal_force_per_multiplier(tie.system, contact) : Expr())
    r.value = tie.constraint.multiplier * simplified(factor);
  r.sentence = "the force of the contact, which is 0 while it is open and positive while it presses";
  return r;
}

Reaction reaction_of(const Tie& tie, std::string label) {
  Reaction r;
  r.name = std::move(label);
  r.symbol = tie.constraint.reaction;
  r.dimension = dimension_of_reaction(tie);
  if (!tie.constraint.body.empty()) {
    r.value = tie.constraint.multiplier;
    r.sentence = fmt::format("no force: the multiplier keeps the four numbers that turn {} on the unit sphere",
                             tie.constraint.body);
    return r;
  }
  if (as_tension(tie, r)) return r;
  if (dimensions::force().same_as(r.dimension) || tie.system.dimensionless)
    if (as_contact(tie, r)) return r;
  const bool own_unit =
      tie.system.dimensionless || dimension_of_multiplier(tie.system, tie.constraint).same_as(r.dimension);
  if (own_unit)
    as_multiplier(tie, r);
  else
    as_generalized(tie, r);
  return r;
}

Reaction reaction_of(const EquationsOfMotion& equations, const Release& release) {
  const MechanicalSystem& system = *equations.system;
  const Parameter& parameter = system.parameters[release.parameter];
  Reaction r;
  r.kind = Reaction::Kind::Released;
  r.name = release.name;
  r.symbol = release.reaction;
  HoldingForce held = holding_force(equations, parameter);
  const bool length = parameter.dimension.same_as(dimensions::length()) || system.dimensionless;
  if (!system.dimensionless) r.dimension = dimensions::energy() / parameter.dimension;
  r.value = held.value && length ? -held.value : held.value;
  r.sentence =
      !held.value ? held.reason
      : length
          ? fmt::format("the tension that holds {}, positive when it resists an increase of {}, as in a pulled rod",
                        parameter.name, parameter.name)
          : fmt::format("the {} that holds {}, positive along increasing {}", word_of(r.dimension), parameter.name,
                        parameter.name);
  return r;
}

}  // namespace

std::vector<Reaction> reactions(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  std::vector<Reaction> all;
  const ExprMatrix a = constraint_matrix(equations);
  const Rods rods(system);
  for (std::size_t k = 0; k < system.constraints.size(); ++k) {
    Tie tie{system, rods, system.constraints[k], {}, {}};
    for (std::size_t i = 0; i < a.columns; ++i) {
      tie.row.push_back(a.at(k, i));
      if (!a.at(k, i).is_zero()) tie.coordinates.push_back(i);
    }
    all.push_back(reaction_of(tie, system.constraint_label(k)));
  }
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    if (system.contacts[k].name.empty()) continue;
    const Constraint closed = as_constraint(system.contacts[k]);
    Tie tie{system, rods, closed, {}, {}};
    const std::vector<Expr> named = symbols_of({&closed.value, 1});  // few of many bodies
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      const Expr q = system.coordinates[i].q;
      const bool is_named = std::find(named.begin(), named.end(), q) != named.end();
      tie.row.push_back(is_named ? differentiate(closed.value, q) : system.context->number(0));
      if (!tie.row[i].is_zero()) tie.coordinates.push_back(i);
    }
    all.push_back(reaction_of_contact(tie, system.contacts[k]));
  }
  for (const Release& release : system.releases) all.push_back(reaction_of(equations, release));
  return all;
}

}  // namespace maupertuis

#include "drawing/coordinate_forces.hpp"

#include <fmt/format.h>

#include <algorithm>

/// Where a force on a coordinate is seen. A place r gets F = Q e/|e|², with e = ∂r/∂q, where F does no work at other
/// coordinates; what a coordinate turns about a place of the plane gets the torque Q about it.
namespace maupertuis::drawing {
namespace {

using Origin = Drawing::ForceOrigin;

/// A point, a body or a frame.
struct Thing {
  std::string name;
  ExprVector place;
  ExprMatrix rotation;  // to the world; empty of a point
};

/// What has mass; everything that is marked, where a model gives its energies as formulas.
std::vector<Thing> things_of(const MechanicalSystem& system) {
  std::vector<Thing> heavy, all;
  for (const Point& p : system.points) {
    all.push_back({p.name, p.position, {}});
    if (p.mass) heavy.push_back(all.back());
  }
  for (const Body& b : system.bodies) heavy.push_back({b.name, b.position, b.rotation});
  if (!heavy.empty()) return heavy;
  for (const Frame& f : system.frames) all.push_back({f.name, f.origin, f.rotation});
  return all;
}

Expr slope(Expr e, Expr q) { return differentiate(expand_time_derivatives(e), q); }

ExprVector slopes(const ExprVector& place, Expr q) {
  ExprVector out;
  for (const Expr& x : place) out.push_back(slope(x, q));
  return out;
}

bool vanish(const ExprVector& v) {
  return std::all_of(v.begin(), v.end(), [](Expr e) { return vanishes_identically(e); });
}

Expr product(Context& context, const ExprVector& a, const ExprVector& b) {
  ExprVector terms;
  for (std::size_t k = 0; k < a.size(); ++k) terms.push_back(a[k] * b[k]);
  return context.sum(terms);
}

/// A thing that moves with the coordinate.
struct Moved {
  const Thing* thing;
  ExprVector by;  // ∂r/∂q
};

/// One coordinate: what it moves, and where a force on it is seen.
class Mover {
 public:
  Mover(const MechanicalSystem& system, const std::vector<Thing>& things, std::size_t coordinate)
      : system_(system), q_(system.coordinates[coordinate].q) {
    for (const Thing& thing : things)
      if (ExprVector by = slopes(thing.place, q_); !vanish(by) || turns(thing)) moved_.push_back({&thing, by});
  }

  /// Empty where no single arrow does what Q does.
  std::optional<Outline> shown(Expr force, Origin origin) const {
    if (auto torque = as_torque(force, origin)) return torque;
    for (const bool alone : {true, false})
      for (const Moved& m : moved_)
        if (!vanish(m.by) && works_here_only(m, alone)) return as_force(m, force, origin);
    return std::nullopt;
  }

 private:
  bool turns(const Thing& thing) const {
    for (std::size_t k = 0; k < thing.rotation.rows; ++k)
      for (std::size_t j = 0; j < thing.rotation.columns; ++j)
        if (!vanishes_identically(slope(thing.rotation.at(k, j), q_))) return true;
    return false;
  }

  /// Whether a force along ∂r/∂q does no work where another coordinate changes; `alone`: whether these do not even
  /// move the place.
  bool works_here_only(const Moved& m, bool alone) const {
    return std::all_of(system_.coordinates.begin(), system_.coordinates.end(), [&](const Coordinate& other) {
      if (other.q == q_) return true;
      const ExprVector by = slopes(m.thing->place, other.q);
      return alone ? vanish(by) : vanishes_identically(product(*system_.context, m.by, by));
    });
  }

  Outline as_force(const Moved& m, Expr force, Origin origin) const {
    const Expr along = force / product(*system_.context, m.by, m.by);
    ExprVector components;
    for (const Expr& e : m.by) components.push_back(along * e);
    return arrow_of(m.thing->place, components, origin, m.thing->name);
  }

  /// Where the coordinate turns all that it moves about one place of the plane, by as much as it grows.
  std::optional<Outline> as_torque(Expr force, Origin origin) const {
    if (system_.space_dimension != 2 || moved_.empty()) return std::nullopt;
    for (const int way : {1, -1})
      if (const ExprVector centre = centre_of_turning(way); !centre.empty())
        return torque_about(centre, {Rational(way) * force}, origin, moved_.front().thing->name);
    return std::nullopt;
  }

  /// C with ∂r/∂q = ± ẑ × (r − C) of everything that moves, which stays where it is as q grows; empty where there is
  /// none.
  ExprVector centre_of_turning(int way) const {
    ExprVector centre;
    for (const Moved& m : moved_) {
      const ExprVector own{m.thing->place[0] - Rational(way) * m.by[1], m.thing->place[1] + Rational(way) * m.by[0]};
      if (centre.empty()) centre = own;
      for (std::size_t k = 0; k < 2; ++k)
        if (!vanishes_identically(own[k] - centre[k]) || !vanishes_identically(slope(own[k], q_))) return {};
      if (!turned_by(*m.thing, way)) return {};
    }
    return centre;
  }

  /// Whether a body turns by as much as the coordinate grows: ∂R/∂q = ± J R.
  bool turned_by(const Thing& thing, int way) const {
    if (thing.rotation.rows == 0) return true;
    return vanishes_identically(slope(thing.rotation.at(0, 0), q_) + Rational(way) * thing.rotation.at(1, 0)) &&
           vanishes_identically(slope(thing.rotation.at(1, 0), q_) - Rational(way) * thing.rotation.at(0, 0));
  }

  const MechanicalSystem& system_;
  Expr q_;
  std::vector<Moved> moved_;
};

/// A force on a coordinate, and what a reader calls it.
struct OnCoordinate {
  std::size_t coordinate;
  Expr force;
  Origin origin;
  std::string name;
};

bool is_of_formula(const EnergyTerm& t) { return t.origin == "V" || t.origin == "D"; }
bool is_torsion(const EnergyTerm& t) { return t.origin.rfind("torsion spring ", 0) == 0; }

/// −∂V/∂q of torsion springs and of V = …, −∂D/∂q̇ of D = …, and `force q = …`.
std::vector<OnCoordinate> forces_on_coordinates(const MechanicalSystem& system) {
  std::vector<OnCoordinate> out;
  const auto add = [&](const EnergyTerm& t, Origin origin, bool of_velocities) {
    const Expr energy = expand_time_derivatives(t.value);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      const Coordinate& c = system.coordinates[i];
      const Expr force = -differentiate(energy, of_velocities ? c.velocity : c.q);
      if (vanishes_identically(force)) continue;
      out.push_back({i, force, origin, is_torsion(t) ? t.origin : fmt::format("{} on {}", t.origin, c.name)});
    }
  };
  for (const EnergyTerm& t : system.potential)
    if (!system.lagrangian_given && (is_torsion(t) || is_of_formula(t)))
      add(t, is_torsion(t) ? Origin::Spring : Origin::Potential, false);
  for (const EnergyTerm& t : system.dissipation)
    if (is_of_formula(t)) add(t, Origin::Damper, true);
  for (const AppliedForce& f : system.forces)
    if (f.kind == AppliedForce::Kind::Generalized && !f.components[0].is_zero())
      out.push_back({f.coordinate, f.components[0], Origin::Applied, "force " + f.target});
  return out;
}

/// Forces of one origin at one place are one arrow.
void add_to(std::vector<Outline>& arrows, Outline arrow) {
  const auto same = std::find_if(arrows.begin(), arrows.end(), [&](const Outline& o) {
    return o.placement == Outline::Placement::Force && arrow.placement == o.placement &&
           o.element.origin == arrow.element.origin && o.element.names == arrow.element.names;
  });
  if (same == arrows.end()) return arrows.push_back(std::move(arrow));
  for (std::size_t k = arrow.values.size() / 2; k < arrow.values.size(); ++k)
    same->values[k] = same->values[k] + arrow.values[k];
}

}  // namespace

void add_forces_on_coordinates(const MechanicalSystem& system, Plan& plan) {
  const std::vector<Thing> things = things_of(system);
  std::vector<Outline> arrows;
  for (const OnCoordinate& f : forces_on_coordinates(system)) {
    auto shown = Mover(system, things, f.coordinate).shown(f.force, f.origin);
    if (shown)
      add_to(arrows, *std::move(shown));
    else
      plan.unplaced.push_back(f.name);
  }
  if (!system.lagrangian_given && !system.generalized_potential.empty()) plan.unplaced.push_back("U");
  if (system.lagrangian_given) plan.unplaced.push_back("L");
  for (Outline& arrow : arrows) plan.outlines.push_back(std::move(arrow));
}

}  // namespace maupertuis::drawing

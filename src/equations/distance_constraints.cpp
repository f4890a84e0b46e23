#include "equations/distance_constraints.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "equations/simplified.hpp"

#include <algorithm>
#include <set>

namespace maupertuis {
namespace {

bool moves(const ExprVector& position) {
  for (const Expr& s : symbols_of(position))
    if (s.role() == Role::Coordinate || s.role() == Role::Time || s.role() == Role::Input) return true;
  return false;
}

/// Points and bodies, then the origin if no point without motion is there already.
std::vector<RodEnd> places_of(const MechanicalSystem& system) {
  std::vector<RodEnd> places;
  const auto add = [&](const std::string& name, const ExprVector& position) {
    if (!position.empty()) places.push_back({name, position, !moves(position)});
  };
  for (const Point& p : system.points) add(p.name, p.position);
  for (const Body& b : system.bodies) add(b.name, b.position);
  if (!system.find_point("O"))
    add("O", ExprVector(static_cast<std::size_t>(system.space_dimension), system.context->number(0)));
  return places;
}

std::set<NodeId> coordinates_in(std::span<const Expr> roots) {
  std::set<NodeId> found;
  for (const Expr& s : symbols_of(roots))
    if (s.role() == Role::Coordinate) found.insert(s.id());
  return found;
}

ExprVector difference(const ExprVector& a, const ExprVector& b) {
  ExprVector out;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Expr plain = a[k] - b[k], flat = expand(plain);  // what both places share cancels
    out.push_back(flat ? flat : plain);
  }
  return out;
}

/// Along one coordinate everything is parallel: only a place that turns about the other is at the end of a rod.
bool turns(const ExprVector& arm, Expr q) {
  for (const Expr& component : arm) {
    const Expr slope = differentiate(component, q);
    if (!coordinates_in({&slope, 1}).empty()) return true;
  }
  return false;
}

/// d² − φ/k where that is a constant: l², of which the root is known where l is a positive parameter.
Expr constant_distance(const MechanicalSystem& system, Expr squared, Expr value, Expr slope) {
  const Expr rest = simplified(squared - value / slope);
  if (!coordinates_in({&rest, 1}).empty()) return sqrt(squared);
  const PowerOf power = split_power(rest);
  if (power.base.is_symbol() && power.exponent == Rational(2))
    for (const Parameter& p : system.parameters)
      if (p.symbol == power.base && p.si_value > 0) return p.symbol;
  return sqrt(rest);
}

std::optional<RodConstraint> between(const MechanicalSystem& system, const Constraint& c, const RodEnd& from,
                                     const RodEnd& to, const std::set<NodeId>& support) {
  const ExprVector arm = difference(to.position, from.position);
  const std::set<NodeId> reach = coordinates_in(arm);
  if (!std::includes(reach.begin(), reach.end(), support.begin(), support.end())) return std::nullopt;
  ExprVector q, others, squares;
  for (const NodeId id : reach) (support.count(id) ? q : others).push_back(system.context->node(id));
  for (const Expr& component : arm) squares.push_back(pow(component, Rational(2)));
  if (q.size() == 1 && !turns(arm, q[0])) return std::nullopt;
  const Expr squared = system.context->sum(squares);
  for (const Expr& slope : gradient(squared, others))  // the angle of polar coordinates drops out
    if (!vanishes_identically(slope)) return std::nullopt;
  const ExprVector of_phi = gradient(c.value, q), of_squared = gradient(squared, q);
  std::size_t pivot = 0;
  while (pivot < q.size() && vanishes_identically(of_squared[pivot])) ++pivot;
  if (pivot == q.size()) return std::nullopt;
  for (std::size_t i = 0; i < q.size(); ++i)
    if (i != pivot && !vanishes_identically(of_phi[i] * of_squared[pivot] - of_phi[pivot] * of_squared[i]))
      return std::nullopt;
  const Expr slope = simplified(simplified(of_phi[pivot]) / simplified(of_squared[pivot]));
  return RodConstraint{from, to, constant_distance(system, squared, c.value, slope), slope};
}

/// Whether φ is d itself or d² but for a sign and a constant, as a person writes it. A point marked halfway has a
/// distance of which φ is a function too, and there is no rod to it.
bool is_as_written(const RodConstraint& rod) {
  Context& context = rod.slope.context();
  if (vanishes_identically(rod.slope * rod.slope - context.number(1))) return true;
  ExprVector squares;
  for (const Expr& component : difference(rod.to.position, rod.from.position)) squares.push_back(component * component);
  return vanishes_identically(Rational(4) * rod.slope * rod.slope * context.sum(squares) - context.number(1));
}

}  // namespace

std::optional<RodConstraint> find_rod(const MechanicalSystem& system, const Constraint& constraint) {
  if (constraint.level != Constraint::Level::Position) return std::nullopt;
  const std::set<NodeId> support = coordinates_in({&constraint.value, 1});
  if (support.empty()) return std::nullopt;
  const std::vector<RodEnd> places = places_of(system);
  std::vector<std::set<NodeId>> reach;
  for (const RodEnd& place : places) reach.push_back(coordinates_in(place.position));
  struct Pair {
    std::size_t first, second, reach;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      std::set<NodeId> both = reach[i];
      both.insert(reach[j].begin(), reach[j].end());
      if (std::includes(both.begin(), both.end(), support.begin(), support.end())) pairs.push_back({i, j, both.size()});
    }
  // Those that depend on no other coordinates first: nearly always it is one of them.
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.reach < b.reach; });
  std::optional<RodConstraint> other;
  std::size_t others = 0;
  for (const Pair& pair : pairs) {
    const RodEnd &a = places[pair.first], &b = places[pair.second];
    auto rod = b.fixed ? between(system, constraint, b, a, support)
                       : between(system, constraint, a, b, support);  // from the fixed end
    if (rod && is_as_written(*rod)) return rod;
    others += rod ? 1 : 0;
    if (rod && !other) other = std::move(rod);
  }
  return others == 1 ? other : std::nullopt;
}

}  // namespace maupertuis

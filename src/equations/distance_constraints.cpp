#include "equations/distance_constraints.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "equations/simplified.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>

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

Rods::Rods(const MechanicalSystem& system) : system_(system), places_(places_of(system)) {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const std::set<NodeId> ids = coordinates_in(places_[i].position);
    reach_.emplace_back(ids.begin(), ids.end());
    for (const NodeId id : ids) depending_[id].push_back(i);
  }
}

/// One of a pair depends on the first coordinate of φ; what the other ones of φ it leaves, its partner depends on.
std::vector<Rods::Pair> Rods::pairs_on(const Ids& support) const {
  std::vector<Pair> pairs;
  const auto found = depending_.find(support.front());
  if (found == depending_.end()) return pairs;
  const auto add = [&](std::size_t i, std::size_t j, const Ids& missing) {
    const Ids &a = reach_[i], &b = reach_[j];
    const bool twice = j < i && std::binary_search(b.begin(), b.end(), support.front());  // comes from j's turn as well
    if (i == j || twice || !std::includes(b.begin(), b.end(), missing.begin(), missing.end())) return;
    std::size_t shared = 0;
    for (const NodeId id : b) shared += std::binary_search(a.begin(), a.end(), id);
    pairs.push_back({std::min(i, j), std::max(i, j), a.size() + b.size() - shared});
  };
  for (const std::size_t i : found->second) {
    Ids missing;
    std::set_difference(support.begin(), support.end(), reach_[i].begin(), reach_[i].end(),
                        std::back_inserter(missing));
    if (missing.empty())
      for (std::size_t j = 0; j < places_.size(); ++j) add(i, j, missing);
    else if (const auto others = depending_.find(missing.front()); others != depending_.end())
      for (const std::size_t j : others->second) add(i, j, missing);
  }
  // Those that depend on no other coordinates first: nearly always it is one of them.
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.reach, a.first, a.second) < std::tie(b.reach, b.first, b.second);
  });
  return pairs;
}

std::optional<RodConstraint> Rods::find(const Constraint& constraint) const {
  if (constraint.level != Constraint::Level::Position) return std::nullopt;
  const std::set<NodeId> support = coordinates_in({&constraint.value, 1});
  if (support.empty()) return std::nullopt;
  std::optional<RodConstraint> other;
  std::size_t others = 0;
  for (const Pair& pair : pairs_on({support.begin(), support.end()})) {
    const RodEnd &a = places_[pair.first], &b = places_[pair.second];
    auto rod = b.fixed ? between(system_, constraint, b, a, support)
                       : between(system_, constraint, a, b, support);  // from the fixed end
    if (rod && is_as_written(*rod)) return rod;
    others += rod ? 1 : 0;
    if (rod && !other) other = std::move(rod);
  }
  return others == 1 ? other : std::nullopt;
}

}  // namespace maupertuis

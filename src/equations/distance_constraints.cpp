#include "equations/distance_constraints.hpp"

#include <maupertuis/scattered_point.hpp>
#include <maupertuis/transform.hpp>

#include "equations/simplified.hpp"

#include <algorithm>
#include <cmath>
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
  ExprVector all;
  for (const RodEnd& place : places_) all.insert(all.end(), place.position.begin(), place.position.end());
  for (const Constraint& c : system.constraints) all.push_back(c.value);
  for (const Contact& c : system.contacts) all.push_back(c.gap);
  point_ = scattered_point(symbols_of(all));
}

const Rods::InNumbers& Rods::numbers_of(std::size_t place) const {
  const auto [found, is_new] = numbers_.try_emplace(place);
  InNumbers& out = found->second;
  if (!is_new) return out;
  out.position = evaluate(places_[place].position, point_);
  for (const NodeId id : reach_[place]) {
    ExprVector slopes;
    for (const Expr& component : places_[place].position)
      slopes.push_back(differentiate(component, system_.context->node(id)));
    out.slopes.push_back(evaluate(slopes, point_));
  }
  return out;
}

Rods::Slopes Rods::slopes_of(Expr value, const Ids& support) const {
  Slopes out;
  for (const NodeId id : support) {
    const Expr slope = differentiate(value, system_.context->node(id));
    out[id] = evaluate(slope, point_);
  }
  return out;
}

/// ∂(d²/2)/∂q along a coordinate.
Rods::Way Rods::way_along(const Pair& pair, NodeId id) const {
  const InNumbers &a = numbers_of(pair.first), &b = numbers_of(pair.second);
  Way out;
  const auto add = [&](std::size_t place, const InNumbers& numbers, double sign) {
    const Ids& reach = reach_[place];
    const auto found = std::lower_bound(reach.begin(), reach.end(), id);
    if (found == reach.end() || *found != id) return;
    const std::vector<double>& slopes = numbers.slopes[static_cast<std::size_t>(found - reach.begin())];
    for (std::size_t k = 0; k < slopes.size(); ++k) {
      const double term = sign * (b.position[k] - a.position[k]) * slopes[k];
      out.slope += term;
      out.size += std::abs(term);
    }
  };
  add(pair.first, a, -1), add(pair.second, b, 1);
  return out;
}

/// Whether ∇φ and ∇d² are parallel at the scattered point, to rounding: what is not is no rod, and of the points of a
/// body nearly all pairs are none. A place without a value there says nothing.
bool Rods::may_be(const Slopes& of_phi, const Pair& pair) const {
  constexpr double rounding = 1e-9;
  const auto steepest = std::max_element(of_phi.begin(), of_phi.end(), [](const auto& x, const auto& y) {
    return std::abs(x.second) < std::abs(y.second);
  });
  const Way most = way_along(pair, steepest->first);
  if (std::abs(most.slope) <= rounding * most.size) return false;
  const auto is_parallel_along = [&](NodeId id) {
    const auto found = of_phi.find(id);
    const double phi = found == of_phi.end() ? 0 : found->second;
    const Way way = way_along(pair, id);
    return !(std::abs(phi * most.slope - steepest->second * way.slope) >
             rounding * (std::abs(phi) * most.size + std::abs(steepest->second) * way.size));
  };
  const Ids &a = reach_[pair.first], &b = reach_[pair.second];
  return std::all_of(a.begin(), a.end(), is_parallel_along) && std::all_of(b.begin(), b.end(), is_parallel_along);
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
  const Ids ids(support.begin(), support.end());
  const Slopes of_phi = slopes_of(constraint.value, ids);
  std::optional<RodConstraint> other;
  std::size_t others = 0;
  for (const Pair& pair : pairs_on(ids)) {
    if (!may_be(of_phi, pair)) continue;
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

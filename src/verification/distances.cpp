#include "verification/distances.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/tree_size.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

Expr squared_distance(Context& context, const ExprVector& a, const ExprVector& b) {
  ExprVector terms;
  for (std::size_t k = 0; k < a.size(); ++k) terms.push_back((a[k] - b[k]) * (a[k] - b[k]));
  return context.sum(terms);
}

/// Squares of what may be a distance: of links, of points from each other and from the origin.
ExprVector squared_distances(const MechanicalSystem& system) {
  Context& context = *system.context;
  ExprVector out;
  for (const Link& link : system.links) out.push_back(squared_distance(context, link.from, link.to));
  constexpr std::size_t most_points = 12;
  if (system.points.size() > most_points) return out;
  for (std::size_t i = 0; i < system.points.size(); ++i) {
    const ExprVector& p = system.points[i].position;
    out.push_back(squared_distance(context, p, ExprVector(p.size(), context.number(0))));
    for (std::size_t j = 0; j < i; ++j) out.push_back(squared_distance(context, p, system.points[j].position));
  }
  return out;
}

bool is_of_positions(Expr e) {
  bool coordinates = false;
  for (const Expr& s : symbols_of({&e, 1})) {
    if (s.role() == Role::Coordinate && s.order() > 0) return false;
    coordinates = coordinates || s.role() == Role::Coordinate;
  }
  return coordinates;
}

double value_at(const MechanicalSystem& system, Expr e, const MotionState& state) {
  ExprMap map;
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    map.emplace(system.coordinates[i].q, system.context->number(Rational::from_double(state.q[i])));
  map.emplace(system.context->time(), system.context->number(Rational::from_double(state.t)));
  return number_of(system, substitute(e, map));
}

/// r where the node is a power of |r|, with sin² + cos² put together.
std::optional<Expr> distance_of(Expr node, const ExprVector& squares, const ReadingOrder& order) {
  const PowerOf power = split_power(node);
  const bool is_root =
      node.is(Kind::Power) && !power.exponent.is_integer() && (power.exponent * Rational(2)).is_integer();
  if (!is_root && !node.is(Kind::Abs)) return std::nullopt;
  constexpr std::size_t most = 1000;
  if (tree_size(node, most) >= most) return std::nullopt;
  const Expr root = node.is(Kind::Abs) ? node : readable(pow(power.base, Rational(1, 2)), order).value;
  const Expr g = root.is(Kind::Abs) ? root[0] : Expr();
  if (!g || !is_of_positions(g)) return std::nullopt;
  const bool known = std::any_of(squares.begin(), squares.end(), [&](const Expr& square) {
    return vanishes_identically(g * g - expand_time_derivatives(square));
  });
  return known ? std::optional(g) : std::nullopt;
}

/// What stands in the energies of a system for distances |r|, with the distance r > 0 that it is at a state.
struct Found {
  ExprMap roots;
  std::vector<Expr> distances;
  bool on_edge = false;  // of some r = 0 at the state
};

Found distances_in(const MechanicalSystem& system, const MotionState& state) {
  Found out;
  std::vector<Expr> energies;
  for (const auto* list : {&system.kinetic, &system.potential, &system.dissipation})
    for (const EnergyTerm& t : *list) energies.push_back(expand_time_derivatives(t.value));
  const ExprVector squares = squared_distances(system);
  const ReadingOrder order = reading_order(system);
  for (const Expr& node : topological_order(energies)) {
    const std::optional<Expr> g = distance_of(node, squares, order);
    if (!g) continue;
    const double value = value_at(system, *g, state);
    out.on_edge = out.on_edge || value == 0;
    const Expr distance = value < 0 ? -*g : *g;
    const Rational exponent = node.is(Kind::Abs) ? Rational(1) : split_power(node).exponent * Rational(2);
    out.roots.emplace(node, pow(distance, exponent));
    if (std::find(out.distances.begin(), out.distances.end(), distance) == out.distances.end())
      out.distances.push_back(distance);
  }
  return out;
}

std::shared_ptr<MechanicalSystem> with_roots(const MechanicalSystem& system, const ExprMap& roots) {
  auto out = std::make_shared<MechanicalSystem>(system);
  for (auto* list : {&out->kinetic, &out->potential, &out->dissipation})
    for (EnergyTerm& t : *list) t.value = substitute(expand_time_derivatives(t.value), roots);
  return out;
}

}  // namespace

Expr SignedDistances::with_signs(Expr e) const {
  Expr out = substitute(expand_time_derivatives(e), roots);
  for (const Expr& r : distances) out = on_side({&out, 1}, r, true).front();
  return out;
}

std::optional<SignedDistances> signed_distances(const EquationsOfMotion& equations, const MotionState& state) {
  const MechanicalSystem& system = *equations.system;
  Found found = distances_in(system, state);
  if (found.distances.empty() || found.on_edge || system.lagrangian_given) return std::nullopt;
  SignedDistances out;
  out.roots = std::move(found.roots);
  out.distances = std::move(found.distances);
  for (const Expr& r : out.distances)
    out.where += fmt::format("{}{} > 0", out.where.empty() ? "" : " and ", to_plain(r, equations.order));
  const auto signed_system = with_roots(system, out.roots);
  if (system.written) signed_system->written = with_roots(*system.written, distances_in(*system.written, state).roots);
  Diagnostics none;
  auto derived = euler_lagrange(signed_system, none);
  if (!derived) return std::nullopt;
  out.equations = std::move(*derived);
  return out;
}

}  // namespace maupertuis

#include "comparison/domains.hpp"

#include <maupertuis/across_switches.hpp>
#include <maupertuis/switches.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

/// L, D and the forces: what a system is made of.
ExprVector parts_of(const MechanicalSystem& system) {
  ExprVector out{system.lagrangian(), system.dissipation_function()};
  const ExprVector forces = system.generalized_forces();
  out.insert(out.end(), forces.begin(), forces.end());
  return in_terms_of_motion(system, expand_time_derivatives(in_terms_of_motion(system, out)));
}

bool is_root(Expr e) { return e.is(Kind::Power) && !(e[1].is_number() && e[1].number().is_integer()); }

/// Functions whose signs decide whether all is defined.
ExprVector borders_of(const ExprVector& functions) {
  ExprVector out;
  for (const Expr& e : topological_order(functions)) {
    Expr border;
    if (e.is(Kind::Log) || is_root(e)) border = e[0];
    if (e.is(Kind::Acosh)) border = e[0] - Rational(1);
    if (e.is(Kind::Asin) || e.is(Kind::Acos) || e.is(Kind::Atanh)) border = e.context().number(1) - e[0] * e[0];
    if (border && !border.is_number() && std::find(out.begin(), out.end(), border) == out.end()) out.push_back(border);
  }
  return out;
}

enum class Defined { Yes, No, Unknown };

/// No: some value is no number at all. Unknown: only infinite, as at a pole.
Defined defined(const ExprVector& functions, const Bindings& at) {
  const std::vector<double> values = evaluate(functions, at);
  if (std::any_of(values.begin(), values.end(), [](double x) { return std::isnan(x); })) return Defined::No;
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }) ? Defined::Yes
                                                                                              : Defined::Unknown;
}

std::optional<MotionState> consistent(const Bindings& point, const Model& b, const EquationsOfMotion& equations) {
  MotionState out{point.at(b.system.context->time()), {}, {}};
  for (const Coordinate& c : b.system.coordinates) {
    out.q.push_back(point.at(c.q));
    out.v.push_back(point.at(c.velocity));
  }
  if (!b.system.constrained()) return out;
  const ConstraintManifold manifold(equations);
  const std::vector<bool> free(out.q.size(), false);
  if (!manifold.move_positions(out, free) || !manifold.move_velocities(out, free)) return std::nullopt;
  return out;
}

}  // namespace

std::optional<DomainGap> domain_gap(const MechanicalSystem& a, const PullBack& pull_back, const Model& b,
                                    const EquationsOfMotion& b_equations, const Motions& motions) {
  const ExprVector of_a = pull_back(parts_of(a)), of_b = with_constants_as_numbers(b.system, parts_of(b.system));
  ExprVector map = pull_back.positions();
  map.insert(map.end(), pull_back.velocities().begin(), pull_back.velocities().end());
  ExprVector all = of_a;
  all.insert(all.end(), of_b.begin(), of_b.end());
  const ExprVector borders = borders_of(all);
  if (borders.empty()) return std::nullopt;
  SwitchSearch search = search_of_states(b.system);
  search.center = motions.at(motions.states().front());
  for (const Bindings& point : points_in_branches(borders, search).points) {
    const auto state = consistent(point, b, b_equations);
    if (!state) continue;
    const Bindings at = motions.at(*state);
    if (defined(map, at) != Defined::Yes) continue;
    const Defined a_there = defined(of_a, at), b_there = defined(of_b, at);
    if (a_there != b_there && a_there != Defined::Unknown && b_there != Defined::Unknown)
      return DomainGap{*state, a_there == Defined::Yes};
  }
  return std::nullopt;
}

}  // namespace maupertuis::comparison

#include <maupertuis/slip_signs.hpp>
#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

namespace maupertuis {
namespace {

/// c of g = c v_t; nothing where g is no multiple of the slip.
std::optional<Expr> multiple_of_slip(Expr g, Expr slip, const std::vector<Coordinate>& coordinates) {
  for (const Coordinate& c : coordinates) {
    const Expr lever = differentiate(slip, c.velocity);
    if (lever.is_zero()) continue;
    const Expr factor = differentiate(g, c.velocity) / lever, rest = expand(g - factor * slip);
    return !factor.is_zero() && rest && rest.is_zero() ? std::optional(factor) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

Expr on_side_of_slip(const MechanicalSystem& system, const Friction& friction, Expr function, bool forwards) {
  const std::vector<Expr> switches = switches_of({&function, 1});
  if (switches.empty() || friction.in_space()) return function;
  const Expr slip = friction.slip[0];
  ExprMap nodes;
  for (const Expr& node : topological_order({&function, 1})) {
    if (!node.is(Kind::Abs) && !node.is(Kind::Sign)) continue;
    const auto factor = multiple_of_slip(node[0], slip, system.coordinates);
    if (!factor) continue;
    const Expr size = node.is(Kind::Abs) ? slip : slip.context().number(1);
    nodes[node] = apply(node.kind(), *factor) * (forwards ? size : -size);
  }
  Expr out = substitute(function, nodes);
  for (const Expr& g : switches) {  // steps, pieces
    const auto factor = multiple_of_slip(g, slip, system.coordinates);
    if (const Rational* c = factor ? factor->number_or_null() : nullptr)
      out = on_side({&out, 1}, g, (c->sign() > 0) == forwards).front();
  }
  return out;
}

Expr limit_of_friction(const MechanicalSystem& system, const Friction& friction, Expr coefficient, Expr normal,
                       bool forwards) {
  const Expr limit = on_side_of_slip(system, friction, coefficient, forwards);
  return normal ? limit * normal : limit;
}

}  // namespace maupertuis

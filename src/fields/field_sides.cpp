#include "fields/field_sides.hpp"

#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

/// The highest derivative of a field by a variable in the equations.
int order_of(const FieldEquations& equations, std::size_t field, std::size_t variable) {
  const FieldSystem& s = equations.system();
  int out = 0;
  for (const Expr& r : equations.residuals)
    for (const Expr& symbol : s.jets_in(r))
      if (const FieldJet jet = *s.jet_of(symbol); jet.field == field && jet.space[variable] > out &&
                                                  !vanishes_identically(s.expanded(differentiate(r, symbol))))
        out = jet.space[variable];
  return out;
}

/// What a condition at a side says of a jet there: that of its own, and what its derivatives along the side and by t
/// are. An empty handle: nothing.
Expr given_jet(const FieldSystem& s, const BoundaryCondition& b, const FieldJet& jet) {
  const std::size_t across = b.side == Side::Left || b.side == Side::Right ? 0 : 1;
  if (jet.field != b.jet.field || jet.space[across] != b.jet.space[across]) return {};
  Expr value = s.expanded(b.value);
  for (std::size_t x = 0; x < s.space.size(); ++x)
    for (int k = b.jet.space[x]; k < jet.space[x]; ++k) value = differentiate(value, s.space[x].symbol);
  for (int k = 0; k < jet.time; ++k) value = differentiate(value, s.context->time());
  return value;
}

/// With what a side holds of the fields.
Expr as_given(const FieldSystem& s, Expr e, Side side) {
  e = s.expanded(e);
  ExprMap given;
  for (const BoundaryCondition& b : s.boundary)
    for (const Expr& symbol : s.jets_in(e))
      if (b.side == side)
        if (const Expr value = given_jet(s, b, *s.jet_of(symbol))) given[symbol] = value;
  return on_side(s, substitute(e, given), side);
}

/// What a side asks of a field, as expressions that vanish.
std::vector<Expr> conditions_at(const FieldEquations& equations, std::size_t field, Side side) {
  const FieldSystem& s = equations.system();
  std::vector<Expr> out;
  for (const BoundaryCondition& b : s.boundary)
    if (b.side == side && b.jet.field == field) out.push_back(s.jet_symbol(b.jet) - s.expanded(b.value));
  for (const NaturalCondition& n : equations.natural) {
    const std::vector<Side> sides = sides_across(n.along);
    if (n.field != field || std::find(sides.begin(), sides.end(), side) == sides.end() || is_given(s, n, side))
      continue;
    const Expr left = as_given(s, n.value, side);
    if (!vanishes_identically(left)) out.push_back(left);
  }
  return out;
}

}  // namespace

std::vector<Side> sides_across(std::size_t variable) {
  return variable == 0 ? std::vector{Side::Left, Side::Right} : std::vector{Side::Bottom, Side::Top};
}

Expr on_side(const FieldSystem& s, Expr e, Side side) {
  const SpaceVariable& x = s.space[side == Side::Left || side == Side::Right ? 0 : 1];
  return s.expanded(substitute(e, {{x.symbol, side == Side::Left || side == Side::Bottom ? x.from : x.to}}));
}

bool is_given(const FieldSystem& s, const NaturalCondition& n, Side side) {
  return std::any_of(s.boundary.begin(), s.boundary.end(), [&](const BoundaryCondition& b) {
    return b.side == side && b.jet.field == n.field && (b.jet.order() == 1 || !n.moment);
  });
}

bool refuse_too_many_conditions(const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  if (s.periodic() || !s.space.front().from) return false;
  for (const NaturalCondition& n : equations.natural) {
    if (s.periodic(n.along) || !n.moment || order_of(equations, n.field, n.along) > 2) continue;
    for (const Side side : sides_across(n.along)) {
      const std::vector<Expr> asked = conditions_at(equations, n.field, side);
      if (asked.size() < 2) continue;
      std::string list;
      for (const Expr& e : asked)
        list += (list.empty() ? "" : " and ") +
                to_plain(field_layout(s, lay_out(readable(e, equations.order), equations.order))) + " = 0";
      diagnostics.error(
          "E0642", s.density_span, "an end has two conditions, where the equation takes one",
          fmt::format("The equation of {} has no derivative by {} above the second; the variation and `boundary` "
                      "ask for {}.",
                      s.fields[n.field].name, s.space[n.along].name, list),
          "Write the density without second derivatives: what these add to it is a total derivative, which changes the "
          "ends alone.");
      return true;
    }
  }
  return false;
}

}  // namespace maupertuis

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

/// Across x and y; a density of three variables knows no sides across the third.
Side side_of(std::size_t variable, bool last) { return sides_across(variable)[last ? 1 : 0]; }

bool has_moment(const FieldEquations& equations, const NaturalCondition& n) {
  return std::any_of(equations.natural.begin(), equations.natural.end(), [&](const NaturalCondition& other) {
    return other.moment && other.field == n.field && other.along == n.along;
  });
}

/// Whether `boundary` holds there what the condition leaves free: the field of a force, the slope of a moment.
bool is_held(const FieldEquations& equations, const NaturalCondition& n, bool last) {
  const auto holds = [&](const BoundaryCondition& b) {
    return b.jet.field == n.field && (b.jet.order() == 1) == n.moment;
  };
  const std::vector<BoundaryCondition>& all = equations.system().boundary;
  if (n.along < 2)
    return std::any_of(all.begin(), all.end(),
                       [&](const BoundaryCondition& b) { return b.side == side_of(n.along, last) && holds(b); });
  constexpr std::ptrdiff_t all_sides = 4;  // `boundary u = 0` means those of the third variable too
  return std::count_if(all.begin(), all.end(), holds) == all_sides;
}

/// Whether the slope is given there of a field without moments: by the force that makes it so.
bool has_given_slope(const FieldEquations& equations, const NaturalCondition& n, bool last) {
  if (n.moment || n.along > 1 || has_moment(equations, n)) return false;
  const std::vector<BoundaryCondition>& all = equations.system().boundary;
  return std::any_of(all.begin(), all.end(), [&](const BoundaryCondition& b) {
    return b.side == side_of(n.along, last) && b.jet.field == n.field && b.jet.order() == 1;
  });
}

/// With the forces there, written or by a slope that is given.
Expr with_forces(const FieldEquations& equations, const NaturalCondition& n, bool last) {
  if (n.along > 1) return n.value;
  const FieldSystem& s = equations.system();
  const Side side = side_of(n.along, last);
  Expr out = n.value + force_at(s, n, side);
  if (!has_given_slope(equations, n, last)) return out;
  const Expr given = as_given(s, n.value, side);
  return vanishes_identically(given) ? out : out - given;
}

}  // namespace

std::vector<Side> sides_across(std::size_t variable) {
  return variable == 0 ? std::vector{Side::Left, Side::Right} : std::vector{Side::Bottom, Side::Top};
}

std::vector<NaturalAtEnds> natural_at_ends(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  std::vector<NaturalAtEnds> out;
  for (std::size_t i = 0; i < equations.natural.size(); ++i) {
    const NaturalCondition& n = equations.natural[i];
    const bool has_ends = !s.periodic(n.along) && s.space[n.along].from;
    const auto holds = [&](bool last) {
      const bool has_bodies = n.along < 2 && is_held_by_bodies(equations, n, side_of(n.along, last));
      return !has_bodies && !is_held(equations, n, last);
    };
    const bool first = has_ends && holds(false), last = has_ends && holds(true);
    const Expr at_first = with_forces(equations, n, false), at_last = with_forces(equations, n, true);
    if (first == last && (!first || at_first == at_last))
      out.push_back({i, first ? at_first : n.value, first, last});
    else {
      if (first) out.push_back({i, at_first, true, false});
      if (last) out.push_back({i, at_last, false, true});
    }
  }
  return out;
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

bool is_held_by_bodies(const FieldEquations& equations, const NaturalCondition& n, Side side) {
  return std::any_of(equations.interfaces.begin(), equations.interfaces.end(), [&](const InterfaceCondition& c) {
    return c.end == side && c.field == n.field && c.moment == n.moment;
  });
}

Expr force_at(const FieldSystem& s, const NaturalCondition& n, Side side) {
  const bool is_last = side == Side::Right || side == Side::Top;
  Expr out = s.context->number(0);
  for (const EndForce& f : s.end_forces)
    if (f.side == side && f.jet.field == n.field && (f.jet.order() == 1) == n.moment)
      out = is_last ? out + f.value : out - f.value;
  return out;
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

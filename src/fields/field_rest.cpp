#include "fields/field_rest.hpp"

#include <maupertuis/evaluate.hpp>

#include "fields/field_sides.hpp"
#include "fields/given_fields.hpp"
#include "fields/resting_fields.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

using Side = BoundaryCondition::Side;

Expr at_rest(const FieldEquations& equations, const FieldRest& rest, Expr e) {
  e = with_given_fields(equations.system(), e);
  return substitute(e, rest.values(equations, e));
}

/// Along the directions that go around.
bool closes(const FieldSystem& s, const FieldRest& rest) {
  for (const Expr& field : rest.fields)
    for (std::size_t i = 0; i < s.space.size(); ++i)
      for (const Expr& e : {field, differentiate(field, s.space[i].symbol)})
        if (const SpaceVariable& x = s.space[i];
            s.periodic(i) &&
            !vanishes_identically(s.expanded(substitute(e, {{x.symbol, x.from}}) - substitute(e, {{x.symbol, x.to}}))))
          return false;
  return true;
}

bool stays_inside(const FieldEquations& equations, const FieldRest& rest) {
  return std::all_of(equations.residuals.begin(), equations.residuals.end(), [&](const Expr& r) {
    return vanishes_identically(equations.system().expanded(at_rest(equations, rest, r)));
  });
}

/// Where bodies act, their equations say the rest.
bool stays_at_ends(const FieldEquations& equations, const FieldRest& rest) {
  const FieldSystem& s = equations.system();
  if (!s.end_forces.empty()) return false;
  if (!s.space.front().from || equations.bodies) return true;
  if (!closes(s, rest)) return false;
  for (const BoundaryCondition& b : s.boundary) {
    const Expr jet = s.jet_symbol(b.jet);
    if (!vanishes_identically(on_side(s, at_rest(equations, rest, jet), b.side) - s.expanded(b.value))) return false;
  }
  for (const NaturalCondition& n : equations.natural)
    for (const Side side : sides_across(n.along))
      if (!s.periodic(n.along) && !is_given(s, n, side) &&
          !vanishes_identically(on_side(s, at_rest(equations, rest, n.value), side)))
        return false;
  return true;
}

}  // namespace

ExprMap FieldRest::values(const FieldEquations& equations, Expr e) const {
  const FieldSystem& s = equations.system();
  ExprMap out;
  for (const Expr& symbol : s.jets_in(e)) {
    const FieldJet jet = *s.jet_of(symbol);
    const std::size_t a = equations.varied_index(jet.field);
    if (a == fields.size()) continue;  // given
    if (computed && jet.time == 0) continue;
    Expr value = jet.time > 0 ? s.context->number(0) : fields[a];
    for (std::size_t x = 0; x < s.space.size(); ++x)
      for (int k = 0; k < jet.space[x]; ++k) value = differentiate(value, s.space[x].symbol);
    out.emplace(symbol, value);
  }
  return out;
}

std::optional<double> FieldRest::value(const FieldSystem& s, Expr symbol, double x, double y) const {
  if (!computed) return std::nullopt;
  const auto jet = s.jet_of(symbol);
  return jet ? std::optional(computed->value(*jet, x, y)) : std::nullopt;
}

std::string FieldRest::text(const FieldEquations& equations) const {
  if (computed) return "the equilibrium";
  std::string out;
  for (std::size_t a = 0; a < fields.size(); ++a)
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", equations.system().fields[equations.varied[a]].name,
                       to_plain(lay_out(readable(fields[a], equations.order), equations.order)));
  return out;
}

bool is_rest(const FieldEquations& equations, const FieldRest& rest) {
  return stays_inside(equations, rest) && stays_at_ends(equations, rest);
}

FieldRest rest_of(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  FieldRest none;
  none.fields.assign(equations.varied.size(), s.context->number(0));
  FieldRest start = none;
  for (const FieldStart& one : equations.model->start)
    for (std::size_t a = 0; a < start.fields.size(); ++a)
      if (equations.varied[a] == one.field && one.order == 0) start.fields[a] = s.expanded(one.value);
  const bool is_other = std::any_of(start.fields.begin(), start.fields.end(), [](Expr e) { return !e.is_zero(); });
  return is_other && !equations.bodies && is_rest(equations, start) ? start : none;
}

}  // namespace maupertuis

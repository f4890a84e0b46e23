#include "fields/static_density.hpp"

#include <maupertuis/transform.hpp>

#include "fields/given_fields.hpp"
#include "fields/semi_discrete.hpp"
#include "fields/small_motions.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

Expr without_motion(const FieldSystem& s, Expr e) {
  ExprMap still;
  for (const Expr& symbol : s.jets_in(e))
    if (s.jet_of(symbol)->time > 0) still.emplace(symbol, s.context->number(0));
  return substitute(s.expanded(e), still);
}

}  // namespace

std::string StaticDensity::read(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  const Expr whole = density_of(equations);
  if (!whole) return "A given field has no formula.";
  const Expr density = without_motion(s, whole);
  smooth.assign(equations.varied.size(), false);
  const auto take = [&](Expr e) {
    for (const Expr& symbol : s.jets_in(e)) {
      const bool known = std::any_of(slots.begin(), slots.end(), [&](const Slot& x) { return x.symbol == symbol; });
      if (!known) slots.push_back({equations.varied_index(s.jet_of(symbol)->field), *s.jet_of(symbol), symbol});
    }
  };
  take(density);
  for (const std::size_t f : equations.varied) {
    FieldJet plain;
    plain.field = f, plain.space.assign(s.space.size(), 0);
    take(s.jet_symbol(plain));
    if (s.forces[f]) take(without_motion(s, with_given_fields(s, s.forces[f])));
  }
  for (const Slot& slot : slots) {
    if (slot.a == equations.varied.size()) return "A given field has no formula.";
    if (slot.jet.order() > 2) return "Its density holds derivatives above the second.";
    if (slot.jet.order() == 2) smooth[slot.a] = true;
  }
  return read_roots(equations, density);
}

std::string StaticDensity::read_roots(const FieldEquations& equations, Expr density) {
  const FieldSystem& s = equations.system();
  roots = {density};
  for (const Slot& slot : slots) {
    Expr force = differentiate(density, slot.symbol);
    if (const Expr f = s.forces[equations.varied[slot.a]]; f && slot.jet.order() == 0)
      force = force + without_motion(s, with_given_fields(s, f));
    roots.push_back(force);
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
    for (const Slot& by : slots) roots.push_back(differentiate(roots[i + 1], by.symbol));
  for (const Expr& e : roots)
    if (changes_in_time(s, e)) return "Its coefficients change in time.";
  return "";
}

}  // namespace maupertuis

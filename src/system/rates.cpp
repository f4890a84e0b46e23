#include "linear_algebra/independent_rows.hpp"
#include "system/constraint_checks.hpp"
#include "system/elaboration.hpp"

#include <maupertuis/integral_symbol.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// rates ω1, ω2, ω3 = B.ω: velocities σ = Y(q,t) q̇ + y(q,t) that stand in the place of q̇.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using Group = syntax::RatesStatement::Group;

constexpr const char* kExample = "rates v = x' cos ψ + y' sin ψ, w = ψ'";

const Group& group_of(const Declaration& d) {
  return std::get<syntax::RatesStatement>(d.statement->body).groups[d.item];
}

ExprVector velocities_of(Elaboration& e) {
  ExprVector symbols;
  for (const Coordinate& c : e.system().coordinates) symbols.push_back(c.velocity);
  return symbols;
}

bool refuse_form(Elaboration& e, const Expression& x, const std::string& message, const std::string& reason) {
  e.diagnostics.error("E0256", x.span, message, reason, fmt::format("Write for example `{}`.", kExample));
  return false;
}

/// One component a name.
bool check_count(Elaboration& e, const Group& group, const Value& v) {
  if (v.parts.size() == group.names.size()) return true;
  e.diagnostics.error(
      "E0255", group.value->span,
      fmt::format("{} for {}",
                  v.parts.size() == 1 ? "one number" : fmt::format("a vector of {} components", v.parts.size()),
                  group.names.size() == 1 ? fmt::format("the one rate `{}`", group.names.front().text)
                                          : fmt::format("{} rates", group.names.size())),
      "Names before one sign of equality are the components of the vector behind it, in order.",
      v.is_vector ? "Name as many rates as it has components, or take one with .x, .y or .z."
                  : "Give each rate its own right side.");
  return false;
}

/// σ is linear in q̇, and q̇ stands in it.
bool check_linear(Elaboration& e, const Expression& x, const std::string& name, Expr value) {
  const ExprVector velocities = velocities_of(e), slopes = gradient(value, velocities);
  bool moves = false;
  for (const Expr& slope : slopes) {
    moves = moves || !slope.is_zero();
    for (const Expr& again : gradient(slope, velocities))
      if (!again.is_zero() && zero_test(again).verdict != Verdict::Zero)
        return refuse_form(e, x, fmt::format("the rate `{}` is not linear in the velocities", name),
                           "Equations are written in rates where the velocities are linear functions of them.");
  }
  if (!moves)
    return refuse_form(e, x, fmt::format("no velocity stands in the rate `{}`", name),
                       "A rate takes the place of a velocity: it is a combination of q'.");
  return true;
}

bool check_value(Elaboration& e, const Expression& x, const std::string& name, Expr value, int order) {
  if (order > 1)
    return refuse_form(e, x, fmt::format("an acceleration stands in the rate `{}`", name),
                       "A rate takes the place of a velocity: it is a combination of q'.");
  for (const Expr& s : symbols_of({&value, 1}))
    if (s.role() == Role::Input)
      return refuse_form(e, x, fmt::format("the input `{}` stands in the rate `{}`", s.name(), name),
                         "A rate depends on coordinates, velocities and t.");
  return check_linear(e, x, name, value);
}

// ------------------------------------------------------------------------------------------------------ independence

/// ∂/∂q̇ of a rate or of a constraint between velocities, ∂/∂q of one between positions.
ExprVector row_of(Elaboration& e, const Constraint& c) {
  if (c.level == Constraint::Level::Velocity) return gradient(c.value, velocities_of(e));
  ExprVector positions;
  for (const Coordinate& q : e.system().coordinates) positions.push_back(q.q);
  return gradient(c.value, positions);
}

struct Independence {
  std::size_t left_free = 0;         // velocities that the constraints leave
  std::vector<std::size_t> surplus;  // rates that are combinations of earlier ones and of the constraints
};

Independence independence_at(Elaboration& e, double shift) {
  const Bindings at = scattered_state(e, shift);
  IndependentRows rows;
  for (const Constraint& c : e.system().constraints) rows.add(evaluate(row_of(e, c), at));
  Independence out;
  out.left_free = e.system().coordinates.size() - rows.rank();
  for (std::size_t k = 0; k < e.system().rates.size(); ++k)
    if (!rows.add(evaluate(gradient(e.system().rates[k].value, velocities_of(e)), at))) out.surplus.push_back(k);
  return out;
}

}  // namespace

void elaborate_rate(Elaboration& e, Declaration& d) {
  const Group& group = group_of(d);
  const std::string& name = group.names[d.component].text;
  d.done = true;
  d.value = Value::poison();
  if (d.component == 0) {
    const Value all = evaluate_formula(e, *group.value);
    if (all.poisoned || !check_count(e, group, all)) return;
    d.group = std::make_shared<const Value>(all);
  } else {
    const Declaration* first = e.table.find(group.names.front().text);  // which came before (definition_order)
    // A name that was taken leads to another declaration, and that was told.
    if (!first || first->statement != d.statement || first->item != d.item || !first->group) return;
    d.group = first->group;
  }
  const Value& v = *d.group;
  const Expr value = expand_time_derivatives(v.parts[d.component]);
  if (!check_value(e, *group.value, name, value, v.order)) return;
  d.value = Value::of(value, v.dimension, v.order);
  e.system().rates.push_back({name, rate_of_integral(e.context, name), value, v.dimension, d.span});
}

void check_rates(Elaboration& e) {
  if (e.system().rates.empty() || e.diagnostics.has_errors()) return;
  std::vector<Rate>& rates = e.system().rates;
  std::stable_sort(rates.begin(), rates.end(),
                   [](const Rate& a, const Rate& b) { return a.span.begin < b.span.begin; });
  const Independence found = independence_at(e, 0.1);
  for (const std::size_t k : found.surplus) {
    const Rate& rate = rates[k];
    if (found.left_free < k + 1)
      e.diagnostics.error("E0258", rate.span,
                          fmt::format("`{}` is one rate more than the {} that {} left free", rate.name,
                                      found.left_free == 1 ? "velocity" : fmt::format("{} velocities", found.left_free),
                                      found.left_free == 1 ? "is" : "are"),
                          "There are as many independent rates as coordinates less the constraints.",
                          "Leave it out; `let` defines a quantity without making it a velocity of its own.");
    else
      e.diagnostics.error("E0257", rate.span, fmt::format("the rate `{}` is a combination of others", rate.name),
                          e.system().constrained() ? "The rates before it and the constraints determine it."
                                                   : "The rates before it determine it.",
                          "Choose one that is independent of them, or write it as `let`.");
    return;
  }
}

}  // namespace maupertuis::elaboration

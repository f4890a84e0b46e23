#include "system/elaboration.hpp"

#include <fmt/format.h>

/// start sat.ω = (0.01, 2, 0.01) rad/s, start v = 1 m/s, start P = (1, 2) m, start P.x' = 3 m/s: what an angular
/// velocity or another rate is at the start, where a point is and how it moves. The coordinates and velocities that
/// give it are found later.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

bool is_rate_of_body(Elaboration& e, const Expression& x) {
  if (x.kind != Expression::Kind::Member || (x.text != "ω" && x.text != "ω_world")) return false;
  if (x.arguments[0]->kind != Expression::Kind::Name) return false;
  const Declaration* d = e.table.find(x.arguments[0]->text);
  return d && (d->kind == Declaration::Kind::Body || d->kind == Declaration::Kind::Frame);
}

/// P, P.x, P', P.x' of a point or a body.
bool is_of_point(Elaboration& e, const Expression& x) {
  using Kind = Declaration::Kind;
  const Expression& base = x.kind == Expression::Kind::Member ? *x.arguments[0] : x;
  if (base.kind != Expression::Kind::Name) return false;
  const Declaration* d = e.table.find(base.text);
  if (!d || (d->kind != Kind::Point && d->kind != Kind::Body)) return false;
  return x.kind == Expression::Kind::Name || x.text == "x" || x.text == "y" || x.text == "z";
}

/// Whether the state changes it, by positions or by velocities.
bool can_change(Expr formula, bool is_of_velocities) {
  for (const Expr& s : symbols_of({&formula, 1}))
    if (s.role() == Role::Coordinate && s.order() == (is_of_velocities ? 1 : 0)) return true;
  return false;
}

std::vector<StartCondition> refuse_fixed(Elaboration& e, const Expression& x, const std::string& name, bool is_rate) {
  e.diagnostics.error("E0223", x.span,
                      fmt::format("no {} of the model gives `{}` this value", is_rate ? "velocity" : "position", name),
                      is_rate ? "The rotation leaves a component of it no freedom."
                              : "A component of it is the same in every configuration, or moves with the time alone.",
                      is_rate ? "Check the rotation, or leave the start out." : "Leave that component out.");
  return {};
}

}  // namespace

bool is_rate(Elaboration& e, const Expression& x) {
  if (x.kind == Expression::Kind::Name) {
    const Declaration* d = e.table.find(x.text);
    return d && d->kind == Declaration::Kind::Rate;
  }
  return is_rate_of_body(e, x) || (x.kind == Expression::Kind::Member && is_rate_of_body(e, *x.arguments[0]));
}

bool is_start_condition(Elaboration& e, const Expression& x) { return is_rate(e, x) || is_of_point(e, x); }

std::vector<StartCondition> start_conditions(Elaboration& e, const syntax::StartStatement::Item& item) {
  const Expression& x = *item.variable;
  const std::string name(e.texts.slice(x.span));
  const Value rate = evaluate_formula(e, x);
  if (rate.poisoned) return {};
  const Dimension expected = rate.dimension;
  if (rate.order > 1) {
    e.diagnostics.error("E0223", x.span, fmt::format("the acceleration `{}` cannot be chosen", name),
                        "The equations of motion give it from positions and velocities.", "Leave it out.");
    return {};
  }
  const Value v = rate.is_vector ? constant_vector_of(e, *item.value, expected, fmt::format("`{}`", name))
                                 : constant_of(e, *item.value, expected, fmt::format("`{}`", name));
  if (v.poisoned) return {};
  std::vector<StartCondition> out;
  const bool is_of_velocities = rate.order == 1;
  for (std::size_t i = 0; i < rate.parts.size(); ++i) {
    const StartCondition part{expand_time_derivatives(rate.parts[i]), v.parts[i], name, x.span};
    if (can_change(part.formula, is_of_velocities))
      out.push_back(part);
    else if (constant_value(e, part.formula - part.value) != 0.0)
      return refuse_fixed(e, x, name, is_rate(e, x));  // (0, 0, θ') = (0, 0, 2 rad/s) asks nothing of its zeros
  }
  return out;
}

}  // namespace maupertuis::elaboration

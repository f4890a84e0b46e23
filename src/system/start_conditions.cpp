#include "system/elaboration.hpp"

#include <fmt/format.h>

/// start sat.ω = (0.01, 2, 0.01) rad/s, start v = 1 m/s: what an angular velocity or another rate is at the start. The
/// velocities that give it are found later.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

bool is_rate_of_body(Elaboration& e, const Expression& x) {
  if (x.kind != Expression::Kind::Member || (x.text != "ω" && x.text != "ω_world")) return false;
  if (x.arguments[0]->kind != Expression::Kind::Name) return false;
  const Declaration* d = e.table.find(x.arguments[0]->text);
  return d && (d->kind == Declaration::Kind::Body || d->kind == Declaration::Kind::Frame);
}

bool has_velocity(Expr rate) {
  const Expr roots[] = {rate};
  for (const Expr& s : symbols_of(roots))
    if (s.role() == Role::Coordinate && s.order() == 1) return true;
  return false;
}

std::vector<StartRate> refuse_fixed(Elaboration& e, const Expression& x, const std::string& name) {
  e.diagnostics.error("E0223", x.span, fmt::format("no velocity of the model gives `{}` this value", name),
                      "The rotation leaves a component of it no freedom.",
                      "Check the rotation, or leave the start out.");
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

std::vector<StartRate> start_rates(Elaboration& e, const syntax::StartStatement::Item& item) {
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
  std::vector<StartRate> out;
  for (std::size_t i = 0; i < rate.parts.size(); ++i) {
    const StartRate part{expand_time_derivatives(rate.parts[i]), v.parts[i], x.span};
    if (has_velocity(part.rate))
      out.push_back(part);
    else if (constant_value(e, part.rate - part.value) !=
             0.0)  // (0, 0, θ') = (0, 0, 2 rad/s) asks nothing of its zeros
      return refuse_fixed(e, x, name);
  }
  return out;
}

}  // namespace maupertuis::elaboration

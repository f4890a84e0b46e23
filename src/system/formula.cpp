#include "system/elaboration.hpp"

#include <fmt/format.h>

/// Formulas: each node of the tree to its expression and dimension. One mistake poisons what contains it.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::Operator;
using Form = Expression::Kind;

/// Long sums become one sum, so that no tower of two-term sums arises: a + b − c.
Value sum_chain(Elaboration& e, const Expression& x, const Place& place) {
  std::vector<const Expression*> operations;
  const Expression* left = &x;
  while (left->kind == Form::Binary && (left->op == Operator::Add || left->op == Operator::Subtract) &&
         (left == &x || !left->bracketed)) {
    operations.push_back(left);
    left = left->arguments[0].get();
  }
  Value total = evaluate_formula(e, *left, place);
  std::vector<ExprVector> terms;
  for (const Expr& part : total.parts) terms.push_back({part});
  for (auto op = operations.rbegin(); op != operations.rend(); ++op) {
    const Expression& operation = **op;
    const Value right = evaluate_formula(e, *operation.arguments[1], place);
    const bool subtract = operation.op == Operator::Subtract;
    Value checked = add(e, total, right, subtract, operation, place);
    if (!checked.poisoned)
      for (std::size_t i = 0; i < terms.size(); ++i) terms[i].push_back(subtract ? -right.parts[i] : right.parts[i]);
    total = std::move(checked);
  }
  if (total.poisoned) return total;
  for (std::size_t i = 0; i < terms.size(); ++i) total.parts[i] = e.context.sum(terms[i]);
  return total;
}

Value binary(Elaboration& e, const Expression& x, const Place& place) {
  if (x.op == Operator::Add || x.op == Operator::Subtract) return sum_chain(e, x, place);
  if (const auto derivative = derivative_of_bracket(e, x, place)) return *derivative;
  if (tell_habit(e, x)) return Value::poison();
  Place inner = place;
  inner.expected.reset();
  const Value a = evaluate_formula(e, *x.arguments[0], inner);
  const Value b = evaluate_formula(e, *x.arguments[1], inner);
  if (a.poisoned || b.poisoned) return Value::poison();
  switch (x.op) {
    case Operator::Multiply:
    case Operator::Juxtapose:
      return multiply(e, a, b, x);
    case Operator::Divide:
      return divide(e, a, b, x);
    case Operator::Dot:
      return a.is_vector && b.is_vector ? dot_product(e, a, b, x) : multiply(e, a, b, x);
    case Operator::Cross:
      return a.is_vector && b.is_vector ? cross_product(e, a, b, x) : multiply(e, a, b, x);
    case Operator::Power:
      return power(e, a, b, x);
    case Operator::Add:
    case Operator::Subtract:
    case Operator::Negate:
    case Operator::Less:
    case Operator::LessEqual:
    case Operator::Greater:
    case Operator::GreaterEqual:
    case Operator::And:
    case Operator::Or:
      break;
  }
  e.diagnostics.error("E0221", x.span, "a comparison stands where a formula is needed",
                      "Conditions stand in piecewise(cond : value, …, else : value).", "Write piecewise around it.");
  return Value::poison();
}

Value condition(Elaboration& e, const Expression& x, const Place& place) {
  if (x.kind != Form::Binary) {
    e.diagnostics.error("E0221", x.span, "this is no condition",
                        "A condition compares two quantities with <, <=, > or >=.", "");
    return Value::poison();
  }
  const bool logical = x.op == Operator::And || x.op == Operator::Or;
  const Value a = logical ? condition(e, *x.arguments[0], place) : evaluate_formula(e, *x.arguments[0], place);
  const Value b = logical ? condition(e, *x.arguments[1], place) : evaluate_formula(e, *x.arguments[1], place);
  if (a.poisoned || b.poisoned) return Value::poison();
  if (!logical && add(e, a, b, true, x, place).poisoned) return Value::poison();
  if (!logical && a.is_vector) {
    e.diagnostics.error("E0210", x.span, "vectors have no order", "Only numbers can be compared.",
                        "Compare their norms or components.");
    return Value::poison();
  }
  const Expr l = a.scalar(), r = b.scalar();
  const auto make = [&](maupertuis::Kind kind, Expr first, Expr second) {
    const Expr arguments[] = {first, second};
    return Value::of(e.context.function(kind, arguments), Dimension{}, std::max(a.order, b.order));
  };
  switch (x.op) {
    case Operator::Less:
      return make(maupertuis::Kind::Less, l, r);
    case Operator::LessEqual:
      return make(maupertuis::Kind::LessEqual, l, r);
    case Operator::Greater:
      return make(maupertuis::Kind::Less, r, l);
    case Operator::GreaterEqual:
      return make(maupertuis::Kind::LessEqual, r, l);
    case Operator::And:
      return make(maupertuis::Kind::And, l, r);
    case Operator::Or:
      return make(maupertuis::Kind::Or, l, r);
    case Operator::Add:
    case Operator::Subtract:
    case Operator::Multiply:
    case Operator::Juxtapose:
    case Operator::Divide:
    case Operator::Dot:
    case Operator::Cross:
    case Operator::Power:
    case Operator::Negate:
      break;
  }
  e.diagnostics.error("E0221", x.span, "this is no condition",
                      "A condition compares two quantities with <, <=, > or >=.", "");
  return Value::poison();
}

Value piecewise(Elaboration& e, const Expression& x, const Place& place) {
  ExprVector arguments;
  Value common;
  bool poisoned = false;
  for (std::size_t i = 0; i < x.arguments.size(); ++i) {
    const bool is_condition = i % 2 == 0 && i + 1 < x.arguments.size();
    Place free = place;
    free.expected.reset();
    const Value v = is_condition ? condition(e, *x.arguments[i], free) : evaluate_formula(e, *x.arguments[i], place);
    if (v.poisoned || v.is_vector) {
      if (!v.poisoned)
        e.diagnostics.error("E0210", x.arguments[i]->span, "a vector as a value of piecewise",
                            "Its values are numbers.", "Write a piecewise for each component.");
      poisoned = true;
      continue;
    }
    arguments.push_back(v.scalar());
    const int order = std::max(common.order, v.order);
    if (!is_condition) {
      if (common.parts.empty())
        common = v;
      else
        common = add(e, common, v, true, *x.arguments[i], place);
      if (common.poisoned) return common;
    }
    common.order = order;
  }
  if (poisoned || arguments.empty()) return Value::poison();
  common.parts = {e.context.function(maupertuis::Kind::Piecewise, arguments)};
  common.is_literal = false;
  return common;
}

Value vector(Elaboration& e, const Expression& x, const Place& place) {
  Value out;
  out.is_vector = true;
  out.fits_any = true;
  out.is_literal = true;
  bool poisoned = false;
  for (const syntax::ExpressionPtr& part : x.arguments) {
    const Value v = evaluate_formula(e, *part, place);
    poisoned = poisoned || v.poisoned;
    if (v.poisoned) continue;
    if (v.is_vector) {
      e.diagnostics.error("E0210", part->span, "a vector as a component of a vector",
                          "The components of a vector are numbers.", "Write its components with .x and .y.");
      poisoned = true;
      continue;
    }
    if (out.fits_any)
      out.dimension = v.dimension;
    else if (!v.fits_any && !v.dimension.same_as(out.dimension)) {
      e.diagnostics.error("E0302", part->span,
                          fmt::format("this component is {}, the ones before it are {}", describe(v.dimension),
                                      describe(out.dimension)),
                          "The components of a vector have one dimension.", "");
      poisoned = true;
    }
    out.fits_any = out.fits_any && v.fits_any;
    out.is_literal = out.is_literal && v.is_literal;
    out.order = std::max(out.order, v.order);
    out.parts.push_back(v.scalar());
  }
  if (poisoned || !check_components(e, out.parts.size(), x.span)) return Value::poison();
  if (place.frame) {
    out.parts = rotate(place.frame->rotation, out.parts);
    out.anchored = true;
  }
  return out;
}

}  // namespace

Value evaluate_formula(Elaboration& e, const Expression& x, const Place& place) {
  switch (x.kind) {
    case Form::Number:
      return value_of_number(e, x);
    case Form::Quantity:
      return value_of_quantity(e, x, place);
    case Form::Name:
      return value_of_name(e, x, place);
    case Form::Member:
      return value_of_member(e, x, place);
    case Form::Call:
      return value_of_call(e, x, place);
    case Form::Vector:
      return vector(e, x, place);
    case Form::Binary:
      return binary(e, x, place);
    case Form::Unary:
      return negative(evaluate_formula(e, *x.arguments[0], place));
    case Form::Piecewise:
      return piecewise(e, x, place);
    case Form::TimeDerivative:
      return time_derivative(e, evaluate_formula(e, *x.arguments[0], place), x.primes, x);
  }
  return Value::poison();
}

Value scalar_of(Elaboration& e, const Expression& x, const Dimension& expected, const std::string& what, Place place) {
  place.expected = e.dimension(expected);
  Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return v;
  if (v.is_vector) {
    e.diagnostics.error("E0210", x.span, fmt::format("{} is a number, not a vector", what), "",
                        "Take a component with .x or .y, or its length with norm(…).");
    return Value::poison();
  }
  return check_dimension(e, v, expected, what, x) ? v : Value::poison();
}

Value vector_of(Elaboration& e, const Expression& x, const Dimension& expected, const std::string& what, Place place) {
  place.expected = e.dimension(expected);
  Value v = evaluate_formula(e, x, place);
  if (v.poisoned) return v;
  if (!v.is_vector) {
    const bool plane = e.system().space_dimension == 2, downward = x.kind == Expression::Kind::Unary;
    const std::string components =
        what == "gravity" && !x.bracketed
            ? fmt::format("({}0, {}{})", plane ? "" : "0, ", downward ? "" : "-", e.texts.slice(x.span))
        : plane ? "(a, b)"
                : "(a, b, c)";
    e.diagnostics.error("E0210", x.span, fmt::format("{} is a vector, not a number", what), "",
                        fmt::format("Write its components: {}.", components));
    return Value::poison();
  }
  return check_dimension(e, v, expected, what, x) ? v : Value::poison();
}

}  // namespace maupertuis::elaboration

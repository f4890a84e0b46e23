#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

/// Sums, products and powers of values with their dimensions.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::Operator;

/// What is written as a plain number stays of bounded size, however long the text that makes it.
bool bounded(Elaboration& e, const Value& v, const Expression& x) {
  for (const Expr& part : v.parts) {
    if (!part.is_number() || part.number().small()) continue;
    const double size = part.number().to_double();
    if (std::isfinite(size) && part.number().numerator_string().size() < 4000 &&
        part.number().denominator_string().size() < 4000)
      continue;
    e.diagnostics.error("E0218", x.span, "this number is beyond the range of computation",
                        "Numbers lie between 1e-308 and 1e308 in size.",
                        "Choose units in which it is of moderate size.");
    return false;
  }
  return true;
}

/// Nor does a long product have a dimension beyond all physics.
bool known_dimension(Elaboration& e, const Value& v, const Expression& x) {
  for (const Dimension::Exponent& exponent : v.dimension.exponents) {
    if (std::abs(exponent.numerator) <= 1000 && exponent.denominator <= 1000) continue;
    e.diagnostics.error("E0305", x.span, "the dimension of this product has an exponent beyond 1000",
                        "No quantity of physics has such a dimension.", "");
    return false;
  }
  return true;
}

Value product(Elaboration& e, const Value& a, const Value& b, ExprVector parts, const Expression& x) {
  Value v;
  v.parts = std::move(parts);
  v.is_vector = v.parts.size() > 1;
  v.dimension = a.dimension * b.dimension;
  v.fits_any = a.fits_any || b.fits_any;
  v.has_pi = a.has_pi || b.has_pi;
  v.hertz = (a.hertz || b.hertz) && !v.has_pi;
  v.order = std::max(a.order, b.order);
  v.is_literal = a.is_literal && b.is_literal;
  return bounded(e, v, x) && known_dimension(e, v, x) ? v : Value::poison();
}

void report_sum(Elaboration& e, const Value& a, const Value& b, const Expression& x, const Place& place) {
  const Expression* right = x.arguments.size() > 1 ? x.arguments[1].get() : &x;
  const Expression* left = x.arguments.size() > 1 ? x.arguments[0].get() : &x;
  const bool left_is_wrong = place.expected && b.dimension.same_as(*place.expected);
  const bool compares = x.kind == Expression::Kind::Binary && x.op >= Operator::Less;
  const char* reason =
      compares ? "Only quantities of one dimension can be compared." : "Only quantities of one dimension can be added.";
  if (x.kind != Expression::Kind::Binary) {
    e.diagnostics.error("E0302", x.span, fmt::format("{} meets {}", describe(b.dimension), describe(a.dimension)),
                        reason, "");
    return;
  }
  const char* verb = compares ? "compares" : x.op == Operator::Subtract ? "subtracts" : "adds";
  const std::string message =
      compares ? fmt::format("this compares {} with {}", describe(a.dimension), describe(b.dimension))
      : x.op == Operator::Subtract
          ? fmt::format("this {} {} from {}", verb, describe(b.dimension), describe(a.dimension))
          : fmt::format("this {} {} to {}", verb, describe(b.dimension), describe(a.dimension));
  const Value& wrong = left_is_wrong ? a : b;
  const Dimension expected = place.expected.value_or(a.dimension);
  const bool damps =
      wrong.order == 1 && wrong.dimension.same_as(dimensions::force()) && expected.same_as(dimensions::energy());
  e.diagnostics.error("E0302", (left_is_wrong ? left : right)->span, message, reason,
                      damps ? "A force that grows with a velocity has no potential: for damping write D = 1/2 c x'^2."
                            : dimension_advice(wrong.dimension, expected));
}

bool same_shape(Elaboration& e, const Value& a, const Value& b, const Expression& x) {
  if (a.is_vector == b.is_vector) return true;
  e.diagnostics.error("E0210", x.span, a.is_vector ? "a number is added to a vector" : "a vector is added to a number",
                      "Vectors are added to vectors, component by component.",
                      "Write the number as a vector, or take a component with .x or .y.");
  return false;
}

void frequency_meets_rate(Elaboration& e, const Expression& x) {
  e.diagnostics.error("E0306", x.span, "a frequency in Hz meets an angular velocity in rad/s",
                      "1 Hz is one turn a second: 2π rad/s, not 1 rad/s.",
                      "Multiply the frequency by 2 pi, or give it in rad/s or rev/s.");
}

bool is_angle_rate(const Dimension& d) { return d.angle() != Dimension::Exponent{}; }

}  // namespace

Value negative(Value v) {
  for (Expr& part : v.parts) part = -part;
  if (v.weight) v.weight = -v.weight;
  return v;
}

Value add(Elaboration& e, const Value& a, const Value& b, bool subtract, const Expression& x, const Place& place) {
  if (a.poisoned || b.poisoned || !same_shape(e, a, b, x)) return Value::poison();
  if (!a.fits_any && !b.fits_any && !a.dimension.same_as(b.dimension)) {
    report_sum(e, a, b, x, place);
    return Value::poison();
  }
  if ((a.hertz && !b.fits_any && is_angle_rate(b.dimension)) ||
      (b.hertz && !a.fits_any && is_angle_rate(a.dimension))) {
    frequency_meets_rate(e, x);
    return Value::poison();
  }
  warn_of_degrees(e, a.is_literal ? a : b, a.is_literal ? b.dimension : a.dimension, x);
  Value v = a;
  if (a.fits_any || (!b.fits_any && is_angle_rate(b.dimension))) v.dimension = b.dimension;
  v.fits_any = a.fits_any && b.fits_any;
  v.order = std::max(a.order, b.order);
  v.hertz = a.hertz && b.hertz;
  v.has_pi = a.has_pi && b.has_pi;
  v.is_literal = a.is_literal && b.is_literal;
  v.anchored = a.anchored || b.anchored;
  if (a.weight || b.weight) {
    const Expr zero = e.number(0), wa = a.weight ? a.weight : zero, wb = b.weight ? b.weight : zero;
    v.weight = subtract ? wa - wb : wa + wb;
  }
  return v;
}

Value multiply(Elaboration& e, const Value& a, const Value& b, const Expression& x) {
  if (a.poisoned || b.poisoned) return Value::poison();
  if (a.is_vector && b.is_vector) {
    e.diagnostics.error("E0210", x.span, "the product of two vectors is not written like this",
                        "Vectors have two products.", "Write dot(u, v) for the number, cross(u, v) for the vector.");
    return Value::poison();
  }
  const Value& v = b.is_vector ? b : a;
  const Value& s = b.is_vector ? a : b;
  Value out = product(e, a, b, scaled(s.scalar(), v.parts), x);
  out.is_vector = v.is_vector;
  out.anchored = v.anchored;
  if (v.weight) out.weight = s.scalar() * v.weight;
  return out;
}

Value divide(Elaboration& e, const Value& a, const Value& b, const Expression& x) {
  if (a.poisoned || b.poisoned) return Value::poison();
  if (b.is_vector) {
    e.diagnostics.error("E0210", x.arguments[1]->span, "division by a vector", "A vector has no inverse.",
                        "Divide by its length: norm(…).");
    return Value::poison();
  }
  if (b.scalar().is_zero()) {
    e.diagnostics.error("E0219", x.arguments[1]->span, "division by zero", "The quotient has no value.", "");
    return Value::poison();
  }
  Value inverse = b;
  inverse.parts = {pow(b.scalar(), Rational(-1))};
  inverse.dimension = Dimension{} / b.dimension;
  inverse.fits_any = false;
  return multiply(e, a, inverse, x);
}

Value dot_product(Elaboration& e, const Value& a, const Value& b, const Expression& x) {
  Value v = product(e, a, b, {dot_of(a.parts, b.parts)}, x);
  v.is_vector = false;
  return v;
}

Value cross_product(Elaboration& e, const Value& a, const Value& b, const Expression& x) {
  if (a.parts.size() == 2) return product(e, a, b, {a.parts[0] * b.parts[1] - a.parts[1] * b.parts[0]}, x);
  Value v = product(e, a, b, cross_of(a.parts, b.parts), x);
  v.anchored = a.anchored || b.anchored;
  return v;
}

namespace {

/// The exponent as an exact number: written so, or made of parameters whose values are.
std::optional<Rational> exact_exponent(Elaboration& e, Expr exponent) {
  if (exponent.is_number()) return exponent.number();
  const Expr number = substitute(exponent, e.exact_values);
  return number.is_number() ? std::optional(number.number()) : std::nullopt;
}

std::size_t digits(const Rational& r) {
  return r.small() ? 19 : std::max(r.numerator_string().size(), r.denominator_string().size());
}

}  // namespace

Value power(Elaboration& e, const Value& base, const Value& exponent, const Expression& x) {
  if (base.poisoned || exponent.poisoned) return Value::poison();
  const Span exponent_span = x.arguments.size() > 1 ? x.arguments[1]->span : x.span;
  if (exponent.is_vector || (!exponent.dimension.is_one() && !exponent.fits_any)) {
    e.diagnostics.error("E0305", exponent_span,
                        exponent.is_vector ? "a vector as an exponent"
                                           : fmt::format("the exponent is {}", describe(exponent.dimension)),
                        "An exponent is a bare number.", "");
    return Value::poison();
  }
  const Expr n = exponent.scalar();
  if (base.is_vector) {
    if (n.is_number() && n.number() == Rational(2)) return dot_product(e, base, base, x);
    e.diagnostics.error("E0210", x.span, "a power of a vector", "Only its square has a meaning: v^2 is dot(v, v).",
                        "Use norm(v) for its length.");
    return Value::poison();
  }
  const bool bare = base.dimension.is_one();
  const std::optional<Rational> exact = n.is_number() || !bare ? exact_exponent(e, n) : std::nullopt;
  const std::optional<Rational::Small> short_form = exact ? exact->small() : std::nullopt;
  const bool is_short = short_form.has_value();
  const Rational::Small ratio = short_form.value_or(Rational::Small{0, 1});
  if (!bare && !base.fits_any && !is_short) {
    e.diagnostics.error(
        "E0305", exponent_span, fmt::format("{} to a power that is no known number", describe(base.dimension)),
        "The dimension of the result would not be known.", "Divide the base by a quantity of its dimension first.");
    return Value::poison();
  }
  const bool huge = exact && (!is_short || std::llabs(ratio.numerator) > 4000 || ratio.denominator > 4000);
  const Expr b = base.scalar();
  const bool explodes = exact && b.is_number() && exact->is_integer() && !huge &&
                        digits(b.number()) * static_cast<std::size_t>(std::llabs(ratio.numerator)) > 8000 &&
                        !b.is_one() && !b.is_zero() && !(-b).is_one();
  if ((huge && !(b.is_one() || b.is_zero())) ||
      (explodes && !std::isfinite(std::pow(b.number().to_double(), exact->to_double()))) ||
      (explodes && digits(b.number()) > 19) ||
      (!bare && is_short && (std::llabs(ratio.numerator) > 100 || ratio.denominator > 100))) {
    e.diagnostics.error("E0218", x.span, "this power is beyond the range of computation",
                        "Numbers lie between 1e-308 and 1e308 in size.", "");
    return Value::poison();
  }
  if (b.is_zero() && exact && exact->sign() < 0) {
    e.diagnostics.error("E0219", x.span, "division by zero", "A negative power of zero has no value.", "");
    return Value::poison();
  }
  Dimension dimension;
  if (is_short && (!bare || n.is_number()) && std::llabs(ratio.numerator) <= 100 && ratio.denominator <= 100)
    dimension = pow(base.dimension, ratio.numerator, ratio.denominator);
  Value v = Value::of(e.context.power(b, n), dimension, std::max(base.order, exponent.order));
  v.fits_any = base.fits_any && exact && exact->sign() > 0;
  v.hertz = base.hertz;
  v.is_literal = base.is_literal && exponent.is_literal;
  return bounded(e, v, x) ? v : Value::poison();
}

Value time_derivative(Elaboration& e, Value v, int times, const Expression& x) {
  if (v.poisoned || times == 0) return v;
  for (const Expr& s : symbols_of(v.parts)) {
    if (s.role() != Role::Multiplier) continue;
    e.diagnostics.error("E0225", x.span, "the derivative of a force of constraint is not known",
                        "The equations of motion give the force itself at each moment.", "Leave the derivative out.");
    return Value::poison();
  }
  bool moves = false;
  for (const Expr& part : v.parts) moves = moves || e.context.depends_on_time(part.id());
  if (!moves) {
    const std::string text(e.texts.slice(x.span));
    e.diagnostics.error("E0217", x.span,
                        fmt::format("`{}` does not change {}", text.substr(0, text.find('\'')), in_words(e, "in time")),
                        "The derivative of a constant is zero.",
                        "Leave the term out, or take the derivative of a coordinate.");
    return Value::poison();
  }
  for (int i = 0; i < times; ++i) {
    for (Expr& part : v.parts) part = e.context.time_derivative(part);
    v.dimension = v.dimension / e.time();
    if (v.order >= 0) ++v.order;
    if (v.weight) v.weight = e.context.time_derivative(v.weight);
  }
  v.fits_any = false;
  return v;
}

}  // namespace maupertuis::elaboration

#include "system/elaboration.hpp"

#include <maupertuis/field_system.hpp>
#include <maupertuis/functions.hpp>
#include <maupertuis/require.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

/// The functions of the language and what they ask of their arguments.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using K = maupertuis::Kind;

struct Function {
  K kind;
  Angles angles;
  bool reciprocal;
};

/// Words for the reciprocal of a function.
constexpr std::pair<std::string_view, K> kReciprocals[] = {
    {"sec", K::Cos}, {"csc", K::Sin}, {"cot", K::Tan}, {"sech", K::Cosh}};

std::optional<Function> find_function(std::string_view name) {
  std::optional<Function> found;
  const auto reciprocal =
      std::find_if(std::begin(kReciprocals), std::end(kReciprocals), [&](const auto& r) { return r.first == name; });
  const bool inverted = reciprocal != std::end(kReciprocals);
  const auto look = [&](const auto& row) {
    if (inverted ? row.kind == reciprocal->second : row.name == name) found = Function{row.kind, row.angles, inverted};
  };
  std::apply([&](const auto&... row) { (look(row), ...); }, functions::rows);
  return found;
}

/// Those that this file has rules for.
bool is_function(std::string_view name) {
  constexpr std::string_view others[] = {"sqrt", "abs", "sign", "step", "min", "max", "dot", "cross", "norm", "atan2"};
  return find_function(name) || std::find(std::begin(others), std::end(others), name) != std::end(others);
}

bool refuse_vector(Elaboration& e, const Value& v, const Expression& x, const Expression& argument) {
  if (!v.is_vector) return false;
  e.diagnostics.error("E0210", argument.span, fmt::format("`{}` of a vector", x.text), "Its argument is a number.",
                      "Take a component with .x or .y, or its length with norm(…).");
  return true;
}

/// `cos ω t` is (cos ω) t: the argument is no angle, and the product was meant. In sin(10 t) the number has a unit.
std::string help_for_argument(Elaboration& e, const Function& f, const Expression& x, const Dimension& found) {
  const Expression& argument = *x.arguments[0];
  const Declaration* d = argument.kind == Expression::Kind::Name ? e.table.find(argument.text) : nullptr;
  if (d && d->kind == Declaration::Kind::Coordinate && argument.primes == 0)
    return fmt::format("Where `{0}` is an angle, it is declared as one: coord {0} : angle. Else divide it by a length.",
                       argument.text);
  if (x.bare)
    return fmt::format(
        "Without brackets {0} takes `{1}` alone: put the whole argument in brackets, such as {0}({1} t).", x.text,
        e.texts.slice(argument.span));
  const Expression* factor = bare_factor(e, argument);
  if (!factor) return "Divide it by a quantity of the same dimension.";
  const Dimension one = f.angles == Angles::Argument ? dimensions::angle() : Dimension{};
  const std::string unit = to_string(one / found);
  return factor->kind == Expression::Kind::Number
             ? fmt::format("The number has a unit: write {} [{}].", e.texts.slice(factor->span), unit)
             : fmt::format("Give `{}` its unit where it is declared, such as {}.", factor->text, unit);
}

/// param α = 30 and sin α: no unit says that α is an angle, and 30 radians are nearly five turns.
void warn_of_degrees_in_parameter(Elaboration& e, const Value& a, const Expression& x) {
  const Expression& argument = *x.arguments[0];
  const bool alone = argument.kind == Expression::Kind::Name && argument.primes == 0 && !a.is_vector &&
                     a.scalar().is_symbol() && a.scalar().role() == Role::Parameter;
  if (e.dimensionless || !alone || a.dimension == dimensions::angle()) return;
  const std::optional<double> size = constant_value(e, a.scalar());
  if (!size || std::abs(*size) <= 6.5) return;
  e.diagnostics.warning(
      "W0310", argument.span, fmt::format("`{}` is {:g} radians here", argument.text, *size),
      fmt::format("It has no unit, and {} takes radians: that is {:.1f} turns.", x.text,
                  std::abs(*size) / 6.283185307179586),
      fmt::format("Write param {} = {:g} deg if degrees are meant, {:g} rad if not.", argument.text, *size, *size));
}

Value elementary(Elaboration& e, const Function& f, const Expression& x, const Value& a) {
  if (!a.fits_any && !a.dimension.is_one()) {
    e.diagnostics.error(
        "E0303", x.arguments[0]->span, fmt::format("the argument of {} is {}", x.text, describe(a.dimension)),
        f.angles == Angles::Argument ? "Its argument is an angle or a bare number." : "Its argument is a bare number.",
        help_for_argument(e, f, x, a.dimension));
    return Value::poison();
  }
  if (f.angles == Angles::Argument && a.hertz)
    e.diagnostics.warning(
        "W0309", x.arguments[0]->span, fmt::format("a frequency in Hz stands in the argument of {} without 2π", x.text),
        "A frequency of 1 Hz turns the phase by 2π in a second.", fmt::format("Write {}(2 pi …).", x.text));
  if (f.angles == Angles::Argument) {
    warn_of_degrees(e, a, dimensions::angle(), *x.arguments[0], true);
    warn_of_degrees_in_parameter(e, a, x);
  }
  Expr value = apply(f.kind, a.scalar());
  if (f.reciprocal) value = pow(value, Rational(-1));
  Value v = Value::of(value, f.angles == Angles::Value ? e.dimension(dimensions::angle()) : Dimension{}, a.order);
  return v;
}

Value square_root(Elaboration& e, const Expression& x, const Value& a) {
  Value v = power(e, a, Value::of(e.number(Rational(1, 2)), Dimension{}), x);
  v.fits_any = a.fits_any;
  return v;
}

/// min, max, atan2: arguments of one dimension.
Value of_several(Elaboration& e, const Expression& x, std::vector<Value> arguments, K kind) {
  Value common = arguments.front();
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    common = add(e, common, arguments[i], true, *x.arguments[i], {});
    if (common.poisoned) return common;
  }
  Expr value = arguments.front().scalar();
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const Expr pair[] = {value, arguments[i].scalar()};
    value = e.context.function(kind, pair);
  }
  common.parts = {value};
  common.is_literal = false;
  common.hertz = common.has_pi = false;
  if (kind == K::Atan2) {
    common.dimension = e.dimension(dimensions::angle());
    common.fits_any = false;
  }
  return common;
}

Value of_one(Elaboration& e, const Expression& x, Value a) {
  if (const auto f = find_function(x.text)) return elementary(e, *f, x, a);
  if (x.text == "sqrt") return square_root(e, x, a);
  const K kind = x.text == "abs" ? K::Abs : x.text == "sign" ? K::Sign : K::Step;
  a.parts = {apply(kind, a.scalar())};
  a.hertz = a.is_literal = false;
  if (kind != K::Abs) {
    a.dimension = Dimension{};
    a.fits_any = false;
  }
  return a;
}

Value of_vectors(Elaboration& e, const Expression& x, const std::vector<Value>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].is_vector) continue;
    e.diagnostics.error("E0210", x.arguments[i]->span, fmt::format("`{}` of a number", x.text),
                        "Its arguments are vectors.", x.text == "norm" ? "Write abs(…) for the size of a number." : "");
    return Value::poison();
  }
  if (x.text == "dot") return dot_product(e, arguments[0], arguments[1], x);
  if (x.text == "cross") return cross_product(e, arguments[0], arguments[1], x);
  Value square = dot_product(e, arguments[0], arguments[0], x);
  if (!square.poisoned) square.parts = {square_of(arguments[0].parts)};
  return square_root(e, x, square);
}

}  // namespace

Value value_of_call(Elaboration& e, const Expression& x, const Place& place) {
  if (e.fields && e.fields->system.jet_of_name(x.text)) return value_at_place(e, x);
  if (x.text == "friction") return value_of_friction(e, x, place);
  if (x.text == "multiplier" || x.text == "reaction") return value_of_reaction(e, x, place);
  if (!is_function(x.text)) return Value::poison();  // a place of a field that was refused: that was told
  const bool vectors = x.text == "dot" || x.text == "cross" || x.text == "norm";
  const bool several = x.text == "min" || x.text == "max";
  const bool two = x.text == "dot" || x.text == "cross" || x.text == "atan2";
  MAUP_REQUIRE(several ? x.arguments.size() >= 2 : x.arguments.size() == (two ? 2u : 1u));  // the grammar counts them
  Place inner = place;
  inner.expected.reset();
  std::vector<Value> arguments;
  bool poisoned = false;
  for (const syntax::ExpressionPtr& a : x.arguments) {
    arguments.push_back(evaluate_formula(e, *a, inner));
    poisoned = poisoned || arguments.back().poisoned || (!vectors && refuse_vector(e, arguments.back(), x, *a));
  }
  if (poisoned) return Value::poison();
  if (vectors) return of_vectors(e, x, arguments);
  if (several) return of_several(e, x, std::move(arguments), x.text == "min" ? K::Min : K::Max);
  if (x.text == "atan2") return of_several(e, x, std::move(arguments), K::Atan2);
  return of_one(e, x, arguments[0]);
}

}  // namespace maupertuis::elaboration

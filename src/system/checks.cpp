#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

/// Checks that the parts of the elaboration share.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

/// The first name in an expression whose value has no unit; empty if there is none.
std::string bare_name(Elaboration& e, const Expression& x) {
  if (x.kind == Expression::Kind::Name) {
    const Value v = evaluate_formula(e, x);  // it was evaluated before: no new message can come of it
    const bool constant = !v.poisoned && v.order < 0;
    return constant && v.dimension.same_as(Dimension{}) ? x.text : std::string();
  }
  for (const syntax::ExpressionPtr& a : x.arguments)
    if (std::string name = bare_name(e, *a); !name.empty()) return name;
  return {};
}

/// The parameters and other constants with units that stand in an expression.
void add_constants(Elaboration& e, const Expression& x, std::map<std::string, Dimension>& found) {
  if (x.kind == Expression::Kind::Name) {
    const Value v = evaluate_formula(e, x);  // no new message can come of it
    if (!v.poisoned && v.order < 0 && !v.dimension.is_one()) found.emplace(x.text, v.dimension);
  }
  for (const syntax::ExpressionPtr& a : x.arguments) add_constants(e, *a, found);
}

/// " Or …" where a formula has one constant alone, whose unit may be the mistake: k = 10 N of a spring.
std::string doubt_about_unit(Elaboration& e, const Expression& x, int order) {
  std::map<std::string, Dimension> constants;
  add_constants(e, x, constants);
  if (constants.size() != 1) return {};
  const auto& [name, dimension] = *constants.begin();
  const Dimension rate = Dimension{} / dimensions::time();
  const bool milliseconds = dimension.same_as(rate) || dimension.same_as(rate * rate);  // 9.81 ms^-2
  if (order != 0 && !milliseconds) return {};
  return fmt::format(" Or the unit of `{}`, {}, is another than was meant{}.", name, to_string(dimension),
                     milliseconds ? ": ms is a millisecond, and m s a metre times a second" : "");
}

/// 2 m (sin θ, cos θ) where m is a mass: "Write 2 [m] …"; empty where no unit in the place of a name fits.
std::string unit_that_is_a_name(Elaboration& e, const Value& v, const Dimension& expected, const Expression& x) {
  using Kind = Expression::Kind;
  if (x.kind == Kind::Binary && x.op == syntax::Operator::Juxtapose && x.arguments[0]->kind == Kind::Number &&
      x.arguments[1]->kind == Kind::Name) {
    const std::string& name = x.arguments[1]->text;
    const auto unit = find_unit(name);
    const Value meant = evaluate_formula(e, *x.arguments[1]);  // no new message can come of it
    if (unit && !meant.poisoned && (v.dimension / meant.dimension * unit->dimension).same_as(expected))
      return fmt::format("Here `{0}` is the name of the model; with the unit it is written {1} [{0}].", name,
                         x.arguments[0]->text);
  }
  const bool product =
      x.kind == Kind::Binary && (x.op == syntax::Operator::Juxtapose || x.op == syntax::Operator::Multiply);
  if (product && x.arguments[1]->kind == Kind::Name && x.arguments[1]->primes == 0) {  // 2 sin(1) m
    const std::string& name = x.arguments[1]->text;
    const auto unit = find_unit(name);
    const Value factor = evaluate_formula(e, *x.arguments[0]);  // no new message can come of it
    if (unit && !factor.poisoned && factor.order < 0 && factor.dimension.is_one() && unit->dimension.same_as(expected))
      return fmt::format("Here `{0}` is the name of the model; for the unit write … * 1 [{0}].", name);
  }
  for (const syntax::ExpressionPtr& a : x.arguments)
    if (std::string found = unit_that_is_a_name(e, v, expected, *a); !found.empty()) return found;
  return {};
}

/// 0.3, -9.81, (0, -9.81)
bool is_bare_number(const Expression& x) {
  using Kind = Expression::Kind;
  if (x.kind == Kind::Number) return true;
  return (x.kind == Kind::Unary || x.kind == Kind::Vector) &&
         std::all_of(x.arguments.begin(), x.arguments.end(), [](const auto& a) { return is_bare_number(*a); });
}

/// A quantity whose unit is often left out where its parameter is declared.
struct Unmarked {
  Dimension dimension;
  const char *quantity, *unit;
};

const Unmarked* missing_factor(const Dimension& found, const Dimension& expected) {
  static const Unmarked all[] = {{dimensions::mass(), "a mass", "kg"},
                                 {dimensions::length(), "a length", "m"},
                                 {dimensions::acceleration(), "an acceleration", "m/s^2"}};
  const auto here = std::find_if(std::begin(all), std::end(all),
                                 [&](const Unmarked& u) { return (found * u.dimension).same_as(expected); });
  return here == std::end(all) ? nullptr : here;
}

/// A bare number in a place for a quantity, or a factor that is missing, is most often a parameter whose unit was left
/// out.
std::string advice_on(Elaboration& e, const Value& v, const Dimension& expected, const Expression& x) {
  if (std::string words = advice_on_words(e, x, expected); !words.empty()) return words;
  if (is_bare_number(x)) {
    const bool formula = expected.same_as(dimensions::energy()) || expected.same_as(dimensions::power());
    const std::string unit = to_string(expected);
    return fmt::format("A number has a unit here, such as {} {}.", e.texts.slice(x.span),
                       formula ? "[" + unit + "]" : unit);
  }
  if (x.kind == Expression::Kind::Quantity || x.kind == Expression::Kind::Number) return "";
  if (std::string unit = unit_that_is_a_name(e, v, expected, x); !unit.empty()) return unit;
  const bool bare = v.dimension.same_as(Dimension{});
  const Unmarked* missing = bare ? nullptr : missing_factor(v.dimension, expected);
  const std::string name = bare || missing ? bare_name(e, x) : std::string();
  if (!name.empty() && bare) return fmt::format("Give `{}` its unit where it is declared, if it has one.", name);
  if (!name.empty())
    return fmt::format("Give `{}` its unit where it is declared, such as {}; or {} is missing as a factor.", name,
                       missing->unit, missing->quantity);
  std::map<std::string, Dimension> constants;
  add_constants(e, x, constants);
  const Expression* number = bare || constants.empty() ? bare_factor(e, x) : nullptr;  // 500 of 500 sin ωt
  if (number && e.texts.slice(number->span) != "1")
    return fmt::format("The number has a unit: write {} [{}].", e.texts.slice(number->span),
                       to_string(expected / v.dimension));
  const std::string advice = dimension_advice(v.dimension, expected);
  const Dimension more = v.dimension * dimensions::length(), less = v.dimension / dimensions::length();
  const bool by_a_length = more.same_as(expected) || less.same_as(expected);  // N for N/m
  return by_a_length && v.order <= 0 ? advice + doubt_about_unit(e, x, v.order) : advice;
}

}  // namespace

const Expression* bare_factor(Elaboration& e, const Expression& x) {
  using Kind = Expression::Kind;
  if (x.kind == Kind::Number) return &x;
  if (x.kind == Kind::Name && x.primes == 0) {
    const Value v = evaluate_formula(e, x);  // it was evaluated before: no new message can come of it
    return !v.poisoned && v.order < 0 && v.dimension.same_as(Dimension{}) ? &x : nullptr;
  }
  const bool leads = (x.kind == Kind::Binary && x.op != syntax::Operator::Power) || x.kind == Kind::Unary;
  return leads ? bare_factor(e, *x.arguments[0]) : nullptr;
}

std::string dimension_advice(const Dimension& found, const Dimension& expected) {
  using namespace dimensions;
  if (expected.same_as(energy()) && found.same_as(dimensions::power()))
    return "A power belongs in the dissipation function: D = ….";
  if (expected.same_as(dimensions::power()) && found.same_as(energy()))
    return "The dissipation function is half a dissipated power, for linear damping D = 1/2 c x'^2.";
  if (expected.same_as(energy()) && found.same_as(torque())) return "";
  if ((found * velocity()).same_as(expected)) return "A velocity is missing as a factor.";
  if ((found * length()).same_as(expected)) return "A length is missing as a factor.";
  if ((found / length()).same_as(expected)) return "There is a length too many among its factors.";
  if ((found / velocity()).same_as(expected)) return "There is a velocity too many among its factors.";
  if ((found * mass()).same_as(expected)) return "A mass is missing as a factor.";
  if ((found / mass()).same_as(expected)) return "There is a mass too many among its factors.";
  if ((found * time()).same_as(expected) || (found / time()).same_as(expected))
    return "A time derivative (') is missing or too many.";
  if ((found * acceleration()).same_as(expected)) return "An acceleration such as g is missing as a factor.";
  return "";
}

bool check_dimension(Elaboration& e, const Value& v, const Dimension& expected, const std::string& what,
                     const Expression& x) {
  if (v.poisoned || v.fits_any || e.dimensionless) return !v.poisoned;
  if (!v.dimension.same_as(expected)) {
    const std::string right = describe(expected), found = describe(v.dimension);
    const bool names_itself = right.rfind(what + " (", 0) == 0;  // "a mass (kg)" where a mass is asked for
    e.diagnostics.error("E0304", x.span,
                        names_itself ? fmt::format("{} is asked for, this is {}", right, found)
                                     : fmt::format("{} is {}, this is {}", what, right, found),
                        "Both sides of an equation have one dimension.", advice_on(e, v, expected, x));
    return false;
  }
  if (v.hertz && expected.angle() != Dimension::Exponent{}) {
    e.diagnostics.error("E0306", x.span, fmt::format("{} is an angular velocity, this is a frequency in Hz", what),
                        "1 Hz is one turn a second: 2π rad/s, not 1 rad/s.", "Write rev/s for turns, or rad/s.");
    return false;
  }
  return true;
}

std::optional<double> constant_value(const Elaboration& e, Expr value) {
  const Expr roots[] = {value};
  for (const Expr& s : symbols_of(roots))
    if (e.values.find(s) == e.values.end()) return std::nullopt;
  return maupertuis::evaluate(value, e.values);
}

bool is_finite(Elaboration& e, Expr value, const Expression& x, const std::string& what) {
  const std::optional<double> size = constant_value(e, value);
  if (!size || std::isfinite(*size)) return true;
  e.diagnostics.error(
      "E0218", x.span, fmt::format("{} is no finite number", what),
      "With the values of the parameters it is a division by zero, a root of a negative number, or beyond 1e308.", "");
  return false;
}

void warn_of_degrees(Elaboration& e, const Value& v, const Dimension& beside, const Expression& x, bool in_formula) {
  if (e.dimensionless || !v.is_literal || v.is_vector || beside != dimensions::angle()) return;
  const std::optional<double> size = constant_value(e, v.scalar());
  if (!size || std::abs(*size) <= 6.5) return;
  e.diagnostics.warning("W0310", x.span, fmt::format("an angle of {:g} without a unit is in radians", *size),
                        fmt::format("That is {:.1f} turns.", std::abs(*size) / 6.283185307179586),
                        fmt::format("Write {:g}{} if degrees are meant.", *size,
                                    x.kind == Expression::Kind::Number && !in_formula ? " deg" : " [deg]"));
}

Span culprit_of_order(Elaboration& e, const Expression& x, int order) {
  using K = Expression::Kind;
  if (x.kind == K::Name || x.kind == K::Member || x.kind == K::TimeDerivative) {
    const Value v = evaluate_formula(e, x);  // it was evaluated before: no new message can come of it
    if (!v.poisoned && v.order >= order) return x.span;
    return {};
  }
  for (const syntax::ExpressionPtr& a : x.arguments) {
    const Span s = culprit_of_order(e, *a, order);
    if (s.end > s.begin) return s;
  }
  return {};
}

bool refuse_acceleration(Elaboration& e, const Value& v, const Expression& x, const std::string& where) {
  if (v.poisoned || v.order < 2) return false;
  Span at = culprit_of_order(e, x, v.order > 2 ? 3 : 2);
  if (at.end <= at.begin) at = x.span;
  if (v.order > 2) {
    e.diagnostics.error("E0401", at, fmt::format("a derivative of order {} stands in {}", v.order, where),
                        "Energies and forces depend on positions, velocities and time, a Lagrangian perhaps on "
                        "accelerations.",
                        "Write it with lower derivatives.");
    return true;
  }
  e.diagnostics.error(
      "E0401", at, fmt::format("an acceleration stands in {}", where),
      "Energies and forces depend on positions, velocities and time; accelerations are what the equations give.",
      "Write it with velocities.");
  return true;
}

bool check_components(Elaboration& e, std::size_t count, Span span) {
  if (static_cast<int>(count) == e.system().space_dimension) return true;
  if (e.dimension_clash) return false;
  e.dimension_clash = true;
  e.diagnostics.error("E0211", span,
                      fmt::format("this vector has {} components in a {}-dimensional model", count,
                                  e.system().space_dimension == 2 ? "two" : "three"),
                      e.dimension_from ? fmt::format("The model is {}-dimensional since line {}.",
                                                     e.system().space_dimension == 2 ? "two" : "three",
                                                     e.texts.locate(*e.dimension_from).line)
                                       : "",
                      e.system().space_dimension == 2 ? "Give every vector three components for a model in space."
                                                      : "Give every vector three components.");
  return false;
}

}  // namespace maupertuis::elaboration

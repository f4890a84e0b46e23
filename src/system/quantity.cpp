#include "system/elaboration.hpp"
#include "system/unit_expression.hpp"

#include <fmt/format.h>
#include <maupertuis/print.hpp>
#include <maupertuis/rounded_value.hpp>

#include <algorithm>
#include <cmath>

/// Numbers and quantities (rule 1 of the language): `3 [J]` of a formula, `2 m` of a quantity place, where `m` may be
/// the metre or a mass of the model: the reading whose dimension fits wins.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

/// The dimension of a word as a name of the model; nothing where it is none.
std::optional<Dimension> dimension_of_name(Elaboration& e, const std::string& word) {
  const Declaration* d = e.table.find(word);
  if (d && d->statement) return d->value.dimension;
  return word == e.system().independent ? std::optional(e.time()) : std::nullopt;
}

std::optional<Dimension> dimension_of_names(Elaboration& e, const syntax::UnitExpression& words) {
  Dimension out;
  for (const auto& word : words.factors) {
    const std::optional<Dimension> d = dimension_of_name(e, word.word);
    if (!d) return std::nullopt;
    out = out * pow(*d, word.exponent_numerator, word.exponent_denominator);
  }
  return out;
}

Value product_of_names(Elaboration& e, const Expression& x, const Place& place) {
  Value out = evaluate_formula(e, *x.arguments[0], place);
  for (const auto& word : x.unit->factors) {
    Expression name;
    name.kind = Expression::Kind::Name;
    name.text = word.word;
    name.span = name.name_span = word.span;
    Value factor = value_of_name(e, name, place);
    const Rational exponent(word.exponent_numerator, word.exponent_denominator);
    if (!exponent.is_one()) factor = power(e, factor, Value::of(e.number(exponent), Dimension{}), name);
    out = multiply(e, out, factor, x);
  }
  return out;
}

bool any_name_but_no_unit(Elaboration& e, const syntax::UnitExpression& words) {
  return std::any_of(words.factors.begin(), words.factors.end(),
                     [&](const auto& word) { return !find_unit(word.word) && dimension_of_name(e, word.word); });
}

/// Whether the words are the names of the model rather than units. Nothing: both fit, which was reported.
std::optional<bool> words_are_names(Elaboration& e, const Expression& x, const Place& place) {
  const syntax::UnitExpression& words = *x.unit;
  if (x.unit_bracketed || place.in_parameter || words.factors.empty()) return false;
  const std::optional<Dimension> of_names = dimension_of_names(e, words);
  if (!all_units(words)) return of_names || e.dimensionless || any_name_but_no_unit(e, words);
  if (!of_names) return false;
  if (!place.expected || e.dimensionless) return e.dimensionless;
  Dimension as_units;
  for (const auto& w : words.factors)
    as_units = as_units * pow(find_unit(w.word)->dimension, w.exponent_numerator, w.exponent_denominator);
  const bool units_fit = as_units.same_as(*place.expected);
  const bool names_fit = of_names->same_as(*place.expected);
  if (units_fit && names_fit) {
    const std::string text(e.texts.slice(words.span));
    const std::string_view number = e.texts.slice(x.arguments[0]->span);
    e.diagnostics.error("E0307", words.span, fmt::format("`{}` is a unit and also a name of this model", text),
                        fmt::format("Both readings give {} here.", describe(*place.expected)),
                        fmt::format("Write {0} [{1}] for the unit or {0} * {1} for the name.", number, text));
    return std::nullopt;
  }
  return names_fit;
}

}  // namespace

bool has_words_of_no_unit(Elaboration& e, const Expression& quantity) {
  return e.dimensionless && !quantity.unit_bracketed && dimension_of_names(e, *quantity.unit);
}

namespace {

/// The one for this quantity, however it was written: 500 g is 0.5 kg.
std::optional<Expr> known_constant(Elaboration& e, Expr value, const Dimension& dimension) {
  for (const Parameter& p : e.system().parameters)
    if (p.symbol.role() == Role::Constant && p.value == value && p.dimension.same_as(dimension)) return p.symbol;
  return std::nullopt;
}

/// An anonymous parameter for a number with a unit in a formula.
Expr anonymous_constant(Elaboration& e, const std::string& name, Expr value, const Unit& unit,
                        const std::string& written, Span span) {
  if (const auto known = known_constant(e, value, unit.dimension)) return *known;
  const Expr symbol = e.context.symbol(name, Role::Constant);
  if (!e.constants.insert(symbol).second) return symbol;
  Parameter p;
  p.name = name;
  p.symbol = symbol;
  p.value = value;
  p.si_value = rounded_value(value, Bindings{});
  p.dimension = unit.dimension;
  p.unit = written;
  p.used = true;
  p.span = span;
  e.values[symbol] = p.si_value;
  e.exact_values[symbol] = value;
  e.system().parameters.push_back(std::move(p));
  return symbol;
}

}  // namespace

Value value_of_number(Elaboration& e, const Expression& x) {
  const std::optional<Rational> r = Rational::parse(x.text);
  if (!r || !std::isfinite(r->to_double()) || (r->to_double() == 0 && !r->is_zero())) {
    e.diagnostics.error(
        "E0218", x.span, fmt::format("the number {} is beyond the range of computation", x.text.substr(0, 40)),
        "Numbers lie between 1e-308 and 1e308 in size.", "Choose units in which it is of moderate size.");
    return Value::poison();
  }
  Value v = Value::of(e.number(*r), Dimension{});
  v.fits_any = r->is_zero();
  v.is_literal = true;
  return v;
}

namespace {

/// 9.81, (1/3): a number as it is read back before a unit.
std::string number_before_unit(Elaboration& e, const Rational& value) {
  const std::string text = to_plain(e.number(value), ReadingOrder{});
  return text.find('/') == std::string::npos ? text : "(" + text + ")";
}

/// "3", "(1/2)": what stands before the unit, to be read back with the unit in brackets behind it.
std::string written_number(const Elaboration& e, const Expression& x) {
  if (x.kind == Expression::Kind::Number) return std::string(e.texts.slice(x.span));
  const std::string text = syntax::to_string(x);
  return x.bracketed || x.kind == Expression::Kind::Name ? text : "(" + text + ")";
}

/// Constants count as positive, as parameters do.
bool is_positive_number(const Expr& part) {
  return symbols_of({&part, 1}).empty() && maupertuis::evaluate(part, Bindings{}) > 0;
}

bool refuse_second_unit(Elaboration& e, const Value& v, const Expression& x) {
  if (v.fits_any || v.dimension.is_one()) return false;
  e.diagnostics.error("E0302", x.unit->span, fmt::format("this unit follows {}", describe(v.dimension)),
                      "What stands before a unit is a bare number, or a vector of bare numbers.",
                      "Write the unit once.");
  return true;
}

}  // namespace

Value value_of_quantity(Elaboration& e, const Expression& x, const Place& place) {
  const std::optional<bool> names = words_are_names(e, x, place);
  if (!names) return Value::poison();
  if (*names) return product_of_names(e, x, place);
  const std::optional<Unit> unit = unit_of(e, *x.unit);
  Place bare = place;
  bare.expected.reset();
  bare.frame = nullptr;  // its components are turned below, as quantities
  Value v = evaluate_formula(e, *x.arguments[0], bare);
  if (!unit || v.poisoned || refuse_second_unit(e, v, x)) return Value::poison();
  v.fits_any = false;
  v.is_literal = false;
  v.dimension = unit->dimension;
  v.hertz = unit->is_hertz;
  const Expr factor = factor_of(e.context, *unit);
  const bool constant = !place.in_parameter && !place.inline_constants && !unit->dimension.is_one();
  const std::string written = written_unit(e.texts, *x.unit);
  for (Expr& part : v.parts) {
    // A component of a vector is named by its own size: (3, -4) [N] is 3 N and −(4 N).
    const bool negative = part.is_number() && part.number() < Rational(0);
    if (negative) part = -part;
    const Expr si = part * factor;
    const bool named = constant && is_positive_number(part) && (!v.is_vector || part.is_number());
    const bool as_written = !v.is_vector && !negative;
    const std::string number = !named       ? ""
                               : as_written ? written_number(e, *x.arguments[0])
                                            : number_before_unit(e, part.number());
    part = named ? anonymous_constant(e, fmt::format("{} {}", number, written), si, *unit, written, x.span) : si;
    if (negative) part = -part;
  }
  if (v.is_vector && place.frame) v.parts = rotate(place.frame->rotation, v.parts);
  return v;
}

namespace {

/// "N/s" rather than "kg m/s^3".
std::string unit_over(const Dimension& above, const Dimension& below) {
  const std::string whole = to_string(above), part = to_string(below);
  const bool plain = whole.find_first_of(" /") == std::string::npos && part.find_first_of(" /") == std::string::npos;
  return plain && !above.is_one() ? whole + "/" + part : to_string(above / below);
}

}  // namespace

std::string advice_on_words(Elaboration& e, const Expression& x, const Dimension& expected) {
  if (x.kind == Expression::Kind::Unary) return advice_on_words(e, *x.arguments[0], expected);
  if (x.kind != Expression::Kind::Quantity || x.unit_bracketed || !x.unit || !all_units(*x.unit)) return {};
  std::string first, names;
  Dimension of_names, of_units;
  for (const auto& word : x.unit->factors) {
    const std::optional<Dimension> d = dimension_of_name(e, word.word);
    const bool is_name = d && word.exponent_numerator > 0;
    const Rational exponent(word.exponent_numerator, word.exponent_denominator);
    Dimension& product = is_name ? of_names : of_units;
    product = product *
              pow(is_name ? *d : find_unit(word.word)->dimension, word.exponent_numerator, word.exponent_denominator);
    if (!is_name) continue;
    if (first.empty()) first = word.word;
    names += " " + word.word + (exponent.is_one() ? "" : "^" + exponent.to_string());
  }
  if (first.empty()) return {};
  const bool is_time = first == e.system().independent;
  if (!is_time && !(of_names * of_units).same_as(expected)) return {};
  const Dimension unit = expected / of_names;
  return fmt::format("`{}` was read as a unit, with `{}` for {}. For {} write {}{}{}.", e.texts.slice(x.unit->span),
                     first, describe(find_unit(first)->dimension), is_time ? in_words(e, "the time") : "the name",
                     written_number(e, *x.arguments[0]),
                     unit.is_one() ? "" : fmt::format(" [{}]", unit_over(expected, of_names)),
                     unit.is_one() ? " *" + names : names);
}

}  // namespace maupertuis::elaboration

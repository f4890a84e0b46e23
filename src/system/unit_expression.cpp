#include "system/unit_expression.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis::elaboration {
namespace {

/// Words for units that the language has as letters.
constexpr std::pair<std::string_view, std::string_view> kUnitWords[] = {
    {"sec", "s"},    {"second", "s"},    {"seconds", "s"},   {"meter", "m"},     {"meters", "m"},  {"metre", "m"},
    {"metres", "m"}, {"kilogram", "kg"}, {"gram", "g"},      {"grams", "g"},     {"newton", "N"},  {"Newton", "N"},
    {"joule", "J"},  {"Joule", "J"},     {"watt", "W"},      {"Watt", "W"},      {"volt", "V"},    {"Volt", "V"},
    {"ampere", "A"}, {"radian", "rad"},  {"radians", "rad"}, {"degrees", "deg"}, {"hz", "Hz"},     {"Kg", "kg"},
    {"KG", "kg"},    {"Rad", "rad"},     {"hours", "h"},     {"minutes", "min"}, {"ms2", "m/s^2"}, {"msec", "ms"},
    {"Ohm", "ohm"},  {"mps", "m/s"},     {"rads", "rad"},    {"degK", "K"},
};

/// `N m` for Nm: two or three units without a blank between them; empty if it is not made of them.
std::string units_apart(const std::string& word, int most = 3) {
  for (std::size_t cut = word.size() - 1; cut > 0 && most > 1; --cut) {
    const auto first = find_unit(word.substr(0, cut));
    if (!first) continue;
    const std::string rest = word.substr(cut);
    const auto second = find_unit(rest);
    if (second && !second->dimension.same_as(first->dimension)) return word.substr(0, cut) + " " + rest;
    if (const std::string apart = units_apart(rest, most - 1); !apart.empty()) return word.substr(0, cut) + " " + apart;
  }
  return "";
}

/// What the word was probably meant to be; empty where nothing is near.
std::string unit_meant(const std::string& word, std::span<const std::string> candidates) {
  for (const auto& [spelled, letters] : kUnitWords)
    if (spelled == word) return fmt::format("Write {}.", letters);
  if (const std::string apart = word.size() <= 8 ? units_apart(word) : ""; !apart.empty())
    return fmt::format("Write {}: units of a product stand apart.", apart);
  if ((word[0] == 'x' || word[0] == 'X') && word == word.substr(0, 1) + "10")
    return "A power of ten is written 2e3 or 2*10^3.";
  const std::size_t digits = word.find_first_of("0123456789");
  if (digits != std::string::npos && digits > 0 && find_unit(word.substr(0, digits)) &&
      word.find_first_not_of("0123456789", digits) == std::string::npos)
    return fmt::format("Write {}^{}.", word.substr(0, digits), word.substr(digits));
  const std::string near = did_you_mean(word, candidates);
  return near.empty() ? "" : fmt::format("Did you mean `{}`?", near);
}

/// Scales of temperature whose zero is not that of temperature, as people spell them.
constexpr std::string_view kShiftedScales[] = {"degC", "deg_C", "Celsius",    "celsius",   "centigrade",
                                               "degF", "deg_F", "Fahrenheit", "fahrenheit"};

void unknown_unit(Elaboration& e, const syntax::UnitExpression::Factor& word) {
  std::vector<std::string> candidates = {"kg", "mm", "cm", "km", "ms", "kN", "mN", "kW", "mH", "mA", "kHz"};
  for (std::string& unit : unit_words()) candidates.push_back(std::move(unit));
  const Declaration* named = e.table.find(word.word);
  if (named && named->statement) {
    e.diagnostics.error("E0209", word.span,
                        fmt::format("`{}` is a {} of this model, not a unit", word.word, word_of(named->kind)),
                        "Here stands a quantity: a number followed by its unit.",
                        "Write a formula with `*`, in a `let` if it defines something.");
    return;
  }
  if (std::find(std::begin(kShiftedScales), std::end(kShiftedScales), word.word) != std::end(kShiftedScales)) {
    e.diagnostics.error("E0301", word.span, fmt::format("`{}` is no unit", word.word),
                        "Its zero is not the zero of temperature, so that it cannot stand in products.",
                        "Write temperatures in K: 20 °C are 293.15 K, and a difference of 1 °C is 1 K.");
    return;
  }
  e.diagnostics.error(
      "E0301", word.span, fmt::format("`{}` is no unit", word.word),
      "Units are SI units with their prefixes, derived units, and common ones such as deg, rpm, bar, inch.",
      unit_meant(word.word, candidates));
}

std::optional<Rational> exact_power(const Rational& base, int numerator, int denominator) {
  const Rational raised = pow(base, numerator);
  return denominator == 1 ? std::optional(raised) : exact_root(raised, denominator);
}

/// Whether a mistake within these words was told: a unit behind a list is read for each of its numbers.
bool is_told(const Elaboration& e, const syntax::UnitExpression& words) {
  const auto items = e.diagnostics.items();
  return std::any_of(items.begin(), items.end(), [&](const Diagnostic& d) {
    return d.severity == Severity::Error && d.span && d.span->source == words.span.source &&
           words.span.begin <= d.span->begin && d.span->end <= words.span.end;
  });
}

}  // namespace

bool all_units(const syntax::UnitExpression& words) {
  for (const auto& word : words.factors)
    if (!find_unit(word.word)) return false;
  return true;
}

std::optional<Unit> unit_of(Elaboration& e, const syntax::UnitExpression& words) {
  if (is_told(e, words)) return std::nullopt;
  Unit out;
  bool known = true;
  for (const auto& word : words.factors) {
    if (const AmbiguousUnit* ambiguous = find_ambiguous_unit(word.word)) {
      e.diagnostics.error("E0313", word.span, fmt::format("`{}` may be two units", word.word),
                          fmt::format("It is {}.", ambiguous->meanings), fmt::format("Write {}.", ambiguous->instead));
      known = false;
      continue;
    }
    const std::optional<Unit> unit = find_unit(word.word);
    if (!unit) {
      unknown_unit(e, word);
      known = false;
      continue;
    }
    const int n = word.exponent_numerator, d = word.exponent_denominator;
    const std::optional<Rational> factor =
        std::abs(n) <= 30 && d <= 30 ? exact_power(unit->factor, n, d) : std::nullopt;
    if (!factor || (unit->pi_power * n) % d != 0) {
      e.diagnostics.error("E0301", word.span,
                          fmt::format("`{}^{}` is no unit that a quantity has", word.word,
                                      d == 1 ? fmt::format("{}", n) : fmt::format("({}/{})", n, d)),
                          "The power of this unit is no exact number of SI units.",
                          "Write the value in SI base units.");
      known = false;
      continue;
    }
    out.dimension = out.dimension * pow(unit->dimension, n, d);
    out.factor *= *factor;
    out.pi_power += unit->pi_power * n / d;
    out.is_hertz = out.is_hertz || (unit->is_hertz && n == d);
  }
  if (!known) return std::nullopt;
  if (e.dimensionless && !out.dimension.is_one()) {
    e.diagnostics.error("E0308", words.span, "a unit in a model without units",
                        "`dimensionless` turns units off: every quantity is a bare number.",
                        "Leave the unit out, or remove `dimensionless` and give every quantity its unit.");
    return std::nullopt;
  }
  if (e.dimensionless) out.dimension = Dimension{};
  return out;
}

Expr factor_of(Context& context, const Unit& unit) {
  const Expr factor = context.number(unit.factor);
  return unit.pi_power == 0 ? factor : factor * pow(context.pi(), Rational(unit.pi_power));
}

std::string written_unit(const SourceTexts& texts, const syntax::UnitExpression& words) {
  if (words.factors.empty()) return {};
  std::string text(texts.slice(words.span));
  const std::size_t first = text.find_first_not_of("[ "), last = text.find_last_not_of("] ");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

}  // namespace maupertuis::elaboration

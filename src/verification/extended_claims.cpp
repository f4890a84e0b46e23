#include "verification/extended_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

NumberFormat format_of(const Model& model) { return model.experiment.precision.value_or(NumberFormat::Double); }

}  // namespace

bool ExtendedClaims::takes(const Expectation& e) const {
  if (format_of(model_) == NumberFormat::Double || !e.subject || e.at_until) return false;
  const auto& coordinates = model_.system.coordinates;
  return std::any_of(coordinates.begin(), coordinates.end(), [&](const Coordinate& c) { return c.q == e.subject || c.velocity == e.subject; });
}

/// As written where it is a number: 0.1 is a tenth. What π or a root stands in is known to 16 digits.
Rational ExtendedClaims::exact(Expr e) const {
  if (!e) return 0;
  const Expr value = in_terms_of_motion(model_.system, {&e, 1}).front();
  const Rational* number = value.number_or_null();
  return number ? *number : Rational::from_double(number_of(model_.system, e));
}

void ExtendedClaims::decide(const std::vector<std::size_t>& which, std::vector<ExpectationResult>& results, Diagnostics& diagnostics) const {
  ExtendedSimulationOptions options;
  options.precision = format_of(model_) == NumberFormat::Quad ? Precision::Quad : Precision::Digits100;
  options.duration = Rational(0);   // as far as the times asked for
  options.interrupt = interrupt_;
  for (const std::size_t index : which) {
    const Expectation& e = model_.experiment.expectations[index];
    options.at.push_back(exact(e.time ? e.time : model_.experiment.start_time));
  }
  const auto run = simulate_extended(model_, equations_, options, diagnostics);
  for (std::size_t i = 0; i < which.size(); ++i) {
    ExpectationResult& result = results[which[i]];
    if (!run) result.message = "The run could not start.";
    else judge(model_.experiment.expectations[which[i]], run->at[i], run->reason, result);
  }
}

const AgreedNumber& ExtendedClaims::value_in(const ExtendedState& state, Expr subject) const {
  const auto& coordinates = model_.system.coordinates;
  std::size_t i = 0;
  while (coordinates[i].q != subject && coordinates[i].velocity != subject) ++i;
  return coordinates[i].q == subject ? state.q[i] : state.v[i];
}

/// What two runs do not agree on counts as error.
void ExtendedClaims::judge(const Expectation& e, const ExtendedState& state, const std::string& reason, ExpectationResult& result) const {
  if (!state.reached) {
    result.message = "The run ended before: " + reason + ".";
    return;
  }
  const AgreedNumber& number = value_in(state, e.subject);
  const auto actual = Rational::parse(number.text), difference = Rational::parse(number.difference);
  const Rational expected = exact(e.value);
  const Rational allowed = !e.tolerance ? abs(expected) * Rational(1, 1'000'000'000) : exact(e.tolerance) * (e.relative ? abs(expected) : Rational(1));
  result.actual = number.text + (e.display_unit.empty() ? "" : " (in SI)");
  result.expected = fmt::format("{:.17g}{}", expected.to_double() / e.display_factor, e.display_unit.empty() ? "" : " " + e.display_unit);
  result.tolerance = tolerance_text(e, model_.system);
  if (!actual || !difference || allowed < *difference) {
    result.message = fmt::format("Two runs of different accuracy differ by {}, more than the tolerance.", number.difference);
    return;
  }
  const Rational error = abs(*actual - expected);
  result.passed = !(allowed < error);
  result.message = fmt::format("off by {:.2g}; {} digits are agreed on", error.to_double(), number.digits);
}

}  // namespace maupertuis

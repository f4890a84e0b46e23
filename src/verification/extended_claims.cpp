#include "verification/extended_claims.hpp"

#include "verification/judge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

NumberFormat format_of(const Model& model) { return model.experiment.precision.value_or(NumberFormat::Double); }

}  // namespace

bool ExtendedClaims::takes(const expectation::ValueAt& e) const {
  if (format_of(model_) == NumberFormat::Double) return false;
  const auto& coordinates = model_.system.coordinates;
  return std::any_of(coordinates.begin(), coordinates.end(),
                     [&](const Coordinate& c) { return c.q == e.subject || c.velocity == e.subject; });
}

/// As written where it is a number: 0.1 is a tenth. What π or a root stands in is known to 16 digits.
Rational ExtendedClaims::exact(Expr e) const {
  if (!e) return 0;
  const Expr value = in_terms_of_motion(model_.system, {&e, 1}).front();
  const Rational* number = value.number_or_null();
  return number ? *number : Rational::from_double(number_of(model_.system, e));
}

void ExtendedClaims::decide(const std::vector<Line>& lines, std::vector<ExpectationResult>& results,
                            Diagnostics& diagnostics) const {
  ExtendedSimulationOptions options;
  options.precision = format_of(model_) == NumberFormat::Quad ? Precision::Quad : Precision::Digits100;
  options.duration = Rational(0);  // as far as the times asked for
  options.interrupt = interrupt_;
  for (const Line& line : lines)
    options.at.push_back(exact(line.expectation->time ? line.expectation->time : model_.experiment.start_time));
  const auto run = simulate_extended(model_, equations_, options, diagnostics);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ExpectationResult& result = results[lines[i].index];
    if (!run)
      result.message = "The run could not start.";
    else
      judge(*lines[i].expectation, run->at[i], run->reason, result);
  }
}

const AgreedNumber& ExtendedClaims::value_in(const ExtendedState& state, Expr subject) const {
  const auto& coordinates = model_.system.coordinates;
  std::size_t i = 0;
  while (coordinates[i].q != subject && coordinates[i].velocity != subject) ++i;
  return coordinates[i].q == subject ? state.q[i] : state.v[i];
}

/// What two runs do not agree on counts as error.
void ExtendedClaims::judge(const expectation::ValueAt& e, const ExtendedState& state, const std::string& reason,
                           ExpectationResult& result) const {
  if (!state.reached) {
    result.message = ended_before(reason);
    return;
  }
  const AgreedNumber& number = value_in(state, e.subject);
  const auto actual = Rational::parse(number.text), difference = Rational::parse(number.difference);
  const auto& [value, tolerance, unit] = e.expected;
  const Rational expected = exact(value);
  const Rational allowed = !tolerance.size ? abs(expected) * Rational(1, 1'000'000'000)
                                           : exact(tolerance.size) * (tolerance.relative ? abs(expected) : Rational(1));
  result.actual = number.text + (unit.name.empty() ? "" : " (in SI)");
  result.expected = fmt::format("{:.17g}{}", expected.to_double() / unit.factor, unit_after(unit));
  result.tolerance = tolerance_text(tolerance, unit, model_.system);
  if (!actual || !difference || allowed < *difference) {
    result.message =
        fmt::format("Two runs of different accuracy differ by {}, more than the tolerance.", number.difference);
    return;
  }
  const Rational error = abs(*actual - expected);
  result.passed = !(allowed < error);
  result.message = fmt::format("off by {:.2g}; {} digits are agreed on", error.to_double(), number.digits);
}

}  // namespace maupertuis

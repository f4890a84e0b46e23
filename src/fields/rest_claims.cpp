#include "fields/rest_claims.hpp"

#include "fields/rest_answers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {

void judge_field_value(ExpectationResult& r, const GivenValue& given, const FieldRunResult::Value& actual,
                       const std::string& source) {
  if (!std::isfinite(actual.value)) {
    r.passed = false, r.actual = "no value";
    r.message = "The elements have no such derivative, or the expression has no value there.";
    return;
  }
  const ValueVerdict verdict = value_verdict(actual.value, given.value, given.tolerance, actual.error);
  const double factor = given.unit.factor, off = (actual.value - given.value) / factor;
  const std::string unit = given.unit.name.empty() ? "" : " " + given.unit.name;
  r.passed = verdict.passed, r.beyond_digits = verdict.beyond_digits;
  r.actual = fmt::format("{:.16g}{}", actual.value / factor, unit);
  r.expected = fmt::format("{:.16g}{}", given.value / factor, unit);
  r.tolerance = fmt::format("± {:.3g}{}", given.tolerance / factor, unit);
  const bool estimated = std::isfinite(actual.error);
  r.uncertainty = estimated ? fmt::format("± {:.2g}{}", actual.error / factor, unit) : "no digit is certain";
  if (!r.passed && !estimated)
    r.message = fmt::format("It is off by {:.3g}{}, and there is no estimate of the error of {}.", off, unit, source);
  else if (!r.passed)
    r.message = fmt::format("It is off by {:.3g}{}; the error of {} is estimated as {:.2g}{}.", off, unit, source,
                            actual.error / factor, unit);
}

namespace {

/// Values first; where all are as expected, the word.
void judge_rest(const AskedRest& asked, const std::vector<FieldRunResult::Value>& values, const RestAnswers& rest,
                ExpectationResult& r) {
  for (std::size_t i = 0; i < asked.expected.size(); ++i) {
    judge_field_value(r, asked.expected[i].value, values[i], "the functions of the equilibrium");
    if (const std::string& name = asked.expected[i].name; !name.empty()) {
      r.actual = name + " = " + r.actual;
      r.expected = name + " = " + r.expected;
    }
    if (!r.passed) return;
  }
  if (asked.word.empty() || (r.passed = asked.word == rest.stability)) return;
  r.actual = rest.stability, r.expected = asked.word;
  r.tolerance.clear(), r.uncertainty.clear();
  r.message = "Stable is a minimum of the energy to second order.";
}

}  // namespace

void judge_rests(const FieldEquations& equations, const std::vector<AskedRest>& asked, Verification& out) {
  if (asked.empty()) return;
  std::vector<FieldQuestion> questions;
  for (const AskedRest& one : asked) questions.insert(questions.end(), one.questions.begin(), one.questions.end());
  const RestAnswers rest = answers_at_rest(equations, questions);
  auto next = rest.values.begin();
  for (const AskedRest& one : asked) {
    ExpectationResult& r = out.results[one.line];
    if (!rest.trouble.empty()) {
      r.actual = "no equilibrium";
      r.message = rest.trouble;
      continue;
    }
    const auto end = next + static_cast<std::ptrdiff_t>(one.questions.size());
    judge_rest(one, {next, end}, rest, r);
    next = end;
  }
}

}  // namespace maupertuis

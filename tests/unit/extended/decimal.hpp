#pragma once
#include "../model_text.hpp"

#include <maupertuis/extended_simulation.hpp>

#include <boost/multiprecision/cpp_dec_float.hpp>

/// Decimal numbers of 130 digits: another arithmetic than the one under test.
using Decimal = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<130>, boost::multiprecision::et_off>;

inline maupertuis::Rational rational(const Decimal& x) {
  return *maupertuis::Rational::parse(x.str(125, std::ios_base::scientific));
}

inline maupertuis::ExtendedResult run(const ModelText& m, const maupertuis::ExtendedSimulationOptions& options) {
  maupertuis::Diagnostics diagnostics;
  auto result = maupertuis::simulate_extended(m.model, m.equations, options, diagnostics);
  INFO(maupertuis::render(diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

inline maupertuis::ExtendedSimulationOptions digits100() {
  maupertuis::ExtendedSimulationOptions options;
  options.precision = maupertuis::Precision::Digits100;
  return options;
}

/// All digits that are claimed are right, to half a unit of the last one, and at least so many are claimed.
inline void check_digits(const maupertuis::AgreedNumber& x, const Decimal& truth, int least) {
  CAPTURE(x.text);
  CAPTURE(truth.str(105));
  CHECK(x.digits >= least);
  const std::string ours = truth.str(std::max(x.digits, 1) - 1, std::ios_base::scientific);
  const Decimal unit = pow(Decimal(10), std::stoi(ours.substr(ours.find('e') + 1)) + 1 - x.digits);
  CHECK(abs(Decimal(x.text) - truth) <= Decimal("0.5001") * unit);
}

/// A number that is zero in truth: nothing is claimed beyond the error.
inline void check_zero(const maupertuis::AgreedNumber& x, double bound) {
  CAPTURE(x.text);
  CHECK(std::abs(std::stod(x.text)) <= bound);
  CHECK(std::stod(x.difference) <= bound);
}

#include "../model_text.hpp"

#include <cmath>
#include <maupertuis/verification.hpp>

#include <limits>

using namespace maupertuis;

namespace value_verdict_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

ExpectationResult only(const std::string& text) {
  const ModelText m(text);
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front();
}

const std::string double_pendulum = R"(system double_pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord a, b : angle
point A mass m at l (sin a, -cos a)
point B mass m at A + l (sin b, -cos b)
gravity (0, -g)
start a = 120 deg, b = -10 deg
)";

}  // namespace

TEST_CASE("a value passes just inside its tolerance and fails just outside") {
  CHECK(value_verdict(1.25, 1, 0.25, 0).passed);
  CHECK(value_verdict(0.75, 1, 0.25, 0).passed);
  CHECK_FALSE(value_verdict(std::nextafter(1.25, 2), 1, 0.25, 0).passed);
  CHECK_FALSE(value_verdict(std::nextafter(0.75, 0), 1, 0.25, 0).passed);
  CHECK_FALSE(value_verdict(1, 1, 0.25, std::nan("")).beyond_digits);
}

TEST_CASE("an expectation that asks for more than is known is no clean pass, and by luck none at all") {
  CHECK_FALSE(value_verdict(1, 1, 1e-9, 1e-9).beyond_digits);
  const ValueVerdict beyond = value_verdict(1, 1, 1e-9, 1.01e-9);
  CHECK(beyond.passed);
  CHECK(beyond.beyond_digits);
  CHECK(value_verdict(1, 1, 1e-9, 1e-7).passed);
  const ValueVerdict luck = value_verdict(1, 1, 1e-9, 1.01e-7);
  CHECK_FALSE(luck.passed);
  CHECK(luck.may_hold);
  CHECK_FALSE(value_verdict(1, 1, 1e9, infinity).passed);
  CHECK(value_verdict(1, 1, 1e9, infinity).beyond_digits);
}

TEST_CASE("what fails although the right value may be within the tolerance is told apart from what is wrong") {
  CHECK(value_verdict(1.5, 1, 0.1, 0.4).may_hold);
  CHECK_FALSE(value_verdict(1.5, 1, 0.1, 0.39).may_hold);
  CHECK_FALSE(value_verdict(1.5, 1, 0.1, 0.4).passed);
  CHECK_FALSE(value_verdict(1.05, 1, 0.1, 0.01).may_hold);  // it passes
}

TEST_CASE("the last bits of double are as much as can be known") {
  CHECK(value_verdict(0.1, 0.1, 0, 1e-17).passed);
  CHECK_FALSE(value_verdict(0.1, 0.1, 0, 1e-17).beyond_digits);
  CHECK(value_verdict(0.1, 0.1, 0, 1e-15).beyond_digits);
}

TEST_CASE("seventeen digits of a chaotic motion are no expectation, even those that it printed") {
  // What the run itself says at 60 s: it agrees to the bit, and nothing is known of it.
  const ModelText m(double_pendulum + "run 60 s\n");
  Diagnostics diagnostics;
  SimulationOptions options;
  options.errors = ErrorEstimates::None;
  const auto run = simulate(m.model, m.equations, options, diagnostics);
  REQUIRE(run);
  char own[64];
  std::snprintf(own, sizeof own, "%.17g", run->final.v[0]);
  const ExpectationResult r = only(double_pendulum + "run 60 s\nexpect a' at 60 s = " + own + " rad/s ± 1e-9 rad/s\n");
  CHECK_FALSE(r.passed);
  CHECK(r.beyond_digits);
  CHECK(r.uncertainty == "no digit is certain");
  CHECK(r.message.find("no digit") != std::string::npos);
}

TEST_CASE("digits that are known pass without a word") {
  const ExpectationResult r = only(double_pendulum + "run 20 s\nexpect b at 20 s = -5.0034073 rad ± 1e-6 rad\n");
  CHECK(r.passed);
  CHECK_FALSE(r.beyond_digits);
  CHECK(r.uncertainty.find("e-0") != std::string::npos);
}

}  // namespace value_verdict_test

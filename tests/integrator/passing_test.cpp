#include "mechanics.hpp"

#include <doctest/doctest.h>

#include <cmath>

// Places where a formula is singular: passed where the motion is not, and never where it is.

using namespace maupertuis;

namespace {

/// x'' = −V'(x) until t; the energy at the end, relative.
struct Fall {
  StepEnding ending = StepEnding::None;
  double x = 0, v = 0;
};

Fall fall(double x, double v, double until, Expr (*potential)(Expr)) {
  Mechanics m;
  const auto q = m.coordinate("x", x, v);
  m.natural(pow(m.dot(q), 2) / Rational(2), potential(q));
  auto stepper = m.stepper();
  while (stepper.time() < until) {
    const Step step = stepper.step(until);
    if (step.ending != StepEnding::None) return {step.ending, stepper.q()[0], stepper.v()[0]};
  }
  return {StepEnding::None, stepper.q()[0], stepper.v()[0]};
}

}  // namespace

TEST_CASE("a removable singularity is passed, and the energy holds") {
  const auto well = [](Expr x) { return -sin(x) / x; };
  const Fall end = fall(2, 0, 20, well);
  REQUIRE(end.ending == StepEnding::None);
  CHECK(end.v * end.v / 2 - std::sin(end.x) / end.x == doctest::Approx(-std::sin(2.0) / 2).epsilon(1e-12));
  const Fall from_there = fall(0, 0.3, 20, well);
  REQUIRE(from_there.ending == StepEnding::None);
  CHECK(from_there.v * from_there.v / 2 - std::sin(from_there.x) / from_there.x ==
        doctest::Approx(0.045 - 1).epsilon(1e-12));
}

TEST_CASE("true singularities end the motion") {
  const auto attraction = [](Expr x) {
    return apply(Kind::Log, pow(x, Rational(2)));
  };  // reached with infinite velocity
  CHECK(fall(1, 0, 10, attraction).ending != StepEnding::None);
  const auto charge = [](Expr x) { return -pow(pow(x, Rational(2)), Rational(-1, 2)); };
  CHECK(fall(1, 0.5, 10, charge).ending != StepEnding::None);
  const auto cusp = [](Expr x) {
    return pow(pow(x, Rational(2)), Rational(1, 2)) * Rational(2);
  };  // the force jumps by 4
  const Fall end = fall(1, 0, 10, cusp);
  if (end.ending == StepEnding::None)
    CHECK(end.v * end.v / 2 + 2 * std::abs(end.x) == doctest::Approx(2).epsilon(1e-12));
}

#include "mechanics.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {

/// A pendulum of length 1 in x and y under gravity 1.
void build_rod(Mechanics& m, double x, double y, double vx, double vy) {
  const auto px = m.coordinate("x", x, vx), py = m.coordinate("y", y, vy);
  const Expr rod = m.context.symbol("λ", Role::Multiplier), phi = pow(px, 2) + pow(py, 2) - Rational(1);
  m.natural((pow(m.dot(px), 2) + pow(m.dot(py), 2)) / Rational(2), py);
  m.source.multipliers = {rod};
  m.source.constraints = {{phi, 0, "rod"}};
  m.source.residual[0] = m.source.residual[0] - rod * differentiate(phi, px);
  m.source.residual[1] = m.source.residual[1] - rod * differentiate(phi, py);
}

double length(const TaylorStepper& stepper) { return std::hypot(stepper.q()[0], stepper.q()[1]); }

}  // namespace

TEST_CASE("a start off its constraint is moved onto it, also from far away") {
  for (const double factor : {1.001, 1.5, 3.0, 8.0}) {
    CAPTURE(factor);
    Mechanics m;
    build_rod(m, 0.6 * factor, -0.8 * factor, 0, 0);
    auto stepper = m.stepper();
    CHECK(advance(stepper, 1).ending == StepEnding::None);
    CHECK(std::abs(length(stepper) - 1) < 1e-14);
    Mechanics right;
    build_rod(right, 0.6, -0.8, 0, 0);
    auto wanted = right.stepper();
    advance(wanted, 1);
    CHECK(std::abs(stepper.q()[0] - wanted.q()[0]) < 1e-13);
  }
}

TEST_CASE("constraints hold to rounding over a long run, with and without an event that is watched") {
  for (const bool watched : {false, true}) {
    CAPTURE(watched);
    Mechanics m;
    build_rod(m, 1, 0, 0, 0.5);
    if (watched) m.source.events = {m.source.coordinates[1] - Rational(3)};
    auto stepper = m.stepper();
    CHECK(advance(stepper, 1000).ending == StepEnding::None);
    CHECK(std::abs(length(stepper) - 1) < 2e-15);
    CHECK(std::abs(stepper.q()[0] * stepper.v()[0] + stepper.q()[1] * stepper.v()[1]) < 4e-15);
  }
}

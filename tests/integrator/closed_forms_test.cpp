#include "mechanics.hpp"

#include <doctest/doctest.h>

#include <cmath>

// Motions whose values at a time are known from elsewhere: closed forms and an independent integrator's digits.

using namespace maupertuis;

TEST_CASE("harmonic oscillator over a hundred periods") {
  Mechanics m;
  build_oscillator(m, 0.8, -0.6);
  auto stepper = m.stepper();
  const double end = 628.0;
  advance(stepper, end);
  CHECK(stepper.time() == end);
  CHECK(std::abs(stepper.q()[0] - (0.8 * std::cos(end) - 0.6 * std::sin(end))) < 1e-12);
  CHECK(std::abs(stepper.v()[0] - (-0.8 * std::sin(end) - 0.6 * std::cos(end))) < 1e-12);
}

TEST_CASE("Kepler's orbit with e = 0.6 over many periods agrees with Kepler's equation") {
  Mechanics m;
  const double e = 0.6;
  build_kepler(m, e);
  auto stepper = m.stepper();
  for (const double t : {1.0, 10.0, 100.0, 300.0}) {
    advance(stepper, t);
    long double anomaly = t;
    for (int i = 0; i < 100; ++i)
      anomaly -= (anomaly - e * std::sin(anomaly) - static_cast<long double>(t)) / (1 - e * std::cos(anomaly));
    CAPTURE(t);
    // The phase error of a rounding error in the energy grows linearly with time.
    CHECK(std::abs(stepper.q()[0] - static_cast<double>(std::cos(anomaly) - e)) < 2e-14 * (1 + 3 * t));
    CHECK(std::abs(stepper.q()[1] - static_cast<double>(0.8L * std::sin(anomaly))) < 2e-14 * (1 + 3 * t));
  }
}

TEST_CASE("the pendulum reaches an angle at the time that the elliptic integral gives") {
  Mechanics m;
  const double k = 0.9;  // sin of half the amplitude; passes the bottom at t = 0
  const auto angle = m.coordinate("a", 0, 2 * k);
  m.natural(pow(m.dot(angle), 2) / Rational(2), -cos(angle));
  auto stepper = m.stepper();
  for (const double t : {0.3, 0.8, 1.3}) {
    advance(stepper, t);
    CHECK(std::ellint_1(k, std::asin(std::sin(stepper.q()[0] / 2) / k)) == doctest::Approx(t).epsilon(1e-14));
  }
}

TEST_CASE("double pendulum from points: reference values of an independent integrator") {
  Mechanics m;
  build_double_pendulum(m);
  auto stepper = m.stepper();
  struct Reference {
    double t, a, b, tolerance;
  };
  for (const auto& [t, a, b, tolerance] : {Reference{1, -0.08386042040500097, -1.313096450613925, 1e-13},
                                           Reference{2, -2.922032235907541, 0.11738517220261478, 1e-13},
                                           Reference{5, 8.191078459414503, 0.0150169205862499, 5e-12},
                                           Reference{10, -0.753128874295, 1.627933082054, 1e-6}}) {
    advance(stepper, t);
    CAPTURE(t);
    CHECK(std::abs(stepper.q()[0] - a) < tolerance);
    CHECK(std::abs(stepper.q()[1] - b) < tolerance);
  }
}

TEST_CASE("a driven system: resonance grows linearly") {
  Mechanics m;  // x'' + x = cos t from rest: x = t sin(t) / 2
  const auto x = m.coordinate("x", 0, 0);
  m.natural(pow(m.dot(x), 2) / Rational(2), pow(x, 2) / Rational(2) - x * cos(m.context.time()));
  auto stepper = m.stepper();
  advance(stepper, 50);
  CHECK(std::abs(stepper.q()[0] - 25 * std::sin(50.0)) < 1e-12);
}

TEST_CASE("a pendulum that turns over keeps its energy, and its angle is counted on") {
  Mechanics m;
  const auto angle = m.coordinate("a", 0, 40);
  m.natural(pow(m.dot(angle), 2) / Rational(2), -cos(angle));
  m.source.observables.push_back(angle);
  auto stepper = m.stepper();
  const double begin = stepper.sample(0).observables[0];
  double before = 0, worst = 0;
  while (stepper.time() < 3000) {
    stepper.step(3000);
    const Sample now = stepper.sample(stepper.time());
    CHECK(now.q[0] == doctest::Approx(stepper.q()[0]).epsilon(1e-15));
    CHECK(now.observables[1] == doctest::Approx(now.q[0]).epsilon(1e-15));
    CHECK(now.q[0] > before);
    CHECK(now.q[0] < before + 20);
    before = now.q[0];
    worst = std::max(worst, std::abs(now.observables[0] - begin));
  }
  // θ − v t stays within 1/v of the mean advance; 19,000 turns.
  CHECK(before == doctest::Approx(40.0 * 3000).epsilon(1e-3));
  CHECK(worst < 1e-11);  // of an energy of 800; angles of 10⁵ rad would be off by 10⁻¹¹ each
}

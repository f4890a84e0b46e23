// The end of a step as a check: passes just inside of what is allowed, fails just outside.
#include "integrator/taylor/end_check.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace maupertuis;
using taylor::EndCheck;

namespace end_check_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Velocities so far 2 and 1e-3, steps of length 0.5; coefficients of order 2 are halves of q̈.
struct Step {
  EndCheck check;
  std::vector<double> half_a{1.5, 2e-4};
  static constexpr double h = 0.5;

  explicit Step(double tolerance) : check(2, tolerance) {
    const double v[] = {2, -1e-3}, none[] = {0, 0};
    check.note_rates(v, none, 1, h);
  }
  std::vector<double> off(std::size_t i, double by) const {
    std::vector<double> a{2 * half_a[0], 2 * half_a[1]};
    a[i] += by;
    return a;
  }
  bool agrees(std::size_t i, double by) const { return check.agrees(off(i, by), half_a.data(), 1, h); }
  bool agrees_on_the_whole(std::size_t i, double by) const {
    return check.agrees_on_the_whole(off(i, by), half_a.data(), h);
  }
  bool agrees_but_for(double rounding, std::size_t i, double by) const {
    const std::vector<double> roundings{rounding, rounding}, a = off(i, 0);
    return check.agrees_but_for_rounding(off(i, by), a, roundings, h);
  }
};

}  // namespace

TEST_CASE("h times the change of an acceleration is measured against the velocity of its coordinate") {
  for (const double tolerance : {0.0, 1e-9}) {
    CAPTURE(tolerance);
    const Step step(tolerance);
    const double allowed = tolerance > 0 ? 1e-8 : 1e-12;
    for (const double sign : {1.0, -1.0}) {
      CHECK(step.agrees(0, sign * 0.95 * allowed * 2 / Step::h));
      CHECK_FALSE(step.agrees(0, sign * 1.05 * allowed * 2 / Step::h));
      CHECK(step.agrees(1, sign * 0.95 * allowed * 1e-3 / Step::h));
      CHECK_FALSE(step.agrees(1, sign * 1.05 * allowed * 1e-3 / Step::h));
    }
  }
}

TEST_CASE("a step that halving did not mend is measured against the fastest coordinate") {
  const Step step(1e-9);
  for (const std::size_t i : {0u, 1u}) {
    CHECK(step.agrees_on_the_whole(i, 0.95e-8 * 2 / Step::h));
    CHECK_FALSE(step.agrees_on_the_whole(i, -1.05e-8 * 2 / Step::h));
  }
}

TEST_CASE("rounding is allowed besides, 64 times") {
  const Step step(0);
  const double by_velocity = 1e-12 * 2 / Step::h, own = 64 * epsilon * 3;
  CHECK(step.agrees_but_for(0, 0, 0.95 * (by_velocity + own)));
  CHECK_FALSE(step.agrees_but_for(0, 0, 1.05 * (by_velocity + own)));
  const double noise = 1e-9;
  CHECK(step.agrees_but_for(noise, 1, 0.98 * 64 * noise));
  CHECK_FALSE(step.agrees_but_for(noise, 1, -1.02 * 64 * noise));
}

TEST_CASE("what rounding made of accelerations counts at the next seven ends, and no further") {
  const std::vector<double> a{2, 1e-5}, roundings{2e-15, 4e-13};  // of the largest: 1e-15, 2e-13
  const auto off = [&](double by) { return std::vector<double>{a[0], a[1] + by}; };
  EndCheck check(2, 0);
  const double h = 1e-6;
  CHECK_FALSE(check.agrees_as_noted(a, a, h));  // nothing is noted
  check.note_roundings(roundings, a);
  for (int end = 0; end < 7; ++end) {
    const double by = end % 2 == 0 ? 0.95 * 64 * 4e-13 : 1.05 * 64 * 4e-13;
    CHECK(check.agrees_as_noted(off(by), a, h) == (end % 2 == 0));
  }
  CHECK_FALSE(check.agrees_as_noted(a, a, h));
  // In units of the largest: at ten times the accelerations ten times as much.
  check.note_roundings(roundings, a);
  const std::vector<double> larger{20, 1e-5};
  CHECK(check.agrees_as_noted(std::vector<double>{20, 1e-5 + 0.95 * 64 * 4e-12}, larger, h));
  CHECK_FALSE(check.agrees_as_noted(std::vector<double>{20, 1e-5 + 1.05 * 64 * 4e-12}, larger, h));
  // What was noted before counts by half, until it is forgotten.
  check.note_roundings(std::vector<double>{0, 0}, a);
  CHECK(check.agrees_as_noted(off(0.95 * 32 * 4e-13), a, h));
  CHECK_FALSE(check.agrees_as_noted(off(1.05 * 32 * 4e-13), a, h));
  check.forget();
  CHECK_FALSE(check.agrees_as_noted(a, a, h));
  // Where it is large it belongs to a place next to a singular mass matrix.
  check.note_roundings(std::vector<double>{0, 2.1e-11}, a);
  CHECK_FALSE(check.agrees_as_noted(a, a, h));
}

TEST_CASE("velocities are kept until they are forgotten, and h q'' counts as one") {
  Step step(0);
  const double slow[] = {0, 0}, half[] = {0, 8};
  step.check.note_rates(slow, half, 1, 0.25);
  CHECK(step.check.rates()[0] == 2);
  CHECK(step.check.rates()[1] == 4);
  step.check.forget();
  CHECK(step.check.rates()[0] == 0);
}

TEST_CASE("roundings of the equations reach the accelerations through the inverse of the bordered matrix") {
  // x'' + 3 sin x = 0 written as 4 x'' + 12 sin x = 0.
  Context context;
  const Expr x = context.symbol("x", Role::Coordinate);
  KernelSource source;
  source.coordinates = {x};
  source.residual = {Rational(4) * context.time_derivative(context.time_derivative(x)) + Rational(12) * sin(x)};
  const Kernel kernel = build_kernel(source);
  KernelWorkspace work(kernel, 4);
  work.set_parameters({});
  const double q[] = {1}, v[] = {0};
  REQUIRE(work.evaluate(0, q, v) == KernelStatus::Ok);
  Disks disks(work.program());
  disks.set_constants(work.constants());
  disks.begin({work.coordinate(0), work.row_stride(), 1});
  const std::vector<double> bordered = taylor::bordered_matrix(work, 1, 0);
  REQUIRE(bordered.size() == 1);
  CHECK(bordered[0] == doctest::Approx(4));
  const double of_residual = disks.residual_rounding(0, 0.1);
  CHECK(of_residual > 12 * std::sin(1.0));
  CHECK(taylor::acceleration_roundings(bordered, 1, 0, disks, 0.1, epsilon)[0] ==
        doctest::Approx(epsilon * of_residual / 4));
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(taylor::acceleration_roundings({infinity}, 1, 0, disks, 0.1, epsilon)[0] == 0);
  CHECK(taylor::acceleration_roundings({0}, 1, 0, disks, 0.1, epsilon)[0] == 0);
  CHECK(taylor::acceleration_roundings({}, 1, 0, disks, 0.1, epsilon)[0] == 0);
}

}  // namespace end_check_test

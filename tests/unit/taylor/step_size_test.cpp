// Multipliers shorten a step where they are felt.
#include "integrator/taylor/step_size.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

using namespace maupertuis;

namespace {

/// The length that λ allows of a step of length 1. A point of mass 1 is led along x = t at speed 1 against the force
/// strength/(1.1 − t), so that λ is its opposite and its series converges slowly; a second point rests at y = 0.
double allowed(Rational strength) {
  Context context;
  const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate),
             push = context.symbol("λ", Role::Multiplier), t = context.time();
  const auto second = [&](const Expr& e) { return context.time_derivative(context.time_derivative(e)); };
  KernelSource source;
  source.coordinates = {x, y};
  source.multipliers = {push};
  source.residual = {second(x) - strength / (-t + Rational(11, 10)) - push, second(y)};
  source.constraints = {{x - t, 0, "guide"}};
  KernelWorkspace work(build_kernel(source), 20);
  work.set_parameters({});
  const double q[] = {0, 0}, v[] = {1, 0};
  REQUIRE(work.expand(0, q, v) == KernelStatus::Ok);
  return taylor::step_within_multipliers(work, 2, 1, taylor::step_control(0, 20), 1);
}

}  // namespace

TEST_CASE("a multiplier that moves no velocity by its rounding leaves the step alone, also beside what rests") {
  CHECK(allowed(Rational(1, 100'000'000'000'000'000)) == 1);
}

TEST_CASE("a multiplier whose series has not converged shortens the step") {
  for (const Rational& strength : {Rational(1), Rational(1, 10'000'000'000)}) {
    const double length = allowed(strength);
    CHECK(length < 0.7);
    CHECK(length > 0.3);  // (h/1.1)^16 is 1e-6 at 0.46
  }
}

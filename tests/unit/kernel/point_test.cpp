// One workspace at one point after the other: what it keeps from the points before changes nothing.
#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <vector>

using namespace maupertuis;

namespace {

/// Masses 1 + x² and 2 along x and y, with forces of both; led along x = y where it is constrained.
KernelSource two_coordinates(Context& context, bool constrained) {
  const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate),
             push = context.symbol("λ", Role::Multiplier);
  const auto second = [&](const Expr& e) { return context.time_derivative(context.time_derivative(e)); };
  KernelSource source;
  source.coordinates = {x, y};
  source.residual = {(x * x + Rational(1)) * second(x) - sin(y), second(y) * Rational(2) + x * y};
  if (constrained) {
    source.multipliers = {push};
    source.constraints = {{x - y, 0, "guide"}};
    source.residual[0] = source.residual[0] - push;
    source.residual[1] = source.residual[1] + push;
  }
  const Expr distance = sqrt(x * x + y * y + Rational(1));
  source.events = {distance - Rational(2), context.time_derivative(distance), second(x) + y};
  source.observables = {distance * x};
  return source;
}

struct PlaceOfTwo {
  std::vector<double> q, v;
};

/// The same x twice, and back to it: M is what it was, another, and what it was.
const std::vector<PlaceOfTwo> points{
    {{0.3, 0.3}, {0.1, 0.1}}, {{0.3, 0.3}, {-0.7, -0.7}}, {{1.1, 1.1}, {0.2, 0.2}}, {{0.3, 0.3}, {0.4, 0.4}}};

}  // namespace

TEST_CASE("accelerations of one workspace are those of a fresh one, with a mass that stays and one that changes") {
  for (const bool constrained : {false, true}) {
    Context context;
    const Kernel kernel = build_kernel(two_coordinates(context, constrained));
    for (const int order : {1, 12}) {
      KernelWorkspace work(kernel, order);
      work.set_parameters({});
      for (const PlaceOfTwo& p : points) {
        KernelWorkspace fresh(kernel, order);
        fresh.set_parameters({});
        REQUIRE(work.expand(0, p.q, p.v) == KernelStatus::Ok);
        REQUIRE(fresh.expand(0, p.q, p.v) == KernelStatus::Ok);
        for (int k = 0; k <= order + 1; ++k)
          for (std::size_t i = 0; i < 2; ++i) CHECK(work.coordinate(k)[i] == fresh.coordinate(k)[i]);
      }
      CHECK(work.acceleration(0) != 0);
    }
  }
}

TEST_CASE("events of a point alone are those of an expansion there, whenever they are asked for") {
  Context context;
  const Kernel kernel = build_kernel(two_coordinates(context, false));
  KernelWorkspace point(kernel, 1), whole(kernel, 12);
  point.set_parameters({});
  whole.set_parameters({});
  for (const PlaceOfTwo& p : points) {
    REQUIRE(point.evaluate(0, p.q, p.v) == KernelStatus::Ok);
    REQUIRE(whole.expand(0, p.q, p.v) == KernelStatus::Ok);
    CHECK(point.observable(0) == doctest::Approx(whole.observable(0)).epsilon(1e-15));
    for (std::size_t i = 0; i < kernel.events(); ++i) {
      CHECK(point.event_scale(i) == doctest::Approx(whole.event_scale(i)).epsilon(1e-15));
      CHECK(point.event(i, 0) == doctest::Approx(whole.event(i, 0)).epsilon(1e-15));
    }
    CHECK(point.event(0, 1) == doctest::Approx(whole.event(0, 1)).epsilon(1e-15));
    CHECK(point.event(0, 1) == doctest::Approx(point.event(1, 0)).epsilon(1e-15));
  }
}

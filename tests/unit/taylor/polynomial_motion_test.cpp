// Motions on parabolas: short expansions, long steps, and steps that go on where only what is watched changes.
#include "integrator/taylor/polynomial_motion.hpp"
#include "disks/unread_switches.hpp"

#include <doctest/doctest.h>
#include <maupertuis/integrator.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <vector>

using namespace maupertuis;

namespace {

/// A point in the plane with a force along x.
struct Point {
  Context context;
  const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate), t = context.time();
  KernelSource source;

  explicit Point(const std::function<Expr(Point&)>& force) {
    source.coordinates = {x, y};
    source.residual = {second(x) - force(*this), second(y)};
  }
  Expr first(const Expr& e) { return context.time_derivative(e); }
  Expr second(const Expr& e) { return first(first(e)); }
  Expr number(Rational r) { return context.number(r); }
  Expr of(Kind kind, Expr a) { return apply(kind, a); }
};

Expr pull(Point& p) { return p.number(Rational(-10)); }

int order_of(Point& p) {
  return taylor::control_of(build_kernel(p.source).program(), taylor::step_control(0, 0)).order;
}

bool is_exact(Point& p) {
  return taylor::control_of(build_kernel(p.source).program(), taylor::step_control(0, 0)).is_exact;
}

}  // namespace

TEST_CASE("the order of a motion on parabolas is what its functions need") {
  Point p(pull);
  CHECK(is_exact(p));
  CHECK(order_of(p) == 3);
  p.source.events = {p.x * p.x * p.x};  // degree 6
  CHECK(order_of(p) == 5);
  p.source.events = {p.first(p.x) * p.x * p.x};  // degree 5, of velocities: one order more
  CHECK(order_of(p) == 5);
  p.source.events = {sqrt(p.x * p.x + p.number(1))};
  CHECK(order_of(p) == 10);
  p.source.events.clear();
  p.source.integrands = {p.of(Kind::Exp, p.x)};
  CHECK(order_of(p) == 20);
  CHECK(is_exact(p));
}

TEST_CASE("a force that changes along a motion makes it none on parabolas") {
  const std::vector<std::function<Expr(Point&)>> forces{[](Point& p) { return -p.x; }, [](Point& p) { return p.t; },
                                                        [](Point& p) { return -p.first(p.y); },
                                                        [](Point& p) { return -p.x * p.second(p.y); }};
  for (const auto& force : forces) {
    Point p(force);
    CHECK_FALSE(is_exact(p));
    CHECK(order_of(p) == 20);
  }
  Point switched([](Point& p) { return p.of(Kind::Sign, p.y); });  // constant on each side
  CHECK(is_exact(switched));
}

TEST_CASE("a throw of a thousand seconds is one step, and meets a sphere where the parabola does") {
  Point p(pull);
  p.source.events = {sqrt(p.x * p.x + p.y * p.y) - p.number(100'000)};
  TaylorStepper stepper(build_kernel(p.source), {}, {});
  const double q[] = {0, 0}, v[] = {40, 30};
  stepper.start(0, q, v);
  const Step step = stepper.step(1000);
  REQUIRE(step.event);
  // (40 t − 5 t²)² + (30 t)² = 10¹⁰
  const double t = stepper.time();
  double root = 150;
  for (int turn = 0; turn < 60; ++turn) {
    const double x = 40 * root - 5 * root * root, y = 30 * root;
    root -= (x * x + y * y - 1e10) / (2 * x * (40 - 10 * root) + 2 * y * 30);
  }
  CHECK(std::abs(t - root) <= 4e-16 * root);
  CHECK(stepper.steps() == 1);
  CHECK(stepper.order() == 20);
}

TEST_CASE("switches that nothing of the motion reads") {
  Point p(pull);
  const Expr side = p.of(Kind::Abs, p.x);
  p.source.events = {side - p.number(7)};
  CHECK(switches_of_events_alone(build_kernel(p.source).program()) == std::vector<bool>{true});
  p.source.observables = {side};
  CHECK(switches_of_events_alone(build_kernel(p.source).program()) == std::vector<bool>{false});
  p.source.observables.clear();
  p.source.integrands = {side};
  CHECK(switches_of_events_alone(build_kernel(p.source).program()) == std::vector<bool>{false});
  p.source.integrands.clear();
  p.source.residual[1] = p.second(p.y) - side;
  CHECK(switches_of_events_alone(build_kernel(p.source).program()) == std::vector<bool>{false});
}

TEST_CASE("a step goes on through a switch that only an event has, to the root on its other side") {
  for (const bool backwards : {false, true}) {
    Point p([](Point& point) { return point.number(0); });
    p.source.events = {p.of(Kind::Abs, p.x) + p.of(Kind::Abs, p.y - p.number(2)) - p.number(6)};
    TaylorStepper stepper(build_kernel(p.source), {}, {});
    const double way = backwards ? -1 : 1, q[] = {-3, 1}, v[] = {way, way * 0.25};
    stepper.start(0, q, v);
    const Step step = stepper.step(way * 100);
    REQUIRE(step.event);
    // −3 + t > 0, 1 + t/4 > 2: −3 + t + t/4 − 1 = 6
    CHECK(std::abs(way * stepper.time() - 8) < 2e-15);
    CHECK(stepper.steps() == 1);
    CHECK(stepper.switches() == 2);
  }
}

TEST_CASE("an event that jumps at such a switch ends the step there, and is none") {
  Point p([](Point& point) { return point.number(0); });
  p.source.events = {p.of(Kind::Sign, p.x) * p.number(3) + p.number(1)};  // −2, then 4: no root
  TaylorStepper stepper(build_kernel(p.source), {}, {});
  const double q[] = {-3, 0}, v[] = {1, 0};
  stepper.start(0, q, v);
  const Step step = stepper.step(100);
  CHECK_FALSE(step.event);
  CHECK(stepper.time() == 3);
  CHECK(step.switches.size() == 1);
  while (stepper.time() != 100) CHECK_FALSE(stepper.step(100).event);
}

TEST_CASE("recorded events are told once on both sides of a switch") {
  Point p([](Point& point) { return point.number(0); });
  p.source.events = {p.of(Kind::Abs, p.x) - p.number(1)};
  TaylorStepper stepper(build_kernel(p.source), {}, {});
  stepper.treat_events(std::vector<TaylorStepper::EventTreatment>{{false, true}});
  const double q[] = {-3, 0}, v[] = {1, 0};
  stepper.start(0, q, v);
  std::vector<double> times;
  std::vector<int> directions;
  while (stepper.time() != 10)
    for (const EventRoot& root : stepper.step(10).events)
      times.push_back(root.time), directions.push_back(root.direction);
  REQUIRE(times.size() == 2);
  CHECK(times[0] == doctest::Approx(2).epsilon(1e-15));
  CHECK(times[1] == doctest::Approx(4).epsilon(1e-15));
  CHECK(directions == std::vector<int>{-1, 1});
  CHECK(stepper.steps() == 1);
}

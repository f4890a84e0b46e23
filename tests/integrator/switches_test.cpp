#include "mechanics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

// Functions with a switch, and events, against closed forms.

using namespace maupertuis;

namespace {

/// x'' = −sign x from (0, v): parabolas of period 4 v.
double sawtooth(double t, double v) {
  double phase = std::fmod(t, 4 * v);
  const double side = phase < 2 * v ? 1 : -1;
  if (phase >= 2 * v) phase -= 2 * v;
  return side * (v * phase - phase * phase / 2);
}

Mechanics& with_force(Mechanics& m, Expr x, Expr force) {
  m.source.residual = {m.context.symbol(x.name(), Role::Coordinate, 2) - force};
  return m;
}

}  // namespace

TEST_CASE("V = |x|: parabolas over many crossings") {
  Mechanics m;
  const auto x = m.coordinate("x", 0, 1);
  m.natural(pow(m.dot(x), 2) / Rational(2), apply(Kind::Abs, x));
  auto stepper = m.stepper();
  for (double t = 0.7; t < 300; t += 11.3) {
    while (!stepper.covers(t)) REQUIRE(stepper.step(300).ending == StepEnding::None);
    CHECK(std::abs(stepper.sample(t).q[0] - sawtooth(t, 1)) < 1e-12);
  }
  CHECK(stepper.switches() > 140);
  CHECK(stepper.switches() <= 150);
}

TEST_CASE("V = |x| with a quartic: energy is kept across crossings, forwards and back") {
  Mechanics m;
  const auto x = m.coordinate("x", 0.3, 0.9), y = m.coordinate("y", -0.2, 0.1);
  m.natural((pow(m.dot(x), 2) + pow(m.dot(y), 2)) / Rational(2),
            apply(Kind::Abs, x - y) + apply(Kind::Abs, x + y) + pow(x, 4) + pow(y, 2));
  auto stepper = m.stepper();
  const double start = stepper.sample(0).observables[0];
  advance(stepper, 50);
  CHECK(std::abs(stepper.sample(50).observables[0] - start) < 1e-13 * 10);
  CHECK(stepper.switches() > 40);
  auto back = m.stepper();
  advance(back, 5);
  advance(back, 0);
  CHECK(std::abs(back.q()[0] - 0.3) < 1e-12);
  CHECK(std::abs(back.q()[1] + 0.2) < 1e-12);
}

TEST_CASE("every kind of switch: the same bouncing written in five ways") {
  const auto force = [](Mechanics& m, Expr x, int way) -> Expr {
    Context& c = m.context;
    const Expr one = c.number(1), zero = c.number(0);
    const auto call = [&](Kind kind, std::vector<Expr> a) { return c.function(kind, a); };
    switch (way) {
      case 0:
        return -apply(Kind::Sign, x);
      case 1:
        return one - Rational(2) * apply(Kind::Step, x);
      case 2:
        return call(Kind::Piecewise, {call(Kind::Less, {x, zero}), one, -one});
      case 3:
        return call(
            Kind::Piecewise,
            {call(Kind::And, {call(Kind::LessEqual, {zero, x}), call(Kind::Less, {x, c.number(9)})}), -one, one});
      default:
        return -x / apply(Kind::Abs, x);
    }
  };
  for (int way = 0; way < 4; ++way) {
    CAPTURE(way);
    Mechanics m;
    const auto x = m.coordinate("x", 0, 1.5);
    auto stepper = with_force(m, x, force(m, x, way)).stepper();
    advance(stepper, 100.25);
    CHECK(std::abs(stepper.q()[0] - sawtooth(100.25, 1.5)) < 1e-12);
  }
  for (const Kind kind : {Kind::Min, Kind::Max}) {
    // V = max(x, −x), and −V = min(x, −x)
    Mechanics m;
    const auto x = m.coordinate("x", 0, 1);
    const std::array arguments{x, -x};
    const Expr extremum = m.context.function(kind, arguments);
    m.natural(pow(m.dot(x), 2) / Rational(2), kind == Kind::Max ? extremum : -extremum);
    auto stepper = m.stepper();
    advance(stepper, 100.25);
    CHECK(std::abs(stepper.q()[0] - sawtooth(100.25, 1)) < 1e-12);
  }
}

TEST_CASE("two crossings within what would be one step are both seen") {
  // Free fall x = t(t − 1)·… : a flat-bottomed valley touched for a short while only.
  Mechanics m;  // x'' = 2 while x > 0, x'' = 2 + 1 while x < 0; x = 1 − 2.0002 t + t²: below zero for about 0.02 s
  const auto x = m.coordinate("x", 1, -2.0002);
  with_force(m, x, m.context.number(3) - apply(Kind::Step, x));
  auto stepper = m.stepper();
  advance(stepper, 4);
  CHECK(stepper.switches() == 2);
  // Closed form: down to −v1 at the first root, up with v1 at the second.
  const double v1 = std::sqrt(2.0002 * 2.0002 - 4), t1 = (2.0002 - v1) / 2, t2 = t1 + 2 * v1 / 3;
  const double s = 4 - t2;
  CHECK(std::abs(stepper.q()[0] - (v1 * s + s * s)) < 1e-12);
}

TEST_CASE("grazing: a touch without crossing flips nothing") {
  Mechanics m;  // x = (t − 1)², exactly
  const auto x = m.coordinate("x", 1, -2);
  with_force(m, x, Rational(2) * apply(Kind::Sign, x));
  auto stepper = m.stepper();
  const Step step = advance(stepper, 3);
  CHECK(step.ending == StepEnding::None);
  CHECK(stepper.switches() == 0);
  CHECK(std::abs(stepper.q()[0] - 4) < 1e-13);
}

TEST_CASE("several switches at once") {
  Mechanics m;
  const auto x = m.coordinate("x", 0, 1), y = m.coordinate("y", 0, 1);
  m.natural((pow(m.dot(x), 2) + pow(m.dot(y), 2)) / Rational(2), apply(Kind::Abs, x) + apply(Kind::Abs, y));
  auto stepper = m.stepper();
  advance(stepper, 101.3);
  CHECK(std::abs(stepper.q()[0] - sawtooth(101.3, 1)) < 1e-12);
  CHECK(std::abs(stepper.q()[1] - sawtooth(101.3, 1)) < 1e-12);
}

TEST_CASE("a start on a switch is decided by where the motion goes") {
  for (const double direction : {1.0, -1.0}) {
    Mechanics m;  // the force changes the stiffness: x'' = −x for x > 0, −4 x for x < 0
    const auto x = m.coordinate("x", 0, direction);
    with_force(m, x, -x * (m.context.number(4) - Rational(3) * apply(Kind::Step, x)));
    auto stepper = m.stepper();
    advance(stepper, 0.5);
    CHECK(std::abs(stepper.q()[0] - (direction > 0 ? std::sin(0.5) : -std::sin(1.0) / 2)) < 1e-14);
  }
}

TEST_CASE("at rest on a roof the motion stays; sliding ends with its reason") {
  Mechanics roof;
  auto x = roof.coordinate("x", 0, 0);
  auto stays = with_force(roof, x, apply(Kind::Sign, x)).stepper();
  CHECK(advance(stays, 1).ending == StepEnding::None);
  CHECK(stays.q()[0] == 0);

  Mechanics valley;
  x = valley.coordinate("x", 0, 0);
  auto slides = with_force(valley, x, -apply(Kind::Sign, x)).stepper();
  CHECK(advance(slides, 1).ending == StepEnding::Sliding);

  Mechanics friction;  // x'' = −sign x' from 1: stops at t = 1
  x = friction.coordinate("x", 0, 1);
  auto stops = with_force(friction, x, -apply(Kind::Sign, friction.dot(x))).stepper();
  const Step step = advance(stops, 2);
  CHECK(step.ending == StepEnding::Sliding);
  CHECK(step.reason.find("slide") != std::string::npos);
  CHECK(std::abs(stops.time() - 1) < 1e-14);
  CHECK(std::abs(stops.q()[0] - 0.5) < 1e-14);
}

TEST_CASE("crossings that accumulate end the run") {
  Mechanics m;  // bounces shrink by damping until they take no time
  const auto x = m.coordinate("x", 0, 1);
  with_force(m, x, -apply(Kind::Sign, x) - apply(Kind::Sign, m.dot(x)) / Rational(2));
  auto stepper = m.stepper();
  const Step step = advance(stepper, 100);
  CHECK(step.ending == StepEnding::Sliding);
  CHECK(stepper.steps() < 2000);
}

TEST_CASE("run until: the root of an event function is located to rounding, and the run goes on from it") {
  Mechanics m;
  build_oscillator(m, 0, 1);
  m.source.events = {m.source.coordinates[0]};
  auto stepper = m.stepper();
  const double pi = std::acos(-1.0);
  for (int i = 1; i <= 20; ++i) {
    const Step step = advance(stepper, 1000);
    REQUIRE(step.event == 0u);
    CHECK(std::abs(stepper.time() - i * pi) < 1e-14 * (1 + i));
    CHECK(std::abs(stepper.q()[0]) < 1e-14 * (1 + i));
  }
  auto back = m.stepper();
  REQUIRE(advance(back, -100).event == 0u);
  CHECK(std::abs(back.time() + pi) < 1e-14);
}

TEST_CASE("an event that is never zero does not end the run; a double root does") {
  for (const Rational& level : {Rational(2), Rational(1) + Rational(1, 1'000'000'000), Rational(1)}) {
    Mechanics m;
    build_oscillator(m, 1, 0);
    m.source.events = {m.source.coordinates[0] + level};
    auto stepper = m.stepper();
    const Step step = advance(stepper, 30);
    const bool touches = level == Rational(1);
    CHECK(step.event.has_value() == touches);
    CHECK(std::abs(stepper.time() - (touches ? std::acos(-1.0) : 30)) <
          3e-8);  // a double root is known to half of the digits
  }
}

namespace {

using Formula = std::function<Expr(Context&, Expr)>;

/// x(5) of x'' = f(t) from rest at 0.
double pushed(const Formula& f, StepEnding& ending) {
  Mechanics m;
  const auto x = m.coordinate("x", 0, 0);
  m.natural(pow(m.dot(x), 2) / Rational(2), m.context.number(0));
  with_force(m, x, f(m.context, m.context.time()));
  auto stepper = m.stepper();
  ending = StepEnding::None;
  while (stepper.time() < 5 && ending == StepEnding::None) ending = stepper.step(5).ending;
  return stepper.q()[0];
}

Expr is_above(Context& c, Expr x, int bound) {
  const std::vector<Expr> sides{c.number(bound), x};
  const std::vector<Expr> pieces{c.function(Kind::Less, sides), c.number(1), c.number(0)};
  return c.function(Kind::Piecewise, pieces);
}

/// Times at which f(t) is zero up to 10.
std::vector<double> zeros(const Formula& f) {
  Mechanics m;
  const auto x = m.coordinate("x", 0, 0);
  m.natural(pow(m.dot(x), 2) / Rational(2), m.context.number(0));
  m.source.events = {f(m.context, m.context.time())};
  auto stepper = m.stepper();
  std::vector<double> out;
  while (stepper.time() < 10) {
    const Step step = stepper.step(10);
    REQUIRE(step.ending == StepEnding::None);
    for (const EventRoot& root : step.events) out.push_back(root.time);
  }
  return out;
}

void check_zeros(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(std::abs(found[i] - expected[i]) < 1e-12);
}

}  // namespace

TEST_CASE("a switch function with a pole changes its side there") {
  constexpr double pi = 3.14159265358979323846;
  const auto tan = [](Expr t) { return apply(Kind::Tan, t); };
  StepEnding ending{};
  // x(5) = Σ ∫ (5 − t) over where the force is 1.
  const auto within = [](double a, double b) { return ((5 - a) * (5 - a) - (5 - b) * (5 - b)) / 2; };
  const Formula reciprocal = [](Context& c, Expr t) { return is_above(c, pow(t - c.number(2), -1), 1); };
  CHECK(std::abs(pushed(reciprocal, ending) - 2.5) < 1e-13);
  const Formula below_too = [](Context& c, Expr t) { return is_above(c, pow(t - c.number(2), -1), -1); };
  CHECK(std::abs(pushed(below_too, ending) - (within(0, 1) + within(2, 5))) < 1e-13);
  const Formula of_tangent = [&](Context&, Expr t) { return apply(Kind::Step, tan(t)); };
  CHECK(std::abs(pushed(of_tangent, ending) - (within(0, pi / 2) + within(pi, 1.5 * pi))) < 1e-13);
  const Formula of_log = [](Context& c, Expr t) {
    return apply(Kind::Step, apply(Kind::Log, apply(Kind::Abs, t - c.number(2))));
  };
  CHECK(std::abs(pushed(of_log, ending) - (within(0, 1) + within(3, 5))) < 1e-13);
  CHECK(ending == StepEnding::None);
}

TEST_CASE("a switch function without a value ends the run, unless nothing depends on it") {
  StepEnding ending{};
  const auto root_less_one = [](Context& c, Expr t) { return sqrt(t - c.number(2)) - c.number(1); };
  pushed([&](Context& c, Expr t) { return apply(Kind::Step, root_less_one(c, t)); }, ending);
  CHECK(ending == StepEnding::Overflow);
  pushed([](Context& c, Expr t) { return apply(Kind::Step, sqrt(c.number(4) - t) - c.number(1)); }, ending);
  CHECK(ending == StepEnding::Overflow);
  const Formula guarded = [&](Context& c, Expr t) {
    const std::vector<Expr> sides{c.number(2), t};
    const std::vector<Expr> pieces{c.function(Kind::Less, sides), apply(Kind::Step, root_less_one(c, t)), c.number(0)};
    return c.function(Kind::Piecewise, pieces);
  };
  CHECK(std::abs(pushed(guarded, ending) - 2) < 1e-13);
  CHECK(ending == StepEnding::None);
}

TEST_CASE("events at the border of a domain, and of fractional powers beside their branch points") {
  const auto tenth = [](Context& c) { return c.number(1) / Rational(10); };
  check_zeros(zeros([&](Context& c, Expr t) { return sqrt(t - c.number(2)) - tenth(c); }), {2.01});
  check_zeros(zeros([&](Context& c, Expr t) { return pow(t - c.number(2), Rational(3, 2)) - tenth(c); }),
              {2 + std::pow(0.1, 2.0 / 3)});
  check_zeros(
      zeros([&](Context& c, Expr t) { return sqrt(c.number(1) - Rational(2) * cos(t)) - tenth(c); }),
      {std::acos(0.495), 2 * 3.14159265358979323846 - std::acos(0.495), 2 * 3.14159265358979323846 + std::acos(0.495)});
  const Formula both = [&](Context& c, Expr t) {
    return pow(apply(Kind::Abs, t - c.number(1)), Rational(3, 2)) - tenth(c);
  };
  check_zeros(zeros(both), {1 - std::pow(0.1, 2.0 / 3), 1 + std::pow(0.1, 2.0 / 3)});
}

TEST_CASE("the cut of an angle is no crossing, and ends a force in time") {
  constexpr double pi = 3.14159265358979323846;
  const auto angle = [](Context& c, Expr t) {
    const std::vector<Expr> of{apply(Kind::Sin, t), apply(Kind::Cos, t)};
    return c.function(Kind::Atan2, of);
  };
  check_zeros(zeros([&](Context& c, Expr t) { return angle(c, t) + c.number(2); }), {2 * pi - 2});
  check_zeros(zeros([&](Context& c, Expr t) { return angle(c, t) - c.number(1); }), {1, 1 + 2 * pi});
  StepEnding ending{};
  const Formula force = [&](Context& c, Expr t) { return is_above(c, angle(c, t), 1); };
  CHECK(std::abs(pushed(force, ending) - (16 - (5 - pi) * (5 - pi)) / 2) < 1e-13);
}

#include "../model_text.hpp"
#include "simulation/function_kernels.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/stiff.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiff_test {
namespace {

using namespace maupertuis;
using State = std::vector<double>;

struct Stiff : ModelText {
  explicit Stiff(const std::string& text, const WantedFunctions& wanted = {})
      : ModelText(text),
        functions(motion_functions(equations, {wanted.observables, wanted.events, {equations.power}})),
        parameters(parameter_values(*system)) {}
  StiffStepper stepper(double tolerance) const {
    StiffOptions options;
    options.tolerance = tolerance;
    return {functions, parameters, options};
  }
  MotionFunctions functions;
  State parameters;
};

void run(StiffStepper& stepper, double end) {
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    INFO(step.reason);
    REQUIRE(step.ending == StepEnding::None);
  }
}

StepEnding ending(const std::string& text, const State& q, const State& v, double end) {
  const Stiff m(text);
  auto stepper = m.stepper(1e-9);
  stepper.start(0, q, v);
  while (stepper.time() != end)
    if (const Step step = stepper.step(end); step.ending != StepEnding::None) {
      CHECK(step.reason.find("t = ") != std::string::npos);
      return step.ending;
    }
  return StepEnding::None;
}

constexpr const char* kOscillator =
    "system oscillator\ndimensionless\nparam k = 1e8, c = 1e6\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 k x^2\nD = 1/2 "
    "c x'^2\nforce x = k cos t\n";

constexpr const char* kPendulum =
    "system pendulum\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 9.81 y\nconstraint x^2 + y^2 = 1 "
    "name rod\n";

constexpr const char* kGovernor =
    "system governor\ndimensionless\n"
    "param l = 1, wd = 0.01, d = 0.1, ds = 0.1, H = 1, mr = 0.3, mp = 5, ms = 3, K = 8e5, C = 4e4, l0 = 0.5, g = 9.81\n"
    "coord phi : angle, b1, b2 : angle, s : number\n"
    "let Jsh = 0.3 wd^2/6\nlet Jsl = ms ds^2/6\n"
    "let x1 = d/2 + l/2 cos b1\nlet z1 = H - l/2 sin b1\nlet X1 = d/2 + l cos b1\nlet Z1 = H - l sin b1\n"
    "let x2 = d/2 + l/2 cos b2\nlet z2 = H - l/2 sin b2\nlet X2 = d/2 + l cos b2\nlet Z2 = H - l sin b2\n"
    "let e1 = sqrt((x1 - ds/2)^2 + (z1 - s)^2)\nlet e2 = sqrt((x2 - ds/2)^2 + (z2 - s)^2)\n"
    "T = (Jsh + Jsl) phi'^2/2 + ms s'^2/2 + mr (x1'^2 + z1'^2 + x2'^2 + z2'^2 + (x1^2 + x2^2) phi'^2)/2 + mr (l^2 + "
    "wd^2)/24 (b1'^2 + b2'^2)"
    " + (mr (l^2 + wd^2)/12 (cos(b1)^2 + cos(b2)^2) + mr wd^2/6 (sin(b1)^2 + sin(b2)^2)) phi'^2/2"
    " + mp (X1'^2 + Z1'^2 + X2'^2 + Z2'^2 + (X1^2 + X2^2) phi'^2)/2\n"
    "V = g (ms s + mr (z1 + z2) + mp (Z1 + Z2)) + K ((e1 - l0)^2 + (e2 - l0)^2)/2\n"
    "D = C (e1'^2 + e2'^2)/2\n";

}  // namespace

TEST_CASE("a driven oscillator whose modes decay in 10 ms and 1 µs, in closed form and in few steps") {
  const Stiff m(kOscillator);
  const double k = 1e8, c = 1e6, end = 5;
  const double d = (k - 1) * (k - 1) + c * c, p = k * (k - 1) / d, r = k * c / d;
  const double root = std::sqrt(c * c / 4 - k), slow = -k / (c / 2 + root), fast = -(c / 2 + root);
  // x = p cos t + r sin t + A e^{slow t} + B e^{fast t} from x(0) = 2, x'(0) = 0.
  const double b = (slow * (2 - p) + r) / (slow - fast), a = 2 - p - b;
  auto stepper = m.stepper(1e-10);
  stepper.start(0, State{2}, State{0});
  double worst = 0;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    REQUIRE(step.ending == StepEnding::None);
    for (const double x : {0.0, 0.4, 1.0}) {
      const double t = std::min(step.end, step.begin + x * (step.end - step.begin));
      State q(1), v(1);
      stepper.state(t, q, v);
      worst = std::max(worst, std::abs(q[0] - (p * std::cos(t) + r * std::sin(t) + a * std::exp(slow * t) +
                                               b * std::exp(fast * t))));
    }
  }
  CHECK(worst < 1e-9);
  CHECK(stepper.steps() < 100);  // an explicit method would need millions
}

TEST_CASE("forces that double knows to fewer digits than the tolerance asks: steps do not shrink for their rounding") {
  const Stiff m(
      "system oscillator\ndimensionless\nparam k = 1e14, c = 1e8\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 k x^2\n"
      "D = 1/2 c x'^2\nforce x = k cos t\n");
  const double k = 1e14, c = 1e8, d = (k - 1) * (k - 1) + c * c;  // the start has died out
  for (const double tolerance : {1e-10, 1e-12, 1e-13}) {
    auto stepper = m.stepper(tolerance);
    stepper.start(0, State{2}, State{0});
    run(stepper, 5);
    CHECK(std::abs(stepper.q()[0] - (k * (k - 1) * std::cos(5.0) + k * c * std::sin(5.0)) / d) < 1e-10);
    CHECK(stepper.steps() < 350);
  }
}

TEST_CASE("the relaxation oscillation of van der Pol: reference values of the Test Set for IVP Solvers") {
  const Stiff m(
      "system vanderpol\ndimensionless\nparam ε = 1e-6\ncoord y : number\nL = 1/2 ε y'^2 - 1/2 y^2\nforce y = (1 - "
      "y^2) y'\n");
  auto stepper = m.stepper(1e-12);
  stepper.start(0, State{2}, State{0});
  run(stepper, 2);
  CHECK(std::abs(stepper.q()[0] - 1.706167732170483) < 1e-12);
  CHECK(std::abs(stepper.v()[0] + 0.8928097010247975) < 1e-11);
  CHECK(stepper.steps() < 1000);
}

TEST_CASE("the same in its own time: jumps of 1e-6 s at t = 1e6 s, which time in double resolves to 1e-10 s") {
  const Stiff slow(
      "system v\ndimensionless\nparam μ = 1e6\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nforce x = μ (1 "
      "- x^2) x'\n");
  const Stiff scaled(
      "system v\ndimensionless\nparam ε = 1e-12\ncoord y : number\nL = 1/2 ε y'^2 - 1/2 y^2\nforce y = (1 - y^2) y'\n");
  auto stepper = slow.stepper(1e-12), other = scaled.stepper(1e-12);
  stepper.start(0, State{2}, State{0});
  other.start(0, State{2}, State{0});
  run(stepper, 3e6);
  run(other, 3);
  CHECK(std::abs(stepper.q()[0] - other.q()[0]) < 1e-11);
  CHECK(stepper.steps() < 5000);
}

TEST_CASE("a stiff flyball governor: the reference states of 80-bit extrapolation") {
  const Stiff m(kGovernor);
  const State reference[] = {{0.1, 0.622106681402688, 0.4961738690759, 0.4961738690759, 0.523836475569576,
                              6.10371780883086, -0.52267392975398, -0.52267392975398, 0.459271810436134},
                             {0.5, 2.8076794883679, 0.259491381543413, 0.259491381543413, 0.743249424786326,
                              5.10341542197154, -0.0539052184987426, -0.0539052184987426, 0.0521197801583733},
                             {1, 5.58634696586901, 0.521833301625546, 0.521833301625546, 0.501420922379568,
                              6.27112574187655, 0.140885579479527, 0.140885579479527, -0.122151492897729}};
  auto stepper = m.stepper(1e-12);
  stepper.start(0, State{0, std::numbers::pi / 6, std::numbers::pi / 6, 0.5}, State{2 * std::numbers::pi, 0, 0, 0});
  for (const State& row : reference) {
    run(stepper, row[0]);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(stepper.q()[i] - row[1 + i]) < 2e-13);
      CHECK(std::abs(stepper.v()[i] - row[5 + i]) < 2e-13);
    }
  }
  CHECK(stepper.steps() < 120);
}

TEST_CASE("a Cartesian pendulum: the angle's own equation, constraints to rounding, the tension") {
  const Stiff m(kPendulum), angle("system swing\ndimensionless\ncoord a : angle\nL = 1/2 a'^2 + 9.81 cos a\n");
  auto stepper = m.stepper(1e-11), other = angle.stepper(1e-11);
  stepper.start(0, State{1, 0}, State{0, 0});
  other.start(0, State{std::numbers::pi / 2}, State{0});
  const double end = 5;
  double worst = 0;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    REQUIRE(step.ending == StepEnding::None);
    for (const double x : {0.3, 1.0}) {
      const Sample s = stepper.sample(std::min(step.end, step.begin + x * (step.end - step.begin)));
      worst = std::max(
          {worst, std::abs(s.q[0] * s.q[0] + s.q[1] * s.q[1] - 1), std::abs(s.q[0] * s.v[0] + s.q[1] * s.v[1])});
      CHECK(2 * s.multipliers[0] == doctest::Approx(-s.v[0] * s.v[0] - s.v[1] * s.v[1] + 9.81 * s.q[1]).epsilon(1e-9));
    }
  }
  run(other, end);
  CHECK(worst < 2e-15);
  CHECK(std::abs(stepper.q()[0] - std::sin(other.q()[0])) < 2e-11);
  CHECK(std::abs(stepper.q()[1] + std::cos(other.q()[0])) < 2e-11);
}

TEST_CASE("the error follows the tolerance") {
  const Stiff m(kPendulum);
  const double x = 0.79356619534332174699;  // by Taylor's steps in 40 digits
  for (const double tolerance : {1e-3, 1e-5, 1e-8, 1e-10, 1e-12}) {
    auto stepper = m.stepper(tolerance);
    stepper.start(0, State{1, 0}, State{0, 0});
    run(stepper, 2);
    CHECK(std::abs(stepper.q()[0] - x) < 10 * tolerance);
  }
}

TEST_CASE("a redundant constraint is left out; its multiplier is not made up") {
  const Stiff m(std::string(kPendulum) + "constraint 2 x^2 + 2 y^2 = 2 name again\n"), once(kPendulum);
  auto stepper = m.stepper(1e-10), other = once.stepper(1e-10);
  for (auto* s : {&stepper, &other}) {
    s->start(0, State{1, 0}, State{0, 0});
    run(*s, 1);
  }
  CHECK(stepper.q()[0] == doctest::Approx(other.q()[0]).epsilon(1e-8));
  CHECK(std::isnan(stepper.sample(1).multipliers[0]));
  CHECK(std::isnan(stepper.sample(1).multipliers[1]));
}

TEST_CASE("a constraint between velocities: a skate on a slope comes back") {
  // Chaplygin's skate, Neimark and Fufaev: x = g sin α/(2ω²) sin² ωt from rest with spin ω.
  const Stiff m(
      "system skate\ndimensionless\nparam G = 2\ncoord x, y : number, φ : angle\nT = 1/2 (x'^2 + y'^2 + φ'^2)\nV = -G "
      "x\n"
      "constraint x' sin φ = y' cos φ\n");
  CHECK_FALSE(m.functions.holonomic);
  auto stepper = m.stepper(1e-11);
  stepper.start(0, State{0, 0, 0}, State{0, 0, 1.5});
  run(stepper, 4);
  CHECK(stepper.q()[0] == doctest::Approx(2 / (2 * 1.5 * 1.5) * std::pow(std::sin(6.0), 2)).epsilon(1e-11));
  CHECK(stepper.q()[1] == doctest::Approx(2 / (2 * 1.5 * 1.5) * (6 - 0.5 * std::sin(12.0))).epsilon(1e-11));
  CHECK(std::abs(stepper.v()[0] * std::sin(stepper.q()[2]) - stepper.v()[1] * std::cos(stepper.q()[2])) < 1e-15);
}

TEST_CASE("what is too fast for steps of a length dies out, or goes on") {
  const auto dies_out = [](const std::string& forces, double length) {
    const Stiff m("system s\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n" + forces);
    return m.stepper(1e-9).fast_parts_die_out(0, State{0.1, 0}, State{0, 0}, length);
  };
  const std::string damped = "V = 1/2*1e8*x^2 + 1/2*y^2\nD = 1/2*1e6*x'^2\n";  // rates −10⁶, −10², ±i
  CHECK(dies_out(damped, 1e-5));
  CHECK_FALSE(dies_out(damped, 1e-7));                                           // nothing is too fast
  CHECK_FALSE(dies_out(damped, 1));                                              // ±i is, and goes on
  CHECK_FALSE(dies_out("V = 1/2*1e8*x^2 + 1/2*y^2\n", 1e-3));                    // swings for ever
  CHECK_FALSE(dies_out("V = 1/2*1e8*x^2 + 1/2*y^2\nD = 1/2*1e3*x'^2\n", 1e-3));  // … for long
  CHECK_FALSE(dies_out("V = 1/2*1e8*x^2\nD = 1/2*1e6*(x'^2 - y'^2)\n", 1e-5));   // grows
}

TEST_CASE("a pair of roots within a step is found, and a jump is no root") {
  const auto first = [](auto&& event) {
    const Stiff m("system line\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\n");
    const MotionFunctions functions = motion_functions(m.equations, {{}, {event(m)}, {}});
    StiffOptions options;
    options.tolerance = 1e-9;
    StiffStepper stepper(functions, {}, options);
    stepper.start(0, State{1}, State{0});
    Step step;
    while (!step.event && stepper.time() != 10) step = stepper.step(10);
    return stepper.time();
  };
  const double pi = std::numbers::pi;
  CHECK(first([](const ModelText& m) { return sin(2000 * m.q(0)) - Rational(999, 1000); }) ==
        doctest::Approx(std::acos((637 * pi - std::asin(0.999)) / 2000)).epsilon(1e-6));
  CHECK(first([](const ModelText& m) {
          return m.system->context->function(Kind::Atan2, std::vector{m.v(0), m.q(0)}) - Rational(3);
        }) == doctest::Approx(2 * pi - 3).epsilon(1e-6));
}

TEST_CASE("energy and the integral of the power agree; backwards brings back the start; events are located") {
  const std::string text = "system damped\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 2 x^2\nD = 0.1 x'^2\n";
  const ModelText symbols(text);
  const Stiff m(text);
  auto stepper = m.stepper(1e-12);
  stepper.start(0, State{1}, State{0});
  run(stepper, 3);
  const Sample s = stepper.sample(3);
  CHECK(s.v[0] * s.v[0] / 2 + 2 * s.q[0] * s.q[0] - 2 == doctest::Approx(s.integrals[0]).epsilon(1e-13));
  CHECK(s.a[0] == doctest::Approx(-0.2 * s.v[0] - 4 * s.q[0]));
  run(stepper, 0);
  CHECK(stepper.q()[0] == doctest::Approx(1).epsilon(1e-9));

  const auto functions = motion_functions(symbols.equations, {{}, {symbols.q(0)}, {}});
  StiffOptions options;
  options.tolerance = 1e-12;
  StiffStepper with_event(functions, {}, options);
  with_event.start(0, State{1}, State{0});
  Step step;
  while (!step.event) step = with_event.step(10);
  const double w = std::sqrt(4 - 0.01);  // tan w t = −w/0.1 at the first zero
  CHECK(with_event.time() == doctest::Approx((std::numbers::pi - std::atan(w / 0.1)) / w).epsilon(1e-9));
  step = with_event.step(10);
  CHECK(!step.event);
  CHECK(with_event.covers(step.begin + 0.5 * (step.end - step.begin)));
  CHECK(std::abs(with_event.sample(step.begin + 0.5 * (step.end - step.begin)).q[0]) < 1e-3);
}

TEST_CASE("forces that jump far from the start, where time is coarse, are crossed") {
  const Stiff m("system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = step(t - 1000)\n");
  auto stepper = m.stepper(1e-12);
  stepper.start(0, State{0}, State{0});
  run(stepper, 1001);
  CHECK(std::abs(stepper.q()[0] - 0.5) < 1e-10);
  CHECK(std::abs(stepper.v()[0] - 1) < 1e-10);
}

TEST_CASE("a run ends with its reason") {
  CHECK(ending("system fall\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - sqrt(x)\n", {1}, {0}, 10) !=
        StepEnding::None);
  CHECK(ending("system flat\ndimensionless\ncoord x, y : number\nL = 1/2 (x' + y')^2 - x^2 - y\n", {1, 0}, {0, 0}, 1) ==
        StepEnding::SingularMass);
  CHECK(ending("system collide\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + 1/x^2\n", {1}, {0}, 10) !=
        StepEnding::None);
  CHECK(ending("system rubbing\ndimensionless\ncoord x : number\nL = 1/2 x'^2\nforce x = -sign(x')\n", {0}, {1}, 3) ==
        StepEnding::StepUnderflow);
  CHECK(ending("system undefined\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - x sqrt(x)\n", {-1}, {0}, 10) ==
        StepEnding::Overflow);
}

}  // namespace stiff_test

TEST_CASE("motions of 1e-18 m have their digits") {
  ModelText run("param m = 40 kg, k = 40 N/m\ncoord x : length\nL = 1/2 m x'^2 - 1/2 k x^2\nstart x = 1e-18 m\n");
  maupertuis::SimulationOptions options;
  options.method = maupertuis::StepMethod::Stiff;
  options.duration = 10;
  const auto result = simulate(run.model, run.equations, options, run.diagnostics);
  REQUIRE(result);
  CHECK(result->final.q[0] == doctest::Approx(1e-18 * std::cos(10)).epsilon(1e-10));
}

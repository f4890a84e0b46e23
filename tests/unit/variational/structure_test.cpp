#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <eigen3/Eigen/Dense>

namespace structure_test {

using State = std::vector<double>;
namespace {

using namespace maupertuis;

constexpr const char* kEntangled =
    "system entangled\ndimensionless\ncoord x, y : number\n"
    "L = 1/2 (1 + x^2) x'^2 + 1/2 (2 + sin y) y'^2 + x'^4/10 + x y' cos t - 1/4 x^4 - y^2 + x y + x' y' sin(x - y)/2\n";

/// A spherical pendulum as a particle: three coordinates and a rod.
constexpr const char* kParticleOnRod =
    "system rod\ndimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\nV = 9.81 z\nconstraint x^2 + y^2 "
    "+ z^2 = 1 name rod\n";

double largest_energy_error(const Variational& m, VariationalStepper& stepper, std::size_t steps, double h,
                            double reference) {
  double worst = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    REQUIRE(stepper.step(h > 0 ? 1e9 : -1e9).ending == StepEnding::None);
    worst = std::max(worst, std::abs(m.energy(stepper) - reference));
  }
  return worst;
}

}  // namespace

TEST_CASE("the map of a step preserves the symplectic form: its derivative by (q, p) obeys JᵀΩJ = Ω") {
  // Differences of fourth order in (q, v) and the chain rule through p = ∂L/∂v.
  const Variational m(kEntangled);
  const std::size_t n = 2;
  for (const int order : {2, 4, 6}) {
    const State base{0.6, -0.3, 0.4, 0.8};
    const auto after = [&](const State& s) {
      auto stepper = m.stepper(0.25, order);
      stepper.start(0.1, std::span(s).first(n), std::span(s).last(n));
      State before(stepper.q().begin(), stepper.q().end());
      before.insert(before.end(), stepper.p().begin(), stepper.p().end());
      run(stepper, 0.6);
      State now(stepper.q().begin(), stepper.q().end());
      now.insert(now.end(), stepper.p().begin(), stepper.p().end());
      return std::pair(before, now);
    };
    Eigen::Matrix4d initial, final;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < 4; ++i) {
        constexpr double d = 2e-3;
        double sums[2] = {};
        for (const auto& [shift, weight] : {std::pair(-3, -1.0 / 60),
                                            {-2, 9.0 / 60},
                                            {-1, -45.0 / 60},
                                            {1, 45.0 / 60},
                                            {2, -9.0 / 60},
                                            {3, 1.0 / 60}}) {
          State moved = base;
          moved[k] += shift * d;
          const auto [before, now] = after(moved);
          sums[0] += weight * before[i], sums[1] += weight * now[i];
        }
        initial(static_cast<long>(i), static_cast<long>(k)) = sums[0] / d;
        final(static_cast<long>(i), static_cast<long>(k)) = sums[1] / d;
      }
    Eigen::Matrix4d omega = Eigen::Matrix4d::Zero();
    omega.topRightCorner<2, 2>().setIdentity();
    omega.bottomLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity();
    const Eigen::Matrix4d map = final * initial.inverse();
    CAPTURE(order);
    CHECK((map.transpose() * omega * map - omega).cwiseAbs().maxCoeff() < 1e-11);
    CHECK((map - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() > 0.1);
  }
}

TEST_CASE("angular momentum of a central force stays to rounding, at steps that are far from exact") {
  const Variational m(
      "system kepler\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = -1/sqrt(x^2 + y^2)\n");
  for (const int order : {2, 4}) {
    auto stepper = m.stepper(0.1, order);
    stepper.start(0, State{0.5, 0}, State{0, 1.7});
    const double momentum = 0.5 * 1.7;
    double worst = 0;
    for (int i = 0; i < (under_sanitizers ? 2000 : 20000); ++i) {
      REQUIRE(stepper.step(1e9).ending == StepEnding::None);
      worst = std::max(worst, std::abs(stepper.q()[0] * stepper.p()[1] - stepper.q()[1] * stepper.p()[0] - momentum));
    }
    CHECK(worst < 5e-14);
  }
}

TEST_CASE("energy error of a pendulum does not drift in a million steps") {
  const Variational m("system pendulum\ndimensionless\ncoord a : angle\nL = 1/2 a'^2 + cos a\n");
  const double reference = -std::cos(2.0);
  const auto energy = [](const VariationalStepper& s) { return s.v()[0] * s.v()[0] / 2 - std::cos(s.q()[0]); };
  const int steps = under_sanitizers ? 20'000 : 1'000'000;
  for (const int order : {2, 6}) {
    auto stepper = m.stepper(0.1, order);
    stepper.start(0, State{2}, State{0});
    double first = 0, last = 0;
    for (int i = 0; i < steps; ++i) {
      if (stepper.step(1e9).ending != StepEnding::None) FAIL("a step failed");
      double& worst = i < steps / 10 ? first : last;
      if (i < steps / 10 || i >= steps / 10 * 9) worst = std::max(worst, std::abs(energy(stepper) - reference));
    }
    CAPTURE(order);
    CAPTURE(first);
    CAPTURE(last);
    CHECK(first > 0);
    CHECK(last == doctest::Approx(first).epsilon(1e-3));
  }
}

TEST_CASE("a particle on a rod: constraint, velocity constraint and momentum to rounding, energy without drift") {
  const Variational m(kParticleOnRod);
  for (const int order : {2, 4, 6}) {
    auto stepper = m.stepper(0.02, order);
    const double angle = 1.1;
    stepper.start(0, State{std::sin(angle), 0, -std::cos(angle)},
                  State{0.5 * std::cos(angle), 1.3, 0.5 * std::sin(angle)});
    const double momentum = std::sin(angle) * 1.3, energy = m.energy(stepper);
    double residual = 0, momentum_error = 0;
    const double early = largest_energy_error(m, stepper, 2000, 1, energy);
    for (int i = 0; i < (under_sanitizers ? 2000 : 20000); ++i) {
      REQUIRE(stepper.step(1e9).ending == StepEnding::None);
      const auto q = stepper.q(), v = stepper.v(), p = stepper.p();
      residual = std::max({residual, std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1),
                           std::abs(q[0] * v[0] + q[1] * v[1] + q[2] * v[2])});
      momentum_error = std::max(momentum_error, std::abs(q[0] * p[1] - q[1] * p[0] - momentum));
    }
    const double late = largest_energy_error(m, stepper, 2000, 1, energy);
    CAPTURE(order);
    CHECK(residual < 5e-14);
    CHECK(momentum_error < 2e-13);
    CHECK(late < 1.5 * early + 1e-12);
  }
}

TEST_CASE("a sample within a step is on the constraints, and its multiplier is the tension of the rod") {
  const Variational m(kParticleOnRod);
  auto stepper = m.stepper(0.1, 4);
  stepper.start(0, State{1, 0, 0}, State{0, 2, 0});
  for (int i = 0; i < 20; ++i) {
    const Step step = stepper.step(1e9);
    const Sample s = stepper.sample(step.begin + 0.37 * (step.end - step.begin));
    CHECK(std::abs(s.q[0] * s.q[0] + s.q[1] * s.q[1] + s.q[2] * s.q[2] - 1) < 1e-14);
    CHECK(std::abs(s.q[0] * s.v[0] + s.q[1] * s.v[1] + s.q[2] * s.v[2]) < 1e-14);
    // r̈ = 2λ r − g e_z, so that 2λ = −v² + g z.
    const double v2 = s.v[0] * s.v[0] + s.v[1] * s.v[1] + s.v[2] * s.v[2];
    CHECK(2 * s.multipliers[0] == doctest::Approx(-v2 + 9.81 * s.q[2]).epsilon(1e-12));
  }
}

TEST_CASE("there and back again: the method is its own inverse") {
  const Variational m(kEntangled);
  for (const int order : {2, 4, 6}) {
    auto stepper = m.stepper(0.05, order);
    stepper.start(0, State{0.6, -0.3}, State{0.4, 0.8});
    run(stepper, 10);
    CHECK(std::abs(stepper.q()[0] - 0.6) > 0.01);
    run(stepper, 0);
    CHECK(stepper.q()[0] == doctest::Approx(0.6).epsilon(1e-11));
    CHECK(stepper.v()[1] == doctest::Approx(0.8).epsilon(1e-11));
  }
}

TEST_CASE("redundant constraints: the motion is the same, and the multipliers that are not determined are NaN") {
  const std::string twice =
      std::string(kParticleOnRod) + "constraint 3 x^2 + 3 y^2 + 3 z^2 = 3 name again\nconstraint y = 0 name plane\n";
  const Variational m(twice), plane(std::string(kParticleOnRod) + "constraint y = 0 name plane\n");
  auto one = m.stepper(0.05, 4), other = plane.stepper(0.05, 4);
  for (auto* s : {&one, &other}) {
    s->start(0, State{1, 0, 0}, State{0, 0, -0.5});
    run(*s, 2);
  }
  CHECK(one.q()[0] == doctest::Approx(other.q()[0]).epsilon(1e-12));
  const Sample sample = one.sample(2);
  CHECK(std::isnan(sample.multipliers[0]));
  CHECK(std::isnan(sample.multipliers[1]));
  CHECK(std::abs(sample.multipliers[2]) < 1e-12);
}

TEST_CASE("a run ends with its reason: a step too long, a singular mass, a value without bound") {
  const auto ending = [](const std::string& text, State q, State v, double h) {
    const Variational m(text);
    auto stepper = m.stepper(h, 2);
    stepper.start(0, q, v);
    for (int i = 0; i < 1000; ++i)
      if (const Step step = stepper.step(1e9); step.ending != StepEnding::None) {
        CHECK(step.reason.find("t = ") != std::string::npos);
        CHECK(step.begin == step.end);
        return step.ending;
      }
    return StepEnding::None;
  };
  CHECK(ending("system fall\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - sqrt(x)\n", {1}, {0}, 0.1) ==
        StepEnding::Overflow);
  CHECK(ending("system flat\ndimensionless\ncoord x, y : number\nL = 1/2 (x' + y')^2 - x^2 - y\n", {1, 0}, {0, 0},
               0.1) == StepEnding::SingularMass);
  CHECK(ending("system stiff\ndimensionless\ncoord a : angle\nL = 1/2 a'^2 + 1000 cos(a + sin a)\n", {1}, {70}, 3) ==
        StepEnding::NoConvergence);
}

TEST_CASE("of two events in one step the earlier one ends it") {
  const ModelText model("system line\ndimensionless\ncoord x : number\nL = 1/2 x'^2\n");
  const Expr x = model.q(0);
  const VariationalFunctions functions =
      variational_functions(model.equations, {{}, {x - Rational(3, 5), x - Rational(11, 20)}, {}});
  VariationalOptions options;
  options.step = 1, options.order = 2;
  VariationalStepper stepper(functions, {}, options);
  stepper.start(0, State{0}, State{1});
  const Step step = stepper.step(10);
  REQUIRE(step.event);
  CHECK(*step.event == 1);
  CHECK(step.end == doctest::Approx(0.55).epsilon(1e-15));
  CHECK(*stepper.step(10).event == 0);
}

TEST_CASE("an event is located by the method itself") {
  const ModelText model("system pendulum\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\n");
  const VariationalFunctions functions = variational_functions(model.equations, {{}, {model.q(0)}, {}});
  VariationalOptions options;
  options.step = 0.1, options.order = 8;
  VariationalStepper stepper(functions, {}, options);
  stepper.start(0, State{1}, State{0});
  Step step;
  while (!step.event) step = stepper.step(10);
  CHECK(stepper.time() == doctest::Approx(std::acos(0.0)).epsilon(1e-12));
  CHECK(std::abs(stepper.q()[0]) < 1e-15);
  step = stepper.step(10);
  CHECK(!step.event);
  CHECK(step.end == doctest::Approx(std::acos(0.0) + 0.1).epsilon(1e-12));
}

namespace {

/// The first root of f(x) along x = cos t, with long steps; −1: none within 10.
double first_root(const std::string& text, Expr (*f)(const ModelText&), StepEnding ending = StepEnding::None) {
  const ModelText model(text);
  const VariationalFunctions functions = variational_functions(model.equations, {{}, {f(model)}, {}});
  VariationalOptions options;
  options.step = 0.5, options.order = 12;
  VariationalStepper stepper(functions, {}, options);
  stepper.start(0, State{1}, State{0});
  Step step;
  while (!step.event && stepper.time() != 10 && step.ending == StepEnding::None) step = stepper.step(10);
  CHECK(step.ending == ending);
  return step.event ? stepper.time() : -1;
}

}  // namespace

TEST_CASE("events are found everywhere in a step: pairs of roots and touches; a jump is none") {
  const std::string oscillator = "system line\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\n";
  const auto near = [](double x) { return doctest::Approx(x).epsilon(1e-10); };
  CHECK(first_root(oscillator, [](const ModelText& m) { return sin(200 * m.q(0)) - Rational(999, 1000); }) ==
        near(std::acos((63 * std::acos(-1.0) - std::asin(0.999)) / 200)));
  CHECK(first_root(oscillator, [](const ModelText& m) { return pow(m.q(0) - Rational(1, 10), Rational(2)); }) ==
        near(std::acos(0.1)));
  const auto angle = [](const ModelText& m) {
    return m.system->context->function(Kind::Atan2, std::vector{m.v(0), m.q(0)}) - Rational(3);
  };
  CHECK(first_root(oscillator, angle) == near(2 * std::acos(-1.0) - 3));  // −t, and π − … behind the cut
  CHECK(first_root(
            oscillator, [](const ModelText& m) { return sqrt(m.q(0)) - Rational(2); }, StepEnding::NoConvergence) ==
        -1);
}

}  // namespace structure_test

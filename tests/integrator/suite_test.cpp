#include "mechanics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

// What every method must do, whatever its order: the suite that other methods instantiate too.

using namespace maupertuis;

namespace {

double kepler_error(int order, double tolerance) {
  Mechanics m;
  build_kepler(m, 0.3);
  auto stepper = m.stepper({.tolerance = tolerance, .order = order});
  const double t = 2;
  advance(stepper, t);
  double anomaly = t;
  for (int i = 0; i < 100; ++i) anomaly -= (anomaly - 0.3 * std::sin(anomaly) - t) / (1 - 0.3 * std::cos(anomaly));
  return std::hypot(stepper.q()[0] - (std::cos(anomaly) - 0.3), stepper.q()[1] - std::sqrt(0.91) * std::sin(anomaly));
}

/// The error of one polynomial of a given order over a step of length h.
double one_step_error(int order, double h) {
  Mechanics m;
  build_oscillator(m, 1, 0);
  KernelWorkspace work(build_kernel(m.source), order);
  REQUIRE(work.expand(0, m.q, m.v) == KernelStatus::Ok);
  double x = 0;
  for (int k = order + 1; k >= 0; --k) x = x * h + work.coordinate(k)[0];
  return std::abs(x - std::cos(h));
}

}  // namespace

TEST_CASE("observed order: the polynomial of q has degree p + 1") {
  for (const int order : {3, 5, 7}) {
    const double observed = std::log2(one_step_error(order, 0.5) / one_step_error(order, 0.25));
    CHECK(observed > order + 1.8);  // the first term left out, of order p + 2 or, by symmetry, p + 3
    CHECK(observed < order + 3.2);
  }
}

TEST_CASE("the error follows the tolerance") {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    CAPTURE(tolerance);
    CHECK(kepler_error(0, tolerance) < 10 * tolerance);
  }
  CHECK(taylor_order(1e-6) < taylor_order(1e-12));
  CHECK(taylor_order(0) == 20);
}

TEST_CASE("a larger tolerance takes fewer steps") {
  const auto steps = [](auto build, double tolerance) {
    Mechanics m;
    build(m);
    auto stepper = m.stepper({.tolerance = tolerance});
    advance(stepper, 20);
    return stepper.steps();
  };
  const auto kepler = [](Mechanics& m) { build_kepler(m, 0.6); };
  // Whole orders leave ripples of some percent; over six decades nothing is left of them.
  for (const double finer : {1e-16, 1e-14, 1e-12, 1e-10}) {
    CAPTURE(finer);
    for (const double larger : {10 * finer, 100 * finer, 1000 * finer}) {
      CHECK(static_cast<double>(steps(build_double_pendulum, larger)) <=
            1.08 * static_cast<double>(steps(build_double_pendulum, finer)));
      CHECK(static_cast<double>(steps(kepler, larger)) <= 1.08 * static_cast<double>(steps(kepler, finer)));
    }
    CHECK(steps(build_double_pendulum, 1e6 * finer) < steps(build_double_pendulum, finer));
    CHECK(steps(kepler, 1e6 * finer) < steps(kepler, finer));
  }
  CHECK(2 * steps(kepler, 1e-3) < 1.6 * steps(kepler, 0));
}

TEST_CASE("the energy of an oscillator errs as rounding adds up at random") {
  Mechanics m;
  build_oscillator(m, 1, 0);
  auto stepper = m.stepper();
  advance(stepper, 2e5);  // with rounded powers of the length, the same in all steps: 1e-12
  CHECK(std::abs(stepper.q()[0] * stepper.q()[0] + stepper.v()[0] * stepper.v()[0] - 1) < 3e-13);
}

TEST_CASE("reversibility: forwards and back returns to the start") {
  Mechanics m;
  build_double_pendulum(m);
  auto stepper = m.stepper();
  advance(stepper, 3);
  advance(stepper, 0);
  CHECK(stepper.time() == 0);
  CHECK(std::abs(stepper.q()[0] - 2.0) < 1e-11);
  CHECK(std::abs(stepper.q()[1] - 2.5) < 1e-11);
  CHECK(std::abs(stepper.v()[0]) < 1e-10);
}

TEST_CASE("backward time is forward time of the reversed velocity") {
  Mechanics forwards, backwards;
  build_kepler(forwards, 0.6);
  build_kepler(backwards, 0.6);
  for (double& v : backwards.v) v = -v;
  auto a = forwards.stepper(), b = backwards.stepper();
  advance(a, -7);
  advance(b, 7);
  for (int i = 0; i < 2; ++i) CHECK(std::abs(a.q()[i] - b.q()[i]) < 1e-13);
}

TEST_CASE("invariants: energy over 200 s of a chaotic double pendulum") {
  Mechanics m;
  build_double_pendulum(m);
  auto stepper = m.stepper();
  const double start = stepper.sample(0).observables[0];
  double worst = 0;
  while (stepper.time() != 200) {
    REQUIRE(stepper.step(200).ending == StepEnding::None);
    worst = std::max(worst, std::abs(stepper.step_start().observables[0] - start));
  }
  CHECK(worst / std::abs(start) < 1e-12);
}

TEST_CASE("dense output agrees with a run that ends at that time") {
  Mechanics m;
  build_double_pendulum(m);
  auto stepper = m.stepper();
  for (double wanted = 0.05; wanted < 2; wanted += 0.137) {
    while (!stepper.covers(wanted)) stepper.step(2);
    const Sample sample = stepper.sample(wanted);
    auto direct = m.stepper();
    advance(direct, wanted);
    const Sample there = direct.sample(wanted);
    CHECK(sample.t == wanted);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(std::abs(sample.q[i] - there.q[i]) < 2e-13);
      CHECK(std::abs(sample.v[i] - there.v[i]) < 1e-12);
      CHECK(std::abs(sample.a[i] - there.a[i]) < 1e-11);
    }
    std::vector<double> q(2), v(2);
    stepper.state(wanted, q, v);
    CHECK(q == sample.q);
    CHECK(v == sample.v);
  }
}

TEST_CASE("a requested end is reached exactly, also when it is near") {
  Mechanics m;
  build_oscillator(m, 1, 0);
  auto stepper = m.stepper();
  for (const double end : {0.1, 0.1 + 1e-13, 0.3, 100.0, 0.1}) {
    advance(stepper, end);
    CHECK(stepper.time() == end);
    CHECK(std::abs(stepper.q()[0] - std::cos(end)) < 1e-13);
  }
}

TEST_CASE("integrals along the motion are those of calculus") {
  Mechanics m;
  build_oscillator(m, 0, 1);  // x = sin t
  m.source.integrands = {pow(m.source.coordinates[0], 2), m.context.time()};
  auto stepper = m.stepper();
  advance(stepper, 20);
  const Sample end = stepper.sample(20);
  CHECK(end.integrals[0] == doctest::Approx(10 - std::sin(40.0) / 4).epsilon(1e-13));
  CHECK(end.integrals[1] == doctest::Approx(200).epsilon(1e-14));
  const double inside = stepper.step_start().t;
  REQUIRE(stepper.covers(inside));
  CHECK(stepper.sample(inside).integrals[1] == doctest::Approx(inside * inside / 2).epsilon(1e-14));
}

TEST_CASE("zero freedoms: time passes") {
  Mechanics m;
  m.source.observables = {sin(m.context.time())};
  m.source.events = {m.context.time() - Rational(3)};
  auto stepper = m.stepper();
  const Step step = advance(stepper, 10);
  CHECK(step.event == 0u);
  CHECK(stepper.time() == doctest::Approx(3).epsilon(1e-15));
  advance(stepper, 10);
  CHECK(stepper.time() == 10);
  CHECK(stepper.sample(10).observables[0] == std::sin(10.0));
}

TEST_CASE("the same run gives the same bits") {
  Mechanics m;
  build_double_pendulum(m);
  auto a = m.stepper(), b = m.stepper();
  advance(a, 20);
  advance(b, 20);
  CHECK(a.steps() == b.steps());
  CHECK(std::memcmp(a.q().data(), b.q().data(), sizeof(double) * 2) == 0);
  CHECK(std::memcmp(a.v().data(), b.v().data(), sizeof(double) * 2) == 0);
}

TEST_CASE("units do not matter: a coordinate of 1e-9 beside one of 1") {
  Mechanics small, plain;
  const auto build = [](Mechanics& m, double scale, Expr factor) {
    const auto x = m.coordinate("x", scale, 0), y = m.coordinate("y", 0, 1);
    const auto s = x * factor;
    m.natural((pow(m.dot(s), 2) + pow(m.dot(y), 2)) / Rational(2), pow(s, 2) + pow(y, 2) + pow(s, 2) * pow(y, 2));
  };
  build(small, 1e-9, small.context.number(1000000000));
  build(plain, 1, plain.context.number(1));
  auto a = small.stepper(), b = plain.stepper();
  advance(a, 10);
  advance(b, 10);
  CHECK(a.q()[0] * 1e9 == doctest::Approx(b.q()[0]).epsilon(1e-12));
  CHECK(a.steps() == b.steps());
}

TEST_CASE("a coordinate that moves late only does not stop the run") {
  // x1'' = −x1, x_{k+1}'' = x_k: from rest x6 begins with t^10.
  Mechanics m;
  std::vector<Expr> x;
  for (int i = 0; i < 6; ++i) x.push_back(m.coordinate("x" + std::to_string(i), i == 0 ? 1 : 0, 0));
  for (int i = 0; i < 6; ++i) {
    const Expr acceleration = m.context.symbol(x[static_cast<std::size_t>(i)].name(), Role::Coordinate, 2);
    m.source.residual.push_back(i == 0 ? acceleration + x[0] : acceleration - x[static_cast<std::size_t>(i) - 1]);
  }
  auto stepper = m.stepper();
  const double t = 3;
  CHECK(advance(stepper, t).ending == StepEnding::None);
  CHECK(stepper.steps() < 200);
  // The remainder of the cosine series: x6 = −(cos t − Σ_{j<5} (−1)^j t^{2j}/(2j)!)
  double rest = std::cos(t), term = 1;
  for (int j = 0; j < 5; ++j) {
    rest -= term;
    term *= -t * t / ((2 * j + 1) * (2 * j + 2));
  }
  CHECK(std::abs(stepper.q()[5] + rest) < 1e-13);
}

TEST_CASE("a comet: energy and period of an orbit with e = 0.99") {
  Mechanics m;
  build_kepler(m, 0.99);
  auto stepper = m.stepper();
  const double turn = 2 * std::acos(-1.0);
  const double start = stepper.sample(0).observables[0];
  advance(stepper, 10 * turn);
  CHECK(std::abs(stepper.sample(10 * turn).observables[0] / start - 1) < 1e-11);
  CHECK(std::abs(stepper.q()[0] - 0.01) < 1e-7);
  CHECK(std::abs(stepper.q()[1]) < 1e-7);
}

TEST_CASE("a run ends with its reason, and keeps what it reached") {
  SUBCASE("step budget") {
    Mechanics m;
    build_oscillator(m, 1, 0);
    auto stepper = m.stepper({.maximum_steps = 3});
    CHECK(advance(stepper, 100).ending == StepEnding::TooManySteps);
    CHECK(stepper.steps() == 3);
    CHECK(std::abs(stepper.q()[0] - std::cos(stepper.time())) < 1e-14);
  }
  SUBCASE("interrupt") {
    Mechanics m;
    build_oscillator(m, 1, 0);
    std::atomic<bool> flag = true;
    auto stepper = m.stepper({.interrupt = &flag});
    CHECK(advance(stepper, 100).ending == StepEnding::Interrupted);
    CHECK(stepper.time() == 0);
  }
  SUBCASE("collision: r'' = −1/r² from rest falls to the centre at π/(2√2)") {
    Mechanics m;
    const auto r = m.coordinate("r", 1, 0);
    m.natural(pow(m.dot(r), 2) / Rational(2), -pow(r, Rational(-1)));
    auto stepper = m.stepper();
    const Step step = advance(stepper, 2);
    CHECK(step.ending == StepEnding::StepUnderflow);
    CHECK(step.reason.find("collision") != std::string::npos);
    CHECK(stepper.time() == doctest::Approx(std::acos(-1.0) / std::sqrt(8.0)).epsilon(1e-12));
  }
  SUBCASE("steps that go on shrinking: a force that oscillates without end near t = 2") {
    Mechanics m;
    const auto x = m.coordinate("x", 0, 0);
    const auto rest = m.context.time() - Rational(2);
    m.source.residual = {m.dot(m.dot(x)) - sin(pow(rest, -1)) / rest};
    auto stepper = m.stepper({.maximum_steps = 1'000'000});
    const Step step = advance(stepper, 3);
    CHECK(step.ending == StepEnding::StepUnderflow);
    CHECK(stepper.time() > 1.9);
    CHECK(stepper.time() < 2);
    CHECK(stepper.steps() < 100'000);
  }
  SUBCASE("blow-up: x'' = 2 x³ with x = 1/(1 − t)") {
    Mechanics m;
    const auto x = m.coordinate("x", 1, 1);
    m.natural(pow(m.dot(x), 2) / Rational(2), -pow(x, 4) / Rational(2));
    auto stepper = m.stepper();
    const StepEnding ending = advance(stepper, 2).ending;
    // Whichever is met first: steps below the resolution of time, or coefficients beyond the range of double.
    CHECK((ending == StepEnding::StepUnderflow || ending == StepEnding::Overflow));
    CHECK(stepper.time() == doctest::Approx(1).epsilon(1e-12));
  }
  SUBCASE("singular mass matrix") {
    Mechanics m;
    const auto x = m.coordinate("x", 0, 1), y = m.coordinate("y", 0, 1);
    m.natural(pow(m.dot(x + y), 2), x);
    auto stepper = m.stepper();
    const Step step = stepper.step(1);
    CHECK(step.ending == StepEnding::SingularMass);
    CHECK(step.reason.find("mass matrix is singular") != std::string::npos);
  }
  SUBCASE("undefined force") {
    Mechanics m;
    const auto x = m.coordinate("x", -1, 0);
    m.natural(pow(m.dot(x), 2), apply(Kind::Log, x));
    m.source.observables = {apply(Kind::Log, x)};
    auto stepper = m.stepper();
    // The force 1/x exists, the energy does not: the run goes on, the observable says NaN.
    CHECK(stepper.step(0.1).ending == StepEnding::None);
    CHECK(std::isnan(stepper.sample(0).observables[0]));
    Mechanics bad;
    const auto y = bad.coordinate("y", -1, 0);
    bad.natural(pow(bad.dot(y), 2), pow(y, Rational(3, 2)));
    auto other = bad.stepper();
    CHECK(other.step(0.1).ending == StepEnding::Overflow);
  }
}

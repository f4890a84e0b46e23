#include "../under_sanitizers.hpp"
#include "systems.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>
#include <numeric>

namespace {

using namespace maupertuis;

/// Pendulums of different lengths, starts and durations.
Trajectories pendulums(std::size_t count) {
  Trajectories out;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i);
    out.add({1 + 0.07 * x, 2 - 0.05 * x}, {0.1 * x, -0.02 * x}, 0.5 + 0.37 * static_cast<double>((7 * i) % 11));
    out.parameters.insert(out.parameters.end(), {9.81, 1 + 0.03 * x});
  }
  return out;
}

/// Kepler ellipses of growing eccentricity, from the pericentre.
Trajectories ellipses(std::size_t count) {
  Trajectories out;
  for (std::size_t i = 0; i < count; ++i) {
    const double e = 0.9 * static_cast<double>(i) / static_cast<double>(count);
    out.add({1 - e, 0}, {0, std::sqrt((1 + e) / (1 - e))}, 2 * std::acos(-1.0) * static_cast<double>(1 + i % 3));
  }
  return out;
}

bool same(const EnsembleResult& a, const EnsembleResult& b) {
  bool equal = same_bits(a.q, b.q) && same_bits(a.v, b.v) && same_bits(a.sampled_q, b.sampled_q) &&
               same_bits(a.sampled_v, b.sampled_v) && a.endings.size() == b.endings.size();
  for (std::size_t i = 0; equal && i < a.endings.size(); ++i) {
    const TrajectoryEnding &x = a.endings[i], &y = b.endings[i];
    equal = x.ending == y.ending && x.t == y.t && x.steps == y.steps && x.reason == y.reason && x.alone == y.alone &&
            x.energy_drift == y.energy_drift;
  }
  return equal;
}

EnsembleOptions with(int width, int threads, std::size_t energy_terms = 0) {
  EnsembleOptions options;
  options.width = width;
  options.threads = threads;
  options.energy_terms = energy_terms;
  return options;
}

double distance(std::span<const double> a, std::span<const double> b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

}  // namespace

TEST_CASE("an ellipse closes after its period, whatever lane carries it") {
  const Trajectories input = ellipses(30);
  const EnsembleResult result = advance_ensemble(kepler(), input.start(), with(8, 1, 2));
  CHECK(result.width == 8);
  CHECK(result.backend == "interpreter");  // so little work pays for no compilation
  for (std::size_t i = 0; i < input.count(); ++i) {
    CAPTURE(i);
    const TrajectoryEnding& ending = result.endings[i];
    CHECK(ending.ok());
    CHECK_FALSE(ending.alone);
    CHECK(ending.t == input.end[i]);
    CHECK(ending.steps > 0);
    CHECK(ending.energy_drift < 2e-14);
    // Errors along the orbit are those of the period times the speed, which is large at the pericentre.
    const double speed = input.v[2 * i + 1];
    CHECK(distance(result.q_of(i), input.q_of(i)) < 2e-13 * speed * speed * speed);
  }
}

TEST_CASE("results depend neither on the width nor on the number of threads, to the bit") {
  const Kernel kernel = double_pendulum();
  Trajectories input = pendulums(23);
  input.times = {0, 0.1, 0.5, 1, 2.2};
  const EnsembleResult expected = advance_ensemble(kernel, input.start(), with(1, 1, 2));
  for (const auto& [width, threads] :
       std::vector<std::pair<int, int>>{{2, 1}, {4, 1}, {8, 1}, {16, 1}, {0, 0}, {8, 2}, {4, 3}, {1, 4}}) {
    CAPTURE(width);
    CAPTURE(threads);
    CHECK(same(advance_ensemble(kernel, input.start(), with(width, threads, 2)), expected));
  }
}

TEST_CASE("results depend neither on the order of the trajectories nor on their neighbours") {
  const Kernel kernel = double_pendulum();
  const Trajectories input = pendulums(20);
  const EnsembleResult expected = advance_ensemble(kernel, input.start(), with(8, 1));
  rc::check("any choice of trajectories in any order", [&] {
    const auto chosen = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, input.count()));
    Trajectories some;
    some.n = 2;
    for (const std::size_t i : chosen) {
      some.add({input.q[2 * i], input.q[2 * i + 1]}, {input.v[2 * i], input.v[2 * i + 1]}, input.end[i]);
      some.parameters.insert(some.parameters.end(), {input.parameters[2 * i], input.parameters[2 * i + 1]});
    }
    if (chosen.size() <= 1) some.end.assign(1, some.end.empty() ? 1.0 : some.end[0]);
    const EnsembleResult found =
        advance_ensemble(kernel, some.start(), with(*rc::gen::element(1, 4, 8), *rc::gen::element(1, 2)));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      RC_ASSERT(distance(found.q_of(k), expected.q_of(chosen[k])) == 0);
      RC_ASSERT(distance(found.v_of(k), expected.v_of(chosen[k])) == 0);
      RC_ASSERT(found.endings[k].steps == expected.endings[chosen[k]].steps);
    }
  });
}

TEST_CASE("every trajectory has its own parameters, begin and end, forwards or backwards") {
  System s;  // x'' = −w² x + f t
  const auto x = s.coordinate("x"), w = s.parameter("w"), f = s.parameter("f");
  const Kernel kernel =
      s.natural(Rational(1, 2) * s.rate_squared(x), Rational(1, 2) * pow(w, 2) * pow(x, 2) - f * s.context.time() * x);
  Trajectories input;
  for (int i = 0; i < 21; ++i) {
    input.add({0.3}, {0.5}, i % 2 == 0 ? 3.0 + i : -2.0 - i);
    input.begin.push_back(0.1 * i);
    input.parameters.insert(input.parameters.end(), {1 + 0.1 * i, 0.2 * i});
  }
  const EnsembleResult result = advance_ensemble(kernel, input.start(), with(8, 1));
  for (std::size_t i = 0; i < input.count(); ++i) {
    CAPTURE(i);
    const double frequency = input.parameters[2 * i], push = input.parameters[2 * i + 1] / (frequency * frequency);
    const double t0 = input.begin[i], angle = frequency * (input.end[i] - t0);
    const double a = 0.3 - push * t0, b = (0.5 - push) / frequency;
    CHECK(result.endings[i].ok());
    CHECK(result.endings[i].t == input.end[i]);
    CHECK(std::abs(result.q_of(i)[0] - (push * input.end[i] + a * std::cos(angle) + b * std::sin(angle))) < 1e-12);
    CHECK(std::abs(result.v_of(i)[0] - (push + frequency * (b * std::cos(angle) - a * std::sin(angle)))) < 1e-11);
  }
}

TEST_CASE("states on the way are those of a trajectory that ends there") {
  const Kernel kernel = kepler();
  Trajectories input = ellipses(5);
  input.times = {-1, 0, 0.3, 2, 2.000001, 5, 10, 1000};
  const EnsembleResult result = advance_ensemble(kernel, input.start());
  for (std::size_t i = 0; i < input.count(); ++i)
    for (std::size_t k = 0; k < input.times.size(); ++k) {
      CAPTURE(i);
      CAPTURE(k);
      if (input.times[k] < 0 || input.times[k] > input.end[i]) {
        CHECK(std::isnan(result.q_of(i, k)[0]));
        continue;
      }
      Trajectories until = input;
      until.times.clear();
      until.end.assign(input.count(), input.times[k]);
      const EnsembleResult there = advance_ensemble(kernel, until.start());
      CHECK(distance(result.q_of(i, k), there.q_of(i)) < 2e-14);
      CHECK(distance(result.v_of(i, k), there.v_of(i)) < 2e-13);
    }
}

TEST_CASE("a trajectory without duration ends where it begins, and one without force in one step") {
  System s;
  const auto x = s.coordinate("x");
  const Kernel kernel = s.natural(s.rate_squared(x), s.context.number(3));
  Trajectories input;
  input.add({1}, {2}, 0);
  input.add({1}, {2}, 1e6);
  input.add({1}, {0}, 10);
  input.times = {0};
  const EnsembleResult result = advance_ensemble(kernel, input.start());
  CHECK(result.q == std::vector<double>{1, 2000001, 1});
  CHECK(result.v == std::vector<double>{2, 2, 0});
  CHECK(result.sampled_q == std::vector<double>{1, 1, 1});
  CHECK(result.endings[0].steps == 0);
  CHECK(result.endings[1].steps == 1);
}

TEST_CASE("angles that turn thousands of times keep their accuracy, and their turns are counted") {
  System s;
  const auto angle = s.coordinate("a"), w = s.parameter("w");
  const Kernel kernel = s.natural(Rational(1, 2) * s.rate_squared(angle), -w * cos(angle));
  Trajectories input;
  constexpr double turns = under_sanitizers ? 300 : 3000, pi = 3.141592653589793;
  for (int i = 0; i < 11; ++i) {
    // Over the top: θ/2 = am(v t/2), of modulus 2 √w/v, which gains π in v t/2 = 2 K.
    const double v = (i % 2 == 0 ? 1 : -1) * (6.5 + 0.2 * i);
    input.add({0}, {v}, turns * 4 * std::comp_ellint_1(2 * std::sqrt(9.81) / std::abs(v)) / std::abs(v));
  }
  input.parameters = {9.81};
  input.times = {0.5, 100, 1000};
  const EnsembleResult result = advance_ensemble(kernel, input.start(), with(8, 1, 2));
  for (std::size_t i = 0; i < input.count(); ++i) {
    CAPTURE(i);
    CHECK(result.endings[i].ok());
    CHECK_FALSE(result.endings[i].alone);
    CHECK(result.endings[i].energy_drift < 3e-14);
    CHECK(std::abs(result.q[i] - std::copysign(2 * pi * turns, input.v[i])) < 1e-8);
    TaylorStepper stepper(kernel, input.parameters, {});
    stepper.start(0, input.q_of(i), input.v_of(i));
    for (std::size_t next = 0; stepper.time() != input.end[i];) {
      REQUIRE(stepper.step(input.end[i]).ending == StepEnding::None);
      for (; next < input.times.size() && stepper.covers(input.times[next]); ++next)
        CHECK(std::abs(result.q_of(i, next)[0] - stepper.sample(input.times[next]).q[0]) < 1e-8);
    }
    CHECK(std::abs(result.q[i] - stepper.q()[0]) < 1e-8);
    CHECK(std::abs(result.v[i] - stepper.v()[0]) < 1e-8);
  }
  for (const auto& [width, threads] : std::vector<std::pair<int, int>>{{1, 1}, {2, 2}, {4, 1}, {16, 1}})
    CHECK(same(advance_ensemble(kernel, input.start(), with(width, threads, 2)), result));
}

TEST_CASE("an energy with an angle in it counts the turns") {
  System s;  // a torque of 1: the energy has a term −θ
  const auto angle = s.coordinate("a");
  const Kernel kernel = s.natural(Rational(1, 2) * s.rate_squared(angle), -cos(angle) - angle);
  Trajectories input;
  for (int i = 0; i < 5; ++i) input.add({0.1 * i}, {0.5 * i}, 100 + i);
  input.times = {3, 50};
  const EnsembleResult result = advance_ensemble(kernel, input.start(), with(4, 1, 2));
  for (std::size_t i = 0; i < input.count(); ++i) {
    CAPTURE(i);
    CHECK_FALSE(result.endings[i].alone);
    CHECK(result.q[i] > 4000);
    CHECK(result.endings[i].energy_drift < 1e-14);
    // θ'² − 2 cos θ − 2 θ stays.
    const double q = input.q[i], v = input.v[i],
                 at_end = result.v[i] * result.v[i] - 2 * std::cos(result.q[i]) - 2 * result.q[i];
    CHECK(std::abs(at_end - (v * v - 2 * std::cos(q) - 2 * q)) < 1e-10);
  }
}

TEST_CASE("a lane that fails ends as its own stepper says, and disturbs no other") {
  const Kernel kernel = kepler();
  Trajectories input = ellipses(12);
  const EnsembleResult undisturbed = advance_ensemble(kernel, input.start(), with(4, 1));
  const auto place = [&](std::size_t i, double x, double y, double vx, double vy) {
    input.q[2 * i] = x, input.q[2 * i + 1] = y, input.v[2 * i] = vx, input.v[2 * i + 1] = vy;
  };
  place(2, 1, 0, 0, 0);  // falls into the centre
  place(5, 0, 0, 1, 0);  // begins there
  for (const int width : {1, 4, 8}) {
    const EnsembleResult result = advance_ensemble(kernel, input.start(), with(width, 1));
    // The fall from rest at 1 takes π/√8.
    CHECK(result.endings[2].t == doctest::Approx(std::acos(-1.0) / std::sqrt(8)).epsilon(1e-9));
    for (const std::size_t i : {2, 5}) {
      TaylorStepper stepper(kernel, {}, {});
      stepper.start(0, input.q_of(i), input.v_of(i));
      Step last;
      while (last.ending == StepEnding::None) last = stepper.step(input.end[i]);
      CHECK(result.endings[i].alone);
      CHECK(result.endings[i].ending == last.ending);
      CHECK(result.endings[i].reason == last.reason);
      CHECK(result.endings[i].t == stepper.time());
      CHECK(distance(result.q_of(i), stepper.q()) == 0);
    }
    CHECK(result.endings[5].ending == StepEnding::Overflow);
    for (std::size_t i = 0; i < input.count(); ++i) {
      if (i == 2 || i == 5) continue;
      CHECK(result.endings[i].ok());
      CHECK(distance(result.q_of(i), undisturbed.q_of(i)) == 0);
    }
  }
}

TEST_CASE("a singular mass matrix is reported by the stepper, with the coordinate") {
  System s;
  const auto x = s.coordinate("x"), y = s.coordinate("y"), m = s.parameter("m");
  const Kernel kernel = s.natural(s.rate_squared(x) + m * s.rate_squared(y), pow(x, 2) + pow(y, 2));
  Trajectories input;
  for (int i = 0; i < 5; ++i) {
    input.add({1, 1}, {0, 0}, 2);
    input.parameters.push_back(i == 3 ? 0 : 1);
  }
  const EnsembleResult result = advance_ensemble(kernel, input.start());
  for (std::size_t i = 0; i < 5; ++i) CHECK(result.endings[i].ok() == (i != 3));
  CHECK(result.endings[3].ending == StepEnding::SingularMass);
  CHECK(result.endings[3].reason.find("acceleration of y") != std::string::npos);
  CHECK(std::abs(result.q_of(0)[0] - std::cos(2.0)) < 1e-14);
}

TEST_CASE("an indefinite mass matrix is solved alone") {
  System s;  // L = x' y' − x y: both oscillate
  const auto x = s.coordinate("x"), y = s.coordinate("y");
  const Kernel kernel = s.natural(s.context.time_derivative(x) * s.context.time_derivative(y), x * y);
  Trajectories input;
  input.add({1, 0.5}, {0, 0}, 3);
  const EnsembleResult result = advance_ensemble(kernel, input.start());
  CHECK(result.endings[0].ok());
  CHECK(result.endings[0].alone);
  CHECK(std::abs(result.q[0] - std::cos(3.0)) < 1e-14);
}

TEST_CASE("kernels with switches and events go alone, and events end a trajectory") {
  System s;  // x'' = −|x|/x … between walls: V = |x|
  const auto x = s.coordinate("x");
  s.natural(Rational(1, 2) * s.rate_squared(x), apply(Kind::Abs, x));
  s.source.events = {x + Rational(1, 2)};
  const Kernel kernel = build_kernel(s.source);
  Trajectories input;
  input.add({1}, {0}, 10);
  input.add({2}, {0}, 1);
  const EnsembleResult result = advance_ensemble(kernel, input.start());
  CHECK(result.width == 0);
  REQUIRE(result.endings[0].event.has_value());
  // From 1 to 0 in √2, through 0 with speed √2, to −1/2 in √2 − 1.
  CHECK(result.endings[0].t == doctest::Approx(2 * std::sqrt(2.0) - 1).epsilon(1e-14));
  CHECK_FALSE(result.endings[1].event.has_value());
  CHECK(result.q[1] == doctest::Approx(1.5).epsilon(1e-14));
}

TEST_CASE("a run stops when it has used up its steps, or is interrupted") {
  const Trajectories input = ellipses(20);
  EnsembleOptions options = with(4, 2);
  options.maximum_steps = 3;
  const EnsembleResult stopped = advance_ensemble(kepler(), input.start(), options);
  for (const TrajectoryEnding& ending : stopped.endings) {
    CHECK(ending.ending == StepEnding::TooManySteps);
    CHECK(ending.steps == 3);
    CHECK(ending.t > 0);
  }
  const std::atomic<bool> interrupt = true;
  options.interrupt = &interrupt;
  const EnsembleResult interrupted = advance_ensemble(kepler(), input.start(), options);
  for (std::size_t i = 0; i < input.count(); ++i) {
    CHECK(interrupted.endings[i].ending == StepEnding::Interrupted);
    CHECK(distance(interrupted.q_of(i), input.q_of(i)) == 0);
  }
}

TEST_CASE("a coarser tolerance takes fewer steps, at the order that it asks for") {
  const Trajectories input = ellipses(8);
  EnsembleOptions coarse = with(0, 1, 2);
  coarse.tolerance = 1e-8;
  const EnsembleResult fine = advance_ensemble(kepler(), input.start(), with(0, 1, 2));
  const EnsembleResult rough = advance_ensemble(kepler(), input.start(), coarse);
  CHECK(rough.order == taylor_order(1e-8));
  CHECK(fine.order == taylor_order(0));
  std::size_t rough_steps = 0, fine_steps = 0;  // a circle takes few steps at the highest order
  double rough_drift = 0, fine_drift = 0;
  for (std::size_t i = 0; i < input.count(); ++i) {
    rough_steps += rough.endings[i].steps, fine_steps += fine.endings[i].steps;
    rough_drift = std::max(rough_drift, rough.endings[i].energy_drift),
    fine_drift = std::max(fine_drift, fine.endings[i].energy_drift);
  }
  CHECK(rough_steps < fine_steps);
  CHECK(rough_drift > fine_drift);
  CHECK(rough_drift < 1e-6);
}

TEST_CASE("what a backend throws comes out of the call") {
  const Trajectories input = ellipses(20);
  EnsembleOptions options = with(2, 2);
  struct Failing : LaneExpansion {
    int width() const override { return 2; }
    std::string_view backend() const override { return "failing"; }
    void expand(double*, const double*, double*, double*, int) const override { throw std::runtime_error("no luck"); }
  };
  options.expansion = [](const Kernel&, int) { return std::make_shared<Failing>(); };
  CHECK_THROWS_WITH(advance_ensemble(kepler(), input.start(), options), "no luck");
}

TEST_CASE("compiled lanes carry the same motions; without a compiler the interpreter does, and says why") {
  const Kernel kernel = double_pendulum();
  Trajectories input = pendulums(13);
  input.times = {0.2, 1};
  EnsembleOptions options = with(8, 1, 2);
  options.cache = false;
  options.backend = Backend::Interpreter;
  const EnsembleResult interpreted = advance_ensemble(kernel, input.start(), options);
  CHECK(interpreted.trouble.empty());
  options.backend = Backend::Compiled;
  const EnsembleResult compiled = advance_ensemble(kernel, input.start(), options);
  const bool here = backend_status().compiled;
  CHECK(compiled.backend == (here ? "compiled" : "interpreter"));
  CHECK(compiled.trouble.empty() == here);
  for (std::size_t i = 0; i < input.count(); ++i) {
    CHECK(compiled.endings[i].ok());
    CHECK_FALSE(compiled.endings[i].alone);
    CHECK(compiled.endings[i].energy_drift < 2e-14);
    CHECK(distance(compiled.q_of(i), interpreted.q_of(i)) < 1e-10);
    CHECK(distance(compiled.v_of(i), interpreted.v_of(i)) < 1e-9);
  }
  for (const auto& [width, threads] : std::vector<std::pair<int, int>>{{1, 1}, {4, 2}}) {
    options.width = width, options.threads = threads;
    CHECK(same(advance_ensemble(kernel, input.start(), options), compiled));
  }
}

TEST_CASE("short ensembles are interpreted, long ones compiled where there is a compiler") {
  const Kernel kernel = kepler();
  Trajectories input = ellipses(4);
  CHECK(advance_ensemble(kernel, input.start()).backend == "interpreter");
  EnsembleOptions options;
  options.maximum_steps = 10;
  const double long_time = 1e6;
  EnsembleStart start = input.start();
  start.end = {&long_time, 1};
  const EnsembleResult result = advance_ensemble(kernel, start, options);
  CHECK(result.backend == (backend_status().compiled ? "compiled" : "interpreter"));
}

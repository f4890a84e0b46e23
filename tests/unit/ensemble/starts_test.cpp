// Starts and numbers that a trajectory does not begin with, and lists that do not fit.
#include "../model_text.hpp"

#include <maupertuis/ensemble.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace {

using namespace maupertuis;

const char* const pendulum =
    "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint B mass m at (x, y)\ngravity (0, "
    "-g)\n"
    "constraint x^2 + y^2 = l^2 name rod\n";

struct Run {
  MotionKernel motion;
  std::vector<double> parameters;
  explicit Run(const ModelText& m) : motion(motion_kernel(m.equations)), parameters(motion.parameters) {}
  EnsembleResult operator()(const std::vector<double>& q, const std::vector<double>& v, double end = 1) const {
    EnsembleStart start;
    start.q = q, start.v = v, start.parameters = parameters, start.end = {&end, 1};
    return advance_ensemble(motion.kernel, start);
  }
};

}  // namespace

TEST_CASE("starts off the constraints end where they are, with the reason") {
  const ModelText m(pendulum);
  Run run(m);
  const auto refused = [&](const std::vector<double>& q, const std::vector<double>& v) {
    const EnsembleResult r = run(q, v);
    CHECK(r.endings[0].ending == StepEnding::Refused);
    CHECK(r.endings[0].reason.find("constraint rod") != std::string::npos);
    CHECK(r.q == q);
    CHECK(r.endings[0].t == 0);
  };
  refused({1, 1}, {0, 0});
  refused({0.6, -0.8}, {0.6, -0.8});  // along the rod
  refused({0.6, -0.80001}, {0, 0});
  run.parameters[1] = 2;  // l
  refused({0.6, -0.8}, {0, 0});
  CHECK(run({1.2, -1.6}, {0.8, 0.6}).endings[0].ok());
}

TEST_CASE("starts on the constraints to rounding begin, at rest and moving") {
  const ModelText m(pendulum);
  const Run run(m);
  for (int k = 0; k < 60; ++k) {
    const double angle = 0.1 * k, speed = k % 3 == 0 ? 0 : std::pow(10.0, k % 7 - 5);
    const double x = std::sin(angle), y = -std::cos(angle);
    CHECK(run({x, y}, {-y * speed, x * speed}).endings[0].ok());
    CHECK(run({x * (1 + 1e-11), y}, {-y * speed, x * speed}).endings[0].ok());
  }
  const ModelText wall("system w\nparam m = 1 kg\ncoord x, y : length\npoint B mass m at (x, y)\nconstraint y = 0 m\n");
  CHECK(Run(wall)({1, 1e-17}, {0, 0}).endings[0].ok());
  CHECK(Run(wall)({1, 1e-3}, {0, 0}).endings[0].ending == StepEnding::Refused);
}

TEST_CASE("numbers that are none are told, in lanes and alone") {
  const ModelText m(
      "system p\nparam l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint B mass 1 kg at l (sin θ, -cos θ)\ngravity (0, "
      "-g)\n");
  const Run run(m);
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto told = [](const EnsembleResult& r, std::size_t i, const char* what) {
    CHECK(r.endings[i].ending == StepEnding::Refused);
    CHECK(r.endings[i].reason.find(what) != std::string::npos);
  };
  const EnsembleResult r = run({0.1, 0.2, none}, {0, infinite, 0});
  CHECK(r.endings[0].ok());
  told(r, 1, "The start holds a number");
  told(r, 2, "The start holds a number");
  told(run({0.1}, {0}, none), 0, "The end is");
  Run other = run;
  other.parameters[0] = none;
  told(other({0.1}, {0}), 0, "A parameter is");
}

TEST_CASE("lists that do not fit are told by name") {
  const ModelText m(pendulum);
  const Run run(m);
  const std::vector<double> q{0.6, -0.8}, v{0, 0}, end{1}, times{1, 0.5};
  const auto wrong = [&](EnsembleStart start, const char* what) {
    CHECK_THROWS_WITH_AS(advance_ensemble(run.motion.kernel, start), doctest::Contains(what), std::invalid_argument);
  };
  EnsembleStart start;
  start.q = q, start.parameters = run.parameters, start.end = end;
  wrong(start, "start.v");
  start.v = v, start.times = times;
  wrong(start, "start.times");
  start.times = {}, start.end = {};
  wrong(start, "start.end");
  start.end = end, start.parameters = std::span(run.parameters).first(1);
  wrong(start, "start.parameters");
  const std::vector<double> factors{1, 0}, unordered{0.5, std::nan("")};
  start.parameters = run.parameters, start.step_factors = factors;
  wrong(start, "start.step_factors");
  start.step_factors = {}, start.times = unordered;
  wrong(start, "start.times");
}

TEST_CASE("numbers that are none, and indices beyond the end, are told") {
  const ModelText m(pendulum);
  const Run run(m);
  const std::vector<double> q{0.6, -0.8}, v{0, 0};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto throws = [](const auto& call, const char* what) {
    CHECK_THROWS_WITH_AS(call(), doctest::Contains(what), std::invalid_argument);
  };
  TaylorStepper stepper(run.motion.kernel, run.parameters, {});
  throws([&] { stepper.step(1); }, "has no start");
  throws([&] { stepper.start(0, q, std::span(v).first(1)); }, "v has another length");
  throws([&] { stepper.start(none, q, v); }, "t is no time");
  stepper.start(0, q, v);
  throws([&] { stepper.step(none); }, "`bound` is no time");
  throws([&] { stepper.integral(7); }, "no such integral");
  const std::vector<std::size_t> events{5};
  throws([&] { stepper.put_at_zero(events); }, "no such event");
  const auto stepper_of = [&](std::span<const double> parameters, double tolerance, int order) {
    TaylorOptions options;
    options.tolerance = tolerance, options.order = order;
    return [&run, parameters, options] { TaylorStepper(run.motion.kernel, parameters, options); };
  };
  throws(stepper_of(std::span(run.parameters).first(1), 0, 0), "`parameters` has another length");
  for (const double tolerance : {none, -1.0, 1.0, std::numeric_limits<double>::infinity()})
    throws(stepper_of(run.parameters, tolerance, 0), "the tolerance");
  for (const int order : {-1, 101, 100'000}) throws(stepper_of(run.parameters, 0, order), "the order");
  EnsembleStart start;
  const std::vector<double> end{1};
  start.q = q, start.v = v, start.parameters = run.parameters, start.end = end;
  EnsembleOptions options;
  options.tolerance = none;
  throws([&] { advance_ensemble(run.motion.kernel, start, options); }, "the tolerance");
}

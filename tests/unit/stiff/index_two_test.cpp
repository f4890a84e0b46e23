// Motions with constraints: the index-2 form, against closed forms, other coordinates and finite differences.
#include "../model_text.hpp"
#include "integrator/stiff/index_two_system.hpp"
#include "simulation/function_kernels.hpp"

#include <maupertuis/motion_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using namespace maupertuis;
using State = std::vector<double>;
using std::numbers::pi;

struct Stiff : ModelText {
  explicit Stiff(const std::string& text, const std::vector<Expr>& events = {})
      : ModelText(text),
        functions(motion_functions(equations, {{}, events, {}})),
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

/// sn, cn, dn by descending Landen transformations (Abramowitz and Stegun 16.12), and the quarter period.
struct Jacobi {
  double sn, cn, dn, quarter;
  Jacobi(double u, double k) {
    std::vector<double> a{1}, c{k};
    double b = std::sqrt(1 - k * k);
    for (int i = 0; i < 8; ++i) {
      const double mean = (a.back() + b) / 2;
      c.push_back((a.back() - b) / 2);
      b = std::sqrt(a.back() * b);
      a.push_back(mean);
    }
    quarter = pi / (2 * a.back());
    double phi = std::ldexp(a.back() * u, 8);
    for (std::size_t i = 8; i > 0; --i) phi = (phi + std::asin(c[i] / a[i] * std::sin(phi))) / 2;
    sn = std::sin(phi), cn = std::cos(phi), dn = std::sqrt(1 - k * k * sn * sn);
  }
};

const std::string kPendulum =
    "system pendulum\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 9.81 y\nconstraint x^2 + y^2 = 1 "
    "name rod\n";

const std::string kGovernor =
    "system governor\ndimensionless\n"
    "param l = 1, wd = 0.01, d = 0.1, ds = 0.1, H = 1, mr = 0.3, mp = 5, ms = 3, K = 8e5, C = 4e4, l0 = 0.5, g = 9.81\n"
    "coord phi : angle, X1, Z1, X2, Z2, s : number\n"
    "let Jsh = 0.3 wd^2/6\nlet Jsl = ms ds^2/6\n"
    "let x1 = (X1 + d/2)/2\nlet z1 = (Z1 + H)/2\nlet x2 = (X2 + d/2)/2\nlet z2 = (Z2 + H)/2\n"
    "let e1 = sqrt((x1 - ds/2)^2 + (z1 - s)^2)\nlet e2 = sqrt((x2 - ds/2)^2 + (z2 - s)^2)\n"
    "T = (Jsh + Jsl) phi'^2/2 + ms s'^2/2 + mr (x1'^2 + z1'^2 + x2'^2 + z2'^2 + (x1^2 + x2^2) phi'^2)/2"
    " + mr (l^2 + wd^2)/(24 l^2) (X1'^2 + Z1'^2 + X2'^2 + Z2'^2)"
    " + (mr (l^2 + wd^2)/(12 l^2) ((X1 - d/2)^2 + (X2 - d/2)^2) + mr wd^2/(6 l^2) ((H - Z1)^2 + (H - Z2)^2)) phi'^2/2"
    " + mp (X1'^2 + Z1'^2 + X2'^2 + Z2'^2 + (X1^2 + X2^2) phi'^2)/2\n"
    "V = g (ms s + mr (z1 + z2) + mp (Z1 + Z2)) + K ((e1 - l0)^2 + (e2 - l0)^2)/2\nD = C (e1'^2 + e2'^2)/2\n"
    "constraint (X1 - d/2)^2 + (Z1 - H)^2 = l^2 name left\nconstraint (X2 - d/2)^2 + (Z2 - H)^2 = l^2 name right\n";

/// phi, b, s and their rates (both arms alike) as the coordinates and velocities of kGovernor.
std::pair<State, State> governor_state(double phi, double b, double s, double phi_rate, double b_rate, double s_rate) {
  const double x = 0.05 + std::cos(b), z = 1 - std::sin(b), vx = -std::sin(b) * b_rate, vz = -std::cos(b) * b_rate;
  return {{phi, x, z, x, z, s}, {phi_rate, vx, vz, vx, vz, s_rate}};
}

}  // namespace

TEST_CASE("∂F/∂ẏ and ∂F/∂y of Newton's iteration, off the constraints and with μ too") {
  const Stiff m(
      "system mixed\ndimensionless\nparam k = 3\ncoord x, y, z, u : number\n"
      "T = 1/2 (1 + x^2) x'^2 + 1/2 y'^2 + x' z' sin(y) + z'^2 + 1/2 u'^2\nV = k x y^2 + cos z + u^2\nD = 1/2 (x' "
      "y)^2\n"
      "constraint x^2 y + sin(z t) = 1 name one\nconstraint x' u + z' cos(x) = t name two\n"
      "constraint 2 x^2 y + 2 sin(z t) = 2 name again\n");
  stiff::Motion motion(m.functions, m.parameters, {});
  stiff::IndexTwoSystem system(motion);
  const std::size_t rows[] = {0, 1};
  system.set_rows(rows);
  const std::size_t size = system.size();
  REQUIRE(size == 14);
  State y(size), rate(size), low(size), high(size);
  for (std::size_t i = 0; i < size; ++i)
    y[i] = 0.3 + 0.7 * std::sin(3.0 * static_cast<double>(i)), rate[i] = std::cos(2.0 * static_cast<double>(i));
  const double t = 0.8, c = 7;
  Eigen::MatrixXd by_rate, by_state;
  REQUIRE(system.derivatives(t, y, rate, by_rate, by_state));
  const Eigen::MatrixXd exact = c * by_rate + by_state;
  for (std::size_t j = 0; j < size; ++j) {
    const double h = 1e-5;
    const auto shifted = [&](double by, State& out) {
      State y_by = y, rate_by = rate;
      y_by[j] += by, rate_by[j] += c * by;
      REQUIRE(system.residual(t, y_by, rate_by, out));
    };
    shifted(h, high), shifted(-h, low);
    for (std::size_t i = 0; i < size; ++i) {
      CAPTURE(i);
      CAPTURE(j);
      CHECK(std::abs(exact(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) - (high[i] - low[i]) / (2 * h)) <
            1e-7);
    }
  }
}

TEST_CASE("a Cartesian pendulum from the horizontal: Jacobi's elliptic functions, and the quarter period as an event") {
  const ModelText symbols(kPendulum);
  const double w = std::sqrt(9.81), k = std::sqrt(0.5), end = 5;
  const Stiff m(kPendulum);
  auto stepper = m.stepper(1e-12);
  stepper.start(0, State{1, 0}, State{0, 0});
  run(stepper, end);
  const Jacobi j(w * end, k);
  const double half = k * j.cn / j.dn;  // sin(θ/2) = k cd(ωt)
  CHECK(std::abs(stepper.q()[0] - 2 * half * std::sqrt(1 - half * half)) < 1e-11);
  CHECK(std::abs(stepper.q()[1] - (2 * half * half - 1)) < 1e-11);

  const MotionFunctions functions = motion_functions(symbols.equations, {{}, {symbols.q(0)}, {}});
  StiffOptions options;
  options.tolerance = 1e-12;
  StiffStepper falling(functions, {}, options);
  falling.start(0, State{1, 0}, State{0, 0});
  for (const double turns : {1.0, 3.0}) {
    Step step;
    while (!step.event) REQUIRE((step = falling.step(10)).ending == StepEnding::None);
    CHECK(falling.time() == doctest::Approx(turns * j.quarter / w).epsilon(1e-9));
    CHECK(std::abs(falling.q()[0]) < 1e-9);
    CHECK(falling.q()[1] == doctest::Approx(-1).epsilon(1e-15));
  }
  run(falling, 0);  // and back
  CHECK(falling.q()[0] == doctest::Approx(1).epsilon(1e-8));
}

TEST_CASE("a stiff governor with its rods as constraints: the reference states, as in independent coordinates") {
  const Stiff m(kGovernor);
  auto stepper = m.stepper(1e-12);
  const auto [q, v] = governor_state(0, pi / 6, 0.5, 2 * pi, 0, 0);
  stepper.start(0, q, v);
  const double reference[][7] = {{0.1, 0.622106681402688, 0.4961738690759, 0.523836475569576, 6.10371780883086,
                                  -0.52267392975398, 0.459271810436134},
                                 {0.5, 2.8076794883679, 0.259491381543413, 0.743249424786326, 5.10341542197154,
                                  -0.0539052184987426, 0.0521197801583733},
                                 {1, 5.58634696586901, 0.521833301625546, 0.501420922379568, 6.27112574187655,
                                  0.140885579479527, -0.122151492897729}};
  for (const auto& row : reference) {
    run(stepper, row[0]);
    const auto [x, u] = governor_state(row[1], row[2], row[3], row[4], row[5], row[6]);
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(std::abs(stepper.q()[i] - x[i]) < 1e-12);
      CHECK(std::abs(stepper.v()[i] - u[i]) < 1e-12);
    }
  }
  CHECK(stepper.constraint_residual() < 1e-15);
  CHECK(stepper.steps() < 200);  // an explicit method needs some hundred thousand
}

TEST_CASE("a chain that stays symmetric: the rounding of a velocity that vanishes does not begin each step anew") {
  const Stiff m(
      "system chain\ndimensionless\nparam l = 0.3, b = 0.8, g = 9.81\n"
      "coord x1, y1, x2, y2, x3, y3, x4, y4, x5, y5 : number\n"
      "let all = x1'^2 + y1'^2 + x2'^2 + y2'^2 + x3'^2 + y3'^2 + x4'^2 + y4'^2 + x5'^2 + y5'^2\n"
      "T = 0.1 all\nV = 0.2 g (y1 + y2 + y3 + y4 + y5)\nD = 1/2 b all\n"
      "constraint sqrt(x1^2 + y1^2) = l\nconstraint sqrt((x2 - x1)^2 + (y2 - y1)^2) = l\n"
      "constraint sqrt((x3 - x2)^2 + (y3 - y2)^2) = l\nconstraint sqrt((x4 - x3)^2 + (y4 - y3)^2) = l\n"
      "constraint sqrt((x5 - x4)^2 + (y5 - y4)^2) = l\nconstraint sqrt((1.2 - x5)^2 + y5^2) = l\n");
  auto stepper = m.stepper(1e-13);
  const double drop = std::sqrt(0.3 * 0.3 - 0.2 * 0.2);
  stepper.start(0, State{0.2, -drop, 0.4, 0, 0.6, -drop, 0.8, 0, 1, -drop}, State(10, 0.0));
  run(stepper, 1);
  CHECK(std::abs(stepper.q()[4] - 0.6) < 1e-12);
  CHECK(stepper.q()[1] == doctest::Approx(stepper.q()[9]).epsilon(1e-10));
  CHECK(stepper.steps() < 400);
}

TEST_CASE("a disk that rolls upright on a slope, in closed form; its constraints between velocities in all samples") {
  const Stiff m(
      "system disk\ndimensionless\nparam R = 0.5, I = 0.2, G = 3\ncoord x, y : number, θ, φ : angle\n"
      "T = 1/2 (x'^2 + y'^2 + I φ'^2 + 0.1 θ'^2)\nV = -G x\n"
      "constraint x' = R φ' cos θ name along\nconstraint y' = R φ' sin θ name across\n");
  const double w = 1.5, end = 4, strength = 0.25 * 3 / (0.25 + 0.2);  // R² G/(R² + I)
  auto stepper = m.stepper(1e-11);
  stepper.start(0, State{0, 0, 0, 0}, State{0, 0, w, 0});
  double worst = 0;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    REQUIRE(step.ending == StepEnding::None);
    for (const double x : {0.4, 1.0}) {
      const Sample s = stepper.sample(std::min(step.end, step.begin + x * (step.end - step.begin)));
      worst = std::max({worst, std::abs(s.v[0] - 0.5 * s.v[3] * std::cos(s.q[2])),
                        std::abs(s.v[1] - 0.5 * s.v[3] * std::sin(s.q[2]))});
    }
  }
  CHECK(worst < 1e-15);
  CHECK(stepper.q()[0] == doctest::Approx(strength * std::pow(std::sin(w * end), 2) / (2 * w * w)).epsilon(1e-11));
  CHECK(stepper.q()[1] == doctest::Approx(strength * (end / 2 - std::sin(2 * w * end) / (4 * w)) / w).epsilon(1e-11));
  CHECK(stepper.q()[2] == doctest::Approx(w * end).epsilon(1e-12));
}

TEST_CASE("a bead on a wire that turns: r = r0 cosh ωt, pushed sideways with 2 ω r', on the wire in all samples") {
  const Stiff m(
      "system bead\ndimensionless\nparam w = 2\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\n"
      "constraint y cos(w t) = x sin(w t) name wire\n");
  const double w = 2, end = 2;
  auto stepper = m.stepper(1e-11);
  stepper.start(0, State{0.1, 0}, State{0, 0.2});
  double worst = 0;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    REQUIRE(step.ending == StepEnding::None);
    const Sample s = stepper.sample(0.5 * (step.begin + step.end));
    const double c = std::cos(w * s.t), d = std::sin(w * s.t), r = 0.1 * std::cosh(w * s.t);
    worst = std::max({worst, std::abs(s.q[1] * c - s.q[0] * d) / r,
                      std::abs(s.v[1] * c - s.v[0] * d - w * (s.q[1] * d + s.q[0] * c)) / (w * r)});
    CHECK(std::abs(s.multipliers[0]) == doctest::Approx(2 * w * 0.1 * w * std::sinh(w * s.t)).epsilon(1e-6));
  }
  CHECK(worst < 1e-15);
  CHECK(stepper.q()[0] == doctest::Approx(0.1 * std::cosh(w * end) * std::cos(w * end)).epsilon(1e-12));
}

TEST_CASE("a run with constraints ends with its reason") {
  const auto ending = [](const std::string& text, const State& q, const State& v) {
    const Stiff m(text);
    auto stepper = m.stepper(1e-9);
    stepper.start(0, q, v);
    while (stepper.time() != 10)
      if (const Step step = stepper.step(10); step.ending != StepEnding::None) {
        CHECK(step.reason.find("t = ") != std::string::npos);
        return step.ending;
      }
    return StepEnding::None;
  };
  const std::string on_line = "dimensionless\ncoord x, y : number\nconstraint x = y\n";
  CHECK(ending("system fall\n" + on_line + "L = 1/2 (x'^2 + y'^2) + 1/x^2\n", {1, 1}, {0, 0}) != StepEnding::None);
  CHECK(ending("system undefined\n" + on_line + "L = 1/2 (x'^2 + y'^2) - x sqrt(x)\n", {-1, -1}, {0, 0}) ==
        StepEnding::Overflow);
  CHECK(ending("system flat\n" + on_line + "L = 1/2 (x' - y')^2 - x^2 - y\n", {1, 1}, {0, 0}) ==
        StepEnding::SingularMass);
  // The hinge moves away faster than the rod can follow: no state meets the constraint after t = 1.
  CHECK(ending("system gone\ndimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nconstraint x = 0\nconstraint "
               "x^2 + y^2 = 1 - t\n",
               {0, 1}, {0, -0.5}) != StepEnding::None);
}

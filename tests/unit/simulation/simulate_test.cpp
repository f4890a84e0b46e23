#include "../model_text.hpp"
#include "kernel/program/program.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/simulation.hpp>

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace simulate_test {
namespace {

SimulationResult run(const ModelText& m, SimulationOptions options = {}) {
  Diagnostics diagnostics;
  auto result = simulate(m.model, m.equations, options, diagnostics);
  INFO(render(diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

const char* const oscillator = R"(system oscillator
param m = 2 kg, k = 8 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 1 m
run 10 s
)";

}  // namespace

TEST_CASE("a place has its value where a force along it has none") {
  // The direction of the damper is undefined as P starts at O; x' = e^(−2 t) from there on.
  ModelText m(
      "param m = 1 kg\ncoord x, y, z : length\npoint P mass m at (x, y, z)\ndamper P - O coefficient 2 N s/m\n"
      "start x' = 1 m/s\nrun 1 s\n");
  const SimulationResult r = run(m);
  CHECK(r.final.v[0] == doctest::Approx(std::exp(-2)).epsilon(1e-14));
  for (const char* const place : {"P.x", "P.y", "P.z"}) CHECK(r.trajectory.at(0, *r.trajectory.column(place)) == 0);
  CHECK(r.trajectory.at(0, *r.trajectory.column("energy")) == 0.5);
  CHECK(r.statistics.energy_drift < 1e-14);
}

TEST_CASE("rows of steps show oscillations that are faster than a thousandth of the run") {
  const auto fork = [](const char* frequency) {
    return ModelText(
        std::string("param m = 1 kg, f = ") + frequency +
        " 1/s\nlet w = 2 pi f\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 m w^2 x^2\nstart x = 1 m\nrun 10 s\n");
  };
  SimulationOptions close;
  close.rows_of_steps = true;
  const auto swings = [](const Trajectory& rows) {
    std::size_t out = 0;
    for (std::size_t row = 1; row < rows.rows(); ++row) out += (rows.at(row, 0) < 0) != (rows.at(row - 1, 0) < 0);
    return out;
  };
  const ModelText hundred = fork("100");
  CHECK(swings(run(hundred).trajectory) < 10);  // a row a period
  const Trajectory rows = run(hundred, close).trajectory;
  CHECK(swings(rows) == 2000);
  for (std::size_t row = 1; row < rows.rows(); ++row) REQUIRE(rows.times[row] > rows.times[row - 1]);
  for (const double t : run(hundred).trajectory.times)  // the output times are among them
    CHECK(std::binary_search(rows.times.begin(), rows.times.end(), t));
  // Ten thousand periods: bounded, and the rows between show how far it swings.
  const Trajectory many = run(fork("1001"), close).trajectory;
  CHECK(many.rows() <= 1001 + 1000 * 100);
  CHECK(swings(many) > 3000);
  CHECK(rows.gaps.empty());
  REQUIRE(many.gaps.size() == 1000);
  for (std::size_t row = 1, gap = 0; row < many.rows(); ++row) {
    const bool is_gap = gap < many.gaps.size() && many.gaps[gap] == row;
    gap += is_gap;
    REQUIRE(is_gap == (many.times[row] - many.times[row - 1] > 1.0 / 1001));  // a period
  }
  // Slow motion, and rows that were asked for, stay as they are.
  CHECK(run(ModelText(oscillator), close).trajectory.rows() == 1001);
  close.output_every = 0.5;
  CHECK(run(hundred, close).trajectory.rows() == 21);
  // Backwards.
  close.output_every.reset(), close.duration = -10;
  const Trajectory back = run(hundred, close).trajectory;
  CHECK(swings(back) == 2000);
  for (std::size_t row = 1; row < back.rows(); ++row) REQUIRE(back.times[row] < back.times[row - 1]);
}

TEST_CASE("rows at times that are asked for stand among the others, in the order of the run") {
  SimulationOptions options;
  options.output_every = 4, options.rows_at = {9.25, 0.3, 4, 12, -1};
  CHECK(run(ModelText(oscillator), options).trajectory.times == std::vector<double>{0, 0.3, 4, 8, 9.25, 10});
  options.duration = -10, options.rows_at = {-0.3, -9.25, 2};
  CHECK(run(ModelText(oscillator), options).trajectory.times == std::vector<double>{0, -0.3, -4, -8, -9.25, -10});
}

TEST_CASE("the harmonic oscillator follows its closed form, forwards and backwards") {
  const ModelText m(oscillator);
  SimulationOptions options;
  options.at = {10, 0.3, 4};
  const SimulationResult forwards = run(m, options);
  REQUIRE(forwards.ok());
  for (const State& s : forwards.at) {
    CHECK(s.q[0] == doctest::Approx(std::cos(2 * s.t)).epsilon(1e-14));
    CHECK(s.a[0] == doctest::Approx(-4 * std::cos(2 * s.t)).epsilon(1e-13));
  }
  CHECK(forwards.at[1].t == 0.3);
  CHECK(forwards.final.t == 10);
  CHECK(forwards.statistics.energy_drift < 5e-15);  // rounding: 20 ulp

  options = {};
  options.duration = -7;
  const SimulationResult backwards = run(m, options);
  CHECK(backwards.final.t == -7);
  CHECK(std::abs(backwards.final.q[0] - std::cos(14.0)) < 1e-14);
  CHECK(backwards.trajectory.times.front() == 0);
  CHECK(backwards.trajectory.times.back() == -7);
}

TEST_CASE("a pendulum let go at 90°: every fourth coefficient alone differs from zero, the last two vanish") {
  const ModelText m(
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
      "gravity (0, -g)\nstart θ = 90 deg\nrun 10 s\n");
  const SimulationResult r = run(m);
  CHECK(r.statistics.energy_drift < 1e-14);
  // 20 digits of the elliptic functions: sin θ(10 s), from the reference case of the pendulum in x and y.
  CHECK(std::abs(std::sin(r.final.q[0]) - 0.2750874625761168600542606) < 1e-13);
}

TEST_CASE("the power balance closes with a drive and friction") {
  const ModelText m(R"(system driven
param m = 1 kg, k = 4 N/m, c = 0.3 N s/m, F = 2 N, w = 3 rad/s
coord x : length
input u : [N] = F sin(w t)
T = 1/2 m x'^2
V = 1/2 k x^2
D = 1/2 c x'^2
force x = u
run 20 s
)");
  const SimulationResult r = run(m);
  REQUIRE(r.ok());
  // The work of the drive varies faster than the motion, whose error alone sets the step: see docs/theory/measures.md.
  CHECK(r.statistics.energy_drift < 1e-11);
  // Steady response of the driven oscillator: amplitude F / |k − m w² + i c w| after the transient has died (e^{−0.15
  // t}).
  SimulationOptions late;
  late.duration = 300;
  late.at = {299, 299.3, 299.7};
  const double amplitude = 2 / std::hypot(4 - 9, 0.9), phase = std::atan2(0.9, -5.0);
  for (const State& s : run(m, late).at) CHECK(std::abs(s.q[0] - amplitude * std::sin(3 * s.t - phase)) < 1e-12);
}

TEST_CASE("a step is as short as the series of the power asks, where the motion is a parabola itself") {
  // q = −3 t² and dh_E/dt = 5 t − 1, made of sines of q + t + t²/2. One step of any length has the motion, not the
  // work.
  for (const char* end : {"8", "40"}) {
    CAPTURE(end);
    const ModelText m(
        "dimensionless\ncoord q : number\npoint P mass 1 at (cos(q + t + t^2/2), sin(q + t + t^2/2))\nV = 5 q\n"
        "start q = 0\nrun " +
        std::string(end) + "\n");
    const SimulationResult r = run(m);
    CHECK(r.final.q[0] == doctest::Approx(-3 * std::pow(r.final.t, 2)).epsilon(1e-13));
    CHECK(r.statistics.energy_drift < 1e-10);
  }
}

TEST_CASE("run until ends at the located root, or says that it was not met") {
  const ModelText m(R"(system fall
param m = 1 kg, g = 10 m/s^2, h = 5 m
coord y : length
T = 1/2 m y'^2
V = m g y
start y = h
run until y = 0 within 60 s
)");
  const SimulationResult r = run(m);
  CHECK(r.ending == Ending::UntilReached);
  CHECK(std::abs(r.final.t - 1.0) < 1e-15);
  CHECK(std::abs(r.final.v[0] + 10.0) < 1e-14);
  CHECK(r.trajectory.times.back() == r.final.t);

  const ModelText never(R"(system at_rest
param m = 1 kg
coord y : length
T = 1/2 m y'^2
start y = 1 m
run until y = 0 within 2 s
)");
  const SimulationResult missed = run(never);
  CHECK(missed.ending == Ending::UntilNotReached);
  CHECK_FALSE(missed.ok());
  CHECK(missed.reason.find("within 2 s") != std::string::npos);
}

TEST_CASE("a collision ends the run with its reason, and what was computed is kept") {
  const ModelText m(R"(system plunge
param m = 1 kg, k = 1 N m^2
coord r : length
T = 1/2 m r'^2
V = -k/r
start r = 1 m
run 10 s
)");
  const SimulationResult r = run(m);
  CHECK_FALSE(r.ok());
  CHECK(r.reason != "");
  // Free fall from rest at r = 1 with m = k = 1 reaches the centre at t = π/(2√2).
  CHECK(std::abs(r.final.t - std::acos(-1.0) / (2 * std::sqrt(2.0))) < 1e-6);
  CHECK(r.trajectory.rows() > 100);
}

TEST_CASE(
    "an event whose function leaves the range of numbers ends the run with that reason, or is met in another form") {
  const auto until_peak = [](const std::string& condition) {
    return run(ModelText("dimensionless\ncoord x : number\nT = 1/2 x'^2\nevent c when " + condition +
                         " : set x' = 2\nstart x = 0, x' = 1\nrun 100\n"));
  };
  const SimulationResult lost = until_peak("cosh((x - 50.3)*1e4) = 2");
  CHECK_FALSE(lost.ok());
  CHECK(lost.reason.find("has no series here") != std::string::npos);
  const SimulationResult met = until_peak("sech((x - 50.3)*1e4) = 0.5");
  CHECK(met.ok());
  CHECK(met.final.q[0] == doctest::Approx(200 - 50.3 + std::acosh(2.0) / 1e4).epsilon(1e-14));
}

TEST_CASE("a narrow pulse has a series also where its cosh is large") {
  const ModelText m(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = 1e5*sech(1e5*(t - 5.5))^2\nstart x = 0\nrun 10\n");
  const SimulationResult r = run(m);
  CHECK(r.ok());
  CHECK(r.final.v[0] == doctest::Approx(2).epsilon(1e-9));
  CHECK(r.final.q[0] == doctest::Approx(9).epsilon(1e-9));
}

TEST_CASE("requests: out of order, beyond the run, not on its way") {
  const ModelText m(oscillator);
  SimulationOptions options;
  options.at = {12};
  CHECK(run(m, options).final.t == 12);
  options.at = {-1};
  Diagnostics diagnostics;
  CHECK_FALSE(simulate(m.model, m.equations, options, diagnostics));
  CHECK(diagnostics.items().front().code == "E0706");
}

TEST_CASE("a model without a run says so") {
  const ModelText m("system s\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n");
  Diagnostics diagnostics;
  CHECK_FALSE(simulate(m.model, m.equations, {}, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items().front().code == "E0701");
}

TEST_CASE("an output interval has to be a positive time, and leave rows that can be kept") {
  const ModelText m(oscillator);
  const auto code_of = [&](double every) {
    SimulationOptions options;
    options.output_every = every;
    Diagnostics diagnostics;
    CHECK_FALSE(simulate(m.model, m.equations, options, diagnostics));
    REQUIRE(diagnostics.items().size() == 1);
    return diagnostics.items().front().code;
  };
  CHECK(code_of(-0.1) == "E0704");
  CHECK(code_of(std::nan("")) == "E0704");
  CHECK(code_of(1e-12) == "E0705");
}

TEST_CASE("multipliers without a name have their units: of positions an energy over φ, of velocities an action") {
  const std::string point =
      "system s\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
      "-g)\n";
  const auto unit = [&](const std::string& constraint) {
    const SimulationResult r = run(ModelText(point + constraint + "\nstart x = 1 m\nrun 0.1 s\n"));
    REQUIRE(r.reactions.size() == 1);
    return r.reactions[0].unit;
  };
  CHECK(unit("constraint x^2 + y^2 = l^2") == "N/m");
  CHECK(unit("constraint x = l") == "N");
  CHECK(unit("constraint x' = 0") == "N");
  CHECK(unit("constraint l x' = 0") == "N/m");
}

TEST_CASE("the output grid begins and ends with the run") {
  const ModelText m(std::string(oscillator) + "output every 300 ms\n");
  const SimulationResult r = run(m);
  CHECK(r.trajectory.times.front() == 0);
  CHECK(r.trajectory.times[1] == doctest::Approx(0.3));
  CHECK(r.trajectory.times.back() == 10);
  CHECK(r.trajectory.rows() == 35);
  CHECK(r.trajectory.columns.size() == 3);
  for (std::size_t i = 0; i < r.trajectory.rows(); ++i) CHECK(std::abs(r.trajectory.at(i, 2) - 4.0) < 1e-13);  // ½ k
}

TEST_CASE("the double pendulum of the reference values") {
  const ModelText m(R"(system double_pendulum
param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2
coord θ1, θ2 : angle
point A mass m1 at l1 (sin θ1, -cos θ1)
point B mass m2 at A + l2 (sin θ2, -cos θ2)
gravity (0, -g)
start θ1 = 2.0 rad, θ2 = 2.5 rad
)");
  SimulationOptions options;
  options.at = {1, 2, 5, 10};
  const SimulationResult r = run(m, options);
  REQUIRE(r.ok());
  const double expected[4][2] = {{-0.08386042040500097, -1.313096450613925},
                                 {-2.922032235907541, 0.11738517220261478},
                                 {8.191078459414503, 0.0150169205862499},
                                 {-0.753128874295, 1.627933082054}};
  const double tolerance[4] = {1e-13, 1e-13, 5e-12, 1e-6};
  for (int k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(std::abs(r.at[static_cast<std::size_t>(k)].q[i] - expected[k][i]) <= tolerance[k]);
}

TEST_CASE("what is switched in time does work at once: the books close") {
  // x'' + (2 + sign(cos t)) x = 0, Meissner: two frequencies in turns, √3 until π/2, then 1 until 3π/2.
  const ModelText m(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (2 + sign(cos(t))) x^2\nstart x = 1\nrun 4\n");
  const SimulationResult r = run(m);
  CHECK(r.statistics.energy_drift < 1e-14);
  const double w = std::sqrt(3.0), quarter = std::acos(0.0), later = 4 - quarter;
  const double x = std::cos(w * quarter), v = -w * std::sin(w * quarter);
  CHECK(r.final.q[0] == doctest::Approx(x * std::cos(later) + v * std::sin(later)).epsilon(1e-13));
  // A kink of V does no work.
  CHECK(run(ModelText("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = abs(x)\nstart x = 1\nrun 20\n"))
            .statistics.energy_drift < 1e-14);
}

TEST_CASE("a Lagrangian that is given whole needs no more products than points") {
  const std::string head =
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, c = 0.3 N m s\ncoord a, b : angle\n"
      "start a = 110 deg, b = 60 deg, b' = 0.4 rad/s\nD = 1/2 c b'^2\n";
  const ModelText points("system points\n" + head +
                         "point P mass m at (l sin a, -l cos a)\npoint Q mass m at P + (l sin b, -l cos b)\n"
                         "gravity (0, -g)\nrun 2 s\n"),
      whole("system whole\n" + head +
            "L = m l^2 a'^2 + 1/2 m l^2 b'^2 + m l^2 a' b' cos(a - b) + 2 m g l cos a + m g l cos b\nrun 2 s\n");
  const auto products = [](const ModelText& m) {
    const MotionKernel motion = motion_kernel(m.equations);
    const Program& program = motion.kernel.program();
    std::ptrdiff_t count = 0;
    for (const Run& part : program.runs[Dynamics])
      for (std::uint32_t at = part.first; at < part.last; ++at) {
        const Instruction& i = program.instructions[at];
        const auto first = program.terms.begin() + i.first_term, last = program.terms.begin() + i.last_term;
        count += i.op == Op::SinCos ? 2 : i.op == Op::Square ? 1 : 0;
        if (i.op == Op::Products) count += std::count_if(first, last, [](const Term& x) { return x.b != no_slot; });
      }
    return count;
  };
  CHECK(products(points) == 8);
  CHECK(products(whole) == products(points));
  const SimulationResult by_points = run(points), by_lagrangian = run(whole);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(by_lagrangian.final.q[i] == doctest::Approx(by_points.final.q[i]).epsilon(1e-12));
}

}  // namespace simulate_test

#include "../model_text.hpp"

#include <maupertuis/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace maupertuis;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

SimulationResult run(const std::string& text, SimulationOptions options = {}, Probe* probe = nullptr) {
  const ModelText m(text);
  Diagnostics diagnostics;
  auto result = simulate(m.model, m.equations, options, diagnostics, probe);
  INFO(render(diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

SimulationOptions at(std::vector<double> times) {
  SimulationOptions options;
  options.at = std::move(times);
  return options;
}

const std::string oscillator = R"(system oscillator
param m = 0.3 kg, k = 1.1 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 1 m
run 40 s
)";

const std::string double_pendulum = R"(system double_pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord a, b : angle
point A mass m at l (sin a, -cos a)
point B mass m at A + l (sin b, -cos b)
gravity (0, -g)
start a = 2 rad, b = 2.5 rad
run 60 s
)";

}  // namespace

TEST_CASE("the stated error covers the true one: an oscillator whose frequency is rounded") {
  const SimulationResult r = run(oscillator, at({1, 7, 40}));
  CHECK(r.statistics.companions == 7);
  for (const State& s : r.at) {
    REQUIRE(s.errors);
    const long double omega = std::sqrt(1.1L / 0.3L);
    const double off = static_cast<double>(std::abs(s.q[0] - std::cos(omega * s.t)));
    CHECK(off <= s.errors->q[0]);
    CHECK(s.errors->q[0] < 1e-13);
  }
  CHECK(r.at[2].errors->q[0] > r.at[0].errors->q[0]);  // the phase is what grows
}

TEST_CASE("what is rounded counts, what is exact does not: companions move 0.3 and 1/3, not 1/2") {
  // Free fall: no step to be wrong in, and the error is that of g alone, ½ t² ulp(g).
  const std::string fall =
      "system fall\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x : length\nT = 1/2 m x'^2\nV = m g x\nstart x = 1 m\nrun "
      "100 s\n";
  const double rounded = run(fall).final.errors->q[0];
  CHECK(rounded > 0.5 * 100 * 100 * 8.8e-16);
  const std::string exact =
      "system fall\nparam m = 1 kg, g = 9.75 m/s^2\ncoord x : length\nT = 1/2 m x'^2\nV = m g x\nstart x = 1 m\nrun "
      "100 s\n";
  const SimulationResult r = run(exact);
  CHECK(r.final.errors->q[0] == epsilon * std::abs(r.final.q[0]));
  // A literal within a formula is a number as well.
  const std::string literal =
      "system fall\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/3 x\nstart x = 1\nrun 100\n";
  CHECK(run(literal).final.errors->q[0] > 1e-13);
}

TEST_CASE("constants of forces keep their digits where they cancel, and so do parameters") {
  // a = 10¹⁰ (cos b − 1 + b²/2) at b = 1/1024, by its series
  const long double b = 1 / 1024.0L, s = b * b, a = 1e10L * s * s / 24 * (1 - s / 30 * (1 - s / 56));
  const std::string head = "dimensionless\nparam b = 1/1024, c = cos(1/1024) - 1 + 1/2097152\ncoord x : number\n",
                    rest = "\nstart x = 0\nrun 1\n";
  for (const std::string force : {"(cos(1/1024) - 1 + 1/2097152)", "(cos(b) - 1 + b^2/2)", "c"}) {
    CAPTURE(force);
    const SimulationResult r = run(head + "L = x'^2/2 + 1e10 x " + force + rest);
    CHECK(std::abs(r.final.q[0] - static_cast<double>(a / 2)) <= r.final.errors->q[0]);
    CHECK(r.final.errors->q[0] < 1e-14 * r.final.q[0]);
  }
}

TEST_CASE("the rounding of constants is told: a mass matrix that is nearly singular") {
  // In u = x + y and y: u'' + x = 0, e y'' + … ; its determinant e is the difference of 1 + e and 1.
  const std::string text =
      "dimensionless\nparam e = 1e-8\ncoord x, y : number\nL = (x' + y')^2/2 + e y'^2/2 - x^2/2 - e y^2/2\n"
      "start x = 1, y = 0.5\nrun 3\n";
  const SimulationResult r = run(text);
  REQUIRE(r.final.errors);
  CHECK(std::abs(r.final.q[0] + 0.596188683092) <= r.final.errors->q[0]);  // with --precision 100
  CHECK(r.final.errors->q[0] < 1e-2);
}

TEST_CASE("a time that is no double moves the state: told in the errors at 10.1, at none that is") {
  const std::string text = "dimensionless\ncoord x : number\nL = x'^2/2 - 1e8 x^2/2\nstart x = 1\nrun 10.1\n";
  const SimulationResult r = run(text, at({10.1, 10}));
  const long double phase = 1e4L * 10.1L;
  for (const State* s : {&r.final, &r.at[0]}) {
    CHECK(std::abs(s->q[0] - static_cast<double>(std::cos(phase))) <= s->errors->q[0]);
    CHECK(s->errors->q[0] >= 0.5 * 1.8e-15 * std::abs(s->v[0]));  // half a unit in the last place of 10.1
  }
  CHECK(r.final.errors->q[0] < 1e-10);
}

TEST_CASE("a probe whose terms cancel has its digits") {
  const ModelText m(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, 1 - cos θ)\n"
      "gravity (0, -g)\nstart θ = 1e-7 rad\nrun 1 s\n");
  Diagnostics diagnostics;
  Probe probe{{m.model.system.points[0].position[1]}, {}, {}};
  SimulationOptions options = at({0, 1});
  options.errors = ErrorEstimates::Rows;
  const auto r = simulate(m.model, m.equations, options, diagnostics, &probe);
  REQUIRE(r);
  for (std::size_t i = 0; i < 2; ++i) {
    const double θ = r->at[i].q[0], right = θ * θ / 2 * (1 - θ * θ / 12);
    CHECK(std::abs(probe.values[i][0] - right) <= 4 * epsilon * right);
    CHECK(probe.errors[i][0] < 1e-14 * right);
  }
  // In the rows the same formula is in double, and its rounding is told.
  const std::size_t height = *r->trajectory.column("P.y"), last = r->trajectory.rows() - 1;
  for (const std::size_t row : {std::size_t{0}, last / 3, last}) {
    const double θ = r->trajectory.at(row, 0), right = θ * θ / 2;
    CHECK(std::abs(r->trajectory.at(row, height) - right) <= r->trajectory.error(row, height));
    CHECK(r->trajectory.error(row, height) < 1e-14);
  }
}

TEST_CASE("zero by symmetry and given starts are exact") {
  const std::string text =
      "system two\nparam m = 1 kg, k = 2 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x^2 + y^2)\n"
      "start x = 0.1 m\nrun 5 s\n";
  const SimulationResult r = run(text, at({0, 5}));
  CHECK(r.at[0].errors->q[0] == 0);
  CHECK(r.at[0].errors->v[0] == 0);
  CHECK(r.at[1].errors->q[0] > 0);
  CHECK(r.at[1].q[1] == 0);
  CHECK(r.at[1].errors->q[1] == 0);
  CHECK(r.at[1].errors->v[1] == 0);
  CHECK(r.uncertain.columns.empty());
}

TEST_CASE("a chaotic run says from when on nothing is certain") {
  const SimulationResult r = run(double_pendulum, at({1, 10, 59}));
  CHECK(r.uncertain.everything);
  CHECK(r.uncertain.from > 15);
  CHECK(r.uncertain.from < 60);
  CHECK(r.at[0].errors->q[0] < 1e-13);
  CHECK(r.at[1].errors->q[0] > 1e-12);
  CHECK(r.at[1].errors->q[0] < 1e-4);
  CHECK(r.final.errors->v[0] == infinity);
  CHECK(r.final.errors->v[1] == infinity);
}

// π is no double: it stays on top for log(10¹⁶)/√9.81 s, falls, and comes near the top again at an unknown time and
// turn.
TEST_CASE("where one coordinate is lost before the others both times are known") {
  const SimulationResult r =
      run("param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord a : angle\npoint P mass m at (l sin a, -l cos a)\ngravity "
          "(0, -g)\n"
          "start a = 180 deg\nrun 100 s\n");
  REQUIRE(r.uncertain.everything);
  CHECK(r.uncertain.first > 8);
  CHECK(r.uncertain.first < 16);
  CHECK(r.uncertain.from >= r.uncertain.first);
}

TEST_CASE("companions of a motion that is lost end early, but not where damping brings motions together again") {
  // Hénon and Heiles' potential just below its escape, and the same with a little friction, which ends at rest.
  const auto motion = [](const std::string& friction) {
    return run("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2) + x^2 y - y^3/3\n" +
               friction + "start x = 0, y = -0.15, x' = 0.52, y' = 0\nrun 20000\n");
  };
  const SimulationResult conserved = motion(""), damped = motion("dissipation = 0.0005 (x'^2 + y'^2)\n");
  CHECK(conserved.uncertain.everything);
  CHECK(conserved.uncertain.from > 200);
  CHECK(conserved.uncertain.from < 2000);
  CHECK(conserved.final.errors->q[0] == infinity);
  REQUIRE(damped.final.errors);
  CHECK(damped.final.errors->q[0] < 1e-3);
  CHECK(damped.final.errors->q[1] < 1e-3);
}

TEST_CASE("where a motion is lost does not depend on the rows: companions end between few of them") {
  SimulationOptions few_rows;
  few_rows.output_every = 60;
  for (const double duration : {60.0, -60.0}) {
    SimulationOptions usual;
    usual.duration = few_rows.duration = duration;
    const SimulationResult few = run(double_pendulum, few_rows), many = run(double_pendulum, usual);
    CHECK(few.trajectory.rows() == 2);
    REQUIRE(few.uncertain.everything);
    CHECK(std::abs(few.uncertain.from - many.uncertain.from) < 1);
    CHECK(std::abs(few.uncertain.first - many.uncertain.first) < 1);
  }
  few_rows.duration = 10;
  few_rows.output_every = 10;
  const SimulationResult known = run(double_pendulum, few_rows);
  CHECK(known.uncertain.columns.empty());
  CHECK(known.final.errors->q[0] < 1e-4);
}

TEST_CASE("equal runs have equal errors, and each row has one where that is asked") {
  SimulationOptions options = at({3});
  options.errors = ErrorEstimates::Rows;
  const SimulationResult a = run(oscillator, options), b = run(oscillator, options);
  REQUIRE(a.trajectory.errors.size() == a.trajectory.values.size());
  CHECK(a.trajectory.errors == b.trajectory.errors);
  CHECK(a.at[0].errors->q == b.at[0].errors->q);
  CHECK(a.trajectory.error(0, 0) == 0);
  const std::size_t last = a.trajectory.rows() - 1;
  CHECK(a.trajectory.error(last, 0) == doctest::Approx(a.final.errors->q[0]).epsilon(0.1));
  const std::size_t energy = *a.trajectory.column("energy");
  CHECK(a.trajectory.error(last, energy) > 0);
  CHECK(a.trajectory.error(last, energy) < 1e-13);

  options.errors = ErrorEstimates::None;
  const SimulationResult without = run(oscillator, options);
  CHECK(without.trajectory.values == a.trajectory.values);  // companions change nothing of the run itself
  CHECK_FALSE(without.final.errors);
  CHECK(without.trajectory.errors.empty());
  CHECK(without.statistics.companions == 0);
}

TEST_CASE("a run that ends at a row of its output is certain there, though its neighbours end a little earlier") {
  const SimulationResult result =
      run("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x' = 1\n"
          "run until sin(pi t) = 0 within 20\n");
  REQUIRE(result.ending == Ending::UntilReached);
  REQUIRE(result.final.errors);
  CHECK(result.final.q[0] == doctest::Approx(std::sin(1)).epsilon(1e-15));
  CHECK(result.final.errors->q[0] < 1e-14);
  CHECK(result.uncertain.columns.empty());
}

TEST_CASE("the time of run until has an error, and so has the state there") {
  const std::string text =
      "system throw\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x : length, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "start x' = 3 m/s, y = 100 m\nrun until y = 0 within 60 s\n";
  const SimulationResult r = run(text);
  REQUIRE(r.ending == Ending::UntilReached);
  const long double right = std::sqrt(200 / 9.81L);
  REQUIRE(r.final.errors);
  CHECK(static_cast<double>(std::abs(r.final.t - right)) <= r.final.errors->t);
  CHECK(r.final.errors->t < 1e-13);
  CHECK(static_cast<double>(std::abs(r.final.q[0] - 3 * right)) <= r.final.errors->q[0]);
  CHECK(r.final.errors->q[0] < 1e-13);
}

TEST_CASE("tolerances show: a coarse run knows that it is coarse") {
  SimulationOptions options = at({40});
  options.tolerance = 1e-6;
  const SimulationResult r = run(oscillator, options);
  const double off = std::abs(r.at[0].q[0] - static_cast<double>(std::cos(40 * std::sqrt(1.1L / 0.3L))));
  CHECK(off > 1e-10);
  CHECK(off <= r.at[0].errors->q[0]);
  CHECK(r.at[0].errors->q[0] <= 100 * off);
}

TEST_CASE("constraints, switches, stiff and variational runs are compared with companions of their own") {
  const std::string pendulum =
      "system pendulum\nparam m = 1 kg, l = 0.7 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, "
      "y)\ngravity (0, -g)\n"
      "constraint x^2 + y^2 = l^2 name rod\nstart x = 0.5 m, y = -0.4 m\nrun 10 s\n";
  const SimulationResult rod = run(pendulum, at({0, 4}));
  CHECK(rod.statistics.companions == 3);
  REQUIRE(rod.at[1].errors->reactions.size() == 1);
  CHECK(rod.at[1].errors->reactions[0] > 0);
  CHECK(rod.at[1].errors->reactions[0] < 1e-10);
  CHECK(rod.at[1].errors->multipliers[0] > 0);

  const std::string kinked =
      "system kink\nparam m = 1 kg, k = 1.3 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2 + 3 [N] abs(x)\nstart "
      "x = 1 m\nrun 10 s\n";
  const SimulationResult kink = run(kinked);
  CHECK(kink.statistics.switches > 3);
  CHECK(kink.final.errors->q[0] > 0);
  CHECK(kink.final.errors->q[0] < 1e-11);

  SimulationOptions options;
  options.method = StepMethod::Variational;
  options.step = 0.05;
  const SimulationResult coarse = run(oscillator, options);
  const double right = static_cast<double>(std::cos(40 * std::sqrt(1.1L / 0.3L)));
  CHECK(std::abs(coarse.final.q[0] - right) > 1e-6);
  CHECK(std::abs(coarse.final.q[0] - right) <= coarse.final.errors->q[0]);
  CHECK(coarse.final.errors->q[0] <= 100 * std::abs(coarse.final.q[0] - right));
}

TEST_CASE("before the first variational step is over its error is known, too") {
  for (const double t : {0.05, 0.2, 0.4}) {
    SimulationOptions options = at({t});
    options.method = StepMethod::Variational;
    options.step = 0.5;
    options.order = 2;
    const SimulationResult r = run(oscillator, options);
    const double right = static_cast<double>(std::cos(t * std::sqrt(1.1L / 0.3L))),
                 off = std::abs(r.at[0].q[0] - right);
    INFO(t);
    CHECK(off > 1e-7);
    CHECK(off <= r.at[0].errors->q[0]);
    CHECK(r.at[0].errors->q[0] < 0.1);
  }
}

TEST_CASE("where shorter variational steps do not come to one motion no digit is certain") {
  // Steps of eight periods of x, which pushes y: with 1/3 and 1/4 of them y comes elsewhere again.
  SimulationOptions options;
  options.method = StepMethod::Variational;
  options.step = 0.5;
  const SimulationResult coarse =
      run("system s\ndimensionless\nparam w = 100\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
          "V = 1/2 w^2 (x - 0.1*sin(y))^2 + 1/2 y^2\nstart x = 0.2, y = 1\nrun 10\n",
          options);
  CHECK(std::abs(coarse.final.q[1] - 0.05277) > 0.5);
  CHECK(coarse.final.errors->q[1] == infinity);
}

TEST_CASE("what is held at zero is known to be there") {
  const SimulationResult r =
      run("system rotor\nparam m = 10 kg, e = 0.5 mm, Ip = 0.05 kg m^2, It = 0.03 kg m^2, δ = 1 deg, n = 3000 rpm, la "
          "= 200 mm, "
          "lb = 300 mm\ncoord x, y, z : length, φ, θ, ψ : angle\nframe S at (x, y, z) rotation rpy (φ, θ, ψ)\n"
          "frame G at (e, 0, 0) rotation axis (0, 1, 0) angle δ in S\nbody rotor mass m inertia diag(It, It, Ip) in G\n"
          "point A at (0, 0, -la) in S\npoint B at (0, 0, lb) in S\nconstraint A.x = 0\nconstraint A.y = 0\n"
          "constraint A.z = -la\nconstraint B.x = 0\nconstraint B.y = 0\nconstraint ψ = n t\nrun 20 ms\n");
  CHECK(r.uncertain.columns.empty());
  for (std::size_t i = 0; i < 3; ++i) CHECK(r.final.errors->q[i] < 1e-15);
}

TEST_CASE("a large energy is no size of a chaotic motion without units") {
  const std::string chaos =
      "system s\ndimensionless\nparam c = 0\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "V = c + 1/2 (x^2 + y^2) + x^2 y - 1/3 y^3\nstart y = -0.1, x' = 0.52, y' = 0.1\nrun 2000\n";
  std::string high = chaos;
  high.replace(high.find("c = 0"), 5, "c = 1e9");
  CHECK_FALSE(run(chaos).uncertain.columns.empty());
  CHECK_FALSE(run(high).uncertain.columns.empty());
}

TEST_CASE("probes have errors of their own") {
  const ModelText m(oscillator);
  Probe probe;
  probe.expressions = {m.q(0) * m.q(0), m.v(0)};
  Diagnostics diagnostics;
  const auto r = simulate(m.model, m.equations, at({0.5, 40}), diagnostics, &probe);
  REQUIRE(r);
  REQUIRE(probe.errors.size() == 2);
  CHECK(probe.errors[1].size() == 2);
  CHECK(probe.errors[1][1] == doctest::Approx(r->at[1].errors->v[0]).epsilon(1e-6));
  const double expected = 2 * std::abs(r->at[1].q[0]) * r->at[1].errors->q[0];
  CHECK(probe.errors[1][0] > 0.5 * expected);
  CHECK(probe.errors[1][0] < 2 * expected);
}

TEST_CASE("an event that holds as the motion begins does not count among those of the companions") {
  const SimulationResult r =
      run("system s\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 0.3, x' = 0.7\nrun 10\n"
          "event e when (x - 0.3)*(x - 0.9) = 0 : record\n");
  REQUIRE(r.happenings.size() == 4);
  for (const Happening& h : r.happenings) CHECK(h.error < 1e-14);
}

TEST_CASE("a touch of zero that rounding hides from a companion takes no digits of the crossings after it") {
  const auto result =
      run("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\nrun 10\n"
          "event zero when tan(x pi) = 0 : record\n");  // x = cos t: crossings at x = 0, touches at ±1, the start one
                                                        // of them
  REQUIRE(result.happenings.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const Happening& h = result.happenings[i];
    CHECK(std::abs(h.t - static_cast<double>(i + 1) * std::acos(0.0)) <= h.error);
    CHECK(h.error < (i % 2 == 0 ? 1e-14 : 1e-7));
  }
}

TEST_CASE("a touch that rounding makes two crossings of, in one run or another, takes no digits of other crossings") {
  const auto result =
      run("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x' = 1\nrun 15\n"
          "event zero when (x^2 - 1)*(x - 0.999) = 0 : record\n");  // x = sin t
  const double turn = std::acos(0.0), aside = std::acos(0.999);
  for (int k = 0; k < 5; ++k)
    for (const double t : {(2 * k + 1) * turn - aside, (2 * k + 1) * turn, (2 * k + 1) * turn + aside}) {
      const bool is_turn = t == (2 * k + 1) * turn;
      if (!is_turn && k % 2 == 1) continue;
      CAPTURE(t);
      CHECK(std::any_of(result.happenings.begin(), result.happenings.end(), [&](const Happening& h) {
        return std::abs(h.t - t) <= h.error + 1e-15 && h.error < (is_turn ? 1e-6 : 1e-12);
      }));
    }
}

TEST_CASE("an energy is known at times at which the state is lost") {
  const ModelText m(double_pendulum);
  Probe probe;
  probe.expressions = {m.equations.energy_function, m.q(0)};
  SimulationOptions options = at({900});
  options.duration = 1000;
  Diagnostics diagnostics;
  const auto r = simulate(m.model, m.equations, options, diagnostics, &probe);
  REQUIRE(r);
  CHECK(r->uncertain.from < 500);  // long before: of a chaotic motion the place depends on each rounding
  REQUIRE(probe.errors.size() == 1);
  CHECK(probe.errors[0][0] < 1e-11);
  CHECK(probe.errors[0][1] == infinity);
}

TEST_CASE("rounding noise about zero is no motion that was lost") {
  // 0.1 + 0.2 − 0.3 is nothing but rounding: it moves y by some 1e-17 beside an x of 1.
  const SimulationResult r =
      run("system s\ndimensionless\nparam a = 0.1, b = 0.2, c = 0.3\ncoord x, y : number\n"
          "T = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2) + (a + b - c) x y\nstart x = 1\nrun 10\n");
  REQUIRE(r.final.errors);
  CHECK(std::abs(r.final.q[1]) < 1e-14);
  CHECK(r.final.errors->q[1] > 0);
  CHECK(r.uncertain.columns.empty());
}

namespace {

/// Codes of a run.
std::string codes_of_run(const std::string& text, double& drift) {
  const ModelText m(text);
  Diagnostics diagnostics;
  const auto result = simulate(m.model, m.equations, {}, diagnostics, nullptr);
  REQUIRE(result);
  drift = result->statistics.energy_drift;
  std::string out;
  for (const Diagnostic& d : diagnostics.items()) out += d.code + " ";
  return out;
}

}  // namespace

TEST_CASE("formulas of starts have the digits of their numbers, not those of their terms") {
  // From 0 the unstable rest is never left; sin(π) in double is 1.2e-16, and 14 at the end.
  CHECK(run("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/2 x^2\nstart x = sin(pi)\nrun 40\n").final.q[0] ==
        0);
  // e - 2.71875 to 17 digits, by its own series.
  const double rest = -4.6817154095476478e-4;
  const SimulationResult r =
      run("dimensionless\nparam a = 1\ncoord x : number\nT = 1/2 x'^2\nstart x = exp(a) - 2.71875\nrun 1\n");
  CHECK(std::abs(r.final.q[0] - rest) <= 2 * epsilon * std::abs(rest));
}

TEST_CASE("numbers in the condition of an event that sets the state are rounded as well") {
  const SimulationResult r =
      run("dimensionless\ncoord x : number\nT = 1/2 x'^2\nevent a when cos(x) = 0.9999999999999 : set x' = 2 x'\n"
          "start x = 0, x' = 1\nrun 1\n");
  const double met = 2 * std::asin(std::sqrt(0.5e-13));  // cos x = 1 − 1e-13
  REQUIRE(r.happenings.size() == 1);
  CHECK(std::abs(r.happenings[0].t - met) <= 3 * r.happenings[0].error);
  CHECK(std::abs(r.final.q[0] - (2 - met)) <= 3 * r.final.errors->q[0]);
}

TEST_CASE("an energy of the first order that is one term does not drift by its own rounding") {
  double drift = 0;
  CHECK(codes_of_run("dimensionless\nparam B = 0.1\ncoord x, y : number\n"
                     "L = 1/2 B (x y' - y x') - 1/2*(x^2 + y^2)\nstart x = 0.4\nrun 9\n",
                     drift)
            .empty());
  CHECK(drift < 1e-12);
}

TEST_CASE("rounding of the energy near the bottom of 1 - cos θ is no jump of it; a wall that is passed is") {
  double drift = 0;
  CHECK(codes_of_run("param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n"
                     "point P mass m at l (sin θ, 1 - cos θ)\ngravity (0, -g)\nstart θ = 1e-7 rad\nrun 3 s\n",
                     drift)
            .empty());
  CHECK(drift > 1e-7);
  CHECK(codes_of_run("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2*(x - 1e8)^2\nstart x = 1e8, x' = 1e-3\n"
                     "run 10\n",
                     drift)
            .empty());
  CHECK(drift > 1e-7);
}

// Constrained runs against closed forms, against the same motion in independent coordinates, and at their limits.
#include <maupertuis/simulation.hpp>
#include <maupertuis/stiff.hpp>
#include "../under_sanitizers.hpp"

#include "../model_text.hpp"

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace {

SimulationResult run(ModelText& m, double end, SimulationOptions options = {}) {
  options.duration = end;
  auto result = simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

double reaction(const SimulationResult& r, const std::string& name) {
  for (std::size_t i = 0; i < r.reactions.size(); ++i)
    if (r.reactions[i].name == name) return r.final.reactions[i];
  FAIL("no reaction " << name);
  return 0;
}

const char* cartesian =
    "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
    "-g)\n"
    "constraint x^2 + y^2 = l^2 name rod\n";

}  // namespace

TEST_CASE("a pendulum in x and y: a hundred thousand steps without drift, and the tension of the rod" *
          doctest::skip(under_sanitizers)) {
  ModelText m(std::string(cartesian) + "start x = 1 m\n");
  const auto r = run(m, 7900);
  CHECK(r.statistics.steps > 100'000);
  CHECK(r.statistics.constraint_residual < 1e-14);
  CHECK(r.statistics.energy_drift < 1e-12);
  CHECK(std::abs(std::hypot(r.final.q[0], r.final.q[1]) - 1) < 4e-16);
  CHECK(reaction(r, "reaction(rod)") == doctest::Approx(-3 * 9.81 * r.final.q[1]).epsilon(1e-11));
  CHECK(r.final.multipliers[0] == doctest::Approx(1.5 * 9.81 * r.final.q[1]).epsilon(1e-11));  // λ ∇φ = −tension · r/l
}

TEST_CASE("the same motion by every method, and by the angle") {
  ModelText m(std::string(cartesian) + "start x = 1 m\n");
  ModelText angle(
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
      "gravity (0, -g)\nstart θ = 90 deg\n");
  const double x = std::sin(run(angle, 3).final.q[0]);
  CHECK(std::abs(run(m, 3).final.q[0] - x) < 1e-13);
  SimulationOptions variational;
  variational.method = StepMethod::Variational;
  variational.step = 0.01;
  variational.order = 8;
  CHECK(std::abs(run(m, 3, variational).final.q[0] - x) < 1e-10);
  SimulationOptions stiff;
  stiff.method = StepMethod::Stiff;
  CHECK(std::abs(run(m, 3, stiff).final.q[0] - x) < 1e-11);
}

TEST_CASE("a free body turned by a unit quaternion, whose M has rank 3 of 4" * doctest::skip(under_sanitizers)) {
  ModelText m(
      "system top\nparam A = 1 kg m^2, C = 2 kg m^2\nbody top inertia diag(A, A, C) rotation quaternion\n"
      "start top.ω = (1, 0, 3) rad/s\n");
  const auto r = run(m, 2000);
  CHECK(r.statistics.constraint_residual < 1e-13);
  CHECK(r.statistics.energy_drift < 1e-12);
  // Euler: ω₁ + i ω₂ turns at (C − A)/A ω₃ = 3 rad/s in the body.
  const auto rates = m.system->bodies[0].angular_velocity;
  Bindings at = parameter_bindings(*m.system);
  for (std::size_t i = 0; i < 4; ++i) at[m.q(i)] = r.final.q[i], at[m.v(i)] = r.final.v[i];
  const auto value = [&](Expr e) { return evaluate(expand_time_derivatives(e), at); };
  CHECK(value(rates[0]) == doctest::Approx(std::cos(6000.0)).epsilon(1e-9));
  CHECK(std::abs(value(rates[1])) == doctest::Approx(std::abs(std::sin(6000.0))).epsilon(1e-9));
  CHECK(value(rates[2]) == doctest::Approx(3).epsilon(1e-12));
}

TEST_CASE("a coordinate without kinetic energy that a constraint ties: every method") {
  ModelText m(
      "system massless\nparam Is = 1e-5 kg m^2, τ = 0.1 N m\ncoord a, b : angle\nT = 1/2 Is a'^2\nforce a = "
      "τ\nconstraint a + b = 0\n");
  for (const StepMethod method : {StepMethod::Taylor, StepMethod::Variational, StepMethod::Stiff}) {
    SimulationOptions options;
    options.method = method;
    options.step = 0.001;
    const auto r = run(m, 0.02, options);
    CHECK(r.final.q[0] == doctest::Approx(2).epsilon(1e-11));  // τ t² / 2 Is
    CHECK(r.final.q[1] == doctest::Approx(-2).epsilon(1e-11));
  }
}

TEST_CASE("a rolling disk runs in a circle of radius R φ'/ψ'") {
  ModelText m(
      "system disk\nparam m = 1 kg, R = 20 cm\nlet I = 1/2 m R^2, J = 1/4 m R^2\ncoord x, y : length\ncoord φ, ψ : "
      "angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2\nconstraint x' = R φ' cos ψ\nconstraint y' = R φ' sin ψ\n"
      "start φ' = 2 rad/s, ψ' = 1 rad/s\n");
  const auto r = run(m, 10);
  CHECK(r.start.v[2] == 2);  // kept as written
  CHECK(r.start.v[0] == doctest::Approx(0.4).epsilon(1e-15));
  CHECK(r.final.q[0] == doctest::Approx(0.4 * std::sin(10.0)).epsilon(1e-12));
  CHECK(r.final.q[1] == doctest::Approx(0.4 * (1 - std::cos(10.0))).epsilon(1e-12));
  CHECK(r.final.v[2] == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("a constraint that moves with time: a bead on a rod that turns, r = r0 cosh Ωt") {
  ModelText m(
      "system bead\nparam m = 1 kg, Ω = 2 rad/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
      "constraint y cos(Ω t) = x sin(Ω t) name rod\nstart x = 1 m, x' = 0\n");
  const auto r = run(m, 2);
  CHECK(std::hypot(r.final.q[0], r.final.q[1]) == doctest::Approx(std::cosh(4.0)).epsilon(1e-12));
  CHECK(r.statistics.energy_drift < 1e-12);  // the rod does work: h_E follows it
  CHECK(r.statistics.constraint_residual < 1e-14);
}

TEST_CASE("redundant constraints: the motion is unique, the shares of the forces are not") {
  const std::string free =
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, "
      "-g)\n";
  ModelText twice(free +
                  "constraint x^2 + y^2 = l^2 name rod\nconstraint 2 x^2 + 2 y^2 = 2 l^2 name wire\nstart x = 1 m\n");
  ModelText once(std::string(cartesian) + "start x = 1 m\n");
  const auto r = run(twice, 3);
  CHECK(std::abs(r.final.q[0] - run(once, 3).final.q[0]) < 1e-13);
  CHECK(std::isnan(r.final.multipliers[0]));
  CHECK(std::isnan(r.final.multipliers[1]));
  CHECK(std::isnan(reaction(r, "reaction(rod)")));
}

TEST_CASE("redundant constraints hold a weight at rest, whatever rounding leaves of its acceleration") {
  for (const char* g : {"9.81", "9.8", "8", "1.62", "274.13"}) {
    CAPTURE(g);
    const std::string weight = std::string("param m = 10 kg, a = 0.5 m, g = ") + g + " m/s^2\n";
    ModelText twice(weight +
                    "coord x, y : length\npoint P mass m at (x, y)\ngravity (0, -g)\nconstraint y = 0 name f1\n"
                    "constraint 2 y = 0 name f2\nstart x' = 1 m/s\n");
    const auto r = run(twice, 1);
    CHECK(r.final.q[0] == doctest::Approx(1).epsilon(1e-14));
    CHECK(std::abs(r.final.q[1]) < 1e-13);
    ModelText beam(weight +
                   "coord x, y : length, θ : angle\nbody B mass m inertia 1 kg m^2 at (x, y) rotation angle θ\n"
                   "point p1 at (-a, 0) in B\npoint p2 at (0, 0) in B\npoint p3 at (a, 0) in B\ngravity (0, -g)\n"
                   "constraint p1.y = 0 name f1\nconstraint p2.y = 0 name f2\nconstraint p3.y = 0 name f3\n"
                   "start x' = 1 m/s\n");
    const auto b = run(beam, 1);
    CHECK(b.final.q[0] == doctest::Approx(1).epsilon(1e-14));
    CHECK(std::isnan(reaction(b, "reaction(f2)")));
  }
}

TEST_CASE("a written start is kept, the rest moves; contradictions move with a warning, or are refused") {
  ModelText kept(std::string(cartesian) + "start y = 0.6 m, x = 0.1 m, y' = 1 m/s\n");
  kept.model.experiment.start.erase(kept.model.experiment.start.begin() + 1);  // x is free
  const auto start = consistent_start(kept.model, kept.equations, kept.diagnostics);
  REQUIRE(start);
  CHECK(start->state.q[1] == 0.6);
  CHECK(std::abs(std::abs(start->state.q[0]) - 0.8) < 1e-14);
  CHECK(start->state.v[1] == 1);
  CHECK(start->state.v[0] * start->state.q[0] == doctest::Approx(-0.6).epsilon(1e-13));

  ModelText off(std::string(cartesian) + "start x = 1.2 m, y = 0.5 m\n");
  const auto moved = consistent_start(off.model, off.equations, off.diagnostics);
  REQUIRE(moved);
  REQUIRE(off.diagnostics.items().size() == 1);
  CHECK(off.diagnostics.items()[0].code == "W0701");
  // The least kinetic change of a single mass is the foot of the perpendicular.
  CHECK(moved->state.q[0] == doctest::Approx(1.2 / 1.3).epsilon(1e-13));
  CHECK(moved->state.q[1] == doctest::Approx(0.5 / 1.3).epsilon(1e-13));

  ModelText just_off(std::string(cartesian) + "start x = 1.00000001 m, y = 0 m\n");
  REQUIRE(consistent_start(just_off.model, just_off.equations, just_off.diagnostics));
  CHECK(just_off.diagnostics.items()[0].message.find("x from 1.00000001 to 1 m") != std::string::npos);

  ModelText exact(std::string(cartesian) + "start exactly x = 1.2 m, y = 0.5 m\n");
  CHECK(!consistent_start(exact.model, exact.equations, exact.diagnostics));
  CHECK(exact.diagnostics.items()[0].code == "E0707");
}

TEST_CASE("a search leaves alone what its constraints do not hold, and constraints that are fulfilled") {
  // Where y = 0 the circle says nothing of it: y is searched for.
  ModelText m(
      "dimensionless\ncoord x, y, z, u, w : number\nT = 1/2 (x'^2 + y'^2 + z'^2 + u'^2 + w'^2) + 1/2 y' z'\n"
      "constraint x^2 + y^2 = 1\nconstraint u = w\nstart x = 0.6, w = 0.25\n");
  const auto start = consistent_start(m.model, m.equations, m.diagnostics);
  REQUIRE(start);
  CHECK(start->searched);
  CHECK(start->state.q[1] == doctest::Approx(0.8).epsilon(1e-13));
  CHECK(start->state.q[2] == 0);
  CHECK(start->state.q[3] == doctest::Approx(0.25).epsilon(1e-13));
  CHECK(start->state.q[4] == 0.25);
}

TEST_CASE("constraints that exclude each other are named, and only they") {
  ModelText m(
      "system p\nparam m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
      "constraint x + y = 1 [m] name near\nconstraint z = x name other\nconstraint x + y = 2 [m] name far\nrun 1 s\n");
  CHECK(!consistent_start(m.model, m.equations, m.diagnostics));
  REQUIRE(m.diagnostics.items().size() == 1);
  CHECK(m.diagnostics.items()[0].code == "E0708");
  CHECK(m.diagnostics.items()[0].message == "no configuration satisfies near and far");
}

TEST_CASE("a loop that cannot close, and velocities that cannot be") {
  ModelText loop(
      "system p\nparam m = 1 kg, a = 1 m, b = 1 m, d = 3 m\ncoord α, β : angle\nT = 1/2 m a^2 (α'^2 + β'^2)\n"
      "constraint a cos α + b cos β = d name closing\nconstraint a sin α + b sin β = 0 name level\nrun 1 s\n");
  CHECK(!consistent_start(loop.model, loop.equations, loop.diagnostics));
  CHECK(loop.diagnostics.items()[0].code == "E0708");
  ModelText speeds(
      "system p\nparam m = 1 kg, c = 1 m/s\ncoord x : length\nT = 1/2 m x'^2\nconstraint x' = c name drive\n"
      "constraint x' = 2 c name faster\nrun 1 s\n");
  CHECK(!consistent_start(speeds.model, speeds.equations, speeds.diagnostics));
  CHECK(speeds.diagnostics.items()[0].code == "E0709");
}

TEST_CASE("a singular configuration ends the run with the reason, or is passed where the motion is determined") {
  // The wire y² = x² has a double point at the origin: which branch the bead takes is not determined by the constraint,
  // but its velocity goes on.
  ModelText cross(
      "system bead\nparam m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint y^2 = x^2 name wire\n"
      "start x = -1 m, y = -1 m, x' = 1 m/s, y' = 1 m/s\n");
  const auto r = run(cross, 3);
  if (r.ok()) {
    CHECK(r.final.q[0] == doctest::Approx(2).epsilon(1e-9));
    CHECK(r.final.q[1] == doctest::Approx(2).epsilon(1e-9));
  } else {
    CHECK(r.ending == Ending::SingularConstraints);
    CHECK(r.final.t <= 1.0 + 1e-9);
  }
  // At the cusp of y³ = x² the velocity cannot go on.
  ModelText cusp(
      "system bead\ndimensionless\nparam m = 1, g = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "constraint y^3 = x^2 name wire\nstart x = 1, y = 1\n");
  const auto end = run(cusp, 30);
  CHECK(!end.ok());
  CHECK(!end.reason.empty());
  CHECK(std::abs(std::pow(end.final.q[1], 3) - std::pow(end.final.q[0], 2)) < 1e-9);
}

TEST_CASE("a parallelogram through its flat position: on with the motion where no force is needed, else the reason") {
  const std::string linkage =
      "system p\nparam l = 1 m, d = 2 m, J = 1 kg m^2\ncoord a, b, c : angle\nT = 1/2 J (a'^2 + b'^2 + c'^2)\n"
      "constraint l cos a + d cos c = d + l cos b name horizontal\nconstraint l sin a + d sin c = l sin b name "
      "vertical\n"
      "start a = 60 deg, a' = -1 rad/s, c = 0, b = 60 deg\n";
  ModelText free(linkage);
  const auto through = run(free, 5);
  CHECK(through.ok());
  CHECK(through.final.q[0] == doctest::Approx(1.0471975511965976 - 5).epsilon(1e-12));
  CHECK(through.final.q[1] == doctest::Approx(through.final.q[0]).epsilon(1e-12));
  // With a weight on the crank the coupler would have to carry an infinite force there.
  ModelText loaded(linkage + "V = 3 [J] sin a\n");
  const auto stuck = run(loaded, 5);
  CHECK(stuck.ending == Ending::SingularConstraints);
  CHECK(std::abs(stuck.final.q[0]) < 0.1);
  CHECK(stuck.statistics.energy_drift < 1e-12);
  CHECK(std::abs(stuck.final.q[0] - stuck.final.q[1]) < 1e-7);
}

TEST_CASE("steps that accuracy keeps short are no reason for the stiff method, nor those that are few") {
  ModelText smooth(
      "system s\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2*x^2 + 1/4*y^4\nstart x = 1, y = "
      "1\n");
  for (const int order : {4, 8}) {
    SimulationOptions options;
    options.duration = 100, options.order = order;
    options.errors = ErrorEstimates::None;
    const auto r = simulate(smooth.model, smooth.equations, options, smooth.diagnostics);
    REQUIRE(r);
    CHECK(r->statistics.method == "taylor");
    CHECK(r->statistics.energy_drift < 1e-12);
  }
  ModelText follows(
      "system f\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2*1e8*(x - sin(y))^2 + 1/2*y^2\n"
      "D = 1/2*1e4*(x' - cos(y)*y')^2\nstart x = sin(1), y = 1\n");
  CHECK(run(follows, 10).statistics.method == "taylor");
}

TEST_CASE("the stiff method takes over where stability limits the steps, and says so") {
  ModelText m(
      "system s\ndimensionless\nparam k = 1e7, c = 1e7\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\n"
      "start x = 1\n");
  const auto r = run(m, 1);  // x' ≈ −(k/c) x once the fast part is gone
  CHECK(r.statistics.method == "stiff");
  CHECK(r.final.q[0] == doctest::Approx(std::exp(-1.0)).epsilon(1e-6));
  CHECK(r.statistics.energy_drift < 1e-7);  // the work before the change counts as well: some part in 1e3 of the energy
  const auto told = [](const ModelText& run, const std::string& tolerance) {
    const auto& items = run.diagnostics.items();
    return std::any_of(items.begin(), items.end(), [&](const Diagnostic& d) {
      return d.code == "N0702" && d.reason.find("a tolerance of " + tolerance + " to") != std::string::npos;
    });
  };
  CHECK(told(m, "1e-12"));
  ModelText coarse = m;
  SimulationOptions wished;
  wished.tolerance = 1e-6;
  run(coarse, 1, wished);
  CHECK(told(coarse, "1e-06"));
  SimulationOptions taylor;
  taylor.method = StepMethod::Taylor;
  taylor.maximum_steps = 3000;
  CHECK(run(m, 1, taylor).ending == Ending::TooManySteps);
}

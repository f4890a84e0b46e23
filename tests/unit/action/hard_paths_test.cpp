#include "support.hpp"

using namespace maupertuis;

namespace {

const char* const pendulum_by_constraint = R"(
system cp
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
)";

std::string of_kepler(const std::string& run) {
  return "system kepler\ndimensionless\nparam μ = 1\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
         "V = -μ/sqrt(x^2 + y^2)\nstart x = 0.1, y' = 4.358898943540674\nrun " +
         run + "\n";
}

}  // namespace

TEST_CASE("paths on a constraint keep it between the nodes too, and come in their pairs") {
  const ModelText by_angle("system p\ndimensionless\ncoord θ : angle\nL = 1/2 θ'^2 + 9.81 cos θ\n");
  const ModelText by_constraint(pendulum_by_constraint);
  for (const double duration : {0.5, 2.0}) {
    const PathSearch angle = paths_of(by_angle, fixed_ends({0}, 0, {pi}, duration));
    const PathSearch found = paths_of(by_constraint, fixed_ends({0, -1}, 0, {0, 1}, duration));
    REQUIRE(angle.paths.size() >= 1);
    REQUIRE(found.paths.size() == 2);
    for (const StationaryPath& p : found.paths) {
      CHECK(p.action == doctest::Approx(angle.paths[0].action).epsilon(1e-12));
      CHECK(p.check.missed < 1e-9);
      for (int k = 0; k <= 100; ++k) {
        const MotionState s = p.path.at(duration * k / 100);
        CHECK(std::hypot(s.q[0], s.q[1]) == doctest::Approx(1).epsilon(1e-10));
      }
    }
    CHECK(found.paths[0].start_velocity[0] == doctest::Approx(-found.paths[1].start_velocity[0]));
  }
}

TEST_CASE("an eccentric orbit: the model's own start, conjugate to it after each turn, S by Kepler's equation") {
  const ModelText m(of_kepler("20"));
  Diagnostics diagnostics;
  const auto found = action_of_motion(m.model, m.equations, {}, diagnostics);
  REQUIRE(found);
  CHECK(found->path.start_velocity[0] == 0);
  CHECK(found->path.start_velocity[1] == 4.358898943540674);
  REQUIRE(found->path.second.conjugate.size() == 5);
  for (const int turn : {1, 2, 3})
    CHECK(std::abs(found->path.second.conjugate[static_cast<std::size_t>(2 * turn - 2)].t - 2 * pi * turn) < 1e-10);
  // det ∂q/∂q'(0) of Kepler's closed form, differenced in 30 digits, vanishes there as well.
  CHECK(std::abs(found->path.second.conjugate[1].t - 8.842916120253369) < 1e-11);
  CHECK(std::abs(found->path.second.conjugate[3].t - 15.36510576292919) < 1e-11);
  // E − 0.9 sin E = 20, S = ∫ (h + 2/r) dt = −½ 20 + 2 E
  double anomaly = 20;
  for (int k = 0; k < 50; ++k) anomaly -= (anomaly - 0.9 * std::sin(anomaly) - 20) / (1 - 0.9 * std::cos(anomaly));
  CHECK(std::abs(found->path.action - (2 * anomaly - 10)) < 2 * found->path.action_error);
  CHECK(found->path.action_error < 1e-11);
}

TEST_CASE("an eccentric orbit as a closed path: 3π, within its error, and no warning") {
  const ModelText m(of_kepler("20"));
  Diagnostics diagnostics;
  const auto found = action_of_orbit(m.model, m.equations, std::nullopt, {}, diagnostics);
  REQUIRE(found);
  CHECK(diagnostics.items().empty());
  CHECK(std::abs(found->path.action - 3 * pi) <= found->path.action_error);
  CHECK(found->path.action_error < 1e-11);
  CHECK(found->abbreviated == doctest::Approx(2 * pi).epsilon(1e-12));
}

TEST_CASE("a motion of more steps than a path has elements for is refused") {
  const ModelText m("system o\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\nrun 20000\n");
  Diagnostics diagnostics;
  CHECK_FALSE(action_of_motion(m.model, m.equations, {}, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items().front().code == "E1211");
}

TEST_CASE("kinks of a double well, which S barely holds in their places: quadratures in 40 digits") {
  const ModelText m("system k\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + 1/2 (x^2 - 1)^2\n");
  // T = ∫ dx/√((1 − x²)² + 2 E), S = ∫ √((1 − x²)² + 2 E) dx − E T from −1 to 1
  const std::pair<double, double> cases[] = {
      {8, 1.3333351306652311741}, {12, 1.333333333937335065}, {20, 1.3333333333333334013}};
  for (const auto& [duration, action] : cases) {
    CAPTURE(duration);
    const PathSearch found = paths_of(m, fixed_ends({-1}, 0, {1}, duration));
    REQUIRE(found.paths.size() == 1);
    CHECK(std::abs(found.paths[0].action - action) <= found.paths[0].action_error);
    CHECK(found.paths[0].check.missed < 1e-9);
  }
}

TEST_CASE("a path along which L vanishes is one as others are") {
  const ModelText m("system s\ndimensionless\ncoord x, y : number\nL = 1/2 x'^2 - 1/2 y'^2 - 1/2 x^2 + 1/2 y^2\n");
  const PathSearch found = paths_of(m, fixed_ends({0, 0}, 0, {1, 1}, 2));
  REQUIRE(found.paths.size() == 1);
  CHECK(std::abs(found.paths[0].action) <= found.paths[0].action_error);
  for (const std::size_t i : {0, 1})
    CHECK(found.paths[0].start_velocity[i] == doctest::Approx(1 / std::sin(2.0)).epsilon(1e-11));
}

TEST_CASE("what is narrower than the elements of a path is told by the motion from its states") {
  // A pulse in t alone leaves the straight line stationary, and adds w A √π to S; the barrier in x bends the path.
  for (const char* narrow : {"1e6*exp(-((t - 0.5137)*1e6)^2)", "1e4*exp(-((x - 0.5137)*1e4)^2)"}) {
    CAPTURE(narrow);
    const ModelText m(std::string("system n\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + ") + narrow + "\n");
    Diagnostics told;
    const auto found = stationary_paths(m.model, m.equations, fixed_ends({0}, 0, {1}, 1), {}, told);
    REQUIRE(found);
    REQUIRE(!found->paths.empty());
    REQUIRE(told.items().size() == 1);
    CHECK(told.items().front().code == "W1203");
    const StationaryPath& p = found->paths.front();
    const double right = narrow[2] == '6' ? 0.5 + std::sqrt(pi) : 0.5348097215;
    CHECK(std::abs(p.action - right) <= 1.01 * p.action_error);
    CHECK(p.second.index.has_value() == (narrow[2] == '6'));  // of the barrier the counts are of another curve
  }
}

TEST_CASE("the integral of L along the motion of a path is that of a pulse in time") {
  // ∫ L dt of the check sees the pulse whole.
  const ModelText m("system n\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + 1e6*exp(-((t - 0.5137)*1e6)^2)\n");
  Diagnostics told;
  const auto found = stationary_paths(m.model, m.equations, fixed_ends({0}, 0, {1}, 1), {}, told);
  REQUIRE(found);
  CHECK(found->paths.front().check.action == doctest::Approx(0.5 + std::sqrt(pi)).epsilon(1e-11));
}

TEST_CASE("layers at the ends of a path that is all but 0 between them") {
  const ModelText m("dimensionless\nparam ω = 100\ncoord x : number\nL = 1/2 x'^2 + 1/2 ω^2 x^2\n");
  for (const double to : {1.0, 0.0, -0.5}) {
    CAPTURE(to);
    const PathSearch found = paths_of(m, fixed_ends({1}, 0, {to}, 10));
    REQUIRE(found.paths.size() == 1);
    const StationaryPath& p = found.paths[0];
    CHECK(p.action == doctest::Approx(50 * (1 + to * to)).epsilon(1e-12));  // ½ ω (x₀² + x₁²), but for exp(−1000)
    CHECK(kind_of(p.second) == "minimum");
    CHECK(p.path.at(0.03).q[0] == doctest::Approx(std::exp(-3.0)).epsilon(1e-9));
    CHECK(p.start_momentum[0] == doctest::Approx(-100).epsilon(1e-9));
  }
}

TEST_CASE("a path so steep that its length hardly knows of its way") {
  const ModelText m("dimensionless\ncoord x : number\nL = sqrt(1 + x'^2)\n");
  for (const double far : {1e3, 1e5, 1e7, 1e9}) {
    CAPTURE(far);
    const PathSearch found = paths_of(m, fixed_ends({0}, 0, {far}, 1));
    REQUIRE(found.paths.size() == 1);
    CHECK(found.paths[0].action == doctest::Approx(std::hypot(1, far)).epsilon(1e-14));
    CHECK(found.paths[0].path.at(0.3).q[0] == doctest::Approx(0.3 * far).epsilon(1e-9));
    CHECK(found.paths[0].check.missed < 1e-9);
  }
  const ModelText beside("dimensionless\ncoord x, y : number\nL = sqrt(1 + x'^2 + y'^2)\n");
  const PathSearch found = paths_of(beside, fixed_ends({0, 0}, 0, {1e8, 1}, 1));
  REQUIRE(!found.paths.empty());
  CHECK(found.paths[0].action == doctest::Approx(1e8).epsilon(1e-14));
  CHECK(found.paths[0].path.at(0.3).q[1] == doctest::Approx(0.3).epsilon(1e-9));
}

TEST_CASE("no path is stationary where p is the same along all of them, and its end is free") {
  ActionEnds ends = fixed_ends({1, 0}, 0, {2, 0}, 1);
  ends.to[1].reset();
  const ModelText linear("dimensionless\nparam b = 3\ncoord x, q : number\nL = 1/2 x'^2 + b t q' + b q\n");
  Diagnostics diagnostics;
  CHECK_FALSE(stationary_paths(linear.model, linear.equations, ends, {}, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items().front().code == "E1204");
  CHECK(diagnostics.items().front().message.find("q is free at the end, and ∂L/∂q' = 3") != std::string::npos);
  // With a velocity in p there is one: p = x' + 3 = 0.
  const ModelText drift("dimensionless\ncoord x : number\nL = 1/2 x'^2 + 3 x'\n");
  ActionEnds open = fixed_ends({1}, 0, {0}, 2);
  open.to[0].reset();
  const PathSearch found = paths_of(drift, open);
  REQUIRE(found.paths.size() == 1);
  CHECK(found.paths[0].action == doctest::Approx(-9).epsilon(1e-12));
}

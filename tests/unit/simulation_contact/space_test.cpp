// Friction in the plane of a contact in space: closed forms, a second integrator, the cones' own conditions.
#include "linear_algebra/resting_forces.hpp"
#include "simulation/contact/cone_forces.hpp"
#include "simulation/contact/impact.hpp"
#include "simulation/contact/space_impulse.hpp"

#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <random>

using namespace maupertuis;

namespace {

std::string block(const std::string& mu, const std::string& start) {
  return "param m = 1 kg, g = 10 m/s^2, α = 0.5 rad\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
         "V = m g (z cos α - x sin α)\ncontact z >= 0 friction " +
         mu + " slip (x', y') name plane\n" + start + "\n";
}

const double downhill = 10 * std::sin(0.5), pressing = 10 * std::cos(0.5);

}  // namespace

TEST_CASE("a block pushed sideways on an incline with μ = tan α ends downhill, with half its speed") {
  // |v| + v_x keeps its value: friction and gravity have the same size.
  const auto r = run_text(block("tan α", "start y' = 2 m/s"), 60);
  CHECK(r.final.v[0] == doctest::Approx(1).epsilon(1e-13));
  CHECK(std::abs(r.final.v[1]) < 1e-13);
  CHECK(r.books->friction == doctest::Approx(0.5 * (4 - 1) + downhill * r.final.q[0]).epsilon(1e-12));
}

TEST_CASE("the plane of contact has two directions, also where points are in space") {
  const auto r = run_text(
      "param m = 1 kg, g = 10 m/s^2\ncoord x, y, z : length\npoint P mass m at (x, y, z)\ngravity (0, 0, -g)\n"
      "contact z >= 0 friction 0.3 slip (x', y') name floor\nstart x' = 3 m/s, y' = 4 m/s\n",
      1);
  CHECK(r.final.v[0] == doctest::Approx(3 - 0.6 * 3).epsilon(1e-12));
  CHECK(r.final.v[1] == doctest::Approx(4 - 0.8 * 3).epsilon(1e-12));
}

TEST_CASE("a block let go on an incline sticks or slides down, from rest and to the last digits") {
  CHECK(run_text(block("1.001 tan α", "start x = 0 m"), 5).first_mode == "plane sticking");
  const auto r = run_text(block("0.3", "start x = 0 m"), 1);
  CHECK(r.first_mode == "plane sliding");
  CHECK(r.final.q[0] == doctest::Approx(0.5 * (downhill - 0.3 * pressing)).epsilon(1e-13));
  CHECK(r.final.v[0] == doctest::Approx(downhill - 0.3 * pressing).epsilon(1e-13));
}

TEST_CASE(
    "a force that grows breaks a block away in its direction, with a slip that begins with the second power of time") {
  for (const char* end : {"1.4", "3", "10"}) {
    const auto r = run_text(
        "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y, z : length\npoint P mass m at (x, y, z)\ngravity (0, 0, -g)\n"
        "force on P = (2 [N/s] t, 1 [N/s] t, 0)\ncontact z >= 0 friction 0.3 slip (x', y') name floor\n",
        std::stod(end));
    const double from = 0.3 * 9.81 / std::sqrt(5.0), left = std::stod(end) - from;
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].t == doctest::Approx(from).epsilon(1e-14));
    CHECK(r.final.q[0] == doctest::Approx(std::pow(left, 3) / 3).epsilon(1e-11));
    CHECK(r.final.q[1] == doctest::Approx(std::pow(left, 3) / 6).epsilon(1e-11));
  }
}

TEST_CASE("a puck on a plate that is shaken in one direction moves in space as in the plane") {
  for (const char* u : {"0.25", "0.26", "0.3"}) {
    const auto with = [&](const std::string& slip) {
      return run_text("param m = 1 kg, g = 9.81 m/s^2, w = 12 rad/s, u = " + std::string(u) +
                          " m/s\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = m g z\n"
                          "contact z >= 0 friction 0.3 slip " +
                          slip + " name plate\n",
                      3);
    };
    const auto in_space = with("(x' - u cos(w t), y')"), in_plane = with("x' - u cos(w t)");
    CHECK(in_space.final.q[0] == doctest::Approx(in_plane.final.q[0]).epsilon(1e-10));
    CHECK(in_space.final.v[0] == doctest::Approx(in_plane.final.v[0]).epsilon(1e-9));
    CHECK(std::abs(in_space.final.q[1]) < 1e-12);
    CHECK(in_space.happenings.size() == in_plane.happenings.size());
  }
}

TEST_CASE("a puck on a plate that is shaken in two directions turns as it begins to slide") {
  const std::string puck =
      "param m = 1 kg, g = 9.81 m/s^2, w = 12 rad/s, u = 0.2 m/s\ncoord x, y, z : length\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2)\nV = m g z\n"
      "contact z >= 0 friction 0.3 slip (x' - u cos(w t), y' - 0.5 u sin(2 w t)) name plate\n";
  const auto with_order = [&](int order) {
    ModelText m(puck);
    SimulationOptions options;
    options.duration = 3;
    options.order = order;
    options.errors = ErrorEstimates::None;
    auto result = simulate(m.model, m.equations, options, m.diagnostics);
    REQUIRE(result);
    return std::move(*result);
  };
  const auto r = with_order(20), other = with_order(28);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(r.final.q[i] == doctest::Approx(other.final.q[i]).epsilon(1e-12));
    CHECK(r.final.v[i] == doctest::Approx(other.final.v[i]).epsilon(1e-12));
  }
  // v_t/√(v_t² + ε²) for v_t/|v_t|, by Runge and Kutta's formula at ε = 4e-5, 2e-5, 1e-5 m/s, extrapolated
  CHECK(r.final.q[0] == doctest::Approx(-0.021996).epsilon(1e-4));
  CHECK(r.final.q[1] == doctest::Approx(0.011741).epsilon(3e-4));
  CHECK(r.statistics.steps < 3000);
  CHECK(r.statistics.energy_drift < 1e-11);
}

TEST_CASE("a body on three rough feet stops and rests, with forces that carry it") {
  const std::string body =
      "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, h = 0.3 m, J = 0.1 kg m^2\ncoord x, y, z : length, u, v, w : angle\n"
      "body B mass m inertia diag(J, J, J) at (x, y, z) rotation rpy (u, v, w)\ngravity (0, 0, -g)\n"
      "point P1 at (a, 0.1*a, -h) in B\npoint P2 at (-a, -0.9*a, -h) in B\npoint P3 at (-0.8*a, a, -h) in B\n"
      "contact P1.z >= 0 friction 0.3 slip (P1.x', P1.y') name l1\n"
      "contact P2.z >= 0 friction 0.3 slip (P2.x', P2.y') name l2\n"
      "contact P3.z >= 0 friction 0.3 slip (P3.x', P3.y') name l3\nstart z = h";
  for (const char* end : {"0.5", "100"}) {
    const auto stops = run_text(body + ", x' = 0.1 m/s\n", std::stod(end));
    REQUIRE(stops.happenings.size() == 3);
    CHECK(stops.happenings[0].t == doctest::Approx(0.1 / (0.3 * 9.81)).epsilon(1e-6));
    CHECK(stops.final.q[0] == doctest::Approx(0.01 / (2 * 0.3 * 9.81)).epsilon(1e-13));
    const auto rests = run_text(body + "\n", std::stod(end));
    CHECK(rests.first_mode == "l1 sticking, l2 sticking, l3 sticking");
    CHECK(rests.happenings.empty());
    for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(rests.final.q[i] - (i == 2 ? 0.3 : 0)) < 1e-15);
  }
}

TEST_CASE("a bar on two rough feet gives way where its friction is determined, though along the bar it is not") {
  const auto bar = [](const std::string& forces, double end) {
    return run_text(
        "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, J = 0.1 kg m^2, k = 1 N/s\ncoord x, y, z : length, v, w : angle\n"
        "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (v'^2 + w'^2)\nV = m g z\n" +
            forces +
            "contact z - a v >= 0 friction 0.3 slip (x', y' + a w') name l1\n"
            "contact z + a v >= 0 friction 0.3 slip (x', y' - a w') name l2\n",
        end);
  };
  const auto pushed = bar("force y = k t\n", 4), turned = bar("force w = k t 1[m]\n", 4);
  CHECK(pushed.happenings[0].t == doctest::Approx(0.3 * 9.81).epsilon(1e-12));
  CHECK(pushed.final.q[1] == doctest::Approx(std::pow(4 - 0.3 * 9.81, 3) / 6).epsilon(1e-11));
  CHECK(turned.happenings[0].t == doctest::Approx(0.15 * 9.81).epsilon(1e-12));
  CHECK(turned.final.q[4] == doctest::Approx(std::pow(4 - 0.15 * 9.81, 3) / 0.6).epsilon(1e-10));
  const auto swings = bar("force w = 2 [N m] sin(t/1[s])\n", 1);
  CHECK(swings.happenings[0].t == doctest::Approx(std::asin(0.15 * 9.81 / 2)).epsilon(1e-12));
}

TEST_CASE("a bar that is turned and pushed gives way at one foot, then at the other") {
  // x, y, w at 4 s: by the implicit midpoint rule in steps of 1e-5 s with friction v_t/√(v_t² + ε²), ε → 0.
  const auto slides = [](const std::string& x, const std::string& y, const std::array<double, 3>& end) {
    CAPTURE(x);
    const auto r = run_text(
        "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, J = 0.1 kg m^2, k = 1 N/s\ncoord x, y, z : length, v, w : angle\n"
        "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (v'^2 + w'^2)\nV = m g z\nforce w = k t 1[m]\nforce x = " +
            x + " k t\nforce y = " + y +
            " k t\ncontact z - a v >= 0 friction 0.3 slip (x', y' + a w') name l1\n"
            "contact z + a v >= 0 friction 0.3 slip (x', y' - a w') name l2\n",
        4);
    for (const std::size_t i : {0, 1}) CHECK(r.final.q[i] == doctest::Approx(end[i]).epsilon(2e-5));
    CHECK(r.final.q[4] == doctest::Approx(end[2]).epsilon(2e-5));
    CHECK(r.statistics.energy_drift < 1e-14);
    return r.happenings[0].t;
  };
  CHECK(slides("0.001", "0", {0.00398530, 0, 26.94249}) == doctest::Approx(1.4715 / std::sqrt(1 + 0.25e-6)));
  CHECK(slides("0.1", "0", {0.398958, 0, 26.97415}) == doctest::Approx(1.4715 / std::sqrt(1.0025)));
  CHECK(slides("0", "0.3", {0, 2.283096, 27.17334}) == doctest::Approx(1.4715 / 1.15));
  CHECK(slides("0.1", "0.3", {0.391662, 2.277944, 27.20992}) == doctest::Approx(1.4715 / 1.15));
}

TEST_CASE("a bar gives way at one foot whose friction is determined, while forces along the bar are not") {
  // The foot at −b comes to its limit first: its friction is (a P + M(t))/(a + b) across the bar.
  const auto r = run_text(
      "param m = 1 kg, g = 9.81 m/s^2, a = 0.394 m, b = 0.362 m, J = 0.228 kg m^2\n"
      "coord x, y, z : length, v, w : angle\nT = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (v'^2 + w'^2)\nV = m g z\n"
      "force x = -0.1 [N/s] t\nforce y = -0.294 [N]\nforce w = 0.041 [N m] + 0.413 [N m/s] t\n"
      "contact z - a v >= 0 friction 0.365 slip (x', y' + a w') name l1\n"
      "contact z + b v >= 0 friction 0.365 slip (x', y' - b w') name l2\n",
      6);
  const double limit = 0.365 * 9.81 * 0.394 / 0.756;
  REQUIRE(r.happenings.size() >= 2);
  CHECK(r.happenings[0].name == "l2");
  CHECK(r.happenings[0].t == doctest::Approx((limit * 0.756 - 0.394 * 0.294 - 0.041) / 0.413).epsilon(1e-8));
  CHECK(r.statistics.energy_drift < 1e-14);
}

TEST_CASE("a slip that gives way to a force that grows stops though it was slow beyond measure when it began") {
  // Nothing turns the bar: it moves as a puck does.
  const std::string forces = "force x = 0.074 [N]\nforce y = 4.33 [N] sin(3 [rad/s] t)\n",
                    given = "param m = 1 kg, g = 9.81 m/s^2\n";
  const auto bar = run_text(given +
                                "param a = 0.4 m, b = 0.5 m, J = 0.2 kg m^2\ncoord x, y, z : length, v, w : angle\n"
                                "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (v'^2 + w'^2)\nV = m g z\n" +
                                forces +
                                "contact z - a v >= 0 friction 0.345 slip (x', y' + a w') name l1\n"
                                "contact z + b v >= 0 friction 0.345 slip (x', y' - b w') name l2\n",
                            3);
  const auto puck = run_text(given + "coord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = m g z\n" + forces +
                                 "contact z >= 0 friction 0.345 slip (x', y') name floor\n",
                             3);
  CHECK(puck.happenings.size() == 5);
  for (const std::size_t i : {0, 1}) CHECK(bar.final.q[i] == doctest::Approx(puck.final.q[i]).epsilon(1e-9));
  CHECK(bar.statistics.energy_drift < 1e-13);
}

TEST_CASE("forces of an undetermined rest are those of cones with a margin, and none beyond them") {
  ConeProblem p;  // a rod between two walls that face each other, pulled along them by F
  p.contacts = {{1, 0.5}, {1, 0.25}};
  p.response.resize(4, 4);
  p.response << 1, 0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 0, 0, 1, 0, 1;
  p.free = Eigen::VectorXd::Zero(4);
  p.free << 0, 1, 0, 1;
  const auto found = resting_forces(p);
  REQUIRE(found);
  CHECK((p.free + p.response * *found).cwiseAbs().maxCoeff() < 1e-13);
  for (const Eigen::Index n : {0, 2}) {
    const double most = (n == 0 ? 0.5 : 0.25) * (*found)(n);
    CHECK(std::abs((*found)(n + 1)) <= 0.9 * most);
  }
  p.contacts = {{1, 0.0}, {1, 0.0}};
  CHECK_FALSE(resting_forces(p));
}

TEST_CASE("a slip that turns until it stops: a block on an incline, a ball on it") {
  // Along and across the incline v = C tan(ψ/2)^k / sin ψ, k the ratio of friction to gravity and ψ the angle between
  // slip and gravity, which falls to 0; the integrals over ψ in 30 digits.
  const auto block_that_stops = [](const char* angle, const char* mu, const char* start) {
    return run_text(
        std::string("dimensionless\ncoord x, y, z : length\npoint P mass 1 at (x, y, z)\ngravity 9.81 (sin(") + angle +
            "), 0, -cos(" + angle + "))\ncontact z >= 0 friction " + mu + " slip (x', y') name floor\nstart " + start +
            "\n",
        4);
  };
  struct Stop {
    const char *angle, *mu, *start;
    double t, x, y;
  };
  for (const Stop& stop : {Stop{"0.1", "0.57", "x' = -0.94, y' = 0.31", 0.152898721470219560196634874427519,
                                -0.0710779941111942494950016879667445, 0.0254670719940671339711924642139481},
                           Stop{"0.2", "0.5", "x' = 0.2, y' = 1.1", 0.298504536831418450913920622889205,
                                0.0603799498565762140425897104220058, 0.138234164654131681470359035891325}}) {
    const auto r = block_that_stops(stop.angle, stop.mu, stop.start);
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].t == doctest::Approx(stop.t).epsilon(1e-11));
    CHECK(r.final.q[0] == doctest::Approx(stop.x).epsilon(1e-14));
    CHECK(r.final.q[1] == doctest::Approx(stop.y).epsilon(1e-14));
    for (const double v : r.final.v) CHECK(v == 0);
    CHECK(r.statistics.energy_drift < 1e-14);
  }
  // The slip of the ball is that of a block with 7/2 of the friction; y' − 2/5 R a' is conserved.
  const auto ball = run_text(
      "dimensionless\ncoord x, y, z : length\ncoord a, b : angle\n"
      "T = 1/2 (x'^2 + y'^2 + z'^2) + 1/5 * 0.15^2 (a'^2 + b'^2)\nV = -9.81 (sin(0.16) x - cos(0.16) z)\n"
      "contact z >= 0 friction 0.39 slip (x' - 0.15 b', y' + 0.15 a') name floor\n"
      "start x' = -0.63, y' = 0.35, a' = -1.62, b' = -0.36\n",
      2);
  REQUIRE(ball.happenings.size() == 1);
  CHECK(ball.happenings[0].t == doctest::Approx(0.0397209022927926549567705529859185).epsilon(1e-9));
  CHECK(ball.final.v[1] == doctest::Approx(5 / 7.0 * (0.35 + 0.4 * 0.15 * 1.62)).epsilon(1e-14));
  CHECK(ball.statistics.energy_drift < 1e-14);
}

TEST_CASE("what the end of a slip on a surface that moves does to the energy is in the books") {
  const auto r = run_text(
      "dimensionless\ncoord x, y, z : length\npoint P mass 1 at (x, y, z)\ngravity (0, 0, -10)\n"
      "contact z >= 0 friction 0.5 slip (x' - 1.3 sin(4 t), y') name table\nstart x' = -0.5, y' = -1.0\n",
      2);
  CHECK(std::count_if(r.happenings.begin(), r.happenings.end(),
                      [](const Happening& h) { return h.kind == Happening::Kind::Stick; }) == 3);
  CHECK(r.statistics.energy_drift < 1e-12);
}

TEST_CASE("a slip that stops while it goes straight is seen at any order, and beside any speed") {
  // Between two steps it would turn round: friction that jumps beside a closed contact was taken for a place that no
  // series has, and passed.
  const auto text = [](const std::string& slip) {
    return "dimensionless\ncoord x, y, z : length\npoint P mass 1 at (x, y, z)\ngravity (0, 0, -10)\n"
           "contact z >= 0 friction 0.5 slip " +
           slip + " name table\nstart x' = -0.5\n";
  };
  const auto in_plane = run_text(text("x' - 1.3 sin(4 t)"), 2);
  for (const int order : {16, 20, 22, 26, 30}) {
    ModelText m(text("(x' - 1.3 sin(4 t), y')"));
    SimulationOptions options;
    options.order = order;
    const auto r = run(m, 2, options);
    REQUIRE(r.ok());
    CHECK(r.statistics.steps < 1000);
    CHECK(r.final.q[0] == doctest::Approx(in_plane.final.q[0]).epsilon(1e-11));
    REQUIRE(r.happenings.size() == in_plane.happenings.size());
    for (std::size_t i = 0; i < r.happenings.size(); ++i)
      CHECK(r.happenings[i].t == doctest::Approx(in_plane.happenings[i].t).epsilon(1e-9));
  }
}

TEST_CASE("a block on a level floor stops after v²/(2 μ g), and stays") {
  const auto r = run_text(
      "param m = 1 kg, g = 10 m/s^2\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = m g z\n"
      "contact z >= 0 friction 0.3 static 0.4 slip (x', y') name floor\nstart x' = 3 m/s, y' = 4 m/s\n",
      1000);
  REQUIRE(r.happenings.size() == 1);
  CHECK(r.happenings[0].kind == Happening::Kind::Stick);
  CHECK(r.happenings[0].t == doctest::Approx(5 / 3.0).epsilon(1e-14));
  CHECK(r.final.q[0] == doctest::Approx(2.5).epsilon(1e-14));
  CHECK(r.final.q[1] == doctest::Approx(10 / 3.0).epsilon(1e-14));
  CHECK(r.final.v[0] == 0);
  CHECK(r.books->friction == doctest::Approx(12.5).epsilon(1e-13));
}

TEST_CASE(
    "a tripod that slides and turns: as a second integrator has it, and at rest with all its energy rubbed away") {
  std::string text =
      "param m = 1 kg, g = 10 m/s^2, μ = 0.2, J = 0.01 kg m^2, s = 0.1 m\ncoord x, y, z : length, φ, a, b : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (φ'^2 + a'^2 + b'^2)\nV = m g z\n";
  for (int k = 0; k < 3; ++k)
    text += fmt::format(
        "contact z + {:.15f} s a + {:.15f} s b >= 0 friction μ slip (x' - s φ' sin(φ + {:.15f}), y' + s φ' cos(φ + "
        "{:.15f})) name f{}\n",
        std::cos(2.0943951023931953 * k), std::sin(2.0943951023931953 * k), 2.0943951023931953 * k,
        2.0943951023931953 * k, k + 1);
  text += "start x' = 1 m/s, φ' = 5 rad/s\n";
  // A fourth-order Runge-Kutta method with steps of 1e-5 s, written apart from this program.
  const auto before = run_text(text, 0.3);
  CHECK(before.final.q[0] == doctest::Approx(0.21857624216959).epsilon(1e-11));
  CHECK(before.final.q[3] == doctest::Approx(1.19906739969567).epsilon(1e-11));
  CHECK(before.final.v[1] == doctest::Approx(-0.0115562536863).epsilon(1e-9));
  const auto r = run_text(text, 2);
  CHECK(r.books->friction == doctest::Approx(0.625).epsilon(1e-12));
  CHECK(r.statistics.energy_drift < 1e-12);
  for (const double v : r.final.v) CHECK(std::abs(v) < 1e-13);
  CHECK(r.happenings.back().mode == "f1 sticking, f2 sticking, f3 sticking");
}

TEST_CASE("a ball with spin bounces to a roll, by impacts with friction in space") {
  const auto r = run_text(
      "param m = 1 kg, R = 0.1 m, g = 10 m/s^2, μ = 0.2, J = 0.004 kg m^2\ncoord x, y, z : length, a, b : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (a'^2 + b'^2)\nV = m g z\n"
      "contact z >= R restitution 0.6 friction μ slip (x' - R b', y' + R a') name floor\n"
      "start x' = 1 m/s, y' = 2 m/s, z = 0.5 m, a' = 30 rad/s, b' = -20 rad/s\n",
      4);
  // What friction cannot change, m x' + J b'/R and m y' − J a'/R, with the slip 0.
  CHECK(r.final.v[0] == doctest::Approx((1 - 0.8) / 1.4).epsilon(1e-10));
  CHECK(r.final.v[1] == doctest::Approx((2 - 1.2) / 1.4).epsilon(1e-10));
  // The first impact slides through: Λ = (1 + e) m √(2 g h), friction μ Λ against a slip of (3, 5).
  REQUIRE(r.happenings[0].kind == Happening::Kind::Impact);
  const double impulse = 1.6 * std::sqrt(8.0);
  CHECK(r.happenings[0].impulse == doctest::Approx(impulse).epsilon(1e-12));
  CHECK(r.happenings[0].v[0] == doctest::Approx(1 - 0.2 * impulse * 3 / std::sqrt(34.0)).epsilon(1e-12));
  CHECK(r.happenings[0].v[1] == doctest::Approx(2 - 0.2 * impulse * 5 / std::sqrt(34.0)).epsilon(1e-12));
}

TEST_CASE("an impulse in space is that of the plane where nothing leaves the plane, and never adds energy") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int turn = 0; turn < 60; ++turn) {
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = number(random);
    SpaceImpact impact;
    impact.response = root * root.transpose() + 0.2 * Eigen::Matrix3d::Identity();
    impact.velocity = {-1 - std::abs(number(random)), number(random), number(random)};
    impact.friction = impact.static_friction = 0.1 + 0.4 * std::abs(number(random));
    impact.restitution = std::abs(number(random));
    const Eigen::Vector3d p = impulse_in_space(impact), after = impact.velocity + impact.response * p;
    CHECK(p(0) > 0);
    CHECK(after(0) >= -1e-12);
    CHECK(0.5 * p.dot(impact.velocity + after) <= 1e-12);
    CHECK(p.tail<2>().norm() <= impact.friction * p(0) * (1 + 1e-9));
    // In a plane.
    impact.response.row(2).head<2>().setZero();
    impact.response.col(2).head<2>().setZero();
    impact.velocity(2) = 0;
    const Eigen::Vector3d flat = impulse_in_space(impact);
    const PlaneImpulse plane =
        frictional_impulse(impact.response(0, 0), impact.response(0, 1), impact.response(1, 1), impact.velocity(0),
                           impact.velocity(1), impact.friction, impact.static_friction, false, impact.restitution);
    CHECK(flat(0) == doctest::Approx(plane.normal).epsilon(1e-9));
    CHECK(flat(1) == doctest::Approx(plane.tangential).epsilon(1e-9));
    CHECK(std::abs(flat(2)) < 1e-12);
  }
}

TEST_CASE("a slip that friction hardly fails to hold in an impact leaves 0 along the friction that it feels") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  for (const double share : {0.999, 0.9, 0.3}) {  // of the coefficient that would hold it
    for (int turn = 0; turn < 20; ++turn) {
      Eigen::Matrix3d root;
      for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = number(random);
      SpaceImpact impact;
      impact.response = root * root.transpose() + 0.5 * Eigen::Matrix3d::Identity();
      impact.velocity = {-1, 0, 0};
      const Eigen::Vector2d hold =
          impact.response.block<2, 2>(1, 1).fullPivLu().solve(impact.response.block<2, 1>(1, 0));
      impact.friction = impact.static_friction = share * hold.norm();
      impact.restitution = 0.5;
      const Eigen::Vector3d p = impulse_in_space(impact), after = impact.velocity + impact.response * p;
      const Eigen::Vector2d friction = p.tail<2>(), slip = after.tail<2>();
      CHECK(friction.norm() == doctest::Approx(impact.friction * p(0)).epsilon(1e-10));
      CHECK(slip.dot(friction) == doctest::Approx(-slip.norm() * friction.norm()).epsilon(1e-10));
    }
  }
}

TEST_CASE("forces in cones keep Coulomb's law, redundant contacts too") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int turn = 0; turn < 60; ++turn) {
    const int contacts = 1 + turn % 6, n = turn % 2 == 0 ? 18 : 6;
    Eigen::MatrixXd rows(3 * contacts, n);
    for (Eigen::Index i = 0; i < rows.size(); ++i) rows(i) = number(random);
    ConeProblem p;
    p.contacts.assign(static_cast<std::size_t>(contacts), {2, 0.2});
    p.response = rows * rows.transpose();
    Eigen::VectorXd pull(n);
    for (Eigen::Index i = 0; i < n; ++i) pull(i) = number(random);
    p.free = rows * pull;
    const auto found = cone_forces(p);
    REQUIRE(found);
    for (int c = 0; c < contacts; ++c) {
      const Eigen::Vector3d force = found->forces.segment<3>(3 * c), a = found->accelerations.segment<3>(3 * c);
      const double size = found->forces.cwiseAbs().maxCoeff() + 1;
      CHECK(force(0) >= -1e-9 * size);
      CHECK(a(0) >= -1e-8 * size);
      CHECK(std::abs(force(0) * a(0)) < 1e-7 * size * size);
      CHECK(force.tail<2>().norm() <= 0.2 * force(0) + 1e-8 * size);
      if (a.tail<2>().norm() > 1e-6 && force(0) > 1e-6) {
        const Eigen::Vector2d against = -0.2 * force(0) * a.tail<2>().normalized();
        CHECK((force.tail<2>() - against).norm() < 1e-5 * size);
      }
    }
  }
}

TEST_CASE("a table on four feet slides, turns and stops: friction takes all its energy") {
  const auto table = [](const std::string& tilt, const std::string& start) {
    std::string text =
        "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, J = 0.1 kg m^2\ncoord x, y, z : length, ψ, α, β : angle\n"
        "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (ψ'^2 + α'^2 + β'^2)\nV = m g (z + 0.3 * " +
        tilt + " sin α)\n";
    const char* const signs[4][2] = {{"+", "+"}, {"-", "+"}, {"-", "-"}, {"+", "-"}};
    for (const auto& [s, c] : signs)
      text += fmt::format(
          "contact z {0} a sin α {1} a sin β >= 0 friction 0.3 slip (x' + {2} β' - a ({3} sin ψ {1} cos ψ) ψ', "
          "y' + {2} α' + a ({3} cos ψ - ({4} sin ψ)) ψ')\n",
          s, c, tilt, *s == '-' ? "-" : "", *c == '-' ? "-" : "");
    return text + "start " + start + "\n";
  };
  const auto level = run_text(table("0 [m]", "x' = 1 m/s, y' = 0.3 m/s, ψ' = 3 rad/s"), 1);
  CHECK(level.books->friction == doctest::Approx(0.5 * 1.09 + 0.05 * 9).epsilon(1e-12));
  for (const double v : level.final.v) CHECK(std::abs(v) < 1e-12);
}

TEST_CASE("a slip in space stops by its own sizes, whatever flies past at a million times its speed") {
  const auto end = [](const std::string& speed) {
    const auto r = run_text(
        "param m = 1 kg, g = 9.81 m/s^2, k = 40 N/m, v = 0.1 m/s, w = 1.3 rad/s, A = 0.1 m\n"
        "coord q, x, y, z : length\npoint P mass m at (x, y, z)\nT += 1/2 m q'^2\ngravity (0, 0, -g)\n"
        "force on P = (k (v t - x), k (A sin(w t) - y), 0)\n"
        "contact z >= 0 friction 0.3 static 0.5 slip (x', y', 0) name plate\nstart q' = " +
            speed + "\n",
        10);
    return r.final.q[1];
  };
  const double alone = end("0 m/s");
  CHECK(std::abs(end("1e4 m/s") - alone) < 1e-14);
  CHECK(std::abs(end("1e6 m/s") - alone) < 1e-14);
}

TEST_CASE(
    "what friction holds at height 0 under loads that grow is known to be at rest, and its energy does not drift") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, J = 0.1 kg m^2, k = 1 N/s\ncoord x, y, z : length, u, v, w : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (u'^2 + v'^2 + w'^2)\nV = m g z\nforce x = 0.2 k t\n"
      "force w = 0.1 k t 1[m]\ncontact z - a v >= 0 friction 0.3 slip (x', y' + a w') name l1\n"
      "contact z + a/2 v - a*sqrt(3)/2 u >= 0 friction 0.3 slip (x' + a*sqrt(3)/2 w', y' - a/2 w') name l2\n"
      "contact z + a/2 v + a*sqrt(3)/2 u >= 0 friction 0.3 slip (x' - a*sqrt(3)/2 w', y' - a/2 w') name l3\n");
  SimulationOptions options;
  options.duration = 5;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  REQUIRE(r->ok());
  CHECK(r->happenings.empty());
  CHECK(r->statistics.energy_drift < 1e-14);
  CHECK_FALSE(r->uncertain.everything);
  CHECK(r->uncertain.columns.empty());
  REQUIRE(r->final.errors);
  for (const auto* errors : {&r->final.errors->q, &r->final.errors->v})
    for (const double error : *errors) CHECK(error < 1e-14);
}

TEST_CASE("what sticks under a force that swings is known to be at rest, though all that is seen of it is rounding") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, J = 0.1 kg m^2\ncoord x, y, z : length, u, v, w : angle\n"
      "T = 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 J (u'^2 + v'^2 + w'^2)\nV = m g z\nforce y = 1 [N] sin(t/1[s])\n"
      "contact z - a v >= 0 slip (x', y' + a w') sticking name l1\n"
      "contact z + a/2 v - a*sqrt(3)/2 u >= 0 slip (x' + a*sqrt(3)/2 w', y' - a/2 w') sticking name l2\n"
      "contact z + a/2 v + a*sqrt(3)/2 u >= 0 slip (x' - a*sqrt(3)/2 w', y' - a/2 w') sticking name l3\n");
  SimulationOptions options;
  options.duration = 3;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  REQUIRE(r->ok());
  CHECK(r->uncertain.columns.empty());
  CHECK(std::abs(r->final.q[1]) < 1e-14);
  CHECK(r->statistics.energy_drift < 1e-10);  // of an energy that is nothing but rounding
}

TEST_CASE("a block whose friction barely stops it stops at v (k + cos θ)/(g sin α (k² − 1))") {
  // μ = k tan α, θ between the slip and downhill at the beginning; 9000 steps, which shrink with the slip.
  const double alpha = 0.3, k = 1.0003, vx = 0.5, vy = 0.3, downhill = 0.4;
  ModelText m(
      "dimensionless\ncoord x, y, z : length\npoint P mass 1.3 at (x, y, z)\n"
      "gravity 9.81 (sin(0.3)*cos(0.4), sin(0.3)*sin(0.4), -cos(0.3))\n"
      "contact z >= 0 friction 1.0003*tan(0.3) slip (x', y') name plane\nstart x' = 0.5, y' = 0.3\n");
  const auto r = run(m, 1e4);
  INFO(r.reason);
  REQUIRE(r.ok());
  REQUIRE(r.happenings.size() == 1);
  const double v = std::hypot(vx, vy), cosine = (vx * std::cos(downhill) + vy * std::sin(downhill)) / v;
  CHECK(r.happenings[0].t == doctest::Approx(v * (k + cosine) / (9.81 * std::sin(alpha) * (k * k - 1))).epsilon(1e-11));
}

TEST_CASE("bodies on three feet slide, turn and stop at any order: all feet at once, or one before the others") {
  struct Body {
    const char *inertia, *tilt, *depth, *feet[3], *friction, *start;
  };
  const Body bodies[] = {{"0.109",
                          "0.011",
                          "0.124",
                          {"0.412, 0.031", "-0.130, 0.552", "-0.277, -0.351"},
                          "0.381",
                          "x' = 0.991, y' = -0.059, w' = 2.692"},
                         {"0.163",
                          "0",
                          "0.162",
                          {"0.501, -0.010", "-0.238, 0.366", "-0.260, -0.457"},
                          "0.477",
                          "x' = 0.586, y' = -0.812, w' = -1.573"}};
  for (const Body& b : bodies) {
    std::string text = fmt::format(
        "dimensionless\ncoord x, y, z : length, u, v, w : angle\nbody B mass 1 inertia diag({0}, {0}, {0}) at (x, y, "
        "z) "
        "rotation rpy (u, v, w)\ngravity 9.81 (sin({1}), 0, -cos({1}))\nstart z = {2}, {3}\n",
        b.inertia, b.tilt, b.depth, b.start);
    for (int i = 0; i < 3; ++i)
      text += fmt::format("point P{0} at ({1}, -{2}) in B\ncontact P{0}.z >= 0 friction {3} slip (P{0}.x', P{0}.y')\n",
                          i, b.feet[i], b.depth, b.friction);
    ModelText m(text);
    const auto with_order = [&](int order) {
      SimulationOptions options;
      options.order = order;
      return run(m, 2, options);
    };
    const auto usual = with_order(20);
    REQUIRE(usual.ok());
    for (const int order : {24, 28, 34}) {
      const auto r = with_order(order);
      CAPTURE(order);
      INFO(r.reason);
      REQUIRE(r.ok());
      CHECK(r.happenings.size() == 3);
      for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(r.final.q[i] - usual.final.q[i]) < 1e-13);
      for (const double v : r.final.v) CHECK(v == 0);
    }
  }
}

TEST_CASE("a table on four legs rests on a plane that tilts until tan w t = μ, and slides straight on") {
  const std::string table =
      "param m = 10 kg, g = 9.81 m/s^2, w = 0.2 rad/s\ncoord x, y, z : length, α, β, γ : angle\n"
      "body K mass m inertia diag(1, 1, 1.5) kg m^2 at (x, y, z) rotation rpy (α, β, γ)\n"
      "point p1 at (0.5 m, 0.4 m, -0.2 m) in K\npoint p2 at (-0.5 m, 0.4 m, -0.2 m) in K\n"
      "point p3 at (-0.5 m, -0.4 m, -0.2 m) in K\npoint p4 at (0.5 m, -0.4 m, -0.2 m) in K\n"
      "gravity (g sin(w t), 0, -g cos(w t))\n"
      "contact p1.z >= 0 friction 0.3 slip (p1.x', p1.y') name c1\n"
      "contact p2.z >= 0 friction 0.3 slip (p2.x', p2.y') name c2\n"
      "contact p3.z >= 0 friction 0.3 slip (p3.x', p3.y') name c3\n"
      "contact p4.z >= 0 friction 0.3 slip (p4.x', p4.y') name c4\nstart z = 0.2 m\n";
  const double begins = std::atan(0.3) / 0.2;
  const auto rests = run_text(table, 1.4);
  CHECK(rests.happenings.empty());
  CHECK(rests.final.q[0] == 0);
  for (const double end : {1.47, 2.0}) {
    const auto r = run_text(table, end);
    REQUIRE(!r.happenings.empty());
    for (const Happening& h : r.happenings) {
      CHECK(std::abs(h.t - begins) <= h.error);
      CHECK(h.error < 1e-9);
    }
    CHECK(r.statistics.steps < 5000);
    // x'' = g (sin w t − μ cos w t)
    const double a = 0.2 * begins, b = 0.2 * end;
    CHECK(r.final.v[0] ==
          doctest::Approx(9.81 / 0.2 * (std::cos(a) - std::cos(b) - 0.3 * (std::sin(b) - std::sin(a)))).epsilon(1e-9));
    CHECK(std::abs(r.final.v[1]) < 1e-12);
    CHECK(std::abs(r.final.q[5]) < 1e-12);
  }
}

TEST_CASE("a stool that is pulled at a foot slides and turns on, one foot a thousand times slower than the others") {
  // Companions of such a run took the slow slip that had just begun for one that stops.
  std::vector<SimulationResult> runs;
  for (const int order : {20, 23}) {
    ModelText m(
        "param m = 3 kg, g = 9.81 m/s^2, μ = 0.3, a = 0.39999999999999997 m, h = 0.3 m, Ix = 0.1 kg m^2\n"
        "param Iz = 0.15 kg m^2\ncoord x, y, z : length\n"
        "body B mass m inertia diag(Ix, Ix, Iz) at (x, y, z) rotation quaternion\ngravity (0, 0, -g)\n"
        "point F0 in B at (1.000000 a, 0.000000 a, -h)\ncontact F0.z >= 0 friction μ slip (F0.x', F0.y') name f0\n"
        "point F1 in B at (-0.500000 a, 0.866025 a, -h)\ncontact F1.z >= 0 friction μ slip (F1.x', F1.y') name f1\n"
        "point F2 in B at (-0.500000 a, -0.866025 a, -h)\ncontact F2.z >= 0 friction μ slip (F2.x', F2.y') name f2\n"
        "force on F1 = (2 [N/s] t, 1 [N/s] t, 0)\nstart z = h\n");
    SimulationOptions options;
    options.order = order;
    runs.push_back(run(m, 2.8, options));
    INFO(runs.back().reason);
    REQUIRE(runs.back().ok());
    CHECK(count(runs.back(), Happening::Kind::Slip) == 3);
  }
  for (std::size_t i = 0; i < 2; ++i) CHECK(runs[0].final.v[i] == doctest::Approx(runs[1].final.v[i]).epsilon(1e-7));
}

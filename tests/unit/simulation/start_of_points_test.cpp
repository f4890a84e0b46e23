// Starts that give points: inverse kinematics with known answers, and where there is none.
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <cmath>

using namespace maupertuis;

namespace {

constexpr double pi = 3.14159265358979323846;

const char* arm =
    "system arm\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord a, b : angle\n"
    "point elbow mass m at l (cos a, sin a)\npoint hand mass m at elbow + l (cos b, sin b)\ngravity (0, -g)\n";

std::optional<ConsistentStart> start_of(ModelText& m) { return consistent_start(m.model, m.equations, m.diagnostics); }

MotionState state_of(ModelText& m) {
  const auto start = start_of(m);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(start);
  return start->state;
}

}  // namespace

TEST_CASE("an arm of two links reaches a point: the elbow is where two circles meet, the rates are those of J") {
  // (1.2, 0.5) is 1.3 away, so that the links make ±acos(0.65) with the line to it.
  ModelText m(std::string(arm) + "start hand = (1.2, 0.5) m, hand' = (0.3, -0.4) m/s\n");
  const MotionState s = state_of(m);
  const double line = std::atan2(0.5, 1.2), half = std::acos(0.65);
  const bool up = std::sin(s.q[0] - line) > 0;
  CHECK(std::remainder(s.q[0] - (line + (up ? half : -half)), 2 * pi) == doctest::Approx(0).scale(1).epsilon(1e-13));
  CHECK(std::remainder(s.q[1] - (line - (up ? half : -half)), 2 * pi) == doctest::Approx(0).scale(1).epsilon(1e-13));
  const double a = s.q[0], b = s.q[1], det = std::sin(b - a);  // J = [−sin a, −sin b; cos a, cos b]
  CHECK(s.v[0] == doctest::Approx((0.3 * std::cos(b) - 0.4 * std::sin(b)) / det).epsilon(1e-12));
  CHECK(s.v[1] == doctest::Approx(-(0.3 * std::cos(a) - 0.4 * std::sin(a)) / det).epsilon(1e-12));
}

TEST_CASE("one coordinate that is written stays, the other follows from the point") {
  ModelText m(std::string(arm) + "start a = 30 deg, hand.y = 0.5 m, elbow.x' = -1 m/s\n");
  const MotionState s = state_of(m);
  CHECK(s.q[0] == doctest::Approx(pi / 6).epsilon(1e-15));
  CHECK(std::sin(s.q[1]) == doctest::Approx(0).scale(1).epsilon(1e-14));
  CHECK(s.v[0] == doctest::Approx(2).epsilon(1e-14));  // −sin 30° a' = −1
}

TEST_CASE("beside constraints: a rod in x and y whose other end is given") {
  ModelText m(
      "system rod\nparam m = 1 kg, l = 5 m, g = 9.81 m/s^2\ncoord x, y, X, Y : length\npoint A mass m at (x, y)\n"
      "point B mass m at (X, Y)\ngravity (0, -g)\nconstraint norm(A - B) = l name rod\n"
      "start x = 0, y = 0, B.x = 3 m, B.y' = 6 m/s, x' = 0, y' = 0\n");
  const MotionState s = state_of(m);
  CHECK(s.q[2] == doctest::Approx(3).epsilon(1e-14));
  CHECK(std::abs(s.q[3]) == doctest::Approx(4).epsilon(1e-14));
  CHECK(s.v[3] == doctest::Approx(6).epsilon(1e-14));
  CHECK(s.v[2] == doctest::Approx(-6 * s.q[3] / 3).epsilon(1e-13));
}

TEST_CASE("places at the time of the start; parts of a vector that nothing moves ask nothing") {
  ModelText m(
      "system cart\nparam m = 1 kg, v = 2 m/s\ncoord x : length\npoint P mass m at (x + v t, 0)\n"
      "start at 3 s, P = (7, 0) m, P.x' = 5 m/s\n");
  const MotionState s = state_of(m);
  CHECK(s.q[0] == doctest::Approx(1).epsilon(1e-15));
  CHECK(s.v[0] == doctest::Approx(3).epsilon(1e-15));
}

TEST_CASE("what no configuration and no velocity gives is named") {
  const auto code = [](const std::string& start) {
    ModelText m(std::string(arm) + start);
    CHECK(!start_of(m));
    const std::string text = render(m.diagnostics, m.source);
    return m.diagnostics.items().back().code + (text.find("the start of `hand") != std::string::npos ? " named" : "");
  };
  CHECK(code("start hand.x = 2.1 m\n") == "E0708 named");
  CHECK(code("start a = 0, b = 0, hand.x' = 1 m/s\n") == "E0709 named");  // stretched along x
  CHECK(code("start exactly a = 0, b = 0, hand.x = 1 m\n") == "E0707 named");
}

TEST_CASE("lengths that a point asks for are positive where they can be, and other ways to it are told") {
  for (const auto& [x, y] : {std::pair(-3, -4), std::pair(-3, 4), std::pair(3, -4), std::pair(-5, 0)}) {
    ModelText m("dimensionless\ncoord r : length, φ : angle\npoint P mass 1 at (r cos φ, r sin φ)\nstart P = (" +
                std::to_string(x) + ", " + std::to_string(y) + ")\n");
    const MotionState s = state_of(m);
    CHECK(s.q[0] == doctest::Approx(5).epsilon(1e-14));
    CHECK(std::cos(s.q[1]) == doctest::Approx(x / 5.0).epsilon(1e-13));
    CHECK(std::sin(s.q[1]) == doctest::Approx(y / 5.0).scale(1).epsilon(1e-13));
    CHECK(m.diagnostics.items().back().code == "N0701");
  }
  ModelText one("dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\nstart P = (-3, -4)\n");
  CHECK(state_of(one).q[0] == -3);
  CHECK(one.diagnostics.items().empty());
}

TEST_CASE("a place beyond a rod is told with the rod, each name once") {
  ModelText m(
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (x, y)\n"
      "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\nstart P = (3, 4) m\n");
  CHECK(!start_of(m));
  const std::string text = render(m.diagnostics, m.source);
  CHECK(m.diagnostics.items().back().code == "E0708");
  CHECK(text.find("no configuration satisfies rod and the start of `P`\n") != std::string::npos);
}

TEST_CASE("an angular velocity turns a body whose frame is away from its centre of mass, and nothing else") {
  const std::string body =
      "body B mass 1 kg inertia diag(1, 1, 1) kg m^2 at (1 m, 0, 0) in S\nstart S.ω = (0, 0, 3) rad/s\n";
  ModelText angles("coord x, y, z : length, a, b, c : angle\nframe S at (x, y, z) rotation rpy (a, b, c)\n" + body);
  CHECK(state_of(angles).v == std::vector<double>{0, 0, 0, 0, 0, 3});
  ModelText quaternion("coord x, y, z : length\nframe S at (x, y, z) rotation quaternion\n" + body);
  const MotionState s = state_of(quaternion);
  CHECK(std::vector<double>(s.v.begin(), s.v.begin() + 3) == std::vector<double>{0, 0, 0});
  ModelText plane(
      "coord x, y : length, θ : angle\nframe S at (x, y) rotation angle θ\nbody B mass 1 kg inertia 2 kg m^2 at (1 m, "
      "0) in "
      "S\nstart B.ω = 3 rad/s\n");
  const MotionState turning = state_of(plane);
  CHECK(turning.v[0] == 0);
  CHECK(turning.v[1] == 0);
  CHECK(turning.v[2] == doctest::Approx(3).epsilon(1e-15));
}

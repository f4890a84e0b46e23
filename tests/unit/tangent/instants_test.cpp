// Directions through impacts, changes of mode and events: against neighbours that are run themselves.
#include <maupertuis/motion_through_modes.hpp>

#include "support.hpp"

#include <cmath>

using namespace maupertuis;

namespace {

/// (q, q̇) after a motion through modes.
std::vector<double> end_of(const ModelText& m, const MotionState& start, double t) {
  MotionThroughModes motion(m.model, m.equations, {}, {});
  motion.start(start.t, start.q, start.v);
  while (motion.time() != t) {
    const Step step = motion.step(t);
    INFO(step.reason);
    REQUIRE(step.ending == StepEnding::None);
  }
  const MotionState s = motion.state();
  std::vector<double> out(s.q);
  out.insert(out.end(), s.v.begin(), s.v.end());
  return out;
}

/// Differences of the fourth order between neighbours along each direction.
std::vector<double> differences(const ModelText& m, const TangentPoint& start, double t, double h) {
  const std::size_t n = start.state.q.size();
  std::vector<double> out;
  for (std::size_t j = 0; j < start.columns(); ++j) {
    const auto at = [&](double by) {
      MotionState s = start.state;
      for (std::size_t i = 0; i < n; ++i) {
        s.q[i] += by * start.column(j)[i];
        s.v[i] += by * start.column(j)[n + i];
      }
      return end_of(m, s, t);
    };
    const auto a = at(h), b = at(-h), c = at(2 * h), d = at(-2 * h);
    for (std::size_t i = 0; i < 2 * n; ++i) out.push_back((8 * (a[i] - b[i]) - (c[i] - d[i])) / (12 * h));
  }
  return out;
}

/// All directions of the start, carried; compared with neighbours.
TangentPoint compare(const ModelText& m, double t, double within, double h = 1e-4) {
  TangentFlow flow(m.model, m.equations, {});
  const TangentPoint start = flow.all_directions(start_of(m));
  TangentPoint end = start;
  const auto stop = flow.advance(end, start.state.t + t);
  if (stop) FAIL(stop->reason);
  const auto other = differences(m, start, start.state.t + t, h);
  CHECK(relative_difference(end.directions, other) < within);
  return end;
}

/// Why directions end on the way.
TangentStop stop_of(const ModelText& m, double t) {
  TangentFlow flow(m.model, m.equations, {});
  TangentPoint point = flow.all_directions(start_of(m));
  const auto stop = flow.advance(point, t);
  REQUIRE(stop);
  return *stop;
}

const std::string rod =
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
    "T = 1/2 m (x'^2 + z'^2) + 1/24 m l^2 θ'^2\nV = m g z\n";

}  // namespace

TEST_CASE("neighbours of a ball that bounces twice: closed form") {
  ModelText m(
      "dimensionless\nparam g = 1, e = 0.5\ncoord z : number\nT = 1/2 z'^2\nV = g z\n"
      "contact z >= 0 restitution e name floor\nstart z = 0.5\n");
  // From z₀ with ż₀ = 0: t₁ = 1, then flights of 2 e, 2 e², …; at t = 2.25 it is on its way after the second impact.
  TangentFlow flow(m.model, m.equations, {});
  TangentPoint p = flow.all_directions(start_of(m));
  REQUIRE_FALSE(flow.advance(p, 2.25));
  // Impact k at t₁ (1 + 2 e + …), speed after it e^k √(2 g z₀): with s = √(2 z₀ + ż₀²) and t₁ = ż₀ + s,
  // z(t) = e² s τ − τ²/2, τ = t − ż₀ − s (1 + 2 e).
  const double e = 0.5, s = 1, tau = 2.25 - s * (1 + 2 * e);
  const double ds_dz = 1 / s, ds_dv = 0, dtau_dz = -ds_dz * (1 + 2 * e), dtau_dv = -1;
  CHECK(p.column(0)[0] == doctest::Approx(e * e * (ds_dz * tau + s * dtau_dz) - tau * dtau_dz).epsilon(1e-13));
  CHECK(p.column(0)[1] == doctest::Approx(e * e * ds_dz - dtau_dz).epsilon(1e-13));
  CHECK(p.column(1)[0] == doctest::Approx(e * e * (ds_dv * tau + s * dtau_dv) - tau * dtau_dv).epsilon(1e-13));
  CHECK(p.column(1)[1] == doctest::Approx(e * e * ds_dv - dtau_dv).epsilon(1e-13));
  CHECK(flow.log_volume_of_jumps().value() == doctest::Approx(4 * std::log(e)).epsilon(1e-14));
}

TEST_CASE("neighbours of impacts on curved walls that move") {
  ModelText m(
      "dimensionless\nparam R = 1, a = 0.1, w = 3\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 y\n"
      "contact R + a sin(w t) - sqrt(x^2 + y^2) >= 0 restitution 0.9 name wall\n"
      "start x = 0.2, y = 0.1, x' = 1.1, y' = 0.4\n");
  compare(m, 4, 2e-8, 1e-4);
}

TEST_CASE("neighbours of a rod that bounces with friction") {
  ModelText m(rod +
              "contact z - l/2 sin θ >= 0 restitution 0.5 friction 0.3 slip x' + l/2 sin θ θ' name left\n"
              "contact z + l/2 sin θ >= 0 restitution 0.5 friction 0.3 slip x' - l/2 sin θ θ' name right\n"
              "start z = 1 m, θ = 0.4 rad, x' = 2 m/s\n");
  compare(m, 0.7, 1e-8);
}

TEST_CASE("neighbours of a mass that depends on the place, and of a constraint, at impacts") {
  ModelText m(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord φ, ψ : angle, x : length\n"
      "point A mass m at (x + l sin φ, -l cos φ)\npoint B mass m at A + l (sin ψ, -cos ψ)\nT += 1/2 m x'^2\n"
      "gravity (0, -g)\ncontact B.x <= 0.5 m restitution 0.7 name wall\nconstraint x = 0.1 m\n"
      "start x = 0.1 m, φ = -0.6 rad, ψ = -0.9 rad\n");
  compare(m, 1.5, 1e-7);
}

TEST_CASE("neighbours where static friction gives way, and where a slip stops") {
  // Two blocks on a belt, tied by a spring: both stick, one slips, and so on.
  ModelText m(
      "dimensionless\nparam v = 0.2, μ = 0.3, μs = 0.5\ncoord x, y, z, u : number\n"
      "T = 1/2 (x'^2 + y'^2 + z'^2 + u'^2)\nV = 4 x^2/2 + 3 (x - y)^2/2 + 5 y^2/2 + z + u\n"
      "contact z >= 0 friction μ static μs slip x' - v name first\n"
      "contact u >= 0 friction μ static μs slip y' - v name second\n"
      "start x = 0.02, y = -0.01, x' = 0.35, y' = 0.05\n");
  const TangentPoint end = compare(m, 3.1, 1e-7);
  CHECK(end.columns() == 4);
}

TEST_CASE("neighbours where a contact opens, and where a ball that does not bounce comes to rest") {
  ModelText leaves(
      "dimensionless\nparam g = 1, R = 1\ncoord r, θ : number\nT = 1/2 (r'^2 + r^2 θ'^2)\nV = g r cos θ\n"
      "contact r >= R name sphere\nstart r = 1, θ = 0.1, θ' = 0.3\n");
  compare(leaves, 2, 1e-7);
  ModelText rests(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = z + 1/2 x^2\n"
      "contact z >= 0.3 x restitution 0 name floor\nstart z = 1, x' = 0.2\n");
  compare(rests, 2.5, 1e-8);
}

TEST_CASE("neighbours of an event that sets the state") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 x^2 + y^2\n"
      "event kick when x + 0.2 y = 0.3 rising : set x' = -0.8 x' + 0.1 y^2, y = y + 0.1 x'\n"
      "start x = -1, y = 0.5\n");
  compare(m, 5, 1e-8);
}

TEST_CASE("impacts that follow each other at one instant: the order is that of Newton's cradle") {
  ModelText m(
      "dimensionless\ncoord a, b, c : number\nT = 1/2 (a'^2 + b'^2 + c'^2)\n"
      "contact b - a >= 1 restitution 1 name ab\ncontact c - b >= 1 restitution 1 name bc\n"
      "start a = -1, b = 1, c = 2, a' = 1\n");
  TangentFlow flow(m.model, m.equations, {});
  TangentPoint p = flow.all_directions(start_of(m));
  REQUIRE_FALSE(flow.advance(p, 3));
  // Equal balls exchange what they are: what was a moves on as c, b waits where a stopped, c where b stopped.
  const std::vector<double> from_a{0, 0, 1, 0, 0, 0};
  for (std::size_t i = 0; i < 6; ++i) CHECK(p.column(0)[i] == doctest::Approx(from_a[i]).epsilon(1e-13));
  CHECK(p.column(3)[2] == doctest::Approx(3).epsilon(1e-13));
  CHECK(p.column(3)[5] == doctest::Approx(1).epsilon(1e-13));
}

TEST_CASE("a motion that only touches a contact has no derivative, nor one that hits a corner") {
  ModelText touches(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact x^2 + y^2 >= 1 restitution 1 name disk\nstart x = -3, y = 1, x' = 1\n");
  const TangentStop grazes = stop_of(touches, 5);
  CHECK(grazes.ending == StepEnding::None);
  CHECK(grazes.reason.find("t = 3:") != std::string::npos);
  CHECK(grazes.reason.find("touched") != std::string::npos);
  ModelText corner(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact y >= 0 restitution 1 name floor\ncontact 2 x + y >= 0 restitution 1 name side\n"
      "start x = 1, y = 1, x' = -1, y' = -1\n");
  const TangentStop hit = stop_of(corner, 3);
  CHECK(hit.reason.find("order") != std::string::npos);
}

TEST_CASE("a right corner is no obstacle: either order ends the same") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact y >= 0 restitution 0.5 name floor\ncontact x >= 0 restitution 1 name side\n"
      "start x = 1, y = 1, x' = -1, y' = -1\n");
  TangentFlow flow(m.model, m.equations, {});
  TangentPoint p = flow.all_directions(start_of(m));
  REQUIRE_FALSE(flow.advance(p, 3));
  CHECK(p.column(0)[0] == doctest::Approx(-1).epsilon(1e-14));
  CHECK(p.column(2)[0] == doctest::Approx(-3).epsilon(1e-14));
  CHECK(p.column(1)[1] == doctest::Approx(-0.5).epsilon(1e-14));
  CHECK(p.column(3)[1] == doctest::Approx(-1.5).epsilon(1e-14));
}

TEST_CASE("neighbours through the end of infinitely many bounces") {
  ModelText m(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = z + 1/2 x^2\n"
      "contact z >= 0.3 x restitution 0.5 name floor\nstart z = 1, x' = 0.2\n");
  TangentFlow flow(m.model, m.equations, {});
  const TangentPoint start = flow.all_directions(start_of(m));
  TangentPoint end = start;
  REQUIRE_FALSE(flow.advance(end, 5.5));
  CHECK(flow.fewest_directions() == 2);
  const double off = relative_difference(end.directions, differences(m, start, 5.5, 1e-4));
  CHECK(off < 1e-10);
  ModelText rubs(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = z + 1/2 x^2\n"
      "contact z >= 0.3 x restitution 0.5 friction 0.2 slip x' + 0.3 z' name floor\nstart z = 1, x' = 1.3\n");
  compare(rubs, 5.5, 1e-10);
}

TEST_CASE("a stepper that has been elsewhere gives the motion of a new one, to the bit") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = y\n"
      "contact y >= x^2 restitution 0.9 friction 0.1 slip x' name bowl\nstart x = 0.4, y = 1\n");
  MotionThroughModes used(m.model, m.equations, {}, {});
  const std::vector<MotionState> starts{{0, {0.4, 1}, {0, 0}}, {0, {-0.7, 2}, {0.3, 1}}, {0, {0.4, 1}, {0, 0}}};
  for (const MotionState& start : starts) {
    MotionThroughModes fresh(m.model, m.equations, {}, {});
    for (MotionThroughModes* motion : {&used, &fresh}) {
      motion->start(start.t, start.q, start.v);
      while (motion->time() != 9.0) REQUIRE(motion->step(9.0).ending == StepEnding::None);
    }
    CHECK(used.state().q == fresh.state().q);
    CHECK(used.state().v == fresh.state().v);
  }
}

TEST_CASE("a slip in space that begins or stops, and its impacts, are refused with their reason") {
  const std::string text =
      "dimensionless\ncoord x, y, z : number\nT = 1/2 (x'^2 + y'^2 + z'^2)\nV = 2 x^2 + y^2 + z\n"
      "contact z >= 0 friction 0.3 slip (x', y') name floor\n";
  CHECK(stop_of(ModelText(text + "start x = 1, y = 0.5\n"), 3).reason.find("begins at the start") != std::string::npos);
  CHECK(stop_of(ModelText(text + "start z = 1, x' = 1\n"), 3).reason.find("Friction in space") != std::string::npos);
}

TEST_CASE("a slip that begins at a start at rest has neighbours on both sides") {
  // m x'' = 5 N - 2 N for x' > 0, 5 N + 2 N for x' < 0: ∂x(1)/∂v₀ is 1 on one side and 3/7 on the other.
  const ModelText m(
      "system f\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\n"
      "gravity (0, -g)\nfriction x limit 2 N\nforce x = 5 N\nstart x = 0 m\n");
  TangentFlow flow(m.model, m.equations, {});
  TangentPoint at_rest{{0, {0}, {0}}, {0, 1}};
  const auto stop = flow.advance(at_rest, 1);
  REQUIRE(stop);
  CHECK(stop->t == 0);
  CHECK(stop->reason.find("begins to slide") != std::string::npos);
  TangentPoint moving{{0, {0}, {0.1}}, {0, 1}};
  REQUIRE_FALSE(flow.advance(moving, 1));
  CHECK(moving.column(0)[0] == doctest::Approx(1));
  TangentPoint back{{0, {0}, {-0.1}}, {0, 1}};  // slower by 7 m/s^2 to rest, then faster by 3 m/s^2
  REQUIRE_FALSE(flow.advance(back, 1));
  CHECK(back.column(0)[1] == doctest::Approx(3.0 / 7));
}

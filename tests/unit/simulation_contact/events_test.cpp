// Events on friction, and at a rate that no run can follow.
#include "run_text.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("the force of friction is an event's condition, of a contact and along a coordinate") {
  const auto contact = run_text(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\npoint P mass m at (x, z)\ngravity (0, -g)\n"
      "contact z >= 0 friction 0.3 slip x' name floor\nforce on P = (1.5 [N/s] t, 0)\n"
      "event half when friction(floor) = -2 [N] : record\n",
      3);
  REQUIRE(count(contact, Happening::Kind::Event, "half") == 1);
  CHECK(contact.happenings.front().t == doctest::Approx(4.0 / 3).epsilon(1e-15));
  const auto coordinate = run_text(
      "param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\nfriction x limit 2 [N]\n"
      "force x = 1.5 [N/s] t\nevent half when friction(x) + 1 [N] = 0 : record\n",
      1);
  REQUIRE(count(coordinate, Happening::Kind::Event, "half") == 1);
  CHECK(coordinate.happenings.front().t == doctest::Approx(2.0 / 3).epsilon(1e-15));
}

TEST_CASE("events at a steady rate that would be too many end the run when that is seen") {
  ModelText m(
      "param m = 1 kg, w = 1e9 rad/s\ncoord x : length\npoint P mass m at (x, 0)\n"
      "event s when sin(w t) = 0 : set x' = -x'\nstart x = 1 m, x' = 1 m/s\n");
  const auto r = run(m, 8);
  CHECK(r.ending == Ending::Unending);
  CHECK(r.reason.find("10000000 are followed at most") != std::string::npos);
  CHECK(r.happenings.size() < 50'000);
  // As many as are followed are no reason.
  const auto few = run_text(
      "param m = 1 kg, w = 1e5 rad/s\ncoord x : length\npoint P mass m at (x, 0)\n"
      "event s when sin(w t) = 0 : record\nstart x = 1 m, x' = 1 m/s\n",
      2);
  CHECK(few.happenings.size() > 60'000);
}

TEST_CASE("bounces are small beside those of their own series, not beside all before") {
  // Down at 2e6 m/s, thrown up, caught, and set down at rest at 1 m: from there on the bounces of a ball.
  const SimulationResult r = run_text(
      "param m = 1 kg, g = 10 m/s^2\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\n"
      "contact y >= 0 [m] restitution 0.9 name floor\n"
      "event caught when y = 1000 [m] rising : set y = 1 [m], y' = 0 [m/s]\nstart y = 1 m, y' = -2e6 m/s\n",
      4);
  const auto caught = std::find_if(r.happenings.begin(), r.happenings.end(),
                                   [](const Happening& h) { return h.kind == Happening::Kind::Event; });
  REQUIRE(caught != r.happenings.end());
  double t = caught->t + std::sqrt(0.2), speed = std::sqrt(20);
  while (t + 2 * 0.9 * speed / 10 < 4) speed *= 0.9, t += 2 * speed / 10;
  const double since = 4 - t, y = 0.9 * speed * since - 5 * since * since;
  CHECK(y > 0.2);
  CHECK(r.final.q[0] == doctest::Approx(y).epsilon(1e-10));
}

TEST_CASE("after drag has slowed a pellet its bounces are as visible as those of any other") {
  const SimulationResult r = run_text(
      "param m = 1 kg, g = 10 m/s^2, c = 1 kg/m\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\n"
      "contact y >= 0 [m] restitution 0.9 name floor\nforce y = -c y' abs(y')\nstart y = 1 mm, y' = -1e6 m/s\n",
      6.2);
  CHECK(count(r, Happening::Kind::Impact) >= 6);
  CHECK(r.final.q[0] > 1e-3);
}

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

// Runs through modes: closed forms, books of energy, and what has no motion.
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/simulation.hpp>

#include "run_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

using namespace maupertuis;

namespace {

const std::string rod =
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
    "T = 1/2 m (x'^2 + z'^2) + 1/24 m l^2 θ'^2\nV = m g z\n";

}  // namespace

TEST_CASE("impacts at once: a contact that is hit alone has its friction; one that is hit with others ends the run") {
  const std::string ball =
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact y >= 0 restitution 0.5 friction 0.3 slip x' name floor\nimpact simultaneous\n";
  ModelText alone(ball + "contact x <= 9 m name wall\nstart y = 1 m, x' = 3 m/s\n");
  const auto r = run(alone, 0.5);
  const double before = std::sqrt(2 * 9.81);
  CHECK(r.final.v[0] == doctest::Approx(3 - 0.3 * 1.5 * before));
  CHECK(r.books->impacts == doctest::Approx(4.5 + 9.81 - 0.5 * std::pow(r.final.v[0], 2) - 0.25 * 9.81));
  CHECK(r.statistics.energy_drift < 1e-13);
  ModelText corner(ball + "contact x <= 3 m restitution 0.5 name wall\nstart x' = 3 m/s, y' = 4.905 m/s\n");
  const auto refused = run(corner, 1.5);
  CHECK(refused.ending == Ending::Paradox);
  CHECK(refused.reason.find("floor with friction among them") != std::string::npos);
}

TEST_CASE("an event that sets a body above the floor on which it lies lets it fall") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact y >= 0 name floor\nevent up when x = 2 m : set y = 0.5 m\nstart x' = 1 m/s\n");
  const auto r = run(m, 2.2);
  CHECK(r.final.q[1] == doctest::Approx(0.5 - 0.5 * 9.81 * 0.04).epsilon(1e-12));
  CHECK(count(r, Happening::Kind::Lost, "floor") == 1);
  CHECK(r.statistics.energy_drift < 1e-13);
}

TEST_CASE("a constraint that drives a contact through zero leaves no motion") {
  ModelText m(
      "param m = 1 kg, A = 0.1 m, w = 3 rad/s\ncoord x : length\nT = 1/2 m x'^2\nconstraint x = A sin(w t) name drive\n"
      "contact x <= 0.05 m restitution 0.5 name stop\nstart x = 0\n");
  const auto r = run(m, 1);
  CHECK(r.ending == Ending::Paradox);
  CHECK(r.reason.find("move the contact stop through zero") != std::string::npos);
  CHECK(r.final.t == doctest::Approx(3.141592653589793 / 18));
  CHECK(std::isfinite(r.final.q[0]));
  CHECK(r.books->impacts == 0);
}

TEST_CASE("the clock keeps what located instants leave of t: a thousand bounces without loss") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\n"
      "contact y >= 0 restitution 1 name floor\nstart y = 1 m\n");
  CHECK(std::abs(run(m, 1000).final.q[0] - 0.47660702466227468009) < 2e-12);
  CHECK(std::abs(run(m, 20000).final.q[0] - 0.77986947055821752211) < 1e-10);
}

TEST_CASE("backwards in time there is no motion from a start that hits") {
  const std::string ball =
      "param m = 1 kg, g = 9.81 m/s^2\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\n"
      "contact y >= 0 restitution 1 name floor\n";
  ModelText hits(ball + "start y' = -2 m/s\n"), rises(ball + "start y = 1 m, y' = -2 m/s\n");
  const auto refused = run(hits, -0.1), fine = run(rises, -0.1);
  CHECK(refused.ending == Ending::Paradox);
  CHECK(refused.reason.find("a start at which a contact is hit") != std::string::npos);
  CHECK(fine.final.q[0] == doctest::Approx(1 + 0.2 - 0.5 * 9.81 * 0.01));
}

TEST_CASE("nothing is told to happen beyond the end of a run") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact y >= 0 restitution 0.5 friction 0.1 slip x' name floor\nstart y = 0.1 m, x' = 1 m/s\n");
  const double end = std::sqrt(0.2 / 9.81) * 3;  // of the bounces
  for (const auto& [duration, made] : {std::pair(end * (1 - 1e-7), 0), std::pair(end * (1 + 1e-7), 1)}) {
    const auto r = run(m, duration);
    CHECK(count(r, Happening::Kind::Made) == static_cast<std::size_t>(made));
    for (std::size_t k = 1; k < r.happenings.size(); ++k) CHECK(r.happenings[k - 1].t <= r.happenings[k].t);
    CHECK(r.happenings.back().t <= duration);
  }
}

TEST_CASE("a row at an instant at which an event sets the state takes no digits from those after it") {
  ModelText m(
      "param m = 1 kg, v0 = 0.7 m/s\ncoord x : length\nT = 1/2 m x'^2\n"
      "event per when x = 0.7 m rising : set x = 0.1 m\nstart x' = v0, x = 0.1 m\n");
  SimulationOptions options;
  options.duration = 10;
  options.output_every = 0.5;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  CHECK(r->uncertain.columns.empty());
  CHECK(r->final.q[0] == doctest::Approx(0.5).epsilon(1e-14));
}

TEST_CASE("a mass that is pressed against a wall rests, however its gap is written") {
  for (const char* gap : {"x - b <= 0", "2 (b - x) >= 0", "-(x - b) >= 0", "x <= b"}) {
    ModelText m("param m = 1 kg, b = 0.7 m\ncoord x : length\nT = 1/2 m x'^2\nforce x = 3 [N]\ncontact " +
                std::string(gap) + " name wall\nstart x = b\n");
    SimulationOptions options;
    options.duration = 1;
    const auto r = simulate(m.model, m.equations, options, m.diagnostics);
    REQUIRE(r);
    CHECK(r->uncertain.columns.empty());
    CHECK(r->final.q[0] == 0.7);
  }
}

TEST_CASE("two blocks and a wall count the digits of π") {
  const std::pair<double, std::size_t> counts[] = {{1, 3}, {100, 31}, {10'000, 314}};
  for (const auto& [ratio, expected] : counts) {
    ModelText m("dimensionless\nparam M = " + fmt::format("{}", ratio) +
                "\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 M y'^2\n"
                "contact x >= 0 restitution 1 name wall\ncontact y >= x restitution 1 name blocks\n"
                "start x = 1, y = 2, y' = -1\n");
    const auto r = run(m, 1000);
    CHECK(count(r, Happening::Kind::Impact) == expected);
    CHECK(r.statistics.energy_drift < 1e-12);
  }
}

TEST_CASE("the books of a bouncing rod with friction close") {
  ModelText m(rod +
              "contact z - l/2 sin θ >= 0 restitution 0.5 friction 0.3 slip x' + l/2 sin θ θ' name left\n"
              "contact z + l/2 sin θ >= 0 restitution 0.5 friction 0.3 slip x' - l/2 sin θ θ' name right\n"
              "start z = 1 m, θ = 0.4 rad, x' = 2 m/s\n");
  const auto r = run(m, 0.9);
  REQUIRE(r.ok());
  CHECK(count(r, Happening::Kind::Impact) >= 2);
  REQUIRE(r.books);
  CHECK(r.books->impacts > 0);
  CHECK(r.statistics.energy_drift < 1e-12);
}

TEST_CASE("Painlevé's rod: no motion, and two motions, are told") {
  const std::string text = rod + "contact z - l/2 sin θ >= 0 friction 1.6 slip x' + l/2 sin θ θ' name floor\n";
  ModelText none(text + "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s\n");
  const auto a = run(none, 0.1);
  CHECK(a.ending == Ending::Paradox);
  CHECK(a.reason.find("no finite forces") != std::string::npos);
  ModelText two(text + "start z = l/2 sin(1), θ = 1 rad, x' = -3 m/s, θ' = 6 rad/s, z' = 3 cos(1) m/s\n");
  const auto b = run(two, 0.1);
  CHECK(b.ending == Ending::Paradox);
  CHECK(b.reason.find("more than one motion") != std::string::npos);
}

TEST_CASE("a result that depends on the order of impacts is told with both") {
  ModelText m(
      "dimensionless\ncoord x, y, z : number\nT = 1/2 x'^2 + 1/2 y'^2 + 1/2 z'^2\n"
      "contact y >= x restitution 0.5\ncontact z >= y restitution 0.5\nstart x = -1, z = 1, x' = 1, z' = -1\n");
  const auto r = run(m, 2);
  CHECK(r.remarks.size() == 1);
}

TEST_CASE("events: record, direction, set, stop") {
  ModelText m(
      "dimensionless\nparam w = 1\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 w^2 x^2\n"
      "event up when x = 0 rising : record\nevent down when x = 0 falling : record\n"
      "event kick when x = 0.5 rising : set x' = 2 x'\nevent far when x = 1.5 : stop\nstart x = 1\n");
  const auto r = run(m, 50);
  CHECK(r.ending == Ending::Stopped);
  // 1 → −1, kicked at x = ½ from ẋ = √¾ to √3: amplitude √(3 + ¼) > 1.5
  CHECK(count(r, Happening::Kind::Event, "down") == 1);
  CHECK(count(r, Happening::Kind::Event, "up") == 1);
  CHECK(count(r, Happening::Kind::Event, "kick") == 1);
  CHECK(r.happenings[0].t == doctest::Approx(std::acos(0.0)).epsilon(1e-14));
  CHECK(r.happenings[1].t == doctest::Approx(3 * std::acos(0.0)).epsilon(1e-14));
  CHECK(r.final.q[0] == doctest::Approx(1.5).epsilon(1e-14));
  CHECK(std::abs(r.final.v[0]) == doctest::Approx(std::sqrt(3.25 - 2.25)).epsilon(1e-13));
  CHECK(r.statistics.energy_drift < 1e-14);
}

TEST_CASE("a set that breaks a contact or a constraint ends the run with the reason") {
  ModelText m(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\ncontact x >= 0 name wall\n"
      "event bad when x = 2 : set x = -1\nstart x = 1, x' = 1\n");
  const auto r = run(m, 5);
  CHECK(r.ending == Ending::ImpossibleState);
  CHECK(r.reason.find("wall") != std::string::npos);
  ModelText c(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nconstraint x = y name tie\n"
      "event bad when x = 2 : set x = 5\nstart x = 1, y = 1, x' = 1, y' = 1\n");
  const auto s = run(c, 5);
  CHECK(s.ending == Ending::ImpossibleState);
  CHECK(s.reason.find("tie") != std::string::npos);
}

TEST_CASE("a contact that the start violates is an error") {
  ModelText m("dimensionless\ncoord x : number\nT = 1/2 x'^2\ncontact x >= 0 name wall\nstart x = -1\n");
  SimulationOptions options;
  options.duration = 1;
  CHECK_FALSE(simulate(m.model, m.equations, options, m.diagnostics));
  CHECK(m.diagnostics.items().back().code == "E0728");
}

TEST_CASE("backwards through an impact is refused") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
      "contact z >= 0 restitution 0.5 name floor\nstart z = 1 m\n");
  const auto r = run(m, -2);
  CHECK(r.ending == Ending::Paradox);
  CHECK(r.reason.find("Backwards") != std::string::npos);
}

TEST_CASE("backwards from a contact that opens at the start there is no motion") {
  const std::string ball =
      "param m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
      "contact z >= 0 restitution 0.8 name floor\nstart z = 0 m, z' = ";
  ModelText opens(ball + "3 m/s\n");
  const auto r = run(opens, -0.5);
  CHECK(r.ending == Ending::Paradox);
  CHECK(r.reason.find("Backwards in time the motion meets a change of contact here") == 0);
  CHECK(r.final.t == 0);
  CHECK(r.final.q[0] == 0);
  // One that is lifted off without speed was open before too.
  ModelText touches("dimensionless\ncoord z : number\nT = 1/2 z'^2\nV = -z\ncontact z >= 0 name floor\nstart z = 0\n");
  const auto parabola = run(touches, -2);
  CHECK(parabola.ok());
  CHECK(parabola.final.q[0] == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("a table on four legs: λ is not determined, the motion is") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, J = 1 kg m^2\ncoord z : length, a, b : angle\n"
      "T = 1/2 m z'^2 + 1/2 J (a'^2 + b'^2)\nV = m g z\nlet d = 1 [m]\n"
      "contact z + d a + d b >= 0\ncontact z + d a - d b >= 0\ncontact z - d a + d b >= 0\ncontact z - d a - d b >= "
      "0\n");
  const auto r = run(m, 10);
  REQUIRE(r.ok());
  for (int i = 0; i < 3; ++i) CHECK(std::abs(r.final.q[static_cast<std::size_t>(i)]) < 1e-13);
}

TEST_CASE("a block on a table that vibrates flies off where a_max > g, and at the phase where z'' = -g") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, A = 10 mm, w = 40 rad/s\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
      "contact z >= A sin(w t) name table\nstart z' = A w\n");
  const auto r = run(m, 0.1);
  REQUIRE(!r.happenings.empty());
  CHECK(r.happenings[0].kind == Happening::Kind::Lost);
  CHECK(r.happenings[0].t == doctest::Approx(std::asin(9.81 / 16) / 40).epsilon(1e-13));
}

TEST_CASE("the bounces that are left out at their end rub too") {
  ModelText m(
      "param m = 1 kg, g = 10 m/s^2\ncoord x, z : length\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\n"
      "contact z >= 0 restitution 0.5 friction 0.2 slip x' name floor\nstart z = 0.1 m, x' = 1 m/s\n");
  const auto r = run(m, 2);
  CHECK(r.final.q[0] == doctest::Approx(0.27).epsilon(1e-11));  // 3 T − 8 T² + (1 − 6 T)²/4 with T = √2/10
  CHECK(r.statistics.energy_drift < 1e-13);
}

TEST_CASE("a table that vibrates: thrown and caught again in each of its periods") {
  ModelText m(
      "param m = 1 kg, g = 10 m/s^2, A = 0.01 m, w = 40 rad/s\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
      "contact z >= A sin(w t) name table\nstart z' = 0.4 m/s\n");
  const auto r = run(m, 20);
  REQUIRE(r.ok());
  CHECK(count(r, Happening::Kind::Impact) == 127);  // 20 s · 40/(2π), and one more period's landing
  for (const Happening& h : r.happenings)
    if (h.kind == Happening::Kind::Impact) CHECK(h.impulse == doctest::Approx(0.567191424106).epsilon(1e-10));
}

TEST_CASE("a set that keeps a constraint to rounding is carried out") {
  ModelText m(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "constraint x^2 + y^2 = l^2 name rod\nevent low when x = 0 m : set x' = -x', y' = -y'\nstart x = l\n");
  const auto r = run(m, 3);
  CHECK(r.ok());
  CHECK(count(r, Happening::Kind::Event, "low") >= 2);
}

TEST_CASE("a surface with a kink is refused, one that goes on smoothly is not") {
  SimulationOptions options;
  options.duration = 5;
  ModelText hill(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = z\ncontact z >= -max(0, x)\nstart x = -1, x' = "
      "2\n");
  CHECK_FALSE(simulate(hill.model, hill.equations, options, hill.diagnostics));
  CHECK(hill.diagnostics.items().back().code == "E0730");
  ModelText stadium(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact max(abs(x) - 1, 0)^2 + y^2 <= 1 restitution 1\nstart x = 0.1, y = 0.2, x' = 0.8, y' = 0.6\n");
  const auto r = run(stadium, 300);
  REQUIRE(r.ok());
  CHECK(r.statistics.energy_drift < 1e-13);
  CHECK(count(r, Happening::Kind::Impact) > 100);
  CHECK(r.statistics.steps <=
        count(r, Happening::Kind::Impact) + 1);  // a flight goes on through abs and max of the gap
}

TEST_CASE("events at one instant all happen, and their sets are all carried out") {
  ModelText m(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = 9.81 z\n"
      "event a when z = 0.5 : set z' = -z'\nevent b when z = 0.5 : set x' = 3\nstart z = 1\n");
  const auto r = run(m, 0.6);
  CHECK(count(r, Happening::Kind::Event, "a") == 1);
  CHECK(count(r, Happening::Kind::Event, "b") == 1);
  CHECK(r.final.v[0] == 3);
}

TEST_CASE("a gap that loses its value on the way ends the run with a word") {
  ModelText m(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\ncontact z >= sqrt(1 - x) name cliff\n"
      "start x' = 1, z = 3\n");
  const auto r = run(m, 2);
  CHECK_FALSE(r.ok());
  CHECK(r.reason.find("cliff") != std::string::npos);
}

TEST_CASE("a wall that is narrower than a step is hit, far from the start") {
  ModelText m(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\n"
      "contact (x - 30)^2 + (z - 900)^2 >= 1e-6 restitution 1 name bead\nstart x' = 1, z' = 30\n");
  const auto r = run(m, 60);
  REQUIRE(count(r, Happening::Kind::Impact, "bead") == 1);
  CHECK(r.happenings[0].t == doctest::Approx(30 - 0.001 / std::hypot(1, 30)).epsilon(1e-12));
}

TEST_CASE(
    "a string whose tension vanishes just at the start is slack from the start, until the parabola meets the circle") {
  ModelText m(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact sqrt(x^2 + y^2) <= l name string\n"
      "start x = l sqrt(3)/2, y = l/2, x' = -1/2 sqrt(g l/2), y' = sqrt(3)/2 sqrt(g l/2)\n");
  const auto r = run(m, 1);
  CHECK(r.first_mode.empty());
  REQUIRE(!r.happenings.empty());
  CHECK(r.happenings[0].kind == Happening::Kind::Impact);
  CHECK(r.happenings[0].t == doctest::Approx(4 * std::sqrt(3.0) / 2 * std::sqrt(9.81 / 2) / 9.81).epsilon(1e-13));
}

TEST_CASE("infinitely many bounces end at √(2 h/g) (1 + e)/(1 − e)") {
  ModelText m(
      "dimensionless\ncoord z : number\nT = 1/2 z'^2\nV = z\ncontact z >= 0 restitution 0.5 name floor\nstart z = 1\n");
  const auto r = run(m, 6);
  REQUIRE(count(r, Happening::Kind::Made) == 1);
  CHECK(r.happenings.back().t == doctest::Approx(3 * std::sqrt(2.0)).epsilon(1e-10));

  // Each impulse is (1 + e) times the speed, but for the last: it is done without bounce, and says so.
  const std::size_t last = r.happenings.size() - 2;
  for (std::size_t k = 0; k < last; ++k) {
    CHECK(r.happenings[k].impulse == doctest::Approx(1.5 * r.happenings[k].speed).epsilon(1e-13));
    CHECK(r.happenings[k].remark.empty());
  }
  CHECK(r.happenings[last].impulse == doctest::Approx(r.happenings[last].speed).epsilon(1e-13));
  CHECK(r.happenings[last].remark == "without bounce, those after it are left out");
}

TEST_CASE("a run that is interrupted before its first step stays at its start") {
  for (const char* start : {"start z = 1", "start z = 0", "start z = 0, z' = -1"}) {
    ModelText m(std::string("dimensionless\ncoord z : number\nT = 1/2 z'^2\nV = z\n"
                            "contact z >= 0 restitution 0.5 name floor\n") +
                start + "\n");
    const std::atomic<bool> stop = true;
    maupertuis::SimulationOptions options;
    options.interrupt = &stop;
    const auto r = run(m, 6, options);
    CHECK(r.ending == Ending::Interrupted);
    CHECK(r.final.t == 0);
    CHECK(r.final.q[0] == (std::string(start) == "start z = 1" ? 1 : 0));
  }
}

TEST_CASE("bounces go on while they are to be seen, however fast something else flies") {
  const std::string ball =
      "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = y\n"
      "contact y >= 0 restitution 0.9 name floor\nstart y = 1";
  ModelText alone(ball + "\n"), beside(ball + ", x' = 1e6\n");
  const auto a = run(alone, 10), b = run(beside, 10);
  CHECK(count(b, Happening::Kind::Made) == 0);
  CHECK(count(b, Happening::Kind::Impact) == count(a, Happening::Kind::Impact));
  CHECK(b.final.q[1] == doctest::Approx(a.final.q[1]).epsilon(1e-13));
  CHECK(b.final.v[1] == doctest::Approx(a.final.v[1]).epsilon(1e-13));
}

TEST_CASE("an impact at once loses what an impact alone does") {
  ModelText m(
      "dimensionless\ncoord z : number\nT = 1/2 z'^2\nV = z\ncontact z >= 0 restitution 0.5 name floor\n"
      "impact simultaneous\nstart z = 1\n");
  const auto r = run(m, 2);
  REQUIRE(count(r, Happening::Kind::Impact) == 1);
  CHECK(r.happenings[0].speed == doctest::Approx(std::sqrt(2.0)).epsilon(1e-14));
  CHECK(r.books->impacts == doctest::Approx(0.75).epsilon(1e-14));
  CHECK(r.statistics.energy_drift < 1e-14);
}

TEST_CASE("a motion that is thrown back from the zero of an event meets it once, and does not rise through it") {
  for (const double height : {0.1, 0.3, 0.77, 1.0})
    for (const char* thrown :
         {"contact y >= 0 restitution e name floor\n", "event floor when y = 0 : set y' = -e y'\n"}) {
      ModelText m("dimensionless\nparam e = 0.9\ncoord y : number\nT = 1/2 y'^2\nV = y\n" + std::string(thrown) +
                  "event zero when y = 0 : record\nevent up when y = 0 rising : record\n"
                  "event down when y = 0 falling : record\n" +
                  fmt::format("start y = {}, y' = 0.3\n", height));
      const auto r = run(m, 12);
      const std::size_t bounces = count(r, Happening::Kind::Impact) + count(r, Happening::Kind::Event, "floor");
      CHECK(bounces > 3);
      CHECK(count(r, Happening::Kind::Event, "zero") == bounces);
      CHECK(count(r, Happening::Kind::Event, "down") == bounces);
      CHECK(count(r, Happening::Kind::Event, "up") == 0);
    }
}

TEST_CASE("a set beside a stop at one time is told, and that the last state is the one before it") {
  const auto r = run_text(
      "dimensionless\ncoord x : length\nT = 1/2 x'^2\nevent a when x = 1 : set x' = 4\nevent b when x = 1 : stop\n"
      "start x' = 2\n",
      3);
  CHECK(r.final.v[0] == 2);
  REQUIRE(r.remarks.size() == 1);
  CHECK(r.remarks[0].find("The event a sets the state") != std::string::npos);
}

TEST_CASE("the end of bounces on a slope is told by impacts, none of which is rounding") {
  const auto r = run_text(
      "dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -9.81)\n"
      "contact y - 0.286*sin(1.068*x) >= 0 restitution 0.68 name floor\nstart x = 0.694, y = 1.029, x' = 0.36\n",
      2.46);
  CHECK(count(r, Happening::Kind::Made, "floor") == 1);
  for (const Happening& h : r.happenings)
    if (h.kind == Happening::Kind::Impact) CHECK(h.impulse > 1e-7);
}

// (x − 300)² − 10⁻¹⁰ about x = 0 has terms of 9·10⁴, whose rounding is larger than what it is between its roots.
TEST_CASE("walls whose gaps are small against their terms far away are met") {
  const std::string free = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x' = 1\n";
  const auto end_of = [&](const std::string& line) { return run_text(free + line, 400); };
  for (const std::string line : {"contact (x - 300)^2 >= 1e-10 restitution 1 name wall\n",
                                 "event hit when (x - 300)^2 = 1e-10 : set x' = -x'\n"}) {
    CAPTURE(line);
    const SimulationResult r = end_of(line);
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].t == doctest::Approx(299.99999).epsilon(1e-15));
    CHECK(r.final.q[0] == doctest::Approx(199.99998).epsilon(1e-15));
    CHECK(r.final.v[0] == -1);
  }
  // Two roots 2·10⁻⁷ apart, and one that is touched.
  const SimulationResult apart = end_of("event hit when (x - 300)^2 = 1e-14 : record\n");
  REQUIRE(apart.happenings.size() == 2);
  CHECK(std::abs(apart.happenings[0].t - (300 - 1e-7)) < 1e-13);
  CHECK(std::abs(apart.happenings[1].t - (300 + 1e-7)) < 1e-13);
  const SimulationResult touch = end_of("event hit when (x - 300)^2 = 0 : record\n");
  REQUIRE(touch.happenings.size() == 1);
  CHECK(std::abs(touch.happenings[0].t - 300) < 1e-12);
  // No polynomial: 200 − 2πk ± √2·10⁻⁴.
  const SimulationResult waves = end_of("event hit when 1 - cos(x - 200) = 1e-8 : record\n");
  CHECK(waves.happenings.size() == 2 * 63);
}

TEST_CASE("a small round wall far away is hit where it stands") {
  // A disk of radius 10⁻⁵, hit at the height 5·10⁻⁶: turned by π − 2·30°.
  const SimulationResult r = run_text(
      "dimensionless\ncoord x : number\ncoord y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact x^2 + y^2 >= 1e-10 restitution 1 name disk\nstart x = -1000, x' = 1, y = 5e-6\n",
      2000);
  CHECK(count(r, Happening::Kind::Impact) == 1);
  CHECK(r.final.q[0] == doctest::Approx(-500).epsilon(1e-6));
  CHECK(r.final.q[1] == doctest::Approx(500 * std::sqrt(3.0)).epsilon(1e-6));
}

TEST_CASE("a motion may end, and an event set it, where the gap of an open contact has no slope") {
  const std::string text =
      "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\n"
      "contact sqrt(x^2 + y^2) <= 1 restitution 1 name wall\nstart x = -0.5, x' = 1\n";
  CHECK(run_text(text, 0.5).final.q[0] == 0);
  const auto r = run_text(text + "event centre when x = 0 : set x' = x'\n", 4);
  CHECK(count(r, Happening::Kind::Event, "centre") == 2);
  CHECK(count(r, Happening::Kind::Impact, "wall") == 2);
  CHECK(r.final.q[0] == doctest::Approx(-0.5));
}

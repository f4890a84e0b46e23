// Runs through modes: closed forms, books of energy, and what has no motion.
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace maupertuis;

namespace {

SimulationResult run(ModelText& m, double end, SimulationOptions options = {}) {
  options.duration = end;
  options.errors = ErrorEstimates::None;
  auto result = simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

std::size_t count(const SimulationResult& r, Happening::Kind kind, const std::string& name = {}) {
  return static_cast<std::size_t>(std::count_if(r.happenings.begin(), r.happenings.end(), [&](const Happening& h) {
    return h.kind == kind && (name.empty() || h.name == name);
  }));
}

const std::string rod =
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
    "T = 1/2 m (x'^2 + z'^2) + 1/24 m l^2 θ'^2\nV = m g z\n";

}  // namespace

TEST_CASE("a block at rest stays where it is for ten thousand seconds, to the last bit") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, α = 0.3 rad\ncoord s, n : length\nT = 1/2 m (s'^2 + n'^2)\n"
      "V = m g (s sin α + n cos α)\ncontact n >= 0 friction 0.4 slip s' name plane\nstart s = 0.7 m\n");
  const auto r = run(m, 1e4);
  CHECK(r.first_mode == "plane sticking");
  CHECK(r.final.q[0] == 0.7);
  CHECK(r.final.v[0] == 0);
  CHECK(r.happenings.empty());
}

TEST_CASE("the threshold of sticking is tan α, to nine digits on either side") {
  const auto mode = [](double mu) {
    ModelText m(
        "param m = 1 kg, g = 9.81 m/s^2, α = 0.3 rad\ncoord s, n : length\nT = 1/2 m (s'^2 + n'^2)\n"
        "V = m g (s sin α + n cos α)\ncontact n >= 0 friction " +
        fmt::format("{:.17g}", mu) + " slip s' name plane\n");
    return run(m, 0.1).first_mode;
  };
  CHECK(mode(std::tan(0.3) * (1 + 1e-9)) == "plane sticking");
  CHECK(mode(std::tan(0.3) * (1 - 1e-9)) == "plane sliding −");
}

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

TEST_CASE("a block under a harmonic force gives way and comes to rest in turns, each once, for as long as the run is") {
  ModelText m(
      "param m = 1 kg, F = 3.2 N, w = 12 rad/s\ncoord x : length\nT = 1/2 m x'^2\nforce x = F cos(w t)\n"
      "friction x limit 2.943 N\n");
  const auto r = run(m, 30);
  CHECK(r.ending == Ending::Finished);
  // It gives way where the force comes to the limit in either direction, half a period after the time before.
  const double first = (3.141592653589793 - std::acos(2.943 / 3.2)) / 12, half = 3.141592653589793 / 12;
  std::size_t slips = 0;
  for (const Happening& h : r.happenings) {
    if (h.kind != Happening::Kind::Slip) continue;
    CHECK(h.t == doctest::Approx(first + static_cast<double>(slips) * half).epsilon(1e-13));
    ++slips;
  }
  CHECK(slips == 1 + static_cast<std::size_t>((30 - first) / half));
  CHECK(count(r, Happening::Kind::Stick) == slips + 1);  // it slides as it begins
}

TEST_CASE("a break-away is seen however soon the run ends after it") {
  for (const double end : {0.0975, 0.098, 0.1, 0.102, 0.104, 0.1061, 0.107, 0.11, 0.113}) {
    ModelText m(
        "param m = 1 kg, F = 3.2 N, w = 12 rad/s\ncoord x : length\nT = 1/2 m x'^2\nforce x = F sin(w t)\n"
        "friction x limit 2.943 N\n");
    const auto r = run(m, end);
    const double from = std::asin(2.943 / 3.2) / 12;
    CHECK(count(r, Happening::Kind::Slip) == 1);
    CHECK(r.final.v[0] ==
          doctest::Approx(3.2 / 12 * (std::cos(12 * from) - std::cos(12 * end)) - 2.943 * (end - from)).epsilon(1e-9));
  }
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

TEST_CASE("what never slides is not begun, nor set, with a slip") {
  const std::string wheel =
      "param m = 1 kg, g = 9.81 m/s^2, R = 0.1 m\ncoord x, y : length, φ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/4 m R^2 φ'^2\nV = m g y\ncontact y >= R slip x' + R φ' sticking name floor\n"
      "start y = R, x' = 3 m/s";
  ModelText rolls(wheel + ", φ' = -30 rad/s\n");
  const auto good = run(rolls, 0.6);
  CHECK(good.final.q[0] == doctest::Approx(1.8));
  ModelText slides(wheel + "\n");
  const auto start = run(slides, 0.6);
  CHECK(start.ending == Ending::Paradox);
  CHECK(start.reason == "The start slides on the contact floor, which is `sticking` and never slides.");
  CHECK(start.final.v[0] == 3);
  ModelText set(wheel + ", φ' = -30 rad/s\nevent push when x = 1 m : set x' = 4 m/s\n");
  const auto pushed = run(set, 0.6);
  CHECK(pushed.ending == Ending::Paradox);
  CHECK(pushed.reason == "The event `push` sets a state that slides on the contact floor, which never slides.");
}

TEST_CASE("friction whose limit becomes negative is told") {
  const std::string block = "param m = 1 kg, F0 = 5 N, w = 1 rad/s\ncoord x : length\nT = 1/2 m x'^2\n";
  ModelText drives(block + "friction x limit F0 cos(w t)\nstart x' = 10 m/s\n");
  const auto told = run(drives, 4).remarks;
  REQUIRE(told.size() == 1);
  CHECK(told[0].find("drives the motion there, which no friction does") != std::string::npos);
  ModelText brakes(block + "friction x limit F0 abs(cos(w t))\nstart x' = 10 m/s\n");
  CHECK(run(brakes, 4).remarks.empty());
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

namespace {

const std::string ladder =
    "param m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord x, y : length, θ : angle\n"
    "T = 1/2 m (x'^2 + y'^2) + 1/24 m l^2 θ'^2\nV = m g y\n"
    "contact y - l/2 sin θ >= 0 friction 0.4 slip x' - l/2 sin θ θ' name floor\n"
    "contact x - l/2 cos θ >= 0 friction 0.3 slip y' + l/2 cos θ θ' name wall\n"
    "start x = l/2 cos θ0, y = l/2 sin θ0, θ = θ0\n";

}  // namespace

TEST_CASE("a ladder between rough walls rests where some forces within the limits hold it, and nowhere else") {
  const double limit = std::atan((1 - 0.4 * 0.3) / (2 * 0.4));
  for (const double above : {-1e-6, 1e-6, 1e-4, 0.01, 0.05, 0.2}) {
    ModelText m("param θ0 = " + fmt::format("{:.17g}", limit + above) + " rad\n" + ladder);
    const auto r = run(m, 0.5);
    CHECK(r.ending == Ending::Finished);
    CHECK(r.first_mode == (above < 0 ? "floor sliding +, wall sliding −" : "floor sticking, wall sticking"));
    if (above < 0) continue;
    REQUIRE(r.final.reactions.size() == 4);  // normal forces of floor and wall, then friction
    const double floor = r.final.reactions[0], wall = r.final.reactions[1];
    const double along_floor = r.final.reactions[2], along_wall = r.final.reactions[3];
    CHECK(std::abs(r.final.v[2]) < 1e-14);
    CHECK(std::abs(along_floor) <= 0.4 * floor);
    CHECK(std::abs(along_wall) <= 0.3 * wall);
    CHECK(floor + along_wall == doctest::Approx(9.81).epsilon(1e-13));  // they carry the weight
    CHECK(std::abs(wall + along_floor) < 1e-12);
    REQUIRE(r.remarks.size() == 1);
    CHECK(r.remarks[0].find("statically indeterminate") != std::string::npos);
  }
}

TEST_CASE("a ladder whose foot is pulled slides when no forces within the limits hold it any more") {
  ModelText m("param θ0 = 60 deg, c = 0.1 N/s\n" + ladder +
              "point foot at (x + l/2 cos θ, y - l/2 sin θ)\nforce on foot = (c t, 0)\n");
  const auto r = run(m, 13);
  const double s = std::sin(std::acos(0.5)), wall = 9.81 * 0.5 / (2 * (s + 0.3 * 0.5)), floor = 9.81 - 0.3 * wall;
  REQUIRE(r.happenings.size() == 2);  // both at once
  CHECK(r.happenings[0].t == doctest::Approx((0.4 * floor - wall) / 0.1).epsilon(1e-12));
  CHECK(r.happenings[1].t == r.happenings[0].t);
  CHECK(r.happenings[1].mode == "floor sliding +, wall sliding −");
}

TEST_CASE("dry friction beside a reaction that goes through zero") {
  for (const char* from : {"99", "101", "120", "150"}) {
    const std::string start = ", th = " + std::string(from) + " deg\n";
    ModelText by_reaction(
        "param m = 1 kg, R = 1 m, μ = 0.2, g = 9.81 m/s^2\ncoord r : length, th : angle\n"
        "T = 1/2 m (r'^2 + r^2 th'^2)\nV = -m g r cos th\nconstraint r = R name hoop\n"
        "friction th coefficient μ normal R reaction(hoop)\nstart r = R" +
        start);
    ModelText by_hand(
        "param m = 1 kg, R = 1 m, μ = 0.2, g = 9.81 m/s^2, r0 = 0 m\ncoord th : angle\nT = 1/2 m R^2 th'^2\n"
        "V = -m g R cos th\nfriction th limit μ R abs(m R th'^2 + m g cos th)\nstart th' = 0" +
        start);
    const auto r = run(by_reaction, 3), hand = run(by_hand, 3);
    CHECK(r.ending == Ending::Finished);
    CHECK(r.final.q[1] == doctest::Approx(hand.final.q[0]).epsilon(1e-12));
    CHECK(r.final.v[1] == doctest::Approx(hand.final.v[0]).epsilon(1e-12));
  }
}

TEST_CASE("a slider-crank with dry friction in its guide goes through the dead centres, where slip and force vanish") {
  ModelText m(
      "param m = 1 kg, r = 0.3 m, l = 0.8 m, μ = 0.2, J = 0.1 kg m^2\ncoord θ, φ : angle, x, y : length\n"
      "T = 1/2 J θ'^2 + 1/2 m (x'^2 + y'^2)\nconstraint x = r cos θ + l cos φ name cx\n"
      "constraint y = r sin θ - l sin φ name cy\nconstraint y = 0 name guide\n"
      "friction x coefficient μ normal reaction(guide)\n"
      "start θ = 30 deg, φ = asin(0.1875), x = 1.045619303410417 m, θ' = 20 rad/s\n");
  const auto r = run(m, 1);
  CHECK(r.ending == Ending::Finished);
  CHECK(count(r, Happening::Kind::Slip) == 5);                    // five dead centres
  CHECK(r.final.q[0] == doctest::Approx(18.7846).epsilon(1e-5));  // by Runge and Kutta's formula
  CHECK(r.final.v[0] == doctest::Approx(20.477).epsilon(1e-4));
  CHECK(r.statistics.energy_drift < 1e-13);
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

TEST_CASE("a ladder that is pushed off its rough wall leaves it where the wall presses no more") {
  std::string rough = ladder;
  for (const auto& [from, to] : {std::pair("friction 0.4", "friction 0.6"), std::pair("friction 0.3", "friction 0.5")})
    rough.replace(rough.find(from), std::string(from).size(), to);
  for (const char* degrees : {"63", "65", "70", "75", "80", "84"}) {
    const std::string angle = std::string(degrees) + " deg";
    ModelText m("param θ0 = " + angle + "\n" + rough + "point centre at (x, y)\nforce on centre = (1 [N/s] t, 0)\n");
    const auto r = run(m, 6);
    CHECK(r.ending == Ending::Finished);
    REQUIRE(count(r, Happening::Kind::Lost, "wall") == 1);
    const double right = 9.81 / std::tan(std::stod(degrees) * 3.141592653589793 / 180);
    CHECK(r.happenings[0].t == doctest::Approx(right).epsilon(1e-9));
    CHECK(r.happenings[0].mode == "floor sticking");
  }
}

TEST_CASE("a block begins to slide beside another one whose feet hold each other") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, h = 0.3 m, J = 0.1 kg m^2, k = 1 N/s\n"
      "coord x, y : length, w : angle, X, Y : length\nbody B mass m inertia J at (x, y) rotation angle w\n"
      "point C mass m at (X, Y)\ngravity (0, -g)\npoint P1 at (a, -h) in B\npoint P2 at (-a, -h) in B\n"
      "force on C = (k t, 0)\nforce on B = (2 [N], 0)\ncontact P1.y >= 0 friction 0.3 slip P1.x' name l1\n"
      "contact P2.y >= 0 friction 0.3 slip P2.x' name l2\ncontact Y >= 0 friction 0.3 slip X' name c\nstart y = h\n");
  const auto r = run(m, 4);
  REQUIRE(r.happenings.size() == 1);
  CHECK(r.happenings[0].mode == "l1 sticking, l2 sticking, c sliding +");
  CHECK(r.happenings[0].t == doctest::Approx(0.3 * 9.81).epsilon(1e-12));
  CHECK(r.final.q[3] == doctest::Approx(std::pow(4 - 0.3 * 9.81, 3) / 6).epsilon(1e-11));
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
  CHECK(r.ending == Ending::SingularConstraints);
  CHECK(r.reason.find("wall") != std::string::npos);
  ModelText c(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nconstraint x = y name tie\n"
      "event bad when x = 2 : set x = 5\nstart x = 1, y = 1, x' = 1, y' = 1\n");
  const auto s = run(c, 5);
  CHECK(s.ending == Ending::SingularConstraints);
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

TEST_CASE("friction with the force of a constraint as its normal force, whichever way that presses") {
  const auto slide = [](const char* lift) {
    ModelText m(std::string("param m = 2 kg, g = 9.81 m/s^2, F = ") + lift +
                "\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\nforce y = F\nconstraint y = 0 name rail\n"
                "friction x coefficient 0.2 normal reaction(rail)\nstart x' = 3 m/s\n");
    return run(m, 0.5);
  };
  CHECK(slide("0 N").final.v[0] == doctest::Approx(3 - 0.5 * 0.2 * 9.81).epsilon(1e-13));
  CHECK(slide("50 N").final.v[0] == doctest::Approx(3 - 0.5 * 0.2 * (25 - 9.81)).epsilon(1e-13));
}

TEST_CASE("a bead on a horizontal hoop: v = v0/(1 + μ v0 t/R), the normal force written out, and never negative") {
  ModelText m(
      "param m = 1 kg, R = 0.5 m, μ = 0.25\ncoord θ : angle\nT = 1/2 m R^2 θ'^2\n"
      "friction θ coefficient μ normal -m R^2 θ'^2\nstart θ' = 6 rad/s\n");
  const auto r = run(m, 2);
  CHECK(r.final.v[0] == doctest::Approx(6 / (1 + 0.25 * 6 * 2)).epsilon(1e-13));
  REQUIRE(r.books);
  CHECK(r.books->friction == doctest::Approx(0.125 * (36 - r.final.v[0] * r.final.v[0])).epsilon(1e-12));
}

TEST_CASE("friction with a limit: an oscillator stops where the spring is weaker than static friction") {
  ModelText m(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nfriction x limit 0.1 static 0.15\nstart x = 1\n");
  const auto r = run(m, 50);
  // Half cycles take 0.2 off the amplitude: 1 → −0.8 → 0.6 → −0.4 → 0.2 → 0, where |x| ≤ 0.15 holds.
  CHECK(std::abs(r.final.q[0]) < 1e-12);
  CHECK(r.final.v[0] == 0);
  CHECK(count(r, Happening::Kind::Stick) == 1);
}

TEST_CASE("a force that jumps lets a contact and a friction go") {
  ModelText lifted(
      "param m = 1 kg, g = 10 m/s^2, F = 20 N, T0 = 1 s\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
      "force z = F step(t - T0)\ncontact z >= 0 name floor\n");
  const auto a = run(lifted, 3);
  CHECK(count(a, Happening::Kind::Lost, "floor") == 1);
  CHECK(a.final.q[0] == doctest::Approx(20).epsilon(1e-14));
  ModelText pushed(
      "param m = 1 kg, F = 4 N, T0 = 1 s\ncoord x : length\nT = 1/2 m x'^2\nforce x = F step(t - T0)\n"
      "friction x limit 3 N\n");
  const auto b = run(pushed, 3);
  CHECK(count(b, Happening::Kind::Slip, "x") == 1);
  CHECK(b.final.q[0] == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("the bounces that are left out at their end rub too") {
  ModelText m(
      "param m = 1 kg, g = 10 m/s^2\ncoord x, z : length\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\n"
      "contact z >= 0 restitution 0.5 friction 0.2 slip x' name floor\nstart z = 0.1 m, x' = 1 m/s\n");
  const auto r = run(m, 2);
  CHECK(r.final.q[0] == doctest::Approx(0.27).epsilon(1e-11));  // 3 T − 8 T² + (1 − 6 T)²/4 with T = √2/10
  CHECK(r.statistics.energy_drift < 1e-13);
}

TEST_CASE("a block that slides in a bowl turns, stops and stays, by x and y as by the angle") {
  const std::string friction = "param m = 1 kg, R = 1 m, g = 10 m/s^2, μ = 0.3\n";
  ModelText plane(
      friction +
      "coord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "contact sqrt(x^2 + y^2) <= R friction μ slip (x y' - y x')/sqrt(x^2 + y^2) name bowl\nstart x = R\n");
  ModelText angle(friction +
                  "coord φ : angle\nT = 1/2 m R^2 φ'^2\nV = -m g R sin φ\n"
                  "friction φ coefficient μ normal m R^2 φ'^2 + m g R sin φ\n");  // from the right end, downwards
  const auto a = run(plane, 5), b = run(angle, 5);
  REQUIRE(a.ok());
  CHECK(count(a, Happening::Kind::Impact) == 0);
  CHECK(a.final.q[0] == doctest::Approx(std::cos(b.final.q[0])).epsilon(1e-12));
  CHECK(a.final.q[1] == doctest::Approx(-std::sin(b.final.q[0])).epsilon(1e-12));
  CHECK(a.books->friction == doctest::Approx(b.books->friction).epsilon(1e-12));
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

TEST_CASE("friction is μ times the normal force, also where the gap is not the distance to the surface") {
  const std::string bead =
      "dimensionless\nparam μ = 0.3\ncoord x, y : number\npoint P mass 1 at (x, y)\ngravity (0, -10)\n";
  const std::string slip = " friction μ slip (x' + 2 x y')/sqrt(1 + 4 x^2) name bowl\nstart x = 1, y = 1\n";
  ModelText height(bead + "contact y - x^2 >= 0" + slip);
  ModelText distance(bead + "contact (y - x^2)/sqrt(1 + 4 x^2) >= 0" + slip);
  const auto a = run(height, 0.5), b = run(distance, 0.5);
  CHECK(a.final.q[0] == doctest::Approx(b.final.q[0]).epsilon(1e-13));
  CHECK(a.books->friction == doctest::Approx(b.books->friction).epsilon(1e-12));
  CHECK(height.diagnostics.items().empty());
  // An impact: the tangential impulse is μ times the normal one, 1.5 · 2 · 0.3.
  ModelText twice(bead + "contact 2 y >= 0 restitution 0.5 friction μ slip x' name floor\nstart x' = 5, y = 0.2\n");
  const auto c = run(twice, 0.21);
  REQUIRE(count(c, Happening::Kind::Impact) == 1);
  CHECK(c.final.v[0] == doctest::Approx(5 - 0.9).epsilon(1e-13));
  CHECK(c.final.v[1] == doctest::Approx(1 - 10 * 0.01).epsilon(1e-12));
  // A factor of the slip is told: nothing says that it is none of a gear.
  ModelText factor(bead + "contact y >= 0 friction μ slip 2 x' name floor\n");
  REQUIRE(factor.diagnostics.items().size() == 1);
  CHECK(factor.diagnostics.items()[0].code == "W0435");
}

TEST_CASE("Stribeck friction by |x'|, however written, goes on while a slip has one direction") {
  // 0.57613206 m after 27 changes by Runge-Kutta steps of 2e-5 s between events.
  const std::string laws[] = {"exp(-abs(x')/v0)", "exp(-abs(x'/v0))", "exp(-max(x', -x')/v0)",
                              "piecewise(x' > 0 [m/s] : exp(-x'/v0), else : exp(x'/v0))"};
  for (const std::string& law : laws)
    for (const std::string still : {"", " static 3 [N]"}) {
      CAPTURE(law);
      ModelText m(
          "param m = 1 kg, k = 10 N/m, v0 = 0.05 m/s\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
          "force x = 3.5 [N] sin(2 [rad/s] t)\nfriction x limit 2 [N] + 1 [N] " +
          law + still + "\n");
      const auto r = run(m, 20);
      REQUIRE(r.ok());
      CHECK(r.final.q[0] == doctest::Approx(0.57613206).epsilon(1e-8));
      CHECK(r.happenings.size() == 27);
      CHECK(r.statistics.switches == 0);
    }
}

TEST_CASE("friction that is stronger in one direction holds, gives way and slides by the limit of each") {
  const auto slip = [](const std::string& limit, const std::string& force) {
    ModelText m("param m = 2 kg\ncoord x : length\nT = 1/2 m x'^2\nforce x = " + force + "\nfriction x limit " + limit +
                "\n");
    const auto r = run(m, 4);
    REQUIRE(r.ok());
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].kind == Happening::Kind::Slip);
    CHECK(r.final.q[0] == doctest::Approx(std::copysign(std::pow(4 - r.happenings[0].t, 3) / 12, r.final.q[0])));
    return std::copysign(r.happenings[0].t, r.final.q[0]);
  };
  for (const std::string limit :
       {"2.5 [N] + 0.5 [N] sign(x')", "piecewise(x' > 0 [m/s] : 3 [N], else : 2 [N])", "2 [N] + 1 [N] step(3 x')"}) {
    CAPTURE(limit);
    CHECK(slip(limit, "1 [N/s] t") == doctest::Approx(3).epsilon(1e-14));
    CHECK(slip(limit, "-1 [N/s] t") == doctest::Approx(-2).epsilon(1e-14));
  }
}

TEST_CASE("a limit that is reached at a root of third order is located as well as it is said to be") {
  const auto of = [](const std::string& rest) {
    ModelText m("param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n" + rest);
    SimulationOptions options;
    options.duration = 3;
    auto r = simulate(m.model, m.equations, options, m.diagnostics);
    REQUIRE(r);
    REQUIRE(r->ok());
    REQUIRE(r->happenings.size() == 1);
    REQUIRE(r->final.errors);
    CHECK(std::abs(r->happenings[0].t - 1) < r->happenings[0].error);
    CHECK(r->happenings[0].error < 1e-3);
    return std::move(*r);
  };
  const auto slips = of("force x = 3 [N] + 1 [N/s^3] (t - 1 [s])^3\nfriction x limit 2 N static 3 N\n");
  CHECK(std::abs(slips.final.q[0] - 3.6) < slips.final.errors->q[0]);
  const auto opens = of("force x = 1 [N/s^3] (t - 1 [s])^3\ncontact x >= 0 name floor\n");
  CHECK(opens.final.q[0] == doctest::Approx(1.6).epsilon(1e-14));
}

// Dry friction in runs through modes, in the plane and along coordinates: what holds, gives way and stops, by closed
// forms.
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/simulation.hpp>

#include "run_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace maupertuis;

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
    CHECK(r.books->friction == doctest::Approx((r.final.q[0] > 0 ? 3 : 2) * std::abs(r.final.q[0])).epsilon(1e-13));
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

TEST_CASE("the friction that comes to its limit gives way, in whatever order two are written; the other one holds") {
  // The floor lets go at F = 2, while the upper block needs F/2 of the 4 that hold it: both move with a = (t − 2)/2.
  const std::string between = "contact y - Y >= 1 friction 0.1 static 0.4 slip x' - X' name between\n",
                    floor = "contact Y >= 0 friction 0.1 slip X' name floor\n";
  for (const std::string& contacts : {between + floor, floor + between}) {
    const auto r = run_text(
        "dimensionless\nparam g = 10\ncoord X, Y, x, y : length\npoint lower mass 1 at (X, Y)\n"
        "point upper mass 1 at (x, y)\ngravity (0, -g)\n" +
            contacts + "force x = t\nstart y = 1\n",
        3);
    CHECK(r.final.q[0] == doctest::Approx(1 / 12.0).epsilon(1e-13));
    CHECK(r.final.q[2] == doctest::Approx(1 / 12.0).epsilon(1e-13));
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].name == "floor");
    CHECK(r.happenings[0].t == doctest::Approx(2).epsilon(1e-14));
  }
  const std::string r_limit = "friction r limit 1 static 4\n", X_limit = "friction X limit 2\n";
  for (const std::string& frictions : {r_limit + X_limit, X_limit + r_limit}) {
    const auto r = run_text(
        "dimensionless\ncoord r, X : length\nT = 1/2 X'^2 + 1/2 (X' + r')^2\nforce r = t\nforce X = t\n" + frictions,
        3);
    CHECK(r.final.q[0] == 0);
    CHECK(r.final.q[1] == doctest::Approx(1 / 12.0).epsilon(1e-13));
  }
}

TEST_CASE("what comes to rest is held where the others' kinetic friction lets it be, and begins so") {
  // Both blocks slow down together and stop. The force overcomes what holds them to each other, 0.58 · 13, and then
  // 0.44 · 13 acts on the lower one, less than the 0.35 · 18.4 that hold it.
  const auto r = run_text(
      "dimensionless\ncoord x, y, X, Y : length\npoint A mass 0.54 at (x, y)\npoint B mass 1.3 at (X, Y)\n"
      "gravity (0, -10)\ncontact y >= 0 friction 0.2 static 0.35 slip x' name floor\n"
      "contact Y - y >= 1 friction 0.44 static 0.58 slip X' - x' name between\nforce on B = (-22.9, 0)\n"
      "start Y = 1, x' = 1, X' = 1\n",
      0.3);
  const double a = (22.9 + 0.2 * 18.4) / 1.84, stop = 1 / a, b = (22.9 - 0.44 * 13) / 1.3;
  CHECK(r.final.q[0] == doctest::Approx(0.5 / a).epsilon(1e-13));
  CHECK(r.final.v[0] == 0);
  CHECK(r.final.q[2] == doctest::Approx(0.5 / a - 0.5 * b * (0.3 - stop) * (0.3 - stop)).epsilon(1e-13));
  // Beyond the limits from the start: the one that is overcome by far gives way, whichever is written first.
  for (const bool swapped : {false, true}) {
    const std::string first = "friction r limit 1 static 4\n", second = "friction X limit 2 static 2.1\n";
    const auto both =
        run_text("dimensionless\ncoord r, X : length\nT = 1/2 X'^2 + 1/2 (X' + r')^2\nforce r = 2.5\nforce X = 2.5\n" +
                     (swapped ? second + first : first + second),
                 1);
    CHECK(both.final.q[0] == 0);
    CHECK(both.final.q[1] == doctest::Approx(0.125).epsilon(1e-13));
  }
}

TEST_CASE("a disc that rolls into a corner comes to rest there, after impacts without end") {
  // It rolls down a slope of 0.7 rad against a wall; slope and wall then hold it in balance.
  for (const double speed : {1.08, 0.4, 2.3}) {
    const auto r = run_text(
        "dimensionless\nparam α = 0.7, R = 0.4\ncoord x, y : length, a : angle\n"
        "body disc mass 1 inertia 1/2 R^2 at (x, y) rotation angle a\ngravity (0, -10)\n"
        "contact y cos α - x sin α >= R friction 0.31 slip x' cos α + y' sin α + R a' name slope\n"
        "contact x >= -1.1 + R friction 0.51 slip y' - R a' name wall\n" +
            fmt::format("start y = R/cos α, x' = -{0} cos α, y' = -{0} sin α, a' = {0}/R\n", speed),
        2);
    for (const double v : r.final.v) CHECK(std::abs(v) < 1e-15);
    CHECK(r.final.q[0] == doctest::Approx(-0.7).epsilon(1e-14));
    CHECK(r.final.q[1] == doctest::Approx((0.4 - 0.7 * std::sin(0.7)) / std::cos(0.7)).epsilon(1e-14));
    CHECK(r.statistics.energy_drift < 1e-13);
  }
}

TEST_CASE("what surfaces that move give is in the books: a belt that is faster, a table that lifts") {
  const auto belt = run_text(
      "dimensionless\nparam g = 9.81, μ = 0.2\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -g)\n"
      "contact y >= 0 friction μ static 0.25 slip x' - 3 t name floor\n",
      2);
  const double force = 0.2 * 9.81;
  CHECK(belt.books->moving == doctest::Approx(force * 6).epsilon(1e-13));                  // the belt goes 6
  CHECK(belt.books->friction == doctest::Approx(force * (6 - 2 * force)).epsilon(1e-13));  // the block 2 F
  // Sticking it gives what the block gains.
  const auto carried = run_text(
      "dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -9.81)\n"
      "contact y >= 0 friction 0.5 slip x' - 3 t name floor\n",
      2);
  CHECK(carried.books->moving == doctest::Approx(18).epsilon(1e-13));
  CHECK(carried.books->friction == 0);
  const auto lift = run_text(
      "dimensionless\ncoord y : length\npoint P mass 2 at (0, y)\ngravity (0, -10)\ncontact y >= 0.5 t name table\n"
      "start y' = 0.5\n",
      3);
  CHECK(lift.books->moving == doctest::Approx(2 * 10 * 1.5).epsilon(1e-13));
}

TEST_CASE(
    "the friction that comes to its limit gives way where nothing has moved before, and where a slip only touches 0") {
  // w is at its 7.1199 first, u carries 10.4 of its 12; numbers of four digits, for what rounding makes of them.
  const auto first = run_text(
      "dimensionless\ncoord u, w : length\npoint A mass 0.71 at (u, 0)\npoint B mass 1.11 at (u + w, 0)\n"
      "force on A = (8.84*sin(2.41*t), 0)\nforce on B = (22*t - 30.88*(u + w - 0.12), 0)\n"
      "friction u limit 5.7 static 12\nfriction w limit 2.8 static 7.1199\n",
      0.3);
  REQUIRE(first.happenings.size() == 1);
  CHECK(first.happenings[0].name == "w");
  CHECK(first.happenings[0].t == doctest::Approx((7.1199 - 30.88 * 0.12) / 22).epsilon(1e-13));
  CHECK(std::abs(first.final.q[0]) < 1e-15);
  // w'' = −(9 t + 20 w − 4) from t = 4/9 on: its slip comes back to 0 and goes on; u carries 4 of its 50.
  for (const bool swapped : {false, true}) {
    const std::string u = "friction u limit 1 static 50\n", w = "friction w limit 4\n";
    const auto r = run_text(
        "dimensionless\ncoord u, w : length\npoint A mass 2 at (u, 0)\npoint C mass 1 at (u + w, 0)\n"
        "force on C = (-9*t - 20*(u + w), 0)\n" +
            (swapped ? w + u : u + w),
        3);
    const double late = 3 - 4 / 9.0, k = std::sqrt(20.0);
    CHECK(std::abs(r.final.q[0]) < 1e-14);
    CHECK(r.final.q[1] == doctest::Approx(-9 / 20.0 * (late - std::sin(k * late) / k)).epsilon(1e-10));
  }
}

TEST_CASE("what rests on friction rests for as long as a force oscillates that balances") {
  const auto r = run_text(
      "dimensionless\ncoord u, w : length\npoint P mass 1 at (u, 0)\npoint Q mass 2 at (u + w, 0)\n"
      "force on Q = (sin(4*t), 0)\nfriction u limit 20\nfriction w limit 20\n",
      20);
  CHECK(r.happenings.empty());
  for (const double q : r.final.q) CHECK(std::abs(q) < 1e-15);
}

TEST_CASE("a stack that comes to rest is held entirely where it can be, in whatever order its contacts are written") {
  // At 0.12433 all four can hold; motions in which the second one slides keep their own conditions as well.
  const std::string contacts[] = {"contact y0 >= 0 friction 0.19 static 0.75 slip x0' name c0\n",
                                  "contact y1 - y0 >= 0 friction 0.11 static 0.46 slip x1' - x0' name c1\n",
                                  "contact y2 - y1 >= 0 friction 0.13 static 0.62 slip x2' - x1' name c2\n",
                                  "contact y3 - y2 >= 0 friction 0.38 slip x3' - x2' name c3\n"};
  const auto stack = [&](std::initializer_list<int> order) {
    std::string text =
        "dimensionless\ncoord x0, y0, x1, y1, x2, y2, x3, y3 : length\npoint P0 mass 1.63 at (x0, y0)\n"
        "point P1 mass 0.73 at (x1, y1)\npoint P2 mass 0.38 at (x2, y2)\npoint P3 mass 1.24 at (x3, y3)\n"
        "gravity (0, -9.81)\nV += 7.62*(x1 + 0.41)^2 + 8.4*(x2 + 0.21)^2 + 14.045*(x2 - x3)^2\n"
        "force on P1 = (1.92*sin(4.41*t), 0)\nforce on P2 = (14.64*sin(4.71*t), 0)\n";
    for (const int k : order) text += contacts[k];
    return run_text(text + "start x2' = -0.94\n", 1.01);
  };
  const auto up = stack({0, 1, 2, 3}), down = stack({3, 2, 1, 0});
  const auto rests = [](const SimulationResult& r) {
    return std::any_of(r.happenings.begin(), r.happenings.end(), [](const Happening& h) {
      return std::abs(h.t - 0.12432803139851512) < 1e-12 && h.mode.find("sliding") == std::string::npos;
    });
  };
  CHECK(rests(up));
  CHECK(rests(down));
  for (std::size_t i = 0; i < up.final.q.size(); ++i)
    CHECK(up.final.q[i] == doctest::Approx(down.final.q[i]).scale(1).epsilon(1e-12));
}

namespace {

/// The upper blocks are held by friction whose forces are rounding.
const std::string stack_at_rest =
    "dimensionless\ncoord x0, y0, x1, y1, x2, y2, x3, y3 : length\npoint P0 mass 1.24 at (x0, y0)\n"
    "point P1 mass 2.43 at (x1, y1)\npoint P2 mass 2.87 at (x2, y2)\npoint P3 mass 1.14 at (x3, y3)\n"
    "gravity (0, -9.81)\nV += 12.82*(x0 - 0.48)^2 + 2.63*(x1 - 0.48)^2\n"
    "contact y0 >= 0 friction 0.4 static 0.66 slip x0' name c0\n"
    "contact y1 - y0 >= 0 friction 0.2 static 0.39 slip x1' - x0' name c1\n"
    "contact y2 - y1 >= 0 friction 0.12 static 0.39 slip x2' - x1' name c2\n"
    "contact y3 - y2 >= 0 friction 0.21 slip x3' - x2' name c3\n";

}  // namespace

TEST_CASE("blocks on an incline by x and y, and stacks, rest for ten thousand seconds to the last bit") {
  // Rounding of forces that balance leaves q'' of some 1e-16, by which one long step would move a block by 1e-8.
  const std::string block =
      "dimensionless\ncoord x, y : length\npoint P mass 1.701 at (x, y)\ngravity (0, -9.81)\n"
      "contact y - 0.225*x >= 0 friction 0.689 slip (x' + 0.225*y')/sqrt(1 + 0.225^2) name f\n"
      "start x = 0.787, y = 0.225*0.787\n";
  for (const char* force : {"0", "0.1*sin(t)", "0.01*t/1000"}) {
    CAPTURE(force);
    const auto r = run_text(block + "force on P = (" + force + ", 0)\n", 1e4);
    CHECK(r.final.q[0] == 0.787);
    CHECK(r.final.v[0] == 0);
  }
  const auto stack = run_text(stack_at_rest, 1e4);
  CHECK(stack.statistics.steps < 10);
  for (const double q : stack.final.q) CHECK(q == 0);
}

TEST_CASE("forces that balance move nothing however they grow, and leave no energy to drift") {
  for (const char* force : {"0.7*sin(3*t)", "-1.6*t", "0.155"}) {
    CAPTURE(force);
    const auto r = run_text(
        "dimensionless\ncoord u, w : length\npoint P mass 2.2 at (u, 0)\npoint Q mass 2.7 at (u + w, 0)\n"
        "force on P = (0.3*cos(2*t), 0)\nforce on Q = (" +
            std::string(force) + ", 0)\nfriction u limit 27 static 33\nfriction w limit 24 static 31\n",
        4);
    for (const double q : r.final.q) CHECK(q == 0);
    CHECK(r.statistics.energy_drift == 0);
  }
}

TEST_CASE("what is carried along slowly is not at rest") {
  const auto r = run_text(
      "dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -9.81)\n"
      "contact y >= 0 friction 0.5 slip x' - 1e-11*cos(t) name table\nstart x' = 1e-11\n",
      20);
  CHECK(r.first_mode == "table sticking");
  CHECK(r.final.q[0] / (1e-11 * std::sin(20.0)) == doctest::Approx(1).epsilon(1e-4));
  const auto steady = run_text(
      "dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -9.81)\n"
      "contact y - 0.2*x >= 0 friction 0.5 slip (x' + 0.2*y')/sqrt(1 + 0.2^2) - 1e-12 name table\n"
      "start x' = 1e-12/sqrt(1 + 0.2^2), y' = 0.2e-12/sqrt(1 + 0.2^2)\n",
      1e4);
  CHECK(steady.final.q[0] / (1e-8 / std::sqrt(1.04)) == doctest::Approx(1).epsilon(1e-13));
}

TEST_CASE("friction that is nothing but rounding is told as 0, with what is known of it") {
  ModelText m(stack_at_rest);
  SimulationOptions options;
  options.duration = 3;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  REQUIRE(r->final.errors);
  std::size_t rounding = 0;
  for (std::size_t i = 0; i < r->final.reactions.size(); ++i) {
    const double force = std::abs(r->final.reactions[i]);
    if (force == 0 || force > 1e-3) continue;
    CHECK(r->final.errors->reactions[i] >= force);
    ++rounding;
  }
  CHECK(rounding > 0);
}

TEST_CASE("where static friction leaves a choice as a slip stops, it is told with both, and nowhere else") {
  const std::string row =
      "dimensionless\ncoord u, v, w : length\npoint P mass 1.96 at (u, 0)\npoint Q mass 1.02 at (u + v, 0)\n"
      "point R mass 0.8 at (u + v + w, 0)\nforce on P = (2.79*t, 0)\nV += 15.825*(u + v + w - 0.42)^2\n";
  const std::string first = "friction u limit 12.98 static 25.22\n", second = "friction v limit 3.57 static 3.57\n",
                    third = "friction w limit 2.04 static 5.02\n";
  const auto tells = [](const SimulationResult& r, const std::string& part) {
    return std::any_of(r.remarks.begin(), r.remarks.end(), [&](const std::string& s) {
      return s.find("Static friction leaves a choice at t = 0.99") == 0 && s.find(part) != std::string::npos;
    });
  };
  const auto forwards = run_text(row + first + second + third, 3),
             backwards = run_text(row + third + second + first, 3);
  CHECK(tells(forwards, "v is held and w begins to slide"));
  CHECK(tells(backwards, "w is held and v begins to slide"));
  // Without static friction above the kinetic one only one motion is right, in whatever order they are written.
  const std::string plain = "friction w limit 5.02\n";
  const auto one = run_text(row + first + second + plain, 3), other = run_text(row + plain + second + first, 3);
  for (const auto* r : {&one, &other}) CHECK(r->remarks.empty());
  for (std::size_t i = 0; i < 3; ++i) CHECK(one.final.q[i] == doctest::Approx(other.final.q[i]).epsilon(1e-13));
}

namespace {

/// A wheel in a corner that a torque turns towards the wall.
std::string wheel_in_a_corner(const std::string& torque, const std::string& floor, const std::string& wall) {
  return "param m = 10 kg, R = 0.3 m, g = 9.81 m/s^2, c = 10 N m/s, a = 1 s\ncoord x, y : length, θ : angle\n"
         "body W mass m inertia m R^2/2 at (x, y) rotation angle θ\ntorque on W = " +
         torque +
         "\ngravity (0, -g)\n"
         "contact y >= R friction " +
         floor + " slip x' + R θ' name floor\ncontact x >= R friction " + wall +
         " slip y' - R θ' name wall\nstart x = R, y = R\n";
}

}  // namespace

TEST_CASE("a wheel in a corner rests under a torque that begins, until floor and wall both slide") {
  const double most = 0.3 * 9.81 * 10 / (1 + 0.4 * 0.3) * (0.4 + 0.4 * 0.3);  // torque that friction can hold
  const double ratio = most / 10;                                             // of c × 1 s
  struct Beginning {
    std::string torque;
    double t;
  };
  for (const Beginning& begins :
       {Beginning{"c t", ratio}, Beginning{"c t^2/a", std::sqrt(ratio)}, Beginning{"c t^3/a^2", std::cbrt(ratio)},
        Beginning{"c t^4/a^3", std::pow(ratio, 0.25)}, Beginning{"2 c a sin(t/a)", std::asin(ratio / 2)}}) {
    const auto r = run_text(wheel_in_a_corner(begins.torque, "0.4", "0.3"), 3);
    CHECK(r.first_mode == "floor sticking, wall sticking");
    REQUIRE(r.happenings.size() >= 2);
    CHECK(r.happenings[0].t == doctest::Approx(begins.t).epsilon(1e-11));
    CHECK(r.happenings[1].mode == "floor sliding +, wall sliding −");
    CHECK(r.final.q[0] == doctest::Approx(0.3).epsilon(1e-15));
    CHECK(r.final.q[1] == doctest::Approx(0.3).epsilon(1e-15));
  }
  const auto r = run_text(wheel_in_a_corner("c t", "0.4", "0.3"), 3);
  // I θ'' = c t − most from then on
  CHECK(r.final.v[2] == doctest::Approx((5 * (9 - ratio * ratio) - most * (3 - ratio)) / 0.45).epsilon(1e-12));
  const auto away = run_text(wheel_in_a_corner("-c t", "0.4", "0.3"), 1);
  CHECK(away.first_mode == "floor sticking");
  CHECK(away.final.q[0] == doctest::Approx(0.3 + 10 / (6 * 1.5 * 10 * 0.3)).epsilon(1e-14));
}

TEST_CASE("a contact whose coefficient of friction is 0 is smooth") {
  // The wall holds x, and the floor what it can: c t = μ m g R.
  for (const bool in_space : {false, true}) {
    std::string text = wheel_in_a_corner("c t", "0.4", "0");
    if (in_space)
      text =
          "param m = 10 kg, R = 0.3 m, g = 9.81 m/s^2, c = 10 N m/s, μ = 0\n"
          "coord x, y, z : length, α, β, θ : angle\n"
          "body W mass m inertia diag(m R^2/2, m R^2/2, m R^2/2) at (x, y, z) rotation rpy (α, β, θ)\n"
          "torque on W = (0, 0, c t)\ngravity (0, -g, 0)\n"
          "contact y >= R friction 0.4 slip (x' + R θ', z') name floor\n"
          "contact x >= R friction μ slip (y' - R θ', z') name wall\nstart x = R, y = R\n";
    const auto r = run_text(text, 3);
    CHECK(r.first_mode == "floor sticking, wall");
    REQUIRE(r.happenings.size() == 1);
    CHECK(r.happenings[0].t == doctest::Approx(0.4 * 9.81 * 0.3).epsilon(1e-12));
    CHECK(r.final.reactions[0] == doctest::Approx(98.1).epsilon(1e-13));
    CHECK(r.final.reactions[1] == doctest::Approx(39.24).epsilon(1e-13));
  }
}

TEST_CASE("a block that would tip and slide at the same force rests until then") {
  const std::string block =
      "param m = 10 kg, b = 0.5 m, h = 1 m, g = 9.81 m/s^2, c = 10 N/s\ncoord x, y : length, θ : angle\n"
      "body K mass m inertia m (b^2 + h^2)/12 at (x, y) rotation angle θ\n"
      "point pl at (-b/2, -h/2) in K\npoint pr at (b/2, -h/2) in K\n"
      "gravity (0, -g)\nforce on K = (c t, 0)\n"
      "contact pl.y >= 0 friction 0.5 slip pl.x' name left\ncontact pr.y >= 0 friction 0.5 slip pr.x' name right\n"
      "start y = h/2\n";
  const auto r = run_text(block, 6);
  const double begins = 0.5 * 98.1 / 10;
  CHECK(r.statistics.steps < 50);
  REQUIRE(!r.happenings.empty());
  CHECK(r.happenings.back().t == doctest::Approx(begins).epsilon(1e-10));
  // It slides: m x'' = c t − μ m g, and does not tip.
  CHECK(r.final.v[0] == doctest::Approx(5 * std::pow(6 - begins, 2) / 10).epsilon(1e-9));
  CHECK(std::abs(r.final.q[2]) < 1e-12);
}

// Modes of contacts and friction in many digits, against closed forms in decimals.
#include "../under_sanitizers.hpp"
#include "decimal.hpp"

#include <fstream>
#include <span>
#include <sstream>

using namespace maupertuis;

namespace {

std::vector<ExtendedHappening> all_of_kind(const ExtendedResult& r, Happening::Kind kind) {
  std::vector<ExtendedHappening> out;
  for (const ExtendedHappening& h : r.happenings)
    if (h.kind == kind) out.push_back(h);
  return out;
}

ExtendedResult run_for(const std::string& text, const Rational& duration) {
  ExtendedSimulationOptions options = digits100();
  options.duration = duration;
  ExtendedResult out = run(ModelText(text), options);
  INFO(out.reason);
  REQUIRE(out.ok());
  return out;
}

}  // namespace

TEST_CASE("a block that slides up an incline stops at v/(g (sin α + μ cos α)), and stays") {
  const ExtendedResult r = run_for(
      "dimensionless\nparam g = 9.81, a = 0.4, u = 0.6\ncoord s, n : number\nT = 1/2 (s'^2 + n'^2)\n"
      "V = g (s sin a + n cos a)\ncontact n >= 0 friction u slip s' name plane\nstart s' = 2\n",
      1);
  const Decimal a("0.4"), pull = Decimal("9.81") * (sin(a) + Decimal("0.6") * cos(a));
  const auto stops = all_of_kind(r, Happening::Kind::Stick);
  REQUIRE(stops.size() == 1);
  check_digits(stops.front().t, 2 / pull, 95);
  check_digits(r.final.q[0], 2 / pull, 95);  // v²/(2 a) with v = 2
  CHECK(r.final.v[0].text == "0");
}

TEST_CASE("a block on a belt sticks for 2 ΔF/(k v) and slips for (π + 2 atan(v k/(w ΔF)))/w") {
  const ExtendedResult r = run_for(
      "dimensionless\nparam k = 100, g = 9.81, u = 0.3, us = 0.4, b = 0.2\ncoord x, z : number\n"
      "T = 1/2 (x'^2 + z'^2)\nV = 1/2 k x^2 + g z\ncontact z >= 0 friction u static us slip x' - b name belt\n"
      "start x' = b\n",
      3);
  const Decimal fall("0.981"), pi = 4 * atan(Decimal(1));
  const Decimal holds = 2 * fall / 20, slides = (pi + 2 * atan(Decimal(20) / (10 * fall))) / 10;
  Decimal slip("0.19620"), stick = slip + slides;
  const auto slips = all_of_kind(r, Happening::Kind::Slip), sticks = all_of_kind(r, Happening::Kind::Stick);
  REQUIRE(slips.size() == 5);
  REQUIRE(sticks.size() == 4);
  for (std::size_t k = 0; k < sticks.size(); ++k) {
    check_digits(slips[k].t, slip, 90);
    check_digits(sticks[k].t, stick, 90);
    slip += holds + slides, stick += holds + slides;
  }
}

TEST_CASE("dry friction of a coordinate takes 2 F/k from the amplitude of each half swing, and holds at last") {
  const ExtendedResult r = run_for(
      "dimensionless\nparam F = 0.3\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nfriction x limit F\n"
      "start x = 2\n",
      12);
  const Decimal pi = 4 * atan(Decimal(1));
  const auto stops = all_of_kind(r, Happening::Kind::Stick), turns = all_of_kind(r, Happening::Kind::Slip);
  REQUIRE(turns.size() == 2);  // 2 → −1.4 → 0.8 → −0.2, where 0.3 holds
  for (std::size_t k = 0; k < 2; ++k) check_digits(turns[k].t, (k + 1) * pi, 90);
  REQUIRE(stops.size() == 1);
  check_digits(stops.front().t, 3 * pi, 90);
  check_digits(r.final.q[0], Decimal("-0.2"), 90);
}

TEST_CASE("an impact with friction takes μ (1 + e) of the speed of approach from a slip that goes on") {
  const ExtendedResult r = run_for(
      "dimensionless\nparam g = 9.81\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = g z\n"
      "contact z >= 0 restitution 0.5 friction 0.1 slip x' name floor\nstart z = 1, x' = 3\n",
      Rational::from_double(0.5));
  const Decimal speed = sqrt(2 * Decimal("9.81"));
  check_digits(r.final.v[0], 3 - Decimal("0.15") * speed, 90);
  check_digits(r.final.v[1], speed / 2 - Decimal("9.81") * (Decimal("0.5") - speed / Decimal("9.81")), 90);
}

TEST_CASE("what falls onto an incline sticks to it: all that moves is what rounding left") {
  const std::string text =
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 10 y\n"
      "contact 0.8 y - 0.6 x >= 0 friction 0.9 slip 0.8 x' + 0.6 y' name plane\nstart y = 1\n";
  ExtendedSimulationOptions options;
  options.duration = 1;
  for (const Precision precision : {Precision::Quad, Precision::Digits100}) {
    options.precision = precision;
    const ExtendedResult r = run(ModelText(text), options);
    INFO(r.reason);
    REQUIRE(r.ok());
    check_digits(r.final.t, 1, 33);
    check_zero(r.final.q[0], 1e-30);
    check_zero(r.final.q[1], 1e-30);
    check_digits(r.final.reactions[0], 8, 30);
    check_digits(r.final.reactions[1], 6, 30);
  }
}

TEST_CASE("three balls in a row that are hit at once share the impact by complementarity") {
  const ExtendedResult r = run_for(
      "dimensionless\ncoord a, b, c : number\nT = 1/2 (a'^2 + b'^2 + c'^2)\n"
      "contact b - a >= 1 restitution 0.7 name ab\ncontact c - b >= 1 restitution 0.7 name bc\nimpact simultaneous\n"
      "start a = -1/3, b = 1, c = 2, a' = 1\n",
      1);
  const auto hits = all_of_kind(r, Happening::Kind::Impact);
  REQUIRE(hits.size() == 2);
  // 2 Λ1 − Λ2 = 1 + e, 2 Λ2 − Λ1 = 0
  const Decimal second = Decimal("1.7") / 3, first = 2 * second;
  check_digits(hits[0].t, Decimal(1) / 3, 95);
  check_digits(hits[0].impulse, first, 95);
  check_digits(hits[1].impulse, second, 95);
  check_digits(r.final.v[0], 1 - first, 95);
  check_digits(r.final.v[1], first - second, 95);
  check_digits(r.final.v[2], second, 95);
}

TEST_CASE("impacts at once: a contact that is hit alone has its friction, and is open where an event sets it so") {
  const std::string ball =
      "dimensionless\nparam g = 8\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = g y\n"
      "contact y >= 0 restitution 1/2 friction 1/4 slip x' name floor\nimpact simultaneous\n";
  const ExtendedResult hit = run_for(ball + "start x' = 3, y = 1\n", Rational(3, 4));  // it falls with 4 after 1/2
  check_digits(hit.final.v[0], Decimal("1.5"), 95);
  check_digits(hit.final.v[1], 0, 95);
  const ExtendedResult set = run_for(ball + "event up when x = 1 : set y = 1\nstart x' = 3, x = -1/8\n", 1);
  const auto lost = all_of_kind(set, Happening::Kind::Lost);
  REQUIRE(lost.size() == 1);  // x' = 3 − 2 t, x = 1 at t = (3 − √4.5)/2
  check_digits(lost.front().t, (3 - sqrt(Decimal("4.5"))) / 2, 95);
}

TEST_CASE("a particle leaves a sphere where its height is (2 + v²/(g R))/3 of the radius") {
  const ExtendedResult r = run_for(
      "dimensionless\nparam g = 9.81, v0 = 0.5\ncoord r, w : number\nT = 1/2 (r'^2 + r^2 w'^2)\nV = g r cos w\n"
      "contact r >= 1 name sphere\nstart r = 1, w' = v0\n",
      1);
  const auto lost = all_of_kind(r, Happening::Kind::Lost);
  REQUIRE(lost.size() == 1);
  const Decimal height = (2 + Decimal("0.25") / Decimal("9.81")) / 3;
  check_digits(lost.front().q[1], acos(height), 80);
}

TEST_CASE("an event that sets the speed to a third at each fall through 0") {
  const ExtendedResult r = run_for(
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 1\n"
      "event back when x = 0 falling : set x' = -x'/3\n",
      7);
  const Decimal pi = 4 * atan(Decimal(1));
  const auto events = all_of_kind(r, Happening::Kind::Event);
  REQUIRE(events.size() == 2);  // at π/2 and 3π/2: from v = −1 to 1/3, from −1/3 to 1/9
  check_digits(events[0].t, pi / 2, 95);
  check_digits(events[1].t, 3 * pi / 2, 95);
  check_digits(r.final.q[0], sin(Decimal(7) - 3 * pi / 2) / 9, 95);
}

TEST_CASE("sets at zeros of every kind happen once at each, at kinks too") {
  const auto count = [](const std::string& condition, const std::string& set) {
    ExtendedSimulationOptions options;  // 113 bits
    options.duration = 5;
    CAPTURE(condition);
    CAPTURE(set);
    const ExtendedResult r =
        run(ModelText("dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = 9/2 x^2 + 1/2 y^2\n"
                      "start x = 0.0709, x' = 0.4342, y' = 0.3\nevent e when " +
                      condition + " : set " + set + "\n"),
            options);
    CHECK(r.ok());
    return r.happenings.size();
  };
  for (const char* set : {"x' = -x'", "x' = 1.01 x'", "y' = 0.9 y'"}) {
    // x = r cos(3 t − φ): zeros π/3 apart, whether it goes on or is thrown back.
    for (const char* zero : {"abs(x) = 0", "x*abs(x) = 0", "abs(sin(3 x)) = 0", "x^3 = 0", "x^2 = 0"})
      CHECK(count(zero, set) == 4);
    CHECK(count("abs(sin(3 t)) = 0", set) == 5);  // with t = 0
  }
}

TEST_CASE("what an event sets is refused where it breaks a constraint") {
  ExtendedSimulationOptions options;
  options.duration = 2;
  const ExtendedResult r =
      run(ModelText("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = y\nconstraint x^2 + y^2 = 1\n"
                    "start x = -0.6, y = -0.8\nevent off when x = 0.1 rising : set x = -0.11\n"),
          options);
  CHECK(r.ending == Ending::ImpossibleState);
}

TEST_CASE("models of the gallery meet in quad what they meet in double, at times within the errors of double") {
  const char* const names[] = {"ball_on_string", "newtons_cradle",    "stick_slip",
                               "rocking_block",  "bouncing_dumbbell", "dry_hoop",
                               "sliding_ladder", "two_link_hopper",   "wheel_brake"};
  for (const char* const name : std::span(names).first(under_sanitizers ? 3 : std::size(names))) {
    CAPTURE(std::string(name));
    std::ostringstream text;
    text << std::ifstream(std::string(PROJECT_DIR) + "/models/" + name + ".lag").rdbuf();
    ModelText m(text.str());
    const ExtendedResult quad = run(m, {});
    const auto rough = simulate(m.model, m.equations, {}, m.diagnostics);
    REQUIRE(rough);
    CHECK(quad.ok());
    REQUIRE(quad.happenings.size() == rough->happenings.size());
    for (std::size_t i = 0; i < quad.happenings.size(); ++i) {
      const Happening& h = rough->happenings[i];
      CHECK(quad.happenings[i].kind == h.kind);
      CHECK(quad.happenings[i].name == h.name);
      CHECK(quad.happenings[i].t.digits >= 25);
      CHECK(std::abs(std::stod(quad.happenings[i].t.text) - h.t) <= 4 * h.error + 1e-15);
    }
  }
}

TEST_CASE(
    "the friction that comes to its limit gives way, and what can hold holds, in whatever order two are written") {
  const std::string between = "contact y - Y >= 1 friction 0.1 static 0.4 slip x' - X' name between\n",
                    floor = "contact Y >= 0 friction 0.1 slip X' name floor\n";
  for (const std::string& contacts : {between + floor, floor + between}) {
    const ExtendedResult r = run_for(
        "dimensionless\nparam g = 10\ncoord X, Y, x, y : length\npoint lower mass 1 at (X, Y)\n"
        "point upper mass 1 at (x, y)\ngravity (0, -g)\n" +
            contacts + "force x = t\nstart y = 1\n",
        3);
    check_digits(r.final.q[0], Decimal(1) / 12, 95);
    check_digits(r.final.q[2], Decimal(1) / 12, 95);
  }
  const std::string upper = "contact Y - y >= 1 friction 0.44 static 0.58 slip X' - x' name between\n",
                    lower = "contact y >= 0 friction 0.2 static 0.35 slip x' name floor\n";
  for (const std::string& contacts : {lower + upper, upper + lower}) {
    const ExtendedResult r = run_for(
        "dimensionless\ncoord x, y, X, Y : length\npoint A mass 0.54 at (x, y)\npoint B mass 1.3 at (X, Y)\n"
        "gravity (0, -10)\n" +
            contacts + "force on B = (-22.9, 0)\nstart Y = 1, x' = 1, X' = 1\n",
        Rational(3, 10));
    const Decimal a = (Decimal("22.9") + Decimal("0.2") * Decimal("18.4")) / Decimal("1.84"),
                  rest = Decimal("0.3") - 1 / a, b = (Decimal("22.9") - Decimal("0.44") * 13) / Decimal("1.3");
    check_digits(r.final.q[0], 1 / (2 * a), 95);
    check_digits(r.final.q[2], 1 / (2 * a) - b * rest * rest / 2, 94);
  }
}

TEST_CASE("what rests on friction rests in many digits too, while a force that balances begins at 0") {
  const ExtendedResult r = run_for(
      "dimensionless\ncoord u, w : length\npoint P mass 1 at (u, 0)\npoint Q mass 2 at (u + w, 0)\n"
      "force on Q = (sin(4*t), 0)\nfriction u limit 20\nfriction w limit 20\n",
      2);
  CHECK(r.happenings.empty());
}

TEST_CASE("a function that stays at 0 since it was set has no root, and one that comes to 0 at the end has") {
  const Decimal pi = 4 * atan(Decimal(1));
  const std::string oscillator =
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nevent zero when x = 0 : set x' = 0\n";
  for (const Precision precision : {Precision::Quad, Precision::Digits100}) {
    ExtendedSimulationOptions options;
    options.precision = precision, options.duration = 30;
    const ExtendedResult rests = run(ModelText(oscillator + "start x = 11/10, x' = 1/7\n"), options);
    CHECK(rests.remarks.empty());
    REQUIRE(rests.happenings.size() == 1);
    check_digits(rests.happenings[0].t, pi / 2 + atan(1 / Decimal("7.7")), precision == Precision::Quad ? 31 : 95);

    options.duration = 3;
    const ExtendedResult ends =
        run(ModelText("dimensionless\ncoord x : number\nT = 1/2 x'^2\nevent tick when sin(pi t) = 0 : record\n"
                      "event mid when x = 3 rising : record\nevent down when x = 3 falling : record\nstart x' = 1\n"),
            options);
    CHECK(ends.remarks.empty());
    REQUIRE(ends.happenings.size() == 5);
    check_digits(ends.happenings.back().t, 3, 31);
  }
}

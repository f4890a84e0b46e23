// Impacts and events in many digits: closed forms in decimals, and two precisions that agree.
#include "decimal.hpp"

#include <fmt/format.h>

using namespace maupertuis;

namespace {

const std::string ball =
    "dimensionless\nparam g = 9.81\ncoord z : number\nT = 1/2 z'^2\nV = g z\ncontact z >= 0 restitution 0.8 name "
    "floor\n"
    "start z = 1\n";

std::vector<ExtendedHappening> of_kind(const ExtendedResult& r, Happening::Kind kind) {
  std::vector<ExtendedHappening> out;
  for (const ExtendedHappening& h : r.happenings)
    if (h.kind == kind) out.push_back(h);
  return out;
}

}  // namespace

TEST_CASE("a bouncing ball hits the floor at t_0 (1 + 2 Σ e^j), with e^k times the first speed") {
  ExtendedSimulationOptions options = digits100();
  options.duration = 3;
  const ExtendedResult r = run(ModelText(ball), options);
  REQUIRE(r.ok());
  const Decimal first = sqrt(Decimal(2) / Decimal("9.81")), e("0.8");
  Decimal time = first, speed = Decimal("9.81") * first, power = 1;
  const auto hits = of_kind(r, Happening::Kind::Impact);
  REQUIRE(hits.size() > 5);
  for (const ExtendedHappening& h : hits) {
    CHECK(h.name == "floor");
    check_digits(h.t, time, 60);
    check_digits(h.speed, speed, 60);
    check_digits(h.impulse, speed * (1 + e), 60);
    power *= e;
    time += 2 * first * power;
    speed *= e;
  }
  CHECK(time > Decimal(3));  // none is left out
}

TEST_CASE("infinitely many bounces end at t_0 (1 + e)/(1 - e), and the ball lies still from then on") {
  ExtendedSimulationOptions options;
  options.duration = 6;
  const ExtendedResult r = run(ModelText(ball), options);
  REQUIRE(r.ok());
  const auto made = of_kind(r, Happening::Kind::Made);
  REQUIRE(made.size() == 1);
  CHECK(made.front().name == "floor");
  check_digits(made.front().t, 9 * sqrt(Decimal(2) / Decimal("9.81")), 27);
  CHECK(of_kind(r, Happening::Kind::Impact).size() > 100);
  check_zero(r.final.q[0], 1e-28);
  CHECK(r.final.v[0].text == "0");
}

TEST_CASE("two balls of 3 : 1 above each other rise with (0, 2) times the speed of their fall") {
  const std::string text =
      "dimensionless\ncoord a, b : number\nT = 3/2 a'^2 + 1/2 b'^2\ncontact a >= 0 restitution 1 name floor\n"
      "contact b >= a + 1 restitution 1 name balls\nstart a = 1, b = 2 + 1e-40, a' = -1, b' = -1\n";
  ExtendedSimulationOptions options = digits100();
  options.duration = 2;
  const ExtendedResult r = run(ModelText(text), options);
  REQUIRE(r.ok());
  check_zero(r.final.v[0], 1e-90);
  check_digits(r.final.v[1], 2, 90);
}

TEST_CASE("events of an oscillator are told at π/6 + 2 π k, one stops the run") {
  const std::string text =
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 0, x' = 1\n"
      "event up when x = 0.5 rising : record\n";
  ExtendedSimulationOptions options = digits100();
  options.duration = 20;
  const ExtendedResult r = run(ModelText(text), options);
  REQUIRE(r.happenings.size() == 4);
  const Decimal pi = 4 * atan(Decimal(1));
  for (int k = 0; k < 4; ++k) check_digits(r.happenings[static_cast<std::size_t>(k)].t, pi / 6 + 2 * k * pi, 90);
  const ExtendedResult stopped = run(ModelText(text + "event end when x' = 0 falling : stop\n"), options);
  CHECK(stopped.ending == Ending::Stopped);
  check_digits(stopped.final.t, pi / 2, 90);
}

TEST_CASE("events at kinks of their formulas are met once each") {
  const Decimal pi = 4 * atan(Decimal(1));
  const auto check = [&](const std::string& condition, const std::vector<Decimal>& expected) {
    ExtendedSimulationOptions options;  // 113 bits
    options.duration = 10;
    const ExtendedResult r =
        run(ModelText("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + y^2)\n"
                      "start x = 1, y' = 1\nevent e when " +
                      condition + " : record\n"),
            options);
    CAPTURE(condition);
    REQUIRE(r.happenings.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) check_digits(r.happenings[k].t, expected[k], 15);
  };
  const std::vector<Decimal> zeros = {pi / 2, 3 * pi / 2, 5 * pi / 2};
  for (const char* kink : {"abs(x) = 0", "x*abs(x) = 0", "abs(x) + x^2 = 0", "min(x, 2 x) = 0", "sqrt(abs(x)) = 0"})
    check(kink, zeros);
  check("x*abs(x) = 0 falling", {zeros[0], zeros[2]});
  check("max(x, y) = 0.5", {5 * pi / 6, 5 * pi / 3, 17 * pi / 6});
  check("abs(x) = x", {zeros[1]});
}

TEST_CASE("sixty reflections in a stadium: a hundred digits agree with all that quad claims, and lie on the wall") {
  const std::string text =
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact max(abs(x) - 1, 0)^2 + y^2 <= 1 restitution 1\nstart x = 0.1, y = 0.2, x' = 0.8, y' = 0.6\n";
  ExtendedSimulationOptions quad, many = digits100();
  quad.duration = many.duration = 150;
  const auto rough = of_kind(run(ModelText(text), quad), Happening::Kind::Impact),
             fine = of_kind(run(ModelText(text), many), Happening::Kind::Impact);
  REQUIRE(rough.size() >= 60);
  REQUIRE(fine.size() >= 60);
  for (std::size_t k = 0; k < 60; ++k) {
    const Decimal x(fine[k].q[0].text), y(fine[k].q[1].text), over = abs(x) > 1 ? abs(x) - 1 : Decimal(0);
    CHECK(abs(over * over + y * y - 1) < Decimal("1e-60"));
    for (std::size_t i = 0; i < 2; ++i)
      if (rough[k].q[i].digits > 0) check_digits(rough[k].q[i], Decimal(fine[k].q[i].text), 1);
  }
  CHECK(fine[59].q[0].digits > 50);
}

TEST_CASE("backwards from a contact that opens at the start there is no motion in many digits either") {
  ExtendedSimulationOptions options;
  options.duration = -1;
  const ExtendedResult r = run(ModelText(ball.substr(0, ball.find("start")) + "start z = 0, z' = 3\n"), options);
  CHECK(r.ending == Ending::Paradox);
  CHECK(r.reason.find("Backwards in time the motion meets a change of contact here") != std::string::npos);
}

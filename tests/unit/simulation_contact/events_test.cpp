// Events on friction, at accumulations, at roots of higher order, with what they set; at a rate that no run can follow.
#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

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
  CHECK(r.reason.find("1000000 are followed at most") != std::string::npos);
  CHECK(r.happenings.size() < 10'000);
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

namespace {

/// Two lines through (x0, y0), inclined by a and b, that throw back a particle which falls between them.
std::string wedge(double x0, double y0, double a, double b, double give_back_a, double give_back_b) {
  const auto line = [&](const char* name, double angle, double e, int side) {
    const double nx = -side * std::sin(angle), ny = side * std::cos(angle);
    const std::string rate = fmt::format("({:.17g} x' + {:.17g} y')", nx, ny);
    return fmt::format(
        "event {0} when {1:.17g} (x - X) + {2:.17g} (y - Y) = 0 : set x' = x' - {3:.17g} {5}, y' = y' - {4:.17g} {5}\n",
        name, nx, ny, (1 + e) * nx, (1 + e) * ny, rate);
  };
  return fmt::format("dimensionless\nparam X = {:.17g}, Y = {:.17g}\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - y\n",
                     x0, y0) +
         line("a", a, give_back_a, 1) + line("b", b, give_back_b, -1) +
         fmt::format("start x = {:.17g}, y = {:.17g}, x' = 0.1\n", x0 + 0.05, y0 + 1);
}

}  // namespace

TEST_CASE("an event ends no step that passes it against its direction or touches it") {
  const auto of = [](const std::string& event) {
    return run_text(
        "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 x^2\nstart x = -1, y' = 1\n" + event, 3);
  };
  const std::size_t steps = of("").statistics.steps;
  for (const char* zero : {"x = 0 falling", "x + 0.9 = 0 falling", "cos(x + 1) = 0 rising", "sin(3 y) - 1 = 0 rising"})
    for (const char* does : {"stop", "set y' = 2 y'"}) {
      CAPTURE(zero);
      const auto r = of(std::string("event e when ") + zero + " : " + does + "\n");
      CHECK(r.statistics.steps == steps);
      CHECK(r.happenings.empty());
      CHECK(r.ending == Ending::Finished);
    }
}

TEST_CASE("events of one direction among many roots of a step are those that a record tells") {
  // Each of them sets what its condition does not read; in all directions of time and orders of the roots.
  const char* const conditions[] = {
      "sin(7 x) = 0",   "cos(11 y) = 0.3",   "sin(5 x) cos(9 x) = 0",    "cos(20 y) + 1 = 0", "abs(sin(6 x)) = 0.5",
      "sin(8 x)^3 = 0", "(x - 0.4)^2 x = 0", "max(sin(9 x), 0.2) = 0.2", "abs(sin(6 x)) = 0", "x abs(x) + 0.01 = 0"};
  for (const std::string condition : conditions)
    for (const std::string way : {"rising", "falling"}) {
      CAPTURE(condition);
      CAPTURE(way);
      const auto times = [&](const std::string& does) {
        const auto r = run_text(
            "dimensionless\ncoord x, y, z : number\nL = 1/2 (x'^2 + y'^2 + z'^2) - 1/2 (x^2 + y^2)\n"
            "start x = 1, y' = 0.8, z' = 1\nevent e when " +
                condition + " " + way + " : " + does + "\n",
            20);
        std::vector<double> out;
        for (const Happening& h : r.happenings) out.push_back(h.t);
        return out;
      };
      const std::vector<double> told = times("record"), met = times("set z' = -z'");
      REQUIRE(told.size() == met.size());
      for (std::size_t k = 0; k < told.size(); ++k) CHECK(std::abs(told[k] - met[k]) < 1e-7);
    }
}

TEST_CASE("a set at a kink through which the motion goes on happens once at each zero") {
  for (const char* zero : {"x = 0", "x abs(x) = 0", "abs(x) = 0", "max(x, 2 x) = 0"})
    for (const char* way : {"", "falling "}) {
      if (std::string(zero) == "abs(x) = 0" && *way) continue;  // it falls nowhere: it goes back
      CAPTURE(zero);
      CAPTURE(way);
      ModelText m(std::string("dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = 4.5 x^2\n"
                              "start x = 1, y' = 1\nevent e when ") +
                  zero + " " + way + ": set y' = 0.5 y'\n");
      const auto r = run(m, 10);
      CHECK(r.ending == Ending::Finished);
      const double pi = std::acos(-1.0), half = pi / 3;  // 10 of them: zeros at half/2 + k half
      const int zeros = *way ? 5 : 10;
      REQUIRE(count(r, Happening::Kind::Event) == zeros);
      for (int k = 0; k < zeros; ++k)
        CHECK(r.happenings[k].t == doctest::Approx((k * (*way ? 2 : 1) + 0.5) * half).epsilon(1e-7));
      CHECK(r.final.v[1] == doctest::Approx(std::pow(0.5, zeros)).epsilon(1e-14));
    }
}

TEST_CASE("events at a kink and beside it are told where an impact ends the step") {
  for (const char* kink : {"abs(x) = 0", "sqrt(x^2) = 0", "min(x, -x) = 0", "min(x, x^2) = 0", "x abs(x) = 0",
                           "x + abs(x) = 0", "max(x, -x) = 0"}) {
    CAPTURE(kink);
    ModelText m(std::string("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 9.81 x\nstart x = 1\n"
                            "contact x >= 0 restitution 0.5 name floor\nevent a when x = 0 : record\nevent b when ") +
                kink + " : record\n");
    const auto r = run(m, 1);
    const double fall = std::sqrt(2 / 9.81);
    REQUIRE(count(r, Happening::Kind::Event) == 4);
    REQUIRE(count(r, Happening::Kind::Impact) == 2);
    for (std::size_t k = 0; k < r.happenings.size(); ++k)
      CHECK(r.happenings[k].t == doctest::Approx(k < 3 ? fall : 2 * fall).epsilon(1e-12));
  }
}

TEST_CASE("events at several kinks of one step, beside a wall, are all told") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = 1/2 x^2 + 1/2 y^2\n"
      "contact x <= 1/2 restitution 0.5 name wall\nstart x = -1, y = sqrt(3)\n"
      "event c when abs(x - 1/2) = 0 : record\nevent d when abs(y) = 0 : record\nevent e when y = 0 : record\n"
      "event f when min(x + 1/2, y) = 0 : record\n");
  const auto r = run(m, 9);
  std::map<std::string, std::vector<double>> told;
  for (const Happening& h : r.happenings)
    if (h.kind == Happening::Kind::Event) told[h.name].push_back(h.t);
  const double pi = std::acos(-1.0);
  const std::vector<double> of_y{pi / 2, 3 * pi / 2, 5 * pi / 2};
  REQUIRE(told["d"].size() == 3);
  REQUIRE(told["e"].size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(told["d"][k] == doctest::Approx(of_y[k]).epsilon(1e-13));
    CHECK(told["e"][k] == doctest::Approx(of_y[k]).epsilon(1e-13));
  }
  CHECK(told["c"].size() == 2);
  CHECK(told["f"].size() == 4);
}

TEST_CASE("a set at a kink leaves the event beside it") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\nV = 1/2 x^2 + 1/2 y^2\nstart x = -1, y = 1\n"
      "event c when abs(y) = 0 : set y' = y'\nevent e when y = 0 : record\n");
  const auto r = run(m, 9);
  REQUIRE(count(r, Happening::Kind::Event) == 6);
  for (std::size_t k = 0; k < 6; ++k)
    CHECK(r.happenings[k].t == doctest::Approx((static_cast<double>(k / 2) + 0.5) * std::acos(-1.0)).epsilon(1e-13));
}

TEST_CASE("a motion that is thrown back from a kink is met once at each return") {
  for (const double start : {1.0, 0.9, 0.77, 1.3})
    for (const char* zero : {"x = 0", "x abs(x) = 0"}) {
      CAPTURE(start);
      CAPTURE(zero);
      ModelText m(
          fmt::format("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 4.5 x^2\nstart x = {}\n"
                      "event e when {} : set x' = -x'\n",
                      start, zero));
      const auto r = run(m, 100);
      CHECK(r.ending == Ending::Finished);
      CHECK(count(r, Happening::Kind::Event) == 95);  // at π/6 + k π/3
    }
}

TEST_CASE("sets in a corner that follow each other infinitely often end the run: none is passed") {
  const double degree = std::acos(-1.0) / 180;
  std::size_t in_turns = 0;
  for (int k = 0; k < 40; ++k) {
    const double x0 = 0.37 * std::sin(3 * k), y0 = 0.41 * std::cos(5 * k);
    const double e[] = {0.3, 0.5, 0.8, 0.9};
    ModelText m(wedge(x0, y0, (20 + 1.5 * k) * degree, (100 + 37 * k % 60) * degree, e[k % 4], e[k / 4 % 4]));
    const auto r = run(m, 100);
    CAPTURE(k);
    INFO(r.reason);
    CHECK(r.ending == Ending::Unending);
    CHECK(std::hypot(r.final.q[0] - x0, r.final.q[1] - y0) < 3);
    // The energy above the last place is what the sets have left.
    const double energy = 0.5 * (r.final.v[0] * r.final.v[0] + r.final.v[1] * r.final.v[1]);
    CHECK(energy < 10);
    in_turns += r.reason.find("`a` and `b` follow each other") != std::string::npos;
  }
  CHECK(in_turns > 0);
}

TEST_CASE("a ball between two events that double its speed: the time at which its sets accumulate is told") {
  // Each flight is half as long as the one before: 1 + 1/2 + 1/4 + …
  const auto r = [&] {
    ModelText m(
        "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
        "event a when x = 0 : set x' = -2 x'\nevent b when x = 1 : set x' = -2 x'\nstart x' = 1\n");
    return run(m, 5);
  }();
  CHECK(r.ending == Ending::Unending);
  CHECK(r.reason.find("`a` and `b` follow each other faster and faster, infinitely often up to t = 2:") !=
        std::string::npos);
  CHECK(r.final.t == doctest::Approx(2).epsilon(1e-9));
  CHECK(r.happenings.size() < 100);
  // A run that ends before is none of that kind.
  ModelText earlier(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "event a when x = 0 : set x' = -2 x'\nevent b when x = 1 : set x' = -2 x'\nstart x' = 1\n");
  CHECK(run(earlier, 2 - 1e-7).ok());
}

TEST_CASE("roots of higher order are met once each, with errors that hold") {
  ModelText m(
      "param w = 1.3 /s, l = 1 m, m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 m w^2 x^2\n"
      "start x = -0.37 m, x' = 1 m/s\nevent third when x^3 = 0 [m^3] : record\n"
      "event both when x^3 + x^5/l^2 = 0 [m^3] : record\nevent sine when sin(x/l) - x/l = 0 : record\n"
      "event fifth when x^5 = 0 [m^5] : record\nevent touch when 2 (1 - cos(x/l)) - x^2/l^2 = 0 : record\n");
  SimulationOptions options;
  options.duration = 10;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  const double first = std::atan(0.37 * 1.3) / 1.3, half = std::acos(-1.0) / 1.3;
  for (const std::string name : {"third", "both", "sine", "fifth", "touch"}) {
    CAPTURE(name);
    const bool is_third = name != "fifth" && name != "touch";
    CHECK(count(*r, Happening::Kind::Event, name) == 4);
    double t = first;
    for (const Happening& h : r->happenings) {
      if (h.name != name) continue;
      CHECK(std::abs(h.t - t) <= h.error);
      if (is_third) CHECK(h.error < 0.01);
      t += half;
    }
  }
}

TEST_CASE("where such a root stops a run or sets its state, errors of the state hold") {
  const std::string model =
      "param w = 1.3 /s, l = 1 m, m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 m w^2 x^2\n"
      "start x = -0.37 m, x' = 1 m/s\nevent e when sin(x/l) - x/l = 0 : ";
  SimulationOptions options;
  options.duration = 1;
  ModelText stops(model + "stop\n");
  const auto stopped = simulate(stops.model, stops.equations, options, stops.diagnostics);
  REQUIRE(stopped);
  REQUIRE(stopped->final.errors);
  CHECK(std::abs(stopped->final.q[0]) <= stopped->final.errors->q[0]);
  CHECK(stopped->final.errors->q[0] < 1e-4);
  ModelText sets(model + "set x' = -x'\n");
  const auto set = simulate(sets.model, sets.equations, options, sets.diagnostics);
  REQUIRE(set);
  REQUIRE(set->final.errors);
  CHECK(count(*set, Happening::Kind::Event) == 1);
  const double since = 1 - std::atan(0.37 * 1.3) / 1.3;
  const double x = -std::hypot(1, 0.37 * 1.3) / 1.3 * std::sin(1.3 * since);
  CHECK(std::abs(set->final.q[0] - x) <= set->final.errors->q[0]);
  CHECK(set->final.errors->q[0] < 1e-4);
}

TEST_CASE("an event that sets what its function does not depend on is met once, at roots of every order") {
  const auto at = [](const std::string& events, double until) {
    return run_text("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nstart x = 0.5, x' = 1\n" + events,
                    until);
  };
  // cos t rises through zero at 3π/2 + 2πk: five times up to 30.
  CHECK(at("event e when cos(t) = 0 rising : set y = y + 1\n", 30).final.q[1] == 5);
  CHECK(at("event e when sin(pi t) = 0 : set y = y + 1\n", 9.5).final.q[1] == 9);
  const auto orders =
      at("event square when (x-1)^2 = 0 : set y = y + 1\nevent absolute when abs(x-2) = 0 : set y = y + 10\n"
         "event cube when (x-3)^3 = 0 rising : set y = y + 100\n",
         30);
  CHECK(orders.final.q[1] == 111);
  // What stands in the function is set: it is elsewhere then, and comes again.
  CHECK(at("event back when x - 1 = 0 rising : set x = 0, y = y + 1\n", 5).final.q[1] == 5);
}

TEST_CASE("an event on a velocity goes on from zero where no impact and no set changes it") {
  const auto r = run_text(
      "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 x^2\nstart x = 0.5\n"
      "event zero when x = 0 rising : set y = y + 1\nevent turn when x' = 0 : set y = y + 100\n",
      100);
  CHECK(r.final.q[1] == 3116);  // 16 times at 3π/2 + 2πk, 31 times at πk
}

TEST_CASE("an event that is still at its zero after what it sets, or whose forces are, is met once") {
  const auto kicks = [](const std::string& event, double until) {
    return run_text("dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 x^2\nstart x = 0.5\n" + event,
                    until)
        .final.q[1];
  };
  CHECK(kicks("event e when x = 0 rising : set x = -x, y = y + 1\n", 100) == 16);
  CHECK(kicks("event e when x = 0 rising : set x = x/3, y = y + 1\n", 100) == 16);
  CHECK(kicks("event e when x'' = 0 rising : set y = y + 1\n", 100) == 16);       // x falls through 0
  CHECK(kicks("event e when x = 0 rising : set x = -1e-6, y = y + 1\n", 6) > 1);  // it is below, and comes again
  // 0.5 cos t comes to each place 32 times; where it does is known to 1e-8 for a square, to 1e-5 for a cube.
  CHECK(kicks("event square when (x - pi/10)^2 = 0 : set y = y + 1\n"
              "event cube when (x - pi/11)^3 = 0 : set y = y + 100\n"
              "event kept_square when (x - pi/13)^2 = 0 : set x = x, y = y + 10000\n"
              "event kept_cube when (x - pi/14)^3 = 0 : set x = x, y = y + 1000000\n",
              100) == 32323232);
  const auto rod = run_text(
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y, n : length\npoint P mass m at (x, y)\nT += 1/2 m n'^2\n"
      "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\n"
      "event turn when λ_rod = 0 [N/m] : set n = n + 1 [m]\nstart x = 1 m, y = 0 m, y' = 3 m/s\n",
      5);
  CHECK(rod.final.q[2] == doctest::Approx(count(rod, Happening::Kind::Event, "turn")));
  CHECK(count(rod, Happening::Kind::Event, "turn") == 8);  // twice in each of the four upper parts of the way
}

TEST_CASE("an event that sets no number ends the run") {
  ModelText m(
      "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nevent e when x = 1 : set y = log(y)\nstart x' = 1\n");
  const auto r = run(m, 5);
  CHECK_FALSE(r.ok());
  CHECK(r.reason.find("The event `e` sets a state without a value") == 0);
  CHECK(r.final.t == doctest::Approx(1));
  CHECK(r.final.q == std::vector<double>{1, 0});
}

TEST_CASE("backwards in time an event that sets the state ends the run") {
  ModelText m(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2\nevent kick when t = 2 : set x' = x' + 1\nstart at 5, x' = 1\n");
  const auto r = run(m, -5);
  CHECK(r.ending == Ending::Paradox);
  CHECK(r.reason.find("sets the state") != std::string::npos);
  CHECK(r.final.t == doctest::Approx(2));
  CHECK(r.final.v[0] == 1);
}

TEST_CASE("what a set leaves at the zero of an event fires again when it has left it, and not by its rounding") {
  const auto oscillator = [](const std::string& place, const std::string& more, double end) {
    return run_text("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (x - " + place + ")^2\n" +
                        "event zero when x = " + place + " : set x' = 0\nevent seen when x = " + place + " : record\n" +
                        more,
                    end);
  };
  const double half = std::acos(-1.0);
  for (const std::string place : {"0", "1/4"}) {
    for (const char* start : {"1.25", "-0.45, x' = 1/7"}) {
      const auto rests = oscillator(place, std::string("start x = ") + start + "\n", 100);
      CHECK(count(rests, Happening::Kind::Event, "zero") == 1);
      CHECK(count(rests, Happening::Kind::Event, "seen") == 1);
      CHECK(std::abs(rests.final.q[0] - (place == "0" ? 0 : 0.25)) < 1e-15);
    }
    // Pulled down from its rest for 2 s, u = cos τ − 1, then up, u = 2 + A cos(τ + φ), through u = 0: there it stops.
    const auto leaves =
        oscillator(place, "force x = -step(t - 10) + 3 step(t - 12)\nstart x = 1 + " + place + "\n", 18);
    REQUIRE(leaves.happenings.size() == 4);
    const double u = std::cos(2.0) - 1, speed = -std::sin(2.0), size = std::hypot(u - 2, speed);
    const double back = 2 * half - std::acos(-2 / size) - std::atan2(-speed, u - 2);
    const double times[] = {half / 2, half / 2, 12 + back, 12 + back};
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(leaves.happenings[k].t == doctest::Approx(times[k]).epsilon(1e-14));
      CHECK(leaves.happenings[k].name == (k % 2 == 0 ? "zero" : "seen"));
      CHECK(leaves.happenings[k].error < 1e-13);
    }
  }
}

TEST_CASE("an event that is met as the run ends is told there, with the state before what it does") {
  const std::string free = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x' = 1\n";
  for (const double end : {1.0, 3.0, 7.0, 1e3}) {
    const std::string at = fmt::format("{}", end);
    const auto r = run_text(free + "event tick when sin(pi t) = 0 : record\nevent mid when x = " + at +
                                " rising : record\nevent down when x = " + at +
                                " falling : record\nevent hit when x = " + at + " : set x' = 0\n",
                            end);
    CHECK(count(r, Happening::Kind::Event, "tick") == static_cast<std::size_t>(end) + 1);
    CHECK(count(r, Happening::Kind::Event, "mid") == 1);
    CHECK(count(r, Happening::Kind::Event, "down") == 0);
    CHECK(count(r, Happening::Kind::Event, "hit") == 1);
    CHECK(r.final.v[0] == 1);
    for (const Happening& h : r.happenings) CHECK(h.error <= 1e-14 * end);
  }
  // Not before the end by more than rounding.
  const auto early = run_text(free + "event late when x = 3 + 1e-13 : record\n", 3);
  CHECK(early.happenings.empty());
}

TEST_CASE("an event whose function is no number is said, once") {
  const auto warnings = [](const std::string& condition) {
    ModelText m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nevent e when " + condition +
                " : record\nstart x = 1\n");
    Diagnostics diagnostics;
    SimulationOptions options;
    options.duration = 10;
    REQUIRE(simulate(m.model, m.equations, options, diagnostics));
    std::vector<std::string> out;
    for (const Diagnostic& d : diagnostics.items())
      if (d.code == "W0736") out.push_back(d.message);
    return out;
  };
  const auto never = warnings("log(-1 - x^2) = 0");
  REQUIRE(never.size() == 1);
  CHECK(never[0] == "the event `e` has no value all along the motion");
  const auto partly = warnings("sqrt(x) = 0.5");
  REQUIRE(partly.size() == 1);
  CHECK(partly[0].find("has no value at ") != std::string::npos);
  CHECK(warnings("x = 0.5").empty());
}

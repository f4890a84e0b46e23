// What happens to several contacts or frictions at one instant: symmetric motions, plates on many legs that tip.
#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

using namespace maupertuis;

namespace {

/// Six discs of radius R: three on the floor, two on these, one on top.
std::string pyramid_of_discs(double friction) {
  constexpr int rows = 3;
  std::string coordinates, angles, bodies, contacts, starts;
  int of_row[rows][rows] = {};
  int next = 0;
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < rows - r; ++i) {
      const int k = of_row[r][i] = next++;
      coordinates += fmt::format("x{0}, y{0}, ", k);
      angles += fmt::format("{}a{}", k == 0 ? "" : ", ", k);
      bodies += fmt::format("body D{0} mass m inertia 1/2 m R^2 at (x{0}, y{0}) rotation angle a{0}\n", k);
      starts += fmt::format("{}x{} = {} R, y{} = (1 + {} sqrt(3)) R", k == 0 ? "start " : ", ", k, 2 * i + r, k, r);
      if (r == 0)
        contacts += fmt::format("contact y{0} >= R friction {1} slip x{0}' + R a{0}' name f{0}\n", k, friction);
      for (int side = 0; r > 0 && side < 2; ++side) {
        const int below = of_row[r - 1][i + side];
        const std::string d = fmt::format("sqrt((x{0} - x{1})^2 + (y{0} - y{1})^2)", k, below);
        contacts += fmt::format(
            "contact {2} >= 2 R friction {3} slip ((x{0}' - x{1}') (y{0} - y{1}) - (y{0}' - y{1}') (x{0} - x{1}))/{2} "
            "+ R (a{0}' + a{1}') name c{0}{4}\n",
            k, below, d, friction, side == 0 ? 'l' : 'r');
      }
    }
  return "param m = 1 kg, R = 0.1 m, g = 9.81 m/s^2\ncoord " + coordinates.substr(0, coordinates.size() - 2) +
         " : length, " + angles + " : angle\n" + bodies + "gravity (0, -g)\n" + contacts + starts + "\n";
}

/// A plate that rests on n smooth legs, until forces that grow tip it over the last one.
std::string plate_on_legs(int n) {
  std::string out =
      "param m = 1 kg, g = 9.81 m/s^2, J = 0.1 kg m^2\ncoord x, z : length, θ : angle\n"
      "body B mass m inertia J at (x, z) rotation angle θ\ngravity (0, -g)\n";
  for (int i = 0; i < n; ++i)
    out += fmt::format("point L{0} in B at ({1:.4f} m, 0)\ncontact L{0}.y >= 0 name c{0}\n", i, (2.0 * i - n + 1) / n);
  return out +
         "point T in B at (0.6 m, 0)\nforce on T = (0, -20 [N/s] t)\npoint U in B at (-0.6 m, 0)\n"
         "force on U = (0, 30 [N/s] t)\n";
}

/// θ' of that plate at 0.5 s by Runge and Kutta's rule: from the tip it turns about the last leg, which slides.
double rate_of_tipping(int n) {
  const double a = std::round((n - 1) * 1e4 / n) / 1e4, m = 1, J = 0.1, g = 9.81;
  double t = a * g / (30 + 10 * a), angle = 0, rate = 0;
  constexpr int steps = 20000;
  const double h = (0.5 - t) / steps;
  const auto f = [&](double time, double th, double w) {
    const double moment = -20 * time * (0.6 - a) + 30 * time * (-0.6 - a) + m * g * a;
    return (moment * std::cos(th) + m * a * a * std::cos(th) * std::sin(th) * w * w) /
           (J + m * a * a * std::cos(th) * std::cos(th));
  };
  for (int k = 0; k < steps; ++k, t += h) {
    const double w1 = rate, a1 = f(t, angle, w1);
    const double w2 = rate + h / 2 * a1, a2 = f(t + h / 2, angle + h / 2 * w1, w2);
    const double w3 = rate + h / 2 * a2, a3 = f(t + h / 2, angle + h / 2 * w2, w3);
    const double w4 = rate + h * a3, a4 = f(t + h, angle + h * w3, w4);
    angle += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
    rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return rate;
}

}  // namespace

TEST_CASE("frictions that come to their limits together give way together, whatever rounding makes of their times") {
  // (m - c) u'' = A (t - F/A) of both, in opposite directions.
  constexpr double A = 1.7, m = 2, c = 0.6;
  for (const double limit : {0.3, 0.7, 1.1, 2.3})
    for (const double coupling : {c, -c}) {
      CAPTURE(limit);
      CAPTURE(coupling);
      const auto r = run_text(fmt::format("coord a, b : length\nT = 0.5 * {0} [kg] (a'^2 + b'^2) + {1} [kg] a' b'\n"
                                          "friction a limit {2} [N]\nfriction b limit {2} [N]\n"
                                          "force a = -{3} [N/s] t\nforce b = {3} [N/s] t\n",
                                          m, coupling, limit, A),
                              3);
      const double since = 3 - limit / A, way = A * since * since * since / (6 * (m - coupling));
      CHECK(r.final.q[0] == doctest::Approx(-way).epsilon(1e-12));
      CHECK(r.final.q[1] == doctest::Approx(way).epsilon(1e-12));
      CHECK(count(r, Happening::Kind::Slip) == 2);
    }
}

TEST_CASE("a pyramid of discs falls apart as symmetrically as it stands") {
  for (const double friction : {0.09, 0.09999, 0.1, 0.1001, 0.105, 0.11}) {
    CAPTURE(friction);
    const auto r = run_text(pyramid_of_discs(friction), 0.34);
    CHECK(r.final.q[0] + r.final.q[4] == doctest::Approx(0.4).epsilon(1e-12));
    CHECK(r.final.q[6] + r.final.q[8] == doctest::Approx(0.4).epsilon(1e-12));
    CHECK(r.final.q[10] == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(r.final.q[0] < -0.05);
    std::vector<double> slips;
    for (const Happening& h : r.happenings)
      if (h.kind == Happening::Kind::Slip) slips.push_back(h.t);
    REQUIRE(slips.size() % 2 == 0);
    CHECK(slips.size() >= 2);
    for (std::size_t k = 0; k < slips.size(); k += 2) CHECK(slips[k] == slips[k + 1]);
  }
}

TEST_CASE("a plate on any number of legs tips over the last one") {
  for (const int n : {2, 4, 5, 6, 7, 10, 11, 20, 31}) {
    CAPTURE(n);
    const auto r = run_text(plate_on_legs(n), 0.5);
    CHECK(r.final.v[2] == doctest::Approx(rate_of_tipping(n)).epsilon(1e-10));
  }
}

TEST_CASE("two blocks at their static limits at once: the one that is written first slides, and the choice is told") {
  // Both slide from 1.635 s with 0.9 m/s² between floor and pull; the upper one leaves the lower one at its limit.
  constexpr double g = 9.81, A = 3, begins = 0.5 * g / A, end = 6;
  const auto r = run_text(
      "param m = 1 kg, g = 9.81 m/s^2, A = 3 N/s\ncoord x1, y1, x2, y2 : length\npoint P mass m at (x1, y1)\n"
      "point Q mass m at (x2, y2)\ngravity (0, -g)\ncontact y1 >= 0 friction 0.2 static 0.25 slip x1' name floor\n"
      "contact y2 - y1 >= 0.1 [m] friction 0.4 static 0.5 slip x2' - x1' name mid\nforce on Q = (A t, 0)\n"
      "start y2 = 0.1 m\n",
      end);
  // Together a = (A t - 0.4 m g)/2m; the upper one is held while A t - m a < 0.5 m g.
  const double parts = (0.5 * g - 0.2 * g) * 2 / A, both = parts - begins;
  const auto speed = [&](double t) { return (A * (t * t - begins * begins) / 2 - 0.4 * g * (t - begins)) / 2; };
  const auto way = [&](double t) {
    return (A * ((t * t * t - begins * begins * begins) / 6 - begins * begins * (t - begins) / 2) -
            0.2 * g * (t - begins) * (t - begins)) /
           2;
  };
  REQUIRE(both > 0);
  const double v = speed(parts), x = way(parts), since = end - parts;  // then 0.4 m g pulls and brakes the lower one
  CHECK(r.final.q[0] == doctest::Approx(x + v * since).epsilon(1e-12));
  CHECK(r.final.v[0] == doctest::Approx(v).epsilon(1e-12));
  REQUIRE(!r.remarks.empty());
  CHECK(r.remarks.front().find("Static friction leaves a choice") != std::string::npos);
}

TEST_CASE("a beam on any number of rough legs that all slide begins when friction is overcome") {
  constexpr double g = 9.81, A = 3, friction = 0.3, begins = friction * g / A, end = 2, since = end - begins;
  for (const int n : {3, 6, 36, 61})
    for (const double sense : {1.0, -1.0}) {
      CAPTURE(n);
      std::string text =
          "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
          "body B mass m inertia 0.1 kg m^2 at (x, z) rotation angle θ\ngravity (0, -g)\n";
      for (int i = 0; i < n; ++i)
        text +=
            fmt::format("point L{0} in B at ({1:.4f} m, 0)\ncontact L{0}.y >= 0 friction 0.3 slip L{0}.x' name c{0}\n",
                        i, (2.0 * i - n + 1) / n);
      const auto r = run_text(text + fmt::format("force on B = ({} [N/s] t, 0)\n", sense * A), end);
      CHECK(r.final.q[0] == doctest::Approx(sense * A * since * since * since / 6).epsilon(1e-11));
    }
}

TEST_CASE("where no mode fits, the cause is told: friction that is weaker at rest than in motion") {
  const auto reason = [](const std::string& text) {
    ModelText m(text);
    return run(m, 5).reason;
  };
  const std::string weak =
      "param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\n"
      "friction x limit 2 [N] static 3 [N] - (1 [N/s]) t\nforce on P = (1.5 [N/s] t, 0)\n";
  CHECK(reason(weak).find("Static friction of x has fallen below kinetic friction") != std::string::npos);
}

TEST_CASE("events of one instant are told in the order of the model") {
  const auto r = run_text(
      "param m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nevent a when x = 1 [m] : set x' = y', y' = x'\n"
      "event b when x = 1 [m] : record\nevent c when x = 1 [m] : record\nstart x' = 1 m/s, y' = 2 m/s\n",
      3);
  REQUIRE(r.happenings.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(r.happenings[k].name == std::string(1, static_cast<char>('a' + k)));
  CHECK(r.final.q[0] == doctest::Approx(5).epsilon(1e-14));
}

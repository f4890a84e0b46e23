// Numbers in SI units may be of any size: what happens is the same.
#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

using namespace maupertuis;

namespace {

struct Units {
  double length, time, mass;
  double speed() const { return length / time; }
  double acceleration() const { return speed() / time; }
  double force() const { return mass * acceleration(); }
};

constexpr Units sizes[] = {{1, 1, 1}, {1e-9, 1e-12, 1e-27}, {1e9, 1e5, 1e24}, {1e-9, 1e6, 1e-3}, {1e6, 1e-9, 1e-15}};

SimulationResult run_in(const Units& u, const std::string& text, double end) {
  ModelText m(text);
  SimulationOptions options;
  options.duration = end * u.time;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  INFO(r->reason);
  REQUIRE(r->ok());
  return *r;
}

}  // namespace

TEST_CASE("a pair of blocks that slide one after the other, in units of all sizes") {
  for (const Units& u : sizes) {
    CAPTURE(u.length);
    const double t0 = 0.2943, t1 = 1.1772, g = 9.81;
    const auto r = run_in(
        u,
        fmt::format("param m = {} kg, g = {} m/s^2, c = {} N/s, h = {} m\ncoord x, z, a, b : length\n"
                    "point A mass 2 m at (x, z)\npoint B mass m at (a, b)\ngravity (0, -g)\nforce on A = (c t, 0 N)\n"
                    "contact z >= 0 friction 0.1 slip x' name floor\n"
                    "contact b - z >= h friction 0.3 slip a' - x' name blocks\nstart b = h\n",
                    u.mass, g * u.acceleration(), 10 * u.force() / u.time, u.length),
        t1 + 1);
    CHECK(count(r, Happening::Kind::Slip, "floor") == 1);
    CHECK(count(r, Happening::Kind::Slip, "blocks") == 1);
    const double together = (5 * (t1 * t1 - t0 * t0) - 0.3 * g * (t1 - t0)) / 3;
    CHECK(r.final.v[2] / u.speed() == doctest::Approx(together + 0.3 * g).epsilon(1e-11));
  }
}

TEST_CASE("a wedge at rest under a block that slides, in units of all sizes") {
  for (const Units& u : sizes) {
    CAPTURE(u.length);
    const auto r = run_in(
        u,
        fmt::format("param m = {} kg, g = {} m/s^2, α = 0.6 rad\ncoord x, y, X, Y : length\n"
                    "point P mass m at (x, y)\npoint W mass 4 m at (X, Y)\ngravity (0, -g)\n"
                    "contact y cos α + (x - X) sin α - Y cos α >= 0 friction 0.3 slip (x' - X') cos α - (y' - Y') sin "
                    "α name wedge\ncontact Y >= 0 friction 0.5 slip X' name floor\n",
                    u.mass, 9.81 * u.acceleration()),
        1);
    const double way = 9.81 / 2 * (std::sin(0.6) - 0.3 * std::cos(0.6)) * std::cos(0.6);
    CHECK(r.final.q[0] / u.length == doctest::Approx(way).epsilon(1e-11));
    CHECK(std::abs(r.final.q[2]) <= 1e-13 * u.length);
  }
}

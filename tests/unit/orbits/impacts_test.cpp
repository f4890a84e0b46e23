// Periodic motions, exponents and sections of motions with impacts and friction.
#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace maupertuis;

namespace {

constexpr double pi = std::numbers::pi;

std::complex<double> product(const std::vector<std::complex<double>>& values) {
  std::complex<double> out = 1;
  for (const auto& x : values) out *= x;
  return out;
}

/// Rays by hand: the curvature B of a wave front becomes B/(1 + B t) on the way, neighbours part by 1 + B t, and a
/// reflection adds ±2/(R cos φ).
double exponent_of_sinai() {
  double x = 0.9, y = 0.2, u = -0.8, v = -0.6, curvature = 0, log_sum = 0, time = 0;
  while (time < 300'000) {
    const double to_side = ((u > 0 ? 1 : -1) - x) / u, to_floor = ((v > 0 ? 1 : -1) - y) / v;
    double t = std::min(to_side, to_floor);
    const double b = x * u + y * v, c = x * x + y * y - 0.16, d = b * b - c;
    const bool disk = b < 0 && d > 0 && -b - std::sqrt(d) < t;
    if (disk) t = -b - std::sqrt(d);
    x += u * t, y += v * t, time += t;
    log_sum += std::log1p(curvature * t);
    curvature /= 1 + curvature * t;
    if (!disk) {
      (to_side <= to_floor ? u : v) *= -1;
      continue;
    }
    const double r = std::hypot(x, y), normal = (x * u + y * v) / r;
    u -= 2 * normal * x / r, v -= 2 * normal * y / r;
    const double speed = std::hypot(u, v);
    u /= speed, v /= speed;
    curvature += 2 / (0.4 * -normal);
  }
  return log_sum / time;
}

double exponent_of_stadium() {
  double x = 0.2, y = 0.1, u = 0.6, v = 0.8, curvature = 0, log_sum = 0, time = 0;
  while (time < 300'000) {
    double t = ((v > 0 ? 1 : -1) - y) / v, centre = 0;
    bool cap = std::abs(x + u * t) > 1;
    if (cap) {  // the half circle on the side where it would leave
      centre = x + u * t > 0 ? 1 : -1;
      const double b = (x - centre) * u + y * v, c = (x - centre) * (x - centre) + y * y - 1;
      t = -b + std::sqrt(std::max(0.0, b * b - c));
    }
    x += u * t, y += v * t, time += t;
    log_sum += std::log(std::abs(1 + curvature * t));
    curvature /= 1 + curvature * t;
    if (!cap) {
      v = -v;
      continue;
    }
    const double r = std::hypot(x - centre, y), normal = ((x - centre) * u + y * v) / r;
    u -= 2 * normal * (x - centre) / r, v -= 2 * normal * y / r;
    const double speed = std::hypot(u, v);
    u /= speed, v /= speed;
    curvature -= 2 / normal;
  }
  return log_sum / time;
}

}  // namespace

TEST_CASE("the impact oscillator of Shaw and Holmes") {
  ModelText m(
      "dimensionless\nparam k = 1, F = 1, w = 2.6, e = 0.8\ncoord x : number\nT = 1/2 x'^2\n"
      "V = 1/2 k x^2 - F x cos(w t)\ncontact x <= 0 restitution e name stop\n"
      "start at 1.16514728298229819, x = -0.0001, x' = -0.40435\nrun 20\n");
  const FloquetResult r = floquet_of(m);
  CHECK(r.motion.period == doctest::Approx(2 * pi / 2.6).epsilon(1e-14));
  CHECK(r.motion.closure < 1e-13);
  REQUIRE(r.multipliers.size() == 2);
  CHECK(r.multipliers[0].real() == doctest::Approx(-0.5745396547960298353026).epsilon(1e-12));
  CHECK(r.multipliers[0].imag() == doctest::Approx(0.5566903852832909050416).epsilon(1e-12));
  CHECK(product(r.multipliers).real() == doctest::Approx(0.64).epsilon(1e-13));
  CHECK(r.integrated_divergence.value() == doctest::Approx(2 * std::log(0.8)).epsilon(1e-14));
  CHECK(r.stability == OrbitalStability::Attracting);
}

TEST_CASE("a ball on a vibrating table: multipliers in closed form") {
  const double g = 9.81, A = 0.0075, w = 40, e = 0.5;
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, A = 7.5 mm, w = 40 rad/s, e = 0.5\ncoord z : length\npoint P mass m at (0, z)\n"
      "gravity (0, -g)\ncontact z >= A sin(w t) restitution e name table\n"
      "start at 0.0137 s, z = 4 mm, z' = 0.77 m/s\nrun 2 s\n");
  const FloquetResult r = floquet_of(m);
  const double T = 2 * pi / w, u = g * T / 2 * (1 - e) / (1 + e), cosine = u / (A * w),
               sine = std::sqrt(1 - cosine * cosine);
  CHECK(r.motion.period == doctest::Approx(T).epsilon(1e-14));
  const double trace = 1 + e * e - (1 + e) * (1 + e) * A * w * w * sine / g;
  CHECK(r.trace == doctest::Approx(trace).epsilon(1e-11));
  CHECK(product(r.multipliers).real() == doctest::Approx(e * e).epsilon(1e-12));
}

TEST_CASE("a ball that rides on a table moves with it, and thrown balls join it where bounces lose") {
  const auto riding = [](const std::string& rest) {
    return floquet_of(
        ModelText("dimensionless\nparam g = 1, A = 0.4, w = 1\ncoord y : number\nL = 1/2 y'^2 - g y\n" + rest));
  };
  const FloquetResult joined = riding("contact y >= A sin(w t) restitution 0.5 name table\nstart y = 3\nrun 60\n");
  CHECK_FALSE(joined.motion.rests);
  CHECK(joined.motion.start.v[0] == doctest::Approx(0.4 * std::cos(joined.motion.start.t)).epsilon(1e-12));
  CHECK(joined.vanished == 2);
  CHECK(joined.stability == OrbitalStability::Attracting);
  const FloquetResult elastic =
      riding("contact y >= A sin(w t) restitution 1 name table\nstart y = 0, y' = 0.4\nrun 60\n");
  CHECK(elastic.vanished == 0);
  CHECK(elastic.stability == OrbitalStability::Neutral);
}

TEST_CASE("two bounces between the walls of an elliptic billiard") {
  const auto multiplier = [](const char* start) {
    ModelText m(
        "dimensionless\nparam a = 1.5, b = 1\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
        "contact x^2/a^2 + y^2/b^2 <= 1 restitution 1 name wall\n" +
        std::string(start) + "\nrun 10\n");
    return floquet_of(m);
  };
  // Mirrors of radius R at the distance L: the trace of a round trip is 4 (1 − L/R)² − 2.
  const FloquetResult across = multiplier("start y' = 1"), along = multiplier("start x' = 1");
  const auto trace = [](double L, double R) { return 4 * (1 - L / R) * (1 - L / R) - 2; };
  CHECK(across.motion.period == doctest::Approx(4).epsilon(1e-13));
  CHECK(across.trivial == 2);
  CHECK((across.multipliers[0] + across.multipliers[1]).real() == doctest::Approx(trace(2, 2.25)).epsilon(1e-11));
  CHECK(across.stability == OrbitalStability::Neutral);
  CHECK(along.motion.period == doctest::Approx(6).epsilon(1e-13));
  CHECK((along.multipliers[0] + along.multipliers[1]).real() == doctest::Approx(trace(3, 1 / 1.5)).epsilon(1e-11));
  CHECK(along.stability == OrbitalStability::Unstable);
  CHECK(along.symplectic_residual.value() < 1e-11);
}

TEST_CASE("stick-slip on a belt closes, and neighbours come into the same motion") {
  ModelText m(
      "param m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, μ = 0.3, μs = 0.4, v = 0.2 m/s\ncoord x, z : length\n"
      "point block mass m at (x, z)\ngravity (0, -g)\nV += 1/2 k x^2\n"
      "contact z >= 0 friction μ static μs slip x' - v name belt\nstart x = 1 mm, x' = v\nrun 4 s\n");
  const FloquetResult r = floquet_of(m);
  const double w = 10, drop = 0.1 * 9.81, period = (pi + 2 * std::atan(0.2 * 100 / (w * drop))) / w + 2 * drop / 20;
  CHECK(r.motion.period == doctest::Approx(period).epsilon(1e-12));
  CHECK(r.largest < 1e-10);
  CHECK(r.stability == OrbitalStability::Attracting);
}

TEST_CASE("exponents of billiards: none in a circle, those of Sinai's by reflecting wave fronts" *
          doctest::skip(under_sanitizers)) {
  ModelText circle(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\ncontact x^2 + y^2 <= 1 restitution 1 name wall\n"
      "start x = 0.2, x' = 0.6, y' = 0.8\nrun 4000\n");
  const LyapunovResult flat = lyapunov_of(circle);
  REQUIRE(flat.exponents.size() == 4);
  for (const double x : flat.exponents) CHECK(std::abs(x) < 5e-3);
  CHECK(flat.sum_rule_residual.value() < 1e-9);

  ModelText sinai(
      "dimensionless\nparam R = 0.4\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\ncontact x >= -1 restitution 1 name "
      "left\n"
      "contact x <= 1 restitution 1 name right\ncontact y >= -1 restitution 1 name bottom\n"
      "contact y <= 1 restitution 1 name top\ncontact sqrt(x^2 + y^2) >= R restitution 1 name disk\n"
      "start x = 0.9, y = 0.2, x' = -0.8, y' = -0.6\nrun 3000\n");
  const LyapunovResult chaotic = lyapunov_of(sinai);
  CHECK(chaotic.exponents[0] == doctest::Approx(exponent_of_sinai()).epsilon(0.03));
  CHECK(chaotic.exponents[3] == doctest::Approx(-chaotic.exponents[0]).epsilon(1e-2));
  CHECK(chaotic.sum_rule_residual.value() < 1e-6);
}

TEST_CASE("the stadium defocuses: its exponent is that of reflected wave fronts") {
  ModelText m(
      "dimensionless\nparam a = 1, R = 1\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "contact max(abs(x) - a, 0)^2 + y^2 <= R^2 restitution 1 name wall\n"
      "start x = 0.2, y = 0.1, x' = 0.6, y' = 0.8\nrun 3000\n");
  const LyapunovResult r = lyapunov_of(m);
  CHECK(r.exponents[0] == doctest::Approx(exponent_of_stadium()).epsilon(0.04));
  CHECK(r.sum_rule_residual.value() < 1e-6);
}

TEST_CASE("directions that vanish are said, not averaged") {
  ModelText m(
      "param m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, v = 0.2 m/s\ncoord x, z : length\n"
      "point block mass m at (x, z)\ngravity (0, -g)\nV += 1/2 k x^2\n"
      "contact z >= 0 friction 0.3 static 0.4 slip x' - v name belt\nstart x = 1 mm, x' = 0\nrun 10 s\n");
  CHECK(code_of([&](Diagnostics& d) { return lyapunov_exponents(m.model, m.equations, {}, d); }) == "E1413");
  LyapunovOptions one;
  one.exponents = 1;
  CHECK(std::abs(lyapunov_of(m, one).exponents[0]) < 0.05);
}

TEST_CASE("a strobe and a section of a bouncing ball") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord z : length\npoint P mass m at (0, z)\ngravity (0, -g)\n"
      "contact z >= 0 restitution 1 name floor\nstart z = 1 m\nrun 10 s\n");
  const double period = 2 * std::sqrt(2 / 9.81);
  SectionOptions strobe;
  strobe.strobe = period;
  strobe.crossings = 5;
  Diagnostics diagnostics;
  const auto flashes = poincare_section(m.model, m.equations, strobe, diagnostics);
  REQUIRE(flashes);
  for (const Crossing& c : flashes->crossings) CHECK(c.state.q[0] == doctest::Approx(1).epsilon(1e-12));
  SectionOptions section;
  section.section = m.q(0) - m.system->context->number(Rational(1, 2));
  section.direction = SectionDirection::Rising;
  section.crossings = 4;
  const auto crossed = poincare_section(m.model, m.equations, section, diagnostics);
  REQUIRE(crossed);
  REQUIRE(crossed->crossings.size() == 4);
  for (const Crossing& c : crossed->crossings) {
    CHECK(c.state.v[0] == doctest::Approx(std::sqrt(9.81)).epsilon(1e-12));
    CHECK(c.state.t ==
          doctest::Approx(std::sqrt(2 / 9.81) * (2 - std::sqrt(0.5)) + period * static_cast<double>(c.number - 1))
              .epsilon(1e-12));
  }
}

TEST_CASE("a block that comes to rest on its plate in each period: nothing is left of neighbours") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, A = 10 mm, w = 40 rad/s\ncoord z : length\npoint block mass m at (0, z)\n"
      "gravity (0, -g)\ncontact z >= A sin(w t) restitution 0.3 name table\nstart z' = A w\nrun 1 s\n");
  const FloquetResult r = floquet_of(m);
  CHECK(r.motion.period == doctest::Approx(2 * pi / 40).epsilon(1e-14));
  CHECK(r.largest < 1e-10);
  CHECK(r.stability == OrbitalStability::Attracting);
}

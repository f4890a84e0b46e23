#include "support.hpp"

#include <random>

using namespace maupertuis;

// The error that is stated holds, and is no excuse: against closed forms in long double.

namespace {

using Wide = long double;

struct Ends {
  double x0, t0, x1, t1;
};

ModelText line(double m, double k, double force) {
  return ModelText("system line\ndimensionless\nparam m = " + std::to_string(m) + ", k = " + std::to_string(k) +
                   ", F = " + std::to_string(force) + "\ncoord x : number\nT = 1/2 m x'^2\nV = 1/2 k x^2 + F x\n");
}

constexpr double ulp = 2.3e-16;

/// `size`: ∫ (T + |V|) dt along the path.
void look(const ModelText& m, const Ends& e, Wide exact, Wide size) {
  ActionOptions options;
  options.variations = false;
  Diagnostics diagnostics;
  const auto found =
      stationary_paths(m.model, m.equations, fixed_ends({e.x0}, e.t0, {e.x1}, e.t1), options, diagnostics);
  CAPTURE(e.x0);
  CAPTURE(e.x1);
  CAPTURE(e.t0);
  CAPTURE(e.t1);
  REQUIRE(found);
  const StationaryPath& p = found->paths.front();
  const double off = static_cast<double>(std::abs(p.action - exact));
  CAPTURE(off);
  CHECK(off <= p.action_error);
  CHECK(p.action_error <= 50 * ulp * static_cast<double>(size));
}

double parameter(const ModelText& m, const char* name) { return m.system->find_parameter(name)->si_value; }

/// x, v of the oscillator's path at a time after its start: for the size of L along it.
Wide oscillator_size(Wide m, Wide w, const Ends& e) {
  const Wide T = Wide(e.t1) - e.t0, b = (e.x1 - e.x0 * std::cos(w * T)) / std::sin(w * T);
  Wide out = 0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    const Wide t = T * (i + 0.5L) / steps, x = e.x0 * std::cos(w * t) + b * std::sin(w * t),
               v = w * (b * std::cos(w * t) - e.x0 * std::sin(w * t));
    out += T / steps * m / 2 * (v * v + w * w * x * x);
  }
  return out;
}

}  // namespace

TEST_CASE("the error of S holds for oscillators") {
  std::mt19937_64 random(1834);
  const auto between = [&](double a, double b) { return a + (b - a) * std::generate_canonical<double, 53>(random); };
  const auto look_at = [&](const ModelText& m, const Ends& e) {
    const Wide mass = parameter(m, "m"), w = std::sqrt(parameter(m, "k") / mass), T = Wide(e.t1) - e.t0;
    const Wide exact = mass * w / (2 * std::sin(w * T)) *
                       ((Wide(e.x0) * e.x0 + Wide(e.x1) * e.x1) * std::cos(w * T) - 2 * Wide(e.x0) * e.x1);
    look(m, e, exact, oscillator_size(mass, w, e));
  };
  look_at(line(1, 1, 0), {0.4, 0, -1.1, 2});
  for (int round = 0; round < (under_sanitizers ? 4 : 30); ++round) {
    const ModelText m = line(between(0.1, 9), between(0.1, 5), 0);
    const double w = std::sqrt(parameter(m, "k") / parameter(m, "m"));
    for (const double halves : {0.11, 0.37, 0.81, 1.6, 2.4}) {
      const double start = between(-3, 3);
      look_at(m, {between(-2, 2), start, between(-2, 2), start + halves * pi / w});
    }
  }
}

TEST_CASE("the error of S holds for free fall and free particles, also far from the origin") {
  std::mt19937_64 random(1744);
  const auto between = [&](double a, double b) { return a + (b - a) * std::generate_canonical<double, 53>(random); };
  for (int round = 0; round < (under_sanitizers ? 4 : 30); ++round) {
    const ModelText m = line(between(0.1, 9), 0, round % 2 ? between(0.5, 20) : 0);
    const Wide mass = parameter(m, "m"), F = parameter(m, "F");
    for (const double far : {0.0, 1.0, 1000.0}) {
      const double start = between(-3, 3), x0 = far + between(-1, 1);
      const Ends e{x0, start, x0 + between(0.5, 2), start + between(0.2, 3)};
      const Wide T = Wide(e.t1) - e.t0, dx = Wide(e.x1) - e.x0;
      const Wide exact = mass * dx * dx / (2 * T) - F * T * (Wide(e.x0) + e.x1) / 2 - F * F * T * T * T / (24 * mass);
      // ∫ T dt of the parabola, and no less than ∫ |F x| dt
      const Wide kinetic = mass * dx * dx / (2 * T) + F * F * T * T * T / (24 * mass);
      look(m, e, exact, kinetic + F * T * (std::abs(Wide(e.x0)) + std::abs(Wide(e.x1)) + F * T * T / mass / 8));
    }
  }
}

TEST_CASE("the error of S along formulas holds, far from the origin and late as well") {
  const ModelText m = line(1.7, 2.3, 0.9);
  const Wide mass = parameter(m, "m"), k = parameter(m, "k"), F = parameter(m, "F");
  Context& c = *m.system->context;
  for (const double far : {0.0, 1.0, 1000.0})
    for (const double start : {0.0, 3.7, 1e5})
      for (const double rate : {0.3, 4.1}) {
        CAPTURE(far);
        CAPTURE(start);
        const double end = start + 2.6;
        const auto number = [&](double x) { return c.number(Rational::from_double(x)); };
        const Expr x = number(far) + number(rate) * (c.time() - number(start));  // x = far + rate (t - start)
        Diagnostics diagnostics;
        ActionOptions options;
        options.variations = false;
        const auto found =
            action_of_path(m.model, m.equations, {&x, 1}, start, end, std::nullopt, options, diagnostics);
        REQUIRE(found);
        const Wide T = Wide(end) - start, a = far, v = rate;
        const Wide square = a * a * T + a * v * T * T + v * v * T * T * T / 3, mean = a * T + v * T * T / 2;
        const Wide exact = mass / 2 * v * v * T - k / 2 * square - F * mean;
        const Wide size = mass / 2 * v * v * T + k / 2 * square + F * mean;
        const double off = static_cast<double>(std::abs(found->action - exact));
        CHECK(off <= found->action_error);
        CHECK(found->action_error <=
              (start > 1e4 ? 1e6 : 50) * ulp * static_cast<double>(size));  // t itself is rounded
      }
}

#include "support.hpp"

namespace {

using namespace maupertuis;

constexpr const char* kDoublePendulum =
    "system double_pendulum\ndimensionless\nparam m1 = 1, m2 = 1.5, l1 = 1, l2 = 0.8, g = 9.81\ncoord a, b : angle\n"
    "point A mass m1 at l1 (sin a, -cos a)\npoint B mass m2 at A + l2 (sin b, -cos b)\ngravity (0, -g)\n";

/// q and q̇ do not part: M depends on q and on q̇, and L on the time.
constexpr const char* kNotSeparable =
    "system entangled\ndimensionless\ncoord x, y : number\n"
    "L = 1/2 (1 + x^2) x'^2 + 1/2 (2 + sin y) y'^2 + x'^4/10 + x y' cos t - 1/4 x^4 - y^2 + x y + x' y' sin(x - y)/2\n";

/// A pendulum on a moving support in Cartesian coordinates.
constexpr const char* kMovingPendulum =
    "system moving\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 9.81 y\n"
    "constraint (x - sin(2 t)/5)^2 + y^2 = 1\n";

double error_at(const Variational& m, int order, double h, double end, const std::vector<double>& q,
                const std::vector<double>& v, const std::vector<double>& exact) {
  auto stepper = m.stepper(h, order);
  stepper.start(0, q, v);
  run(stepper, end);
  double error = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    error = std::max(error, std::abs(stepper.q()[i] - exact[i]));
    error = std::max(error, std::abs(stepper.v()[i] - exact[q.size() + i]));
  }
  return error;
}

/// The order that the errors at h and h/2 show.
void check_orders(const Variational& m, double end, const std::vector<double>& q, const std::vector<double>& v,
                  std::initializer_list<std::pair<int, double>> steps) {
  auto fine = m.stepper(end / 1000, 12);
  fine.start(0, q, v);
  run(fine, end);
  std::vector<double> exact(fine.q().begin(), fine.q().end());
  exact.insert(exact.end(), fine.v().begin(), fine.v().end());
  for (const auto& step : steps) {
    const int order = step.first, parts = step.second;
    const double coarse = error_at(m, order, end / parts, end, q, v, exact);
    const double finer = error_at(m, order, end / (2 * parts), end, q, v, exact);
    CAPTURE(order);
    CAPTURE(coarse);
    CAPTURE(finer);
    CHECK(finer > 1e-13);
    CHECK(std::log2(coarse / finer) == doctest::Approx(order).epsilon(0.06));
  }
}

}  // namespace

TEST_CASE("double pendulum: orders 2, 4, 6, 8") {
  check_orders(Variational(kDoublePendulum), 1, {0.6, -0.5}, {0.3, 0.5}, {{2, 400}, {4, 80}, {6, 40}, {8, 60}});
}

TEST_CASE(
    "a Lagrangian that does not separate, with velocities beyond the second power and with time: orders 2, 4, 6, 8") {
  check_orders(Variational(kNotSeparable), 2, {0.9, -0.4}, {0.5, 0.7}, {{2, 200}, {4, 50}, {6, 10}, {8, 5}});
}

TEST_CASE("a moving constraint: orders 2, 4, 6, 8") {
  check_orders(Variational(kMovingPendulum), 1, {std::sin(0.7), -std::cos(0.7)}, {0.4, 0},
               {{2, 200}, {4, 40}, {6, 16}, {8, 10}});
}

TEST_CASE("forces by the principle of Lagrange and d'Alembert: the damped driven oscillator in closed form") {
  // x'' + 0.3 x' + 4 x = cos t from rest at 1.
  const Variational m(
      "system damped\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 2 x^2\nD = 0.15 x'^2\nforce x = cos t\n");
  const double c = 0.3, k = 4, w = std::sqrt(k - c * c / 4), end = 3;
  const double d = (k - 1) * (k - 1) + c * c, p = (k - 1) / d, r = c / d;  // the driven motion: p cos t + r sin t
  const double A = 1 - p, B = (-r + c / 2 * A) / w, decay = std::exp(-c / 2 * end);
  const double x = decay * (A * std::cos(w * end) + B * std::sin(w * end)) + p * std::cos(end) + r * std::sin(end);
  const double v = decay * (-c / 2 * (A * std::cos(w * end) + B * std::sin(w * end)) +
                            w * (B * std::cos(w * end) - A * std::sin(w * end))) -
                   p * std::sin(end) + r * std::cos(end);
  for (const auto& step : {std::pair(2, 200), {4, 40}, {6, 15}, {8, 8}}) {
    const int order = step.first, parts = step.second;
    const double coarse = error_at(m, order, end / parts, end, {1}, {0}, {x, v});
    const double finer = error_at(m, order, end / (2 * parts), end, {1}, {0}, {x, v});
    CAPTURE(order);
    CAPTURE(coarse);
    CAPTURE(finer);
    CHECK(finer > 1e-13);
    CHECK(std::log2(coarse / finer) == doctest::Approx(order).epsilon(0.06));
  }
}

TEST_CASE("states within a step and integrals are as accurate as the steps") {
  const Variational m("system damped\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 2 x^2\nD = 0.15 x'^2\n");
  const double w = std::sqrt(4 - 0.15 * 0.15);
  for (const double parts : {8.0, 16.0}) {
    auto stepper = m.stepper(3 / parts, 6);
    stepper.start(0, std::vector{1.0}, std::vector{0.0});
    double worst = 0, worst_work = 0;
    while (stepper.time() != 3) {
      const Step step = stepper.step(3);
      for (const double x : {0.0, 0.3, 0.77, 1.0}) {
        const double t = step.begin + x * (step.end - step.begin);
        const Sample s = stepper.sample(std::min(t, step.end));
        const double exact = std::exp(-0.15 * s.t) * (std::cos(w * s.t) + 0.15 / w * std::sin(w * s.t));
        worst = std::max(worst, std::abs(s.q[0] - exact));
        worst_work = std::max(worst_work, std::abs(s.v[0] * s.v[0] / 2 + 2 * s.q[0] * s.q[0] - 2 - s.integrals[0]));
        CHECK(s.a[0] == doctest::Approx(-0.3 * s.v[0] - 4 * s.q[0]));
      }
    }
    CHECK(worst < 2.5e-3 * std::pow(3 / parts, 6));
    CHECK(worst_work < 6e-3 * std::pow(3 / parts, 6));
  }
}

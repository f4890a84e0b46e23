#include "support.hpp"

using namespace maupertuis;

namespace {

/// Accelerations at a state, by the bordered system.
std::vector<double> accelerations_at(const Linearized& m, const MotionState& s) {
  const auto point = operating_point(m.at, s);
  REQUIRE(point);
  return point->a;
}

/// The column of A for one independent position or velocity, by central differences along the manifold: `move` says how
/// the dependent ones follow.
template <class Move>
void check_against_differences(const Linearized& m, const MotionState& at, Move&& move, double tolerance) {
  const auto point = operating_point(m.at, at);
  REQUIRE(point);
  const Linearization l = linearize(m.at, *point).linearization;
  const std::size_t f = l.independent.size(), g = l.independent_velocities.size();
  constexpr double h = 1e-5;
  for (std::size_t column = 0; column < f + g; ++column) {
    const auto shifted = [&](double by) {
      MotionState s = at;
      if (column < f)
        s.q[l.independent[column]] += by;
      else
        s.v[l.independent_velocities[column - f]] += by;
      move(s);
      return s;
    };
    const MotionState low = shifted(-h), high = shifted(h);
    const auto al = accelerations_at(m, low), ah = accelerations_at(m, high);
    for (std::size_t i = 0; i < g; ++i) {
      const std::size_t c = l.independent_velocities[i];
      CHECK(std::abs(l.a.at(f + i, column) - (ah[c] - al[c]) / (2 * h)) <
            tolerance * (1 + std::abs(l.a.at(f + i, column))));
    }
    for (std::size_t i = 0; i < f; ++i) {
      const std::size_t c = l.independent[i];
      CHECK(std::abs(l.a.at(i, column) - (high.v[c] - low.v[c]) / (2 * h)) < tolerance);
    }
  }
}

}  // namespace

TEST_CASE("A along a motion, against differences of the accelerations") {
  Linearized m(R"(system double_pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2, b = 0.3 N m s
coord θ1, θ2 : angle
point A mass m at l (sin θ1, -cos θ1)
point B mass m at A + l (sin θ2, -cos θ2)
gravity (0, -g)
D = 1/2 b θ1'^2
)");
  check_against_differences(
      m, {0, {0.7, -1.1}, {2.3, -0.4}}, [](MotionState&) {}, 1e-7);
}

TEST_CASE("A of a constrained motion, against differences on the constraint") {
  Linearized m(cartesian_pendulum);
  const double x = 0.3, y = -std::sqrt(0.49 - 0.09), v = 1.7;
  const auto follow_y = [](MotionState& s) {  // whichever coordinate is independent, the other follows
    s.q[1] = -std::sqrt(0.49 - s.q[0] * s.q[0]);
    s.v[1] = -s.q[0] * s.v[0] / s.q[1];
  };
  const auto point = operating_point(m.at, {0, {x, y}, {v, -x * v / y}});
  REQUIRE(point);
  REQUIRE(linearize(m.at, *point).linearization.independent == std::vector<std::size_t>{0});
  check_against_differences(m, {0, {x, y}, {v, -x * v / y}}, follow_y, 1e-6);
}

TEST_CASE("Inputs: B of a cart, D = 0, C gives back the coordinates") {
  Linearized m(R"(system cart
param M = 2 kg, m = 0.5 kg, l = 0.6 m, g = 9.81 m/s^2
coord x : length, θ : angle
input u : [N] = 0
point cart mass M at (x, 0)
point bob mass m at cart + l (sin θ, -cos θ)
gravity (0, -g)
force on cart = (u, 0)
)");
  const ModalEntry e = m.here();
  const Linearization& l = e.linearization;
  REQUIRE(l.b.columns == 1);
  CHECK(l.b.at(0, 0) == 0);
  CHECK(near(l.b.at(2, 0), 1 / 2.0, 1e-14));           // ẍ = (u + m g θ)/M
  CHECK(near(l.b.at(3, 0), -1 / (2.0 * 0.6), 1e-14));  // θ̈ = −ẍ/l − g θ/l
  CHECK(near(l.a.at(2, 1), 0.5 * 9.81 / 2, 1e-14));
  CHECK(near(l.a.at(3, 1), -9.81 / 0.6 * (1 + 0.25), 1e-14));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) CHECK(l.c.at(i, j) == (i == j ? 1 : 0));
  for (const double d : l.d.entries) CHECK(d == 0);
}

TEST_CASE("Both routes to the eigenvalues agree: the quadratic problem, and A") {
  Linearized m(R"(system three
dimensionless
param a = 0.7, b = 1.3, c = 0.2, d = 0.9
coord x, y, z : number
T = 1/2 (x'^2 + 2 y'^2 + 3 z'^2) + 0.4 x' y'
V = 1/2 (5 x^2 + 3 y^2 + 4 z^2) + a x y - b y z
D = 1/2 (c x'^2 + 0.3 z'^2) + 0.05 y'^2
L = T - V + d (x y' - y z')
)");
  const ModalEntry e = m.here();
  CHECK(e.analysis.eigenvalues.size() == e.linearization.a.rows);
  CHECK(largest_root_error(e.linearization.a, e.analysis.eigenvalues) < 1e-12);
}

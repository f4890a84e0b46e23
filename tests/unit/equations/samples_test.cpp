// Points at which equations are looked at: consistent states near the start, and both sides of a switch.
#include "equations/manifold_samples.hpp"

#include "../model_text.hpp"

#include <maupertuis/across_switches.hpp>

#include <algorithm>
#include <cmath>

using namespace maupertuis;

TEST_CASE("samples of a manifold satisfy the constraints, and lie on all sides of the start") {
  const ModelText m(
      "param m = 1 kg, l = 2 m\ncoord x, y, z : length\npoint P mass m at (x, y, z)\nconstraint x^2 + y^2 + z^2 = "
      "l^2\n");
  const ConstraintManifold manifold(m.equations, {});
  const double place = 2 / std::sqrt(3.0);
  const MotionState start{0, {place, place, place}, {0, 0, 0}};
  const ManifoldSamples samples = sample_manifold(manifold, *m.system, &start);
  REQUIRE(samples.states.size() == samples.beside.size());
  CHECK(samples.clashing.empty());
  CHECK(samples.states.size() >= 4);
  int above = 0, below = 0;
  for (std::size_t s = 0; s < samples.states.size(); ++s) {
    const auto& q = samples.states[s].q;
    const auto& v = samples.states[s].v;
    CHECK(std::hypot(q[0], q[1], q[2]) == doctest::Approx(2).epsilon(1e-9));
    CHECK(std::abs(q[0] * v[0] + q[1] * v[1] + q[2] * v[2]) < 1e-9);
    CHECK(samples.states[s].t >= 0);
    CHECK(samples.states[s].t <= 0.01);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(samples.beside[s].q[i] - place) <= 0.2 * 2 + 1e-12);
      (samples.beside[s].q[i] > place ? above : below) += 1;
    }
  }
  CHECK(above >= 2);
  CHECK(below >= 2);
}

TEST_CASE("a function that jumps at a switch with parameters in it is found out, one that goes on is not") {
  const ModelText m(
      "param m = 1 kg, a = 3 m, k = 2 N/m, E = 5 J\ncoord x : length\nT = 1/2 m x'^2\nV = k max(x - a, 0 m)^2\n");
  const Expr x = m.q(0), distance = x - m.p("a");
  const AcrossSwitches wall = across_switches(*m.system, m.p("E") * apply(Kind::Step, distance), m.equations.order);
  CHECK(wall.switches == 1);
  REQUIRE(wall.jump);
  CHECK(std::abs(wall.jump->jump) == doctest::Approx(5));
  CHECK(wall.jump->at.at(x) == doctest::Approx(3).epsilon(1e-6));
  const AcrossSwitches spring =
      across_switches(*m.system, m.p("E") * distance * apply(Kind::Step, distance), m.equations.order);
  CHECK(spring.switches == 1);
  CHECK(spring.points > 0);
  CHECK_FALSE(spring.jump);
}

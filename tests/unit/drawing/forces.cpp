#include "../model_text.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/drawing.hpp>

#include <cmath>

// Arrows of forces against the forces as they are known: m g, k (s − l0), c ṡ, what is applied, and no more where it is
// not asked for.

using namespace maupertuis;

namespace forces_test {
namespace {

using Origin = Drawing::ForceOrigin;

Trajectory at_state(const MechanicalSystem& system, const std::vector<double>& q, const std::vector<double>& v) {
  Trajectory run;
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name, ""});
  for (const Coordinate& c : system.coordinates) run.columns.push_back({c.name + "'", ""});
  run.times = {0};
  run.values = q;
  run.values.insert(run.values.end(), v.begin(), v.end());
  return run;
}

/// Foot and force in newtons of each arrow of this origin.
std::vector<std::array<double, 4>> forces(const Drawing& d, Origin origin) {
  std::vector<std::array<double, 4>> out;
  for (const Drawing::Element& e : d.elements)
    if (e.kind == Drawing::Kind::Arrow && e.origin == origin)
      out.push_back({e.positions[0], e.positions[1], (e.positions[2] - e.positions[0]) / d.metres_a_newton,
                     (e.positions[3] - e.positions[1]) / d.metres_a_newton});
  return out;
}

void check(const std::array<double, 4>& found, const std::array<double, 4>& wanted) {
  for (std::size_t k = 0; k < 4; ++k) CHECK(found[k] == doctest::Approx(wanted[k]).epsilon(1e-9).scale(1));
}

const std::string block =
    "system block\nparam m = 2 kg, k = 50 N/m, l0 = 1 m, c = 3 N s/m, g = 9.81 m/s^2, F = 7 N\n"
    "coord x, y : length\npoint A at (0, 0)\npoint P mass m at (x, y)\ngravity (0, -g)\n"
    "spring A - P stiffness k length l0\ndamper A - P coefficient c\nforce on P = (F, 0)\n";

}  // namespace

TEST_CASE("weights, springs, dampers and applied forces are arrows of one scale where all forces are asked for") {
  // P = (3, 4) m, 5 m from A, with the velocity (2, 1) m/s, 2 m/s along the spring.
  const ModelText m(block);
  const Trajectory run = at_state(m.model.system, {3, 4}, {2, 1});
  const auto asked = evaluate_drawing(m.model, run);
  REQUIRE(asked);
  for (const Drawing::Element& e : asked->elements) CHECK(e.kind != Drawing::Kind::Arrow);
  const auto all = evaluate_drawing(m.model, run, 1, &m.equations, {}, ForcesShown::All);
  REQUIRE(all);
  REQUIRE(forces(*all, Origin::Weight).size() == 1);
  check(forces(*all, Origin::Weight)[0], {3, 4, 0, -2 * 9.81});
  const auto spring = forces(*all, Origin::Spring), damper = forces(*all, Origin::Damper);
  REQUIRE(spring.size() == 2);
  check(spring[0], {0, 0, 50 * 4 * 0.6, 50 * 4 * 0.8});  // on A, towards P: it is stretched by 4 m
  check(spring[1], {3, 4, -50 * 4 * 0.6, -50 * 4 * 0.8});
  REQUIRE(damper.size() == 2);
  check(damper[1], {3, 4, -3 * 2 * 0.6, -3 * 2 * 0.8});
  REQUIRE(forces(*all, Origin::Applied).size() == 1);
  check(forces(*all, Origin::Applied)[0], {3, 4, 7, 0});
  // The picture of the model is the same: what is not asked for does not make it smaller.
  CHECK(all->low == asked->low);
  CHECK(all->high == asked->high);
}

TEST_CASE("a spring without a rest length and a damper on a line have no root to divide by") {
  const ModelText m(
      "system slider\nparam m = 2 kg, k = 50 N/m, c = 3 N s/m\ncoord x : length\npoint A at (0, 0)\n"
      "point P mass m at (x, 0)\nspring A - P stiffness k\ndamper A - P coefficient c\n");
  const auto drawn =
      evaluate_drawing(m.model, at_state(m.model.system, {0.2}, {-1}), 1, &m.equations, {}, ForcesShown::All);
  REQUIRE(drawn);
  check(forces(*drawn, Origin::Spring).at(1), {0.2, 0, -10, 0});
  check(forces(*drawn, Origin::Damper).at(1), {0.2, 0, 3, 0});
}

TEST_CASE("a torque is an arc about its body that turns as it does, and its opposite about the other body") {
  const ModelText m(
      "system arm\nparam m = 1 kg, I = 0.1 kg m^2, l = 1 m, τ = 2 N m\ncoord α, β : angle\n"
      "body A mass m inertia I at l (cos α, sin α) rotation angle α\n"
      "body B mass m inertia I at 2 l (cos α, sin α) + l (cos β, sin β) rotation angle β\n"
      "torque on B from A = τ\n");
  const auto drawn =
      evaluate_drawing(m.model, at_state(m.model.system, {0.3, 0.5}, {0, 0}), 1, &m.equations, {}, ForcesShown::All);
  REQUIRE(drawn);
  CHECK(drawn->largest_torque == doctest::Approx(2));
  std::map<std::string, double> turned;
  for (const Drawing::Element& e : drawn->elements) {
    if (e.origin != Origin::Torque) continue;
    const bool on_b = e.names[0] == "B";
    const double x = std::cos(0.3) * (on_b ? 2 : 1) + (on_b ? std::cos(0.5) : 0),
                 y = std::sin(0.3) * (on_b ? 2 : 1) + (on_b ? std::sin(0.5) : 0);
    double sum = 0;
    for (std::size_t p = 0; p + 1 < e.points; ++p)
      sum += std::remainder(std::atan2(e.positions[2 * p + 3] - y, e.positions[2 * p + 2] - x) -
                                std::atan2(e.positions[2 * p + 1] - y, e.positions[2 * p] - x),
                            2 * M_PI);
    turned[e.names[0]] = sum;
  }
  REQUIRE(turned.size() == 2);
  CHECK(turned["B"] == doctest::Approx(1.5 * M_PI));
  CHECK(turned["A"] == doctest::Approx(-1.5 * M_PI));
}

TEST_CASE("a torsion spring is an arc about the place about which its coordinate turns, also of a clockwise angle") {
  for (const int way : {1, -1}) {
    const ModelText m(
        "system lever\nparam m = 1 kg, l = 2 m, k = 5 N m/rad\ncoord θ : angle\npoint O at (1 [m], 0)\n"
        "point P mass m at O + (l sin θ, " +
        std::string(way > 0 ? "-" : "") + "l cos θ)\ntorsion spring θ stiffness k rest 0.1 rad\n");
    const auto drawn =
        evaluate_drawing(m.model, at_state(m.model.system, {0.5}, {0}), 1, &m.equations, {}, ForcesShown::All);
    REQUIRE(drawn);
    CHECK(drawn->unplaced_forces.empty());
    CHECK(drawn->largest_torque == doctest::Approx(5 * 0.4));
    std::size_t found = 0;
    for (const Drawing::Element& e : drawn->elements) {
      if (e.kind != Drawing::Kind::Arrow) continue;
      ++found;
      CHECK(e.origin == Origin::Spring);
      const std::size_t last = 2 * (e.points - 1);  // after three quarters of a turn against θ
      CHECK(e.positions[0] - 1 == doctest::Approx(e.positions[last + 1] * way));
      CHECK(e.positions[last] == doctest::Approx(1));
    }
    CHECK(found == 1);
  }
}

TEST_CASE("forces of V, of D and on coordinates stand where their coordinate moves a place") {
  const ModelText chain(
      "system chain\nparam m = 1 kg, k = 10 N/m, c = 2 N/m, b = 3 N s/m, F = 7 N\ncoord x1, x2 : length\n"
      "T = 1/2 m (x1'^2 + x2'^2)\nV = 1/2 k x1^2 + 1/2 c (x2 - x1)^2\nD = 1/2 b x2'^2\nforce x1 = F\n"
      "point W at (-1 [m], 0)\npoint A at (x1, 0)\npoint B at (x2 + 1 [m], 0)\n");
  const auto drawn = evaluate_drawing(chain.model, at_state(chain.model.system, {0.3, 0.8}, {0, -1}), 1,
                                      &chain.equations, {}, ForcesShown::All);
  REQUIRE(drawn);
  CHECK(drawn->unplaced_forces.empty());
  const auto of_v = forces(*drawn, Origin::Potential);
  REQUIRE(of_v.size() == 2);
  check(of_v[0], {0.3, 0, -10 * 0.3 + 2 * 0.5, 0});
  check(of_v[1], {1.8, 0, -2 * 0.5, 0});
  check(forces(*drawn, Origin::Damper).at(0), {1.8, 0, 3, 0});
  check(forces(*drawn, Origin::Applied).at(0), {0.3, 0, 7, 0});

  // In polar coordinates: one arrow, −∂V/∂r along r.
  const ModelText planet(
      "system planet\ndimensionless\nparam μ = 2\ncoord r, φ : number\nT = 1/2 (r'^2 + r^2 φ'^2)\nV = -μ/r\n"
      "point P at (r cos φ, r sin φ)\n");
  const auto central = evaluate_drawing(planet.model, at_state(planet.model.system, {2, 0.6}, {0, 0}), 1,
                                        &planet.equations, {}, ForcesShown::All);
  REQUIRE(central);
  REQUIRE(forces(*central, Origin::Potential).size() == 1);
  check(forces(*central, Origin::Potential)[0],
        {2 * std::cos(0.6), 2 * std::sin(0.6), -0.5 * std::cos(0.6), -0.5 * std::sin(0.6)});

  // In the plane of x and y: both parts of one force.
  const ModelText well(
      "system well\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 x^2 + 2 y^2 + x y\n"
      "point P at (x, y)\n");
  const auto both = evaluate_drawing(well.model, at_state(well.model.system, {2, 3}, {0, 0}), 1, &well.equations, {},
                                     ForcesShown::All);
  REQUIRE(both);
  REQUIRE(forces(*both, Origin::Potential).size() == 1);
  check(forces(*both, Origin::Potential)[0], {2, 3, -5, -14});
}

TEST_CASE("a force that no single arrow stands for is named") {
  // On the block alone it would push the wedge as well; on the wedge it does what it says.
  const ModelText m(
      "system wedge\nparam M = 3 kg, m = 1 kg, k = 9 N/m, F = 4 N\ncoord X, s : length\npoint W mass M at (X, 0)\n"
      "point P mass m at (X + s/2, -s)\nV += 1/2 k s^2\nforce X = F\n");
  const auto drawn =
      evaluate_drawing(m.model, at_state(m.model.system, {1, 0.5}, {0, 0}), 1, &m.equations, {}, ForcesShown::All);
  REQUIRE(drawn);
  CHECK(drawn->unplaced_forces == std::vector<std::string>{"V on s"});
  CHECK(forces(*drawn, Origin::Potential).empty());
  check(forces(*drawn, Origin::Applied).at(0), {1, 0, 4, 0});
  CHECK(drawing_json(*drawn).find("\"unplacedForces\":[\"V on s\"]") != std::string::npos);

  const ModelText charge(
      "system charge\ndimensionless\nparam B = 2\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
      "U = -1/2 B (x y' - y x')\npoint P at (x, y)\n");
  const auto bent = evaluate_drawing(charge.model, at_state(charge.model.system, {1, 0}, {0, 1}), 1, &charge.equations,
                                     {}, ForcesShown::All);
  REQUIRE(bent);
  CHECK(bent->unplaced_forces == std::vector<std::string>{"U"});
}

}  // namespace forces_test

#include "support.hpp"

#include <cmath>

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

TEST_CASE("the kinetic energy of points is that of their velocities") {
  const Elaborated e(
      "param m1 = 2 kg, m2 = 3 kg, l1 = 0.7 m, l2 = 1.3 m\ncoord θ1, θ2 : angle\n"
      "point A mass m1 at l1 (sin θ1, -cos θ1)\npoint B mass m2 at A + l2 (sin θ2, -cos θ2)\n");
  const double a = 0.4, b = -1.2, da = 1.5, db = 0.8;
  const double expected =
      0.5 * 5 * 0.49 * da * da + 0.5 * 3 * 1.69 * db * db + 3 * 0.7 * 1.3 * da * db * std::cos(a - b);
  CHECK(value(e.system().kinetic_energy(), e.at({a, b}, {da, db})) == Approx(expected));
}

TEST_CASE("a rigid body: ½ m v² + ½ ω·I ω, with products of inertia") {
  const Elaborated e(
      "param m = 2 kg, l = 0.5 m\ncoord φ, θ, ψ : angle\n"
      "body B mass m inertia full(0.3 [kg m^2], 0.4 [kg m^2], 0.5 [kg m^2], 0.01 [kg m^2], 0.02 [kg m^2], -0.03 [kg "
      "m^2]) "
      "at l (sin θ cos φ, sin θ sin φ, cos θ) rotation euler zyz (φ, θ, ψ)\n");
  const std::vector<double> q = {0.3, 0.9, -0.5}, v = {0.7, -0.2, 1.1};
  const auto at = e.at(q, v);
  const ExprVector& omega = e.system().bodies[0].angular_velocity;
  const double w[3] = {value(omega[0], at), value(omega[1], at), value(omega[2], at)};
  const double i[3][3] = {{0.3, 0.01, 0.02}, {0.01, 0.4, -0.03}, {0.02, -0.03, 0.5}};
  double rotation = 0;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation += 0.5 * w[r] * i[r][c] * w[c];
  const double speed2 = 0.25 * (v[1] * v[1] + std::pow(std::sin(q[1]) * v[0], 2));
  CHECK(value(e.system().kinetic_energy(), at) == Approx(rotation + speed2));
}

TEST_CASE("springs with and without a rest length, torsion springs, dampers, gravity") {
  const Elaborated e(
      "param m = 2 kg, k = 3 N/m, l0 = 0.5 m, κ = 4 N m/rad, c = 0.6 N s/m, g = 10 m/s^2, J = 1 kg m^2\ncoord x, y : "
      "length, θ : angle\n"
      "point P mass m at (x, y)\nspring O - P stiffness k length l0\nspring (0, 1 [m]) - P stiffness k\n"
      "torsion spring θ stiffness κ rest 0.25 [rad]\ndamper O - P coefficient c\ngravity (0, -g)\nT += 1/2 J θ'^2\n");
  const double x = 0.6, y = -0.8, th = 0.9, vx = 0.3, vy = 0.5;
  const auto at = e.at({x, y, th}, {vx, vy, 0});
  const double V = 0.5 * 3 * 0.25 + 0.5 * 3 * (x * x + (y - 1) * (y - 1)) + 0.5 * 4 * 0.65 * 0.65 + 2 * 10 * y;
  CHECK(value(e.system().potential_energy(), at) == Approx(V));
  const double stretch_rate = x * vx + y * vy;  // |r| = 1
  CHECK(value(e.system().dissipation_function(), at) == Approx(0.5 * 0.6 * stretch_rate * stretch_rate));
}

TEST_CASE("lengths in polar coordinates are written without sines, and sums of squares stay sums") {
  const std::string model =
      "param m = 2 kg, k = 3 N/m, c = 0.6 N s/m, l = 0.5 m, b = 1 N m^2\ncoord r, z : length, φ, θ : angle\n";
  for (const char* place : {"r (sin φ cos θ, sin φ sin θ, cos φ)", "(r cos φ, r sin φ, 0)"}) {
    const Elaborated e(model + "point P mass m at " + place +
                       "\nspring O - P stiffness k length l\ndamper O - P coefficient c\nV += -b/norm(P - O)\n");
    const Expr potential = e.system().potential_energy(), dissipation = e.system().dissipation_function();
    for (const Expr& node : topological_order(std::array{potential, dissipation}))
      CHECK_FALSE((node.is(Kind::Sin) || node.is(Kind::Cos)));
    for (const double r : {0.7, -0.7}) {
      const auto at = e.at({r, 0, 0.3, 1.1}, {0.2, 0, 0.5, -0.4});
      CHECK(value(potential, at) == Approx(0.5 * 3 * 0.04 - 1 / 0.7));
      CHECK(value(dissipation, at) == Approx(0.5 * 0.6 * 0.04));
    }
  }
  // (r cos φ)² + (r sin φ)² + z² would be r² + z²; (r cos φ − z)² + … loses digits where it is multiplied out.
  const Elaborated near(model + "point P mass m at (r cos φ - z, r sin φ, 0)\nspring O - P stiffness k length l\n");
  const double z = 1 + 1e-9;
  CHECK(value(near.system().potential_energy(), near.at({1, z, 0, 0}, {0, 0, 0, 0})) ==
        Approx(0.5 * 3 * std::pow(1e-9 - 0.5, 2)).epsilon(1e-14));
}

TEST_CASE("a damper between ends on one line is 1/2 c u'^2 wherever they are, where they meet too") {
  const std::string model = "param m = 2 kg, c = 0.6 N s/m, α = 30 deg\ncoord x : length\n";
  for (const char* place : {"(x, 0)", "(x cos α, -x sin α)", "(-x, 0)"}) {
    const Elaborated e(model + "point P mass m at " + place + "\ndamper O - P coefficient c\n");
    for (const double x : {-1.0, 0.0, 1.0})
      CHECK(value(e.system().dissipation_function(), e.at({x}, {0.5})) == Approx(0.5 * 0.6 * 0.25));
  }
  const Elaborated away(model + "point P mass m at (x - 3 [m], 0)\ndamper (1 [m], 0) - P coefficient c\n");
  CHECK(value(away.system().dissipation_function(), away.at({4.0}, {0.5})) == Approx(0.5 * 0.6 * 0.25));
}

TEST_CASE("a torsion spring on a name that is not there, or on one without a value, is told once") {
  const std::string model = "param m = 1 kg, κ = 4 N m/rad\ncoord x : length\nT = 1/2 m x'^2\n";
  CHECK(Elaborated(model + "torsion spring z stiffness κ\n").codes() == "E0201");
  CHECK(Elaborated(model + "let z = x + m\ntorsion spring z stiffness κ\n").codes() == "E0302");
  CHECK(Elaborated(model + "torsion spring m stiffness κ\n").codes().find("E0212") == 0);
}

TEST_CASE("virtual work: forces at points, torques, torques between bodies, forces along coordinates") {
  const Elaborated e(
      "param m = 1 kg, l = 2 m, F = 3 N, τ = 5 N m, J = 1 kg m^2\ncoord x : length, θ, φ : angle\n"
      "frame A at (x, 0) rotation angle θ\nbody B mass m inertia J at (l, 0) rotation angle φ in A\n"
      "force on B = (F, 2 F)\nforce on B = (0, F) in A\ntorque on B from A = τ\ntorque on A = 2 τ\nforce x = F\nT += "
      "1/2 J θ'^2\n");
  const double th = 0.6;
  const ExprVector q = e.system().generalized_forces();
  const auto at = e.at({0.1, th, 0.3}, {0, 0, 0});
  CHECK(value(q[0], at) == Approx(3 - 3 * std::sin(th) + 3));
  // ∂r/∂θ = l (-sin θ, cos θ)
  CHECK(value(q[1], at) == Approx(2 * (-3 * std::sin(th) + 6 * std::cos(th)) + 2 * 3 + 10));
  CHECK(value(q[2], at) == Approx(5));
}

TEST_CASE("given energies add, and names of energies in formulas mean them") {
  const Elaborated e(
      "param m = 2 kg, k = 3 N/m, b = 0.1 kg/s\ncoord x, y : length\nT = 1/2 m x'^2\nT += 1/2 m y'^2\nV = 1/2 k (x^2 + "
      "y^2)\nL = T - V + b (x y' - y x')\n");
  const auto at = e.at({0.5, 0.25}, {2, 3});
  CHECK(value(e.system().lagrangian(), at) == Approx(13 - 1.5 * 0.3125 + 0.1 * (0.5 * 3 - 0.25 * 2)));
  CHECK_MESSAGE(e.fine(), e.messages());
}

TEST_CASE("short names of energies may be names of the model; the long names always work") {
  const Elaborated e(
      "param V = 2 m^3, p = 3 Pa, m = 1 kg\ncoord x : number\nkinetic = 1 [m^2] m x'^2/2\npotential = p V x^2\nlet E = "
      "kinetic + potential\nexpect conserved E\n");
  CHECK_MESSAGE(e.fine(), e.messages());
  CHECK(value(e.system().potential_energy(), e.at({2}, {0})) == Approx(24));
}

TEST_CASE("definitions of parameters stay symbols in the system as written, and nowhere else") {
  const Elaborated e("param m = 2 kg, R = 3 m\nlet I = 1/2 m R^2, K = 2 I, n = 2\ncoord φ : angle\nT = 1/2 K φ'^n\n");
  CHECK_MESSAGE(e.fine(), e.messages());
  const MechanicalSystem& s = e.system();
  REQUIRE(s.written);
  const Expr K = s.definitions[1].symbol;
  REQUIRE(K);
  CHECK_FALSE(s.definitions[2].symbol);  // a number
  const auto has = [](Expr where, Expr what) {
    for (const Expr& x : symbols_of({&where, 1}))
      if (x == what) return true;
    return false;
  };
  CHECK(has(s.written->kinetic_energy(), K));
  CHECK_FALSE(has(s.kinetic_energy(), K));
  CHECK(substitute(s.written->kinetic_energy(), s.definition_values()) == s.kinetic_energy());
  CHECK(value(s.kinetic_energy(), e.at({0}, {1})) == Approx(9));
}

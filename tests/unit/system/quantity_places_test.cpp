#include "support.hpp"

#include <cmath>

// A quantity needs no brackets around its unit wherever it follows a keyword or the `=` of a force, an input or a
// constraint: what the place asks for decides what its words are.

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

namespace {

/// The Lagrangian of a model without names for its numbers, at a state.
double lagrangian(const std::string& text, const std::vector<double>& q, const std::vector<double>& v, double t = 0) {
  const Elaborated e(text);
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  CHECK_FALSE(e.diagnostics.has_errors());
  return value(e.system().lagrangian(), e.at(q, v, t));
}

struct Same {
  const char *plain, *bracketed;
};

}  // namespace

TEST_CASE("a number with its unit follows each keyword that a quantity follows") {
  const std::string head = "coord x : length\n";
  for (const Same& same : {
           Same{"point P mass 2 kg at (x, 0)", "point P mass 2 [kg] at (x, 0)"},
           Same{"point P mass 2 kg at (x, 3 m)", "point P mass 2 [kg] at (x, 3 [m])"},
           Same{"point P mass 500 g at (x, 0)\ngravity (0, -9.81) m/s^2",
                "point P mass 0.5 [kg] at (x, 0)\ngravity (0, -9.81) [m/s^2]"},
           Same{"point P mass 2 kg at (x, x)\ngravity (0, -9.81 m/s^2)",
                "point P mass 2 [kg] at (x, x)\ngravity (0, -9.81 [m/s^2])"},
           Same{"body B mass 2 kg inertia 0.1 kg m^2 at (x, 0)", "body B mass 2 [kg] inertia 0.1 [kg m^2] at (x, 0)"},
           Same{"point P mass 2 kg at (x, 0)\nspring O - P stiffness 40 N/m length 10 cm",
                "point P mass 2 [kg] at (x, 0)\nspring O - P stiffness 40 [N/m] length 0.1 [m]"},
           Same{"point P mass 2 kg at (x, 0)\nspring O - P stiffness 40 N/m length 1/2 m",
                "point P mass 2 [kg] at (x, 0)\nspring O - P stiffness 40 [N/m] length 0.5 [m]"},
           Same{"point P mass 2 kg at (x, 0)\nspring O - P stiffness 4*10^1 N/m",
                "point P mass 2 [kg] at (x, 0)\nspring O - P stiffness 40 [N/m]"},
           Same{"frame F at (1, 2) m rotation angle 30 deg\npoint P mass 2 kg at (x, 1 m) in F\ngravity (0, -1) m/s^2",
                "frame F at (1, 2) [m] rotation angle 30 [deg]\npoint P mass 2 [kg] at (x, 1 [m]) in F\ngravity (0, "
                "-1) [m/s^2]"},
       }) {
    CAPTURE(same.plain);
    CHECK(lagrangian(head + same.plain + "\n", {0.3}, {0.7}) ==
          Approx(lagrangian(head + same.bracketed + "\n", {0.3}, {0.7})).epsilon(1e-14));
  }
}

TEST_CASE("a torsion spring, a damper, forces, an input and constraints take quantities") {
  const Elaborated e(
      "param J = 1 kg m^2\ncoord θ : angle, x : length\nT = 1/2 J θ'^2\npoint P mass 1 kg at (x, 0)\n"
      "torsion spring θ stiffness 5 N m rest 90 deg\ndamper O - P coefficient 3 N s/m\nforce θ = 2 N m\nforce on P = "
      "(3, 4) N\n"
      "input u : [N] = 7 N\nconstraint x^2 = 4 m^2\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  const MechanicalSystem& s = e.system();
  const Bindings at = e.at({0, 2}, {0, 1});
  CHECK(value(s.potential_energy(), at) == Approx(0.5 * 5 * std::pow(std::acos(-1) / 2, 2)));
  CHECK(value(s.dissipation_function(), at) == Approx(1.5));
  CHECK(value(s.forces[0].components[0], at) == Approx(2));
  CHECK(value(s.forces[1].components[1], at) == Approx(4));
  CHECK(value(s.inputs[0].formula, at) == Approx(7));
  CHECK(value(s.constraints[0].value, at) == Approx(0));
}

TEST_CASE("a body in space: inertia with one unit behind the bracket, angles of rotations") {
  const Elaborated e(
      "coord φ : angle\nbody B mass 1 kg inertia diag(1, 2, 3) kg m^2 rotation axis (0, 0, 1) angle φ\n"
      "body C mass 1 kg inertia full(2, 2, 3, 0, 0, 0.1) kg m^2 at (0, 0, 1 m) rotation euler zxz (10 deg, 20 deg, "
      "φ)\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  CHECK(value(e.system().kinetic_energy(), e.at({0.2}, {2})) == Approx(0.5 * 3 * 4 + 0.5 * 3 * 4));
}

TEST_CASE("names and units: the reading whose dimension fits is taken, and two that fit are told") {
  const std::string head = "param m = 3 kg, l = 2 m, g = 9.81 m/s^2\ncoord x : length\n";
  // `2 m` is a length after `length` and a mass after `mass`; `2 g` after `mass` is in grams, since g is no mass.
  CHECK(lagrangian(head + "point P mass 2 m at (x, 0)\n", {0}, {1}) == Approx(0.5 * 6));
  CHECK(lagrangian("param g = 9.81 m/s^2\ncoord x : length\npoint P mass 2 g at (x, x)\ngravity (0, -g)\n", {0}, {1}) ==
        Approx(0.002));
  CHECK(lagrangian(head + "point P mass m at (x, 2 m)\ngravity (0, -g)\n", {0}, {0}) == Approx(-3 * 9.81 * 2));
  CHECK(lagrangian(head + "point P mass 1/2 m at (x, 2 l)\ngravity (0, -g)\n", {0}, {0}) == Approx(-1.5 * 9.81 * 4));
  const Elaborated both("param N = 5 N\ncoord x : length\nT = 1/2 (1 [kg]) x'^2\nforce x = 2 N\n");
  CHECK(both.codes() == "E0307");
  const Elaborated chosen("param N = 5 N\ncoord x : length\nT = 1/2 (1 [kg]) x'^2\nforce x = 2 [N]\n");
  CHECK_FALSE(chosen.diagnostics.has_errors());
  // A weight: m g is a force by its names; as a product of units it would be none.
  const Elaborated weight(head + "T = 1/2 m x'^2\nforce x = 2 m g\npoint Q at (l, 0)\n");
  REQUIRE_MESSAGE(weight.model.has_value(), weight.messages());
  CHECK(value(weight.system().forces[0].components[0], weight.at({0}, {0})) == Approx(2 * 3 * 9.81));
}

TEST_CASE("without units a number before names is a product, t among them") {
  const Elaborated e(
      "dimensionless\nparam m = 2\ncoord x : number\nT = 1/2 m x'^2\nforce x = 3 m + t\nforce x = 2 t\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  CHECK(value(e.system().forces[1].components[0], e.at({0}, {0}, 5)) == Approx(10));
  // In starts, runs and expectations too, where the words might be units.
  const Elaborated places(
      "dimensionless\nparam m = 2, s = 3\ncoord x, y : number\nL = 1/2 m (x'^2 + y'^2)\nstart x = 1/s, y = 2 m\n"
      "run 2 s\nexpect x at 2 s = 1/s ± 1 m\n");
  REQUIRE_MESSAGE(places.model.has_value(), places.messages());
  const auto start = [&](std::size_t i) {
    return value(places.model->experiment.start[i].value, places.at({0, 0}, {0, 0}));
  };
  CHECK(start(0) == Approx(1.0 / 3));
  CHECK(start(1) == Approx(4));
}

TEST_CASE("numbers with π and powers are quantities") {
  const Elaborated e(
      "param ω = 10 pi rad/s, p = 2*10^5 Pa, n = 1/2, q = sqrt(2) m, a = 10 pi [rad/s], w = pi/2 rad\ncoord x : "
      "length\nT = 1/2 (1 [kg]) x'^2\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  const double pi = std::acos(-1);
  const std::vector<std::pair<std::string, double>> values = {{"ω", 10 * pi},        {"p", 2e5},     {"n", 0.5},
                                                              {"q", std::sqrt(2.0)}, {"a", 10 * pi}, {"w", pi / 2}};
  for (const auto& [name, si] : values) CHECK(e.system().find_parameter(name)->si_value == Approx(si).epsilon(1e-15));
  CHECK(e.system().find_parameter("ω")->unit == "rad/s");
}

TEST_CASE("a unit after what has one is refused") {
  CHECK(Elaborated("coord x : length\npoint P mass 1 kg at (1 m, 2 m) m\nT = 1/2 (1 [kg]) x'^2\n")
            .codes()
            .find("E0302") == 0);
}

TEST_CASE("one bare end of a sweep has the unit of the other") {
  const Elaborated e(
      "param Ω = 1 rad/s\ncoord θ : angle\nT = 1/2 (1 [kg m^2]) (θ' - Ω)^2\nsweep Ω = 20 .. 200 rad/s steps 3\n");
  REQUIRE_MESSAGE(e.model.has_value(), e.messages());
  CHECK(evaluate(e.experiment().sweep->from, {}) == Approx(20));
}

// What friction multiplies and reaction(…) shows: the force across a surface, in any coordinates.
#include "run_text.hpp"

#include <cmath>
#include <string>

using namespace maupertuis;

TEST_CASE("friction is μ times the normal force, also where the gap is not the distance to the surface") {
  const std::string bead =
      "dimensionless\nparam μ = 0.3\ncoord x, y : number\npoint P mass 1 at (x, y)\ngravity (0, -10)\n";
  const std::string slip = " friction μ slip (x' + 2 x y')/sqrt(1 + 4 x^2) name bowl\nstart x = 1, y = 1\n";
  ModelText height(bead + "contact y - x^2 >= 0" + slip);
  ModelText distance(bead + "contact (y - x^2)/sqrt(1 + 4 x^2) >= 0" + slip);
  const auto a = run(height, 0.5), b = run(distance, 0.5);
  CHECK(a.final.q[0] == doctest::Approx(b.final.q[0]).epsilon(1e-13));
  CHECK(a.books->friction == doctest::Approx(b.books->friction).epsilon(1e-12));
  CHECK(height.diagnostics.items().empty());
  // An impact: the tangential impulse is μ times the normal one, 1.5 · 2 · 0.3.
  ModelText twice(bead + "contact 2 y >= 0 restitution 0.5 friction μ slip x' name floor\nstart x' = 5, y = 0.2\n");
  const auto c = run(twice, 0.21);
  REQUIRE(count(c, Happening::Kind::Impact) == 1);
  CHECK(c.final.v[0] == doctest::Approx(5 - 0.9).epsilon(1e-13));
  CHECK(c.final.v[1] == doctest::Approx(1 - 10 * 0.01).epsilon(1e-12));
  // A factor of the slip is told: nothing says that it is none of a gear.
  ModelText factor(bead + "contact y >= 0 friction μ slip 2 x' name floor\n");
  REQUIRE(factor.diagnostics.items().size() == 1);
  CHECK(factor.diagnostics.items()[0].code == "W0435");
}

TEST_CASE("a block on a wedge that slides, by a gap that is no distance") {
  // Newton's equations by hand: N = m (g cos α)/(1 + m/M sin α (sin α − μ cos α)), X'' = −N (sin α − μ cos α)/M.
  const double a = 50 * 3.14159265358979323846 / 180, mu = 0.3, m = 1, M = 3, g = 9.81;
  const double share = std::sin(a) - mu * std::cos(a);
  const double N = m * g * std::cos(a) / (1 + m / M * std::sin(a) * share);
  const std::string wedge =
      "param m = 1 kg, M = 3 kg, g = 9.81 m/s^2, α = 50 deg, μ = 0.3\ncoord X, x, y : length\npoint W mass M at (X, "
      "0)\n"
      "point P mass m at (x, y)\ngravity (0, -g)\n";
  const std::string rest = " friction μ slip (x' - X') cos α + y' sin α name face\nstart x = 2 m, y = 2 [m] * tan(α)\n";
  for (const std::string gap : {"contact y >= (x - X) tan α", "contact 3 y cos α - 3 (x - X) sin α >= 0"}) {
    ModelText model(wedge + gap + rest);
    const auto r = run(model, 0.4);
    CHECK(model.diagnostics.items().empty());
    CHECK(r.final.q[0] == doctest::Approx(-N * -share / M * 0.08).epsilon(1e-12));
    CHECK(r.final.reactions[0] == doctest::Approx(N).epsilon(1e-12));
  }
  // The block in polar coordinates, on the wedge and on a slope that is at rest.
  ModelText polar(
      "param m = 1 kg, M = 3 kg, g = 9.81 m/s^2, α = 50 deg, μ = 0.3\ncoord X, r : length, φ : angle\n"
      "point W mass M at (X, 0)\npoint P mass m at (r cos φ, r sin φ)\ngravity (0, -g)\n"
      "contact P.y >= (P.x - X) tan α friction μ slip (P.x' - X') cos α + P.y' sin α name face\n"
      "start r = 2 m, φ = α\n");
  const auto turned = run(polar, 0.4);
  CHECK(turned.final.q[0] == doctest::Approx(N * share / M * 0.08).epsilon(1e-12));
  CHECK(turned.final.reactions[0] == doctest::Approx(N).epsilon(1e-12));
  // At rest on a slope, in coordinates along directions that are not at right angles: N = m g cos atan 0.2.
  ModelText oblique(
      "dimensionless\ncoord a, b : length\npoint P mass 2 at (a + b cos(0.7), b sin(0.7))\ngravity (0, -10)\n"
      "contact 2 P.y - 0.4 P.x >= 0 friction 0.5 slip (P.x' + 0.2 P.y')/sqrt(1.04) name slope\n");
  CHECK(run(oblique, 0.1).final.reactions[0] == doctest::Approx(20 / std::sqrt(1.04)).epsilon(1e-12));
  CHECK(oblique.diagnostics.items().empty());
  const auto code = [](const std::string& text) {
    ModelText model(text);
    return model.diagnostics.items().empty() ? std::string() : model.diagnostics.items()[0].code;
  };
  const std::string formulas = "dimensionless\ncoord x, y : length\nT = 1/2 (x'^2 + y'^2)\nV = 10 y\n",
                    slope = " friction 0.3 slip (x' + 2 x y')/sqrt(1 + 4 x^2)\nstart y = 1\n";
  CHECK(code(formulas + "contact y - x^2 >= 0" + slope) == "W0437");
  CHECK(code(formulas + "contact (y - x^2)/sqrt(1 + 4 x^2) >= 0" + slope) == "");
  CHECK(code(formulas + "contact 2 y >= 0 friction 0.3 slip x'\n") == "W0437");
  CHECK(code(formulas + "contact y >= 0 friction 0.3 slip x'\n") == "");
  CHECK(code(formulas + "contact x cos(0.3) + y sin(0.3) >= 0 friction 0.3 slip x' sin(0.3) - y' cos(0.3)\n") == "");
}

TEST_CASE("the normal force on an oblique surface, in any coordinates and for any spelling of the slip") {
  // N = m g cos α on a slope; s'' = −g (sin α + μ cos α) upwards.
  const double a = 30 * 3.14159265358979323846 / 180, mu = 0.3, g = 9.81;
  const auto slope = run_text(
      "param m = 2 kg, g = 9.81 m/s^2, α = 30 deg\ncoord s, n : length\npoint P mass m at (s cos α, n + s sin α)\n"
      "gravity (0, -g)\ncontact n >= 0 friction 0.3 slip s' name plane\nstart s' = 1 m/s\n",
      0.1);
  CHECK(slope.final.reactions[0] == doctest::Approx(2 * g * std::cos(a)).epsilon(1e-14));
  CHECK(slope.final.v[0] == doctest::Approx(1 - 0.1 * g * (std::sin(a) + mu * std::cos(a))).epsilon(1e-14));
  // Held there, whatever the force.
  const auto held = run_text(
      "param m = 2 kg, g = 9.81 m/s^2, α = 30 deg\ncoord s, n : length\npoint P mass m at (s cos α, n + s sin α)\n"
      "gravity (0, -g)\ncontact n >= 0 slip s' sticking name plane\n",
      0.1);
  CHECK(held.final.reactions[0] == doctest::Approx(2 * g * std::cos(a)).epsilon(1e-14));
  CHECK(held.final.q[0] == 0);
  // The same in space, the third coordinate along the slope too.
  const auto space = run_text(
      "param m = 2 kg, g = 9.81 m/s^2, α = 30 deg\ncoord s, z, n : length\n"
      "point P mass m at (s cos α + 0.2 z, z, n + s sin α)\ngravity (0, 0, -g)\ncontact n >= 0 name plane\n",
      0.1);
  // Its plane holds (cos α, 0, sin α) and (0.2, 1, 0).
  const double normal = std::cos(a) / std::sqrt(1 + 0.04 * std::sin(a) * std::sin(a));
  CHECK(space.final.reactions[0] == doctest::Approx(2 * g * normal).epsilon(1e-14));

  // A block that slides down a wedge of 5 kg, which recoils; without friction N = M m g cos α/(M + m sin² α).
  const std::string both = "param m = 2 kg, M = 5 kg, g = 9.81 m/s^2, α = 30 deg\n",
                    wedge = "point W mass M at (X, 0)\ngravity (0, -g)\n",
                    cartesian = both + "coord X, x, y : length\npoint P mass m at (x, y)\n" + wedge,
                    height = both + "coord X, x, h : length\npoint P mass m at (x, h - (x - X) tan α)\n" + wedge,
                    gap = "contact y + (x - X) tan α >= 0";
  const double smooth = 5 * 2 * g * std::cos(a) / (5 + 2 * std::sin(a) * std::sin(a));
  CHECK(run_text(cartesian + gap + " name face\n", 0.3).final.reactions[0] == doctest::Approx(smooth).epsilon(1e-13));
  CHECK(run_text(height + "contact h >= 0 name face\n", 0.3).final.reactions[0] ==
        doctest::Approx(smooth).epsilon(1e-13));
  // With friction N (cos α + μ sin α + tan α (sin α − μ cos α) (1 + m/M)) = m g.
  const double rough =
      2 * g / (std::cos(a) + mu * std::sin(a) + std::tan(a) * (std::sin(a) - mu * std::cos(a)) * (1 + 2.0 / 5));
  for (const std::string& text :
       {cartesian + gap +
            " friction 0.3 slip (x' - X')/cos α name face\nstart x' = 1 cm/s, y' = -0.57735026918962573 cm/s\n",
        cartesian + gap +
            " friction 0.3 slip (x' - X') cos α - y' sin α name face\nstart x' = 1 cm/s, y' = -0.57735026918962573 "
            "cm/s\n",
        height + "contact h >= 0 friction 0.3 slip (x' - X')/cos α name face\nstart x' = 1 cm/s\n"}) {
    ModelText model(text);
    const auto r = run(model, 0.3);
    CHECK(model.diagnostics.items().empty());
    CHECK(r.final.reactions[0] == doctest::Approx(rough).epsilon(1e-12));
  }
}

TEST_CASE("the force at the tip of an arm and on a rope, for gaps that are twice a distance, and at a lever") {
  const auto same = [](const std::string& model, const std::string& gap, const std::string& rest, double end) {
    ModelText plain(model + "contact " + gap + " >= 0" + rest), twice(model + "contact 2*(" + gap + ") >= 0" + rest);
    const auto a = run(plain, end), b = run(twice, end);
    CHECK(plain.diagnostics.items().empty());
    CHECK(twice.diagnostics.items().empty());
    for (std::size_t i = 0; i < a.final.q.size(); ++i)
      CHECK(a.final.q[i] == doctest::Approx(b.final.q[i]).scale(1).epsilon(1e-12));
    CHECK(a.final.reactions[0] > 1);
    CHECK(a.final.reactions[0] == doctest::Approx(b.final.reactions[0]).epsilon(1e-11));
    return a;
  };
  // Coordinates that move the elbow as well, and both: one of these masses is pressed, and it is the tip.
  const std::string arm =
      "dimensionless\ncoord a, b, c : number\npoint A mass 1 at (cos(a), sin(a))\n"
      "point B mass 1 at A + (cos(b), sin(b))\npoint C mass 2 at B + (cos(c), -1)\ngravity (0, -10)\n";
  same(arm, "B.y", " friction 0.3 slip B.x' name floor\nstart a = 0.9, b = -0.9, c = 1\n", 0.2);
  same(
      "dimensionless\ncoord a, b : number\npoint A mass 1 at (cos(a), sin(a))\npoint B mass 1 at A + (cos(b), sin(b))\n"
      "gravity (0, -10)\n",
      "B.y", " friction 0.3 slip B.x' name floor\nstart a = 0.9, b = -0.9\n", 0.2);
  // Atwood's machine: T = 2 m₁ m₂ g/(m₁ + m₂).
  const auto rope = same(
      "dimensionless\ncoord x, y, u, v : number\npoint P mass 1 at (x, y)\npoint Q mass 2 at (u, v)\n"
      "gravity (0, -10)\n",
      "2 - norm(P) - norm(Q)", " name rope\nstart y = -1, v = -1\n", 0.1);
  CHECK(rope.final.reactions[0] == doctest::Approx(40.0 / 3).epsilon(1e-12));
  // A lever of 2 to 1: half of the weight at its tip, and twice the friction there at the mass.
  ModelText lever(
      "dimensionless\ncoord x, y : number\npoint P mass 1 at (x, y)\npoint tip at (2 x, 2 y)\ngravity (0, -10)\n"
      "contact tip.y >= 0 friction 0.3 slip tip.x' name floor\nstart x' = 5\n");
  const auto r = run(lever, 0.1);
  CHECK(lever.diagnostics.items().empty());
  CHECK(r.final.reactions[0] == doctest::Approx(5).epsilon(1e-13));
  CHECK(r.final.v[0] == doctest::Approx(5 - 0.1 * 2 * 0.3 * 5).epsilon(1e-13));
}

TEST_CASE("a slip that holds the rate at which the contact opens is refused, however the body is given") {
  const auto code = [](const std::string& text) {
    Diagnostics diagnostics;
    const SourceText source("model", text);
    const auto tree = syntax::parse(source, diagnostics);
    const auto model = diagnostics.has_errors() ? std::nullopt : elaborate(tree, source, diagnostics);
    if (model) {
      const auto equations = euler_lagrange(std::make_shared<const MechanicalSystem>(model->system), diagnostics);
      SimulationOptions options;
      options.duration = 0.1;
      if (equations) static_cast<void>(simulate(*model, *equations, options, diagnostics));
    }
    for (const Diagnostic& d : diagnostics.items())
      if (d.severity == Severity::Error) return d.code;
    return std::string();
  };
  const std::string point = "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\npoint P mass m at (x, z)\n",
                    energies =
                        "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\n"
                        "T = 1/2 m (x'^2 + z'^2)\nV = m g z\n",
                    polar =
                        "param m = 1 kg, R = 1 m\ncoord r : length, φ : angle\n"
                        "point P mass m at (r cos φ, r sin φ)\nstart r = R\n",
                    turned =
                        "param m = 1 kg, l = 0.5 m\ncoord x, z : length, θ : angle\n"
                        "body B mass m inertia 0.1 kg m^2 at (x, z) rotation angle θ\n";
  for (const std::string& model : {point, energies}) {
    CHECK(code(model + "contact z >= 0 friction 0.3 slip x' + z'\n") == "E0265");
    CHECK(code(model + "contact z >= 0 friction 0.3 slip x'\n") == "");
  }
  CHECK(code(polar + "contact r >= R friction 0.3 slip R φ' + r'\n") == "E0265");
  CHECK(code(polar + "contact r >= R friction 0.3 slip r φ'\n") == "");
  CHECK(code(turned + "contact z - l sin θ >= 0 friction 0.3 slip x' + l sin θ θ' - z'\n") == "E0265");
  CHECK(code(turned + "contact z - l sin θ >= 0 friction 0.3 slip x' + l sin θ θ'\n") == "");
  // Coordinates along which a point does more than open the contact: the slip is laid along the surface.
  CHECK(code("param m = 1 kg, α = 30 deg\ncoord s, n : length\npoint P mass m at (s cos α, n + s sin α)\n"
             "contact n >= 0 friction 0.3 slip s'\n") == "");
  CHECK(code("param m = 1 kg, α = 30 deg\ncoord s, n : length\n"
             "T = 1/2 m (s'^2 + n'^2 + 2 s' n' sin α)\n"
             "contact n >= 0 friction 0.3 slip s' + n' sin α\n") == "");
}

TEST_CASE("friction by the resultant of forces of constraint is refused, by one of them it is computed") {
  const auto bead = [](const std::string& normal) {
    return "param m = 0.1 kg, R = 0.3 m, Ω = 8 rad/s, g = 9.81 m/s^2, μ = 0.2\ncoord r : length, θ, φ : angle\n"
           "point P mass m at r (sin θ cos φ, sin θ sin φ, -cos θ)\ngravity (0, 0, -g)\nconstraint r = R name hoop\n"
           "constraint φ = Ω t name spin\nfriction θ coefficient μ normal " +
           normal + "\nstart r = R, θ = 20 deg\n";
  };
  ModelText m(bead("R sqrt(reaction(hoop)^2 + reaction(spin)^2/(R sin θ)^2)"));
  SimulationOptions options;
  options.duration = 1;
  CHECK_FALSE(simulate(m.model, m.equations, options, m.diagnostics));
  REQUIRE(!m.diagnostics.items().empty());
  CHECK(m.diagnostics.items().back().code == "E0733");
  run_text(bead("R abs(reaction(hoop))"), 1);
}

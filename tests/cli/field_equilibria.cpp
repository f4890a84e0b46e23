// Equilibria of fields and of the bodies beside them: what `expect` says of them, what is shown and drawn.
#include "program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace cli_test;

namespace {

const std::string film =
    "dimensionless\nfield y(x) : number on x = -1 .. 1\ndensity = -y sqrt(1 + y_x^2)\nboundary y = cosh(1)\n";

/// Of a model with one more line.
Outcome at_rest(const std::string& model, const std::string& line) {
  return maup({"test", "-"}, model + "expect " + line + "\n");
}

const std::string bead =
    "param T0 = 40 N, l = 1 m, m = 0.3 kg, g = 9.81 m/s^2, ρ = 3 g/m\nfield u(x) : length on x = 0 m .. l\n"
    "boundary u = 0\ndensity = 1/2 ρ u'^2 - 1/2 T0 u_x^2 - ρ g u\nT = 1/2 m u(l/2)'^2\nV = m g u(l/2)\n";

}  // namespace

TEST_CASE("expect equilibrium of a field: values, slopes, integrals, stability") {
  const std::string shallow = film + "start y = 1.2\n", deep = film + "start y = 0.7 + 0.84 x^2\n";
  CHECK(at_rest(shallow, "equilibrium at y(0) = 1 ± 1e-12, y_x(1) = sinh(1) ± 1e-10 is stable").code == 0);
  CHECK(at_rest(shallow, "total sqrt(1 + y_x^2) at equilibrium = 2*sinh(1) rel 1e-12").code == 0);
  const Outcome off = at_rest(shallow, "equilibrium at y(1/2) = cosh(0.5) rel 1e-12, y(0) = 1.5 ± 1e-3");
  CHECK(off.code == 4);
  CHECK(contains(off.out, "y(0) = 1.5 ± 0.001"));
  CHECK(contains(off.out, "off by -0.5"));
  CHECK(at_rest(deep, "equilibrium at y(0) = 0.7 ± 0.01 is unstable").code == 0);
  const Outcome word = at_rest(deep, "equilibrium at y(0) = 0.7 ± 0.01 is stable");
  CHECK(word.code == 4);
  CHECK(contains(word.out, "unstable"));
  // Rings too far apart have no film between them.
  const Outcome none = maup({"test", "-"},
                            "dimensionless\nfield y(x) : number on x = -1 .. 1\ndensity = -y sqrt(1 + y_x^2)\n"
                            "boundary y = 1.2\nstart y = 1\nexpect equilibrium at y(0) = 1\n");
  CHECK(none.code == 4);
  CHECK(contains(none.out, "no equilibrium"));
  CHECK(at_rest(shallow, "equilibrium at y_xx(0) = 1").code == 4);  // no value: slopes of elements are not continuous
}

TEST_CASE("expect equilibrium of what rests by a formula, and in the plane") {
  const std::string wells =
      "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 u_x^2 - 1/4 (u^2 - 1)^2\n";
  CHECK(at_rest(wells, "equilibrium at u(0.3) = 0 ± 1e-12 is unstable").code == 0);
  CHECK(at_rest(wells + "start u = 1\n", "equilibrium at u(0.3) = 1 ± 1e-12 is stable").code == 0);
  const std::string plane =
      "dimensionless\nfield z(x, y) : number on x = 0 .. 1, y = 0 .. 1\ndensity = -1/2 (z_x^2 + z_y^2)\n"
      "boundary z = x^2 - y^2\n";
  CHECK(at_rest(plane, "equilibrium at z(0.3, 0.8) = 0.09 - 0.64 ± 1e-12 is stable").code == 0);
  CHECK(at_rest(plane, "total z_x^2 at equilibrium = 4/3 rel 1e-12").code == 0);
}

TEST_CASE("bodies rest with the fields that they take hold of") {
  CHECK(at_rest(bead, "equilibrium at u(l/2) = -m g l/(4 T0) - ρ g l^2/(8 T0) rel 1e-12 is stable").code == 0);
  CHECK(at_rest(bead, "equilibrium at u(l/4) = -m g l/(8 T0) - 3/32*ρ g l^2/T0 rel 1e-12").code == 0);
  const std::string beam =
      "param EI = 20 N m^2, ρ = 1 kg/m, l = 2 m, m = 0.5 kg, g = 9.81 m/s^2\nfield w(x) : length on x = 0 m .. l\n"
      "boundary left : w = 0, w_x = 0\nV = m g w(l)\n";
  const std::string tip =
      "equilibrium at w(l) = -(ρ g l^4/8 + m g l^3/3)/EI rel 1e-12, "
      "w_x(l) = -(ρ g l^3/6 + m g l^2/2)/EI rel 1e-12 is stable";
  CHECK(at_rest(beam + "density = -1/2 EI w_xx^2 - ρ g w\n", tip).code == 0);
  CHECK(at_rest(beam + "T = 1/2 m w(l)'^2\ndensity = 1/2 ρ w'^2 - 1/2 EI w_xx^2 - ρ g w\n", tip).code == 0);
}

TEST_CASE("a field that is not linear rests under a weight, and moves about that rest") {
  // u'' = sin u, u(0) = 0, u'(3) = 0.7, and v'' = (cos u − ω²) v, v'(3) = 0.4 ω² v(3): integrated in 20 digits.
  const std::string chain =
      "dimensionless\nfield u(x) : number on x = 0 .. 3\nboundary left : u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2 - (1 - cos u)\nT = 0.2*u(3)'^2\nV = -0.7*u(3)\n";
  CHECK(
      at_rest(chain, "equilibrium at u(3) = 0.71121270336183529 ± 1e-12, u_x(0) = 0.07170547449977184 ± 1e-10").code ==
      0);
  CHECK(at_rest(chain, "frequencies of u : 0.941661870976651, 1.66444352795072 rel 1e-10").code == 0);
}

TEST_CASE("constraints tie coordinates to a field at rest") {
  // 6.4 sin θ cos θ − 0.5886 cos θ + 5 (θ − 0.1) = 0, from the energy of a string pulled in its middle.
  const std::string tied =
      "param T0 = 40 N, l = 1 m, m = 0.3 kg, g = 9.81 m/s^2, k = 5 N m, a = 0.2 m\ncoord θ : angle\n"
      "field u(x) : length on x = 0 m .. l\nboundary u = 0\ndensity = -1/2 T0 u_x^2\n"
      "V = -m g a sin θ + 1/2 k (θ - 0.1)^2\nconstraint u(l/2) = a sin θ name tie\nstart θ = 0.1\n";
  CHECK(at_rest(tied, "equilibrium at θ = 0.09558178151031 ± 1e-12 is stable").code == 0);
}

TEST_CASE("a rest beyond an open contact is none") {
  const std::string chain =
      "dimensionless\nfield u(x) : number on x = 0 .. 3\nboundary left : u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2 - (1 - cos u)\nT = 0.2*u(3)'^2\nV = -0.7*u(3)\n";
  const Outcome shut = at_rest(chain + "contact u(3) <= 0.5 name stop\n", "equilibrium at u(3) = 0.7 ± 0.1");
  CHECK(shut.code == 4);
  CHECK(contains(shut.out, "stop"));
  CHECK(contains(maup({"modes", "-"}, chain + "contact u(3) <= 0.5 name stop\n").err, "E0644"));
}

TEST_CASE("equilibria are printed, written and drawn") {
  const Outcome modes = maup({"modes", "-"}, bead), json = maup({"modes", "-", "--json"}, bead);
  CHECK(contains(modes.out, "u(l/2) = -0.01848571875"));
  const auto document = nlohmann::json::parse(json.out);
  CHECK(document["equilibrium"]["coordinates"]["u(l/2)"].get<double>() ==
        doctest::Approx(-0.01848571875).epsilon(1e-12));
  const Outcome curve = maup({"plot", "-"}, film + "start y = 1.2\n");
  CHECK(curve.code == 0);
  CHECK(contains(curve.out, "</svg>"));
}

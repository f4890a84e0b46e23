#include "../under_sanitizers.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

/// Frequencies and shapes of membranes against their closed forms.
using namespace maupertuis;

namespace plane_modes_test {
namespace {

FieldModes plane_modes_of(const std::string& text, std::size_t count) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  Diagnostics diagnostics;
  FieldModes out = field_modes(*equations, count, diagnostics);
  REQUIRE_MESSAGE(out.frequencies.size() == count, text);
  return out;
}

/// π c sqrt(m²/a² + n²/b²) for m = m0, m0 + step, …, n alike, the lowest.
std::vector<double> closed_forms(double c, double a, double b, double m0, double n0, std::size_t count) {
  std::vector<double> out;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) out.push_back(std::acos(-1.0) * c * std::hypot((m0 + i) / a, (n0 + j) / b));
  std::sort(out.begin(), out.end());
  out.resize(count);
  return out;
}

const std::string density = "density = 1/2 u'^2 - 1/2 c^2 (u_x^2 + u_y^2)\n";

std::string rectangle(const std::string& boundary) {
  return "dimensionless\nparam c = 2\nfield u(x, y) : number on x = 0 .. 3, y = -1 .. 0\n" + density + boundary;
}

}  // namespace

TEST_CASE("a rectangle of any sides: π c sqrt(m²/a² + n²/b²)" * doctest::skip(under_sanitizers)) {
  struct {
    const char* boundary;
    double m0, n0;  // held on both sides: 1, 2, …; free: 0, 1, …; one of each: 1/2, 3/2, …
  } const sides[] = {
      {"boundary left : u = 0\nboundary right : u = 0\nboundary bottom : u = 0\nboundary top : u = 0\n", 1, 1},
      {"", 0, 0},
      {"boundary left : u = 0\n", 0.5, 0},
      {"boundary left : u = 0\nboundary right : u = 0\nboundary top : u = 0\n", 1, 0.5},
      {"boundary bottom : u = 0\nboundary top : u = 0\n", 0, 1},
  };
  for (const auto& s : sides) {
    CAPTURE(s.boundary);
    for (const std::size_t count : {1, 4, 6, 8}) {
      const FieldModes found = plane_modes_of(rectangle(s.boundary), count);
      const std::vector<double> expected = closed_forms(2, 3, 1, s.m0, s.n0, count);
      for (std::size_t i = 0; i < count; ++i) {
        const double error = std::abs(found.frequencies[i] - expected[i]);
        CHECK(error < (expected[i] == 0 ? 1e-4 : 1e-10 * expected[i]));
        CHECK(error <= found.errors[i]);
        CHECK(found.errors[i] < 1e-4);
      }
    }
  }
}

TEST_CASE("equal frequencies of a square have the shapes sin 2πx sin πy and sin πx sin 2πy") {
  const double pi = std::acos(-1.0);
  const FieldModes found = plane_modes_of(
      "dimensionless\nparam c = 1\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0\n" + density, 4);
  CHECK(std::abs(found.frequencies[1] - found.frequencies[2]) < 1e-10);
  for (const std::size_t mode : {1, 2}) {
    const double m = mode == 1 ? 1 : 2, n = 3 - m;  // the one that changes less along x first
    double worst = 0;
    for (std::size_t j = 0; j < found.upwards.size(); ++j)
      for (std::size_t i = 0; i < found.places.size(); ++i) {
        const double value = found.shapes[mode].fields[0][j * found.places.size() + i];
        const double form = std::sin(m * pi * found.places[i]) * std::sin(n * pi * found.upwards[j]);
        worst = std::max(worst, std::abs(std::abs(value) - std::abs(form)));
      }
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("a membrane that is heavier to one side: a string of the same density, with the waves across as a bedding") {
  // sides along y are free, so that the modes without change along y are those of a string
  const FieldModes plane = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1/10\nboundary left : u = 0\nboundary right : u "
      "= 0\ndensity = 1/2 (1 + x^2) u'^2 - 1/2 (u_x^2 + u_y^2)\n",
      4);
  Study study(SourceText("field.lag",
                         "dimensionless\nfield u(x) : number on x = 0 .. 1 boundary u = 0\n"
                         "density = 1/2 (1 + x^2) u'^2 - 1/2 u_x^2\n"));
  Diagnostics diagnostics;
  const std::vector<double> string = field_frequencies(*study.field_equations(), 4, diagnostics);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(plane.frequencies[i] - string[i]) < 1e-10 * string[i]);
}

/// Bending with Poisson's ratio 0.3 on the unit square, μ = D = 1.
const std::string plate_density = "density = 1/2 w'^2 - 1/2 ((w_xx + w_yy)^2 - 2*0.7 (w_xx w_yy - w_xy^2))\n";

TEST_CASE("frequencies of plates: hinged, clamped, free" * doctest::skip(under_sanitizers)) {
  const std::string square = "dimensionless\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 1 ";
  const FieldModes hinged = plane_modes_of(square + "boundary w = 0\n" + plate_density, 4);
  const double pi2 = std::numbers::pi * std::numbers::pi;
  const double of_hinged[] = {2 * pi2, 5 * pi2, 5 * pi2, 8 * pi2};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(hinged.frequencies[i] - of_hinged[i]) < hinged.errors[i]);
    CHECK(hinged.errors[i] < 1e-8);
  }
  // Leissa, The free vibration of rectangular plates, J. Sound Vib. 31 (1973), with the digits of later works.
  const FieldModes clamped = plane_modes_of(square +
                                                "boundary w = 0\nboundary left : w_x = 0\nboundary right : w_x = 0\n"
                                                "boundary bottom : w_y = 0\nboundary top : w_y = 0\n" +
                                                plate_density,
                                            4);
  const double of_clamped[] = {35.98519, 73.39385, 73.39385, 108.2165};
  for (std::size_t i = 0; i < 4; ++i) CHECK(clamped.frequencies[i] == doctest::Approx(of_clamped[i]).epsilon(2e-7));
  const FieldModes free = plane_modes_of(square + "\n" + plate_density, 6);
  const double of_free[] = {0, 0, 0, 13.4682, 19.5961, 24.2702};
  for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(free.frequencies[i] - of_free[i]) < 1e-4);
}

TEST_CASE("a plate between two hinges without Poisson's ratio is a beam, with rotary inertia too") {
  for (const std::string inertia : {"", " + 1/2*0.01 w_tx^2"}) {
    const FieldModes plate = plane_modes_of(
        "dimensionless\nfield w(x, y) : number on x = 0 .. 1, y = 0 .. 0.05\nboundary left : w = 0\n"
        "boundary right : w = 0\ndensity = 1/2 w'^2" +
            inertia + " - 1/2 (w_xx^2 + w_yy^2 + 2 w_xy^2)\n",
        2);
    const FieldModes beam =
        plane_modes_of("dimensionless\nfield w(x) : number on x = 0 .. 1 boundary w = 0\ndensity = 1/2 w'^2" + inertia +
                           " - 1/2 w_xx^2\n",
                       2);
    CHECK(std::abs(plate.frequencies[0] - beam.frequencies[0]) < 1e-9);
  }
}

TEST_CASE("a mass that is narrow along both sides is not passed by") {
  // It weighs as much as twenty membranes, at a place of no line of points.
  const std::string text =
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0\n"
      "density = 1/2 (1 + 1e6 exp(-(400 (x - 0.37))^2 - (400 (y - 0.61))^2)) u'^2 - 1/2 (u_x^2 + u_y^2)\n";
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE(equations);
  Diagnostics diagnostics;
  CHECK(field_modes(*equations, 2, diagnostics).frequencies.empty());
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "E0647");
}

TEST_CASE("a stiffness that lies between all points of modes is not passed by, on a line and in the plane") {
  // As narrow as a millionth of the domain: neither two sizes of functions nor samples of the coefficient see it.
  for (const char* text :
       {"dimensionless\nfield u(x) : number on x = 0 .. 1 boundary u = 0\n"
        "density = 1/2 u'^2 - 1/2 u_x^2 - 1e6 exp(-(1e6 (x - 0.4877))^2) u^2\n",
        "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0\n"
        "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - 1e12 exp(-(1e6 (x - 0.4877))^2 - (1e6 (y - 0.4877))^2) u^2\n"}) {
    Study study(SourceText("field.lag", text));
    REQUIRE(study.field_equations());
    Diagnostics diagnostics;
    CHECK(field_modes(*study.field_equations(), 2, diagnostics).frequencies.empty());
    REQUIRE(diagnostics.items().size() == 1);
    CHECK(diagnostics.items()[0].code == "E0647");
  }
}

TEST_CASE("frequencies of a membrane whose tension jumps within the domain are within their errors" *
          doctest::skip(under_sanitizers)) {
  // Separable: sin π y times a string whose tension jumps, on elements that end at the jump.
  const std::string tension = "(1 + 3 step(x - 0.3))";
  const FieldModes found = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 10 by 10 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 " +
          tension + " (u_x^2 + u_y^2)\n",
      1);
  const FieldModes exact = plane_modes_of(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 " +
          tension + " (u_x^2 + pi^2 u^2)\n",
      1);
  CHECK(std::abs(found.frequencies[0] - exact.frequencies[0]) < found.errors[0] + 1e-12);
  CHECK(found.errors[0] < 1e-9);
  // With sin π y, the tension 0.001 + s at the distance s from the line x = 1/2: J_1(a) Y_0(b) = Y_1(a) J_0(b) with
  // a² = 0.004 ω², b² = 2.004 ω² has the root 1.7049955005707.
  const FieldModes kink = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 (0.001 + abs(x - 0.5)) u_x^2 - 1/2 u_y^2\n",
      1);
  CHECK(std::abs(kink.frequencies[0] - std::hypot(1.7049955005707, std::numbers::pi)) < kink.errors[0]);
  CHECK(kink.errors[0] < 1e-4);
}

TEST_CASE("modes without the dissipation of the field say so") {
  Study study(SourceText("field.lag", rectangle("boundary left : u = 0\n") + "dissipation density = 0.1 u'^2\n"));
  Diagnostics diagnostics;
  field_modes(*study.field_equations(), 3, diagnostics);
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "W0653");
}

TEST_CASE("a tension that is not along the sides: ω² = k² + l² + 2 β k l on a periodic square") {
  const FieldModes found = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 2 pi, y = 0 .. 2 pi cells 5 by 5 boundary periodic\n"
      "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - 0.3 u_x u_y\n",
      9);
  const double expected[] = {0, 1, 1, 1, 1, std::sqrt(1.4), std::sqrt(1.4), std::sqrt(2.6), std::sqrt(2.6)};
  for (std::size_t i = 0; i < 9; ++i) CHECK(std::abs(found.frequencies[i] - expected[i]) < (i == 0 ? 1e-6 : 1e-11));
  // k = −l: functions of x − y
  const std::size_t n = found.places.size();
  for (const std::size_t mode : {5u, 6u})
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t j = 0; j + 1 < n; ++j) {
        const std::vector<double>& u = found.shapes[mode].fields[0];
        CHECK(std::abs(u[j * n + i] - u[(j + 1) * n + i + 1]) < 1e-9);
      }
}

TEST_CASE("a strip that is closed along one direction has a standing wave along the other, waves both ways around") {
  const double pi = std::acos(-1.0);
  for (const bool along_x : {true, false}) {
    const FieldModes found =
        plane_modes_of(std::string("dimensionless\nfield u(x, y) : number on ") +
                           (along_x ? "x = 0 .. 2 pi, y = 0 .. 1 boundary periodic x\nboundary bottom : u = 0\n"
                                    : "x = 0 .. 1, y = 0 .. 2 pi boundary periodic y\nboundary left : u = 0\n") +
                           "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\n",
                       5);
    for (std::size_t i = 0; i < 5; ++i) {
      const double k = std::ceil(static_cast<double>(i) / 2);
      CHECK(std::abs(found.frequencies[i] - std::hypot(k, pi / 2)) < 1e-9);
    }
  }
}

TEST_CASE("a membrane that runs over two rollers: ω² = (1 − v²)² k² + (1 − v²) l²") {
  // exp(iωt + i v ω x/(1 − v²)) sin kx sin ly, with k and l multiples of π
  const FieldModes found = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 5 by 5 boundary u = 0\n"
      "density = 1/2 (u' + 0.6 u_x)^2 - 1/2 (u_x^2 + u_y^2)\n",
      3);
  const double w = 0.64;  // 1 − v²
  const double expected[] = {std::hypot(w * 1, std::sqrt(w) * 1), std::hypot(w * 2, std::sqrt(w) * 1),
                             std::hypot(w * 1, std::sqrt(w) * 2)};
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::abs(found.frequencies[i] - std::acos(-1.0) * expected[i]) < std::max(1e-9, found.errors[i]));
}

TEST_CASE("which way a tension leans: dω²/dβ = 2 for sin(πx/2) sin(πy/2), held at the left and below") {
  const double beta = 1e-4;
  const FieldModes found = plane_modes_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 5 by 5\n"
      "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - 1e-4 u_x u_y\n"
      "boundary left : u = 0\nboundary bottom : u = 0\n",
      1);
  const double change = std::pow(found.frequencies[0], 2) - std::pow(std::acos(-1.0), 2) / 2;
  CHECK(change / beta == doctest::Approx(2).epsilon(1e-3));
}

namespace {

/// The code of the one diagnostic of modes that are refused.
std::string refusal(const std::string& text) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  Diagnostics diagnostics;
  CHECK(field_modes(*equations, 3, diagnostics).frequencies.empty());
  REQUIRE(diagnostics.items().size() == 1);
  return diagnostics.items()[0].code;
}

const std::string square = "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 ";

}  // namespace

TEST_CASE("two fields that turn into each other: sqrt(π² (m² + n²) + W²) ± W, each within its error") {
  // Sizes of two fields are half as large: two sizes with the same degrees would agree on anything.
  const FieldModes found = plane_modes_of(
      "dimensionless\nfield u(x, y), v(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0, v = 0\n"
      "density = 1/2 (u'^2 + v'^2) - 1/2 (u_x^2 + u_y^2 + v_x^2 + v_y^2) + 3 (u v' - v u')\n",
      8);
  const double pi = std::acos(-1.0);
  const double squares[] = {2, 5, 5, 8, 10, 10};  // of m and n
  for (std::size_t i = 0; i < 6; ++i) {
    const double expected = std::sqrt(pi * pi * squares[i] + 9) - 3;
    CHECK(std::abs(found.frequencies[i] - expected) <= std::max(found.errors[i], 1e-13 * expected));
  }
}

TEST_CASE("a rest that is unstable grows, at its rate") {
  const FieldModes found =
      plane_modes_of(square + "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) + 20 (1 - cos u)\n", 2);
  const double pi = std::acos(-1.0);
  CHECK(std::abs(found.frequencies[0] + std::sqrt(20 - 2 * pi * pi)) < 1e-10);
  CHECK(std::abs(found.frequencies[1] - std::sqrt(5 * pi * pi - 20)) < 1e-10);
}

TEST_CASE("modes are about the start where it is a rest, and say which rest it is") {
  // Two wells at u = ±1, where ω² = 2 + k², and a hill at 0.
  const double pi = std::numbers::pi;
  const std::string wells = " - 1/4 (u^2 - 1)^2\nstart u = ";
  for (const std::string sides : {"(x) : number on x = 0 .. 1", "(x, y) : number on x = 0 .. 1, y = 0 .. 1"}) {
    const std::string head = "dimensionless\nfield u" + sides + "\ndensity = 1/2 u'^2 - 1/2 u_x^2" +
                             (sides.find('y') < sides.size() ? " - 1/2 u_y^2" : "") + wells;
    const FieldModes well = plane_modes_of(head + "-1\nrun 1\n", 2);
    CHECK(well.about == "u = -1");
    CHECK(well.frequencies[0] == doctest::Approx(std::sqrt(2)).epsilon(1e-10));
    CHECK(well.frequencies[1] == doctest::Approx(std::sqrt(2 + pi * pi)).epsilon(1e-10));
    const FieldModes hill = plane_modes_of(head + "0.1 cos(pi x)\nrun 1\n", 1);
    CHECK(hill.about == "u = 0");
    CHECK(hill.frequencies[0] == doctest::Approx(-1).epsilon(1e-10));
  }
  // A kink between them, held at its ends: without these its first mode would be its translation.
  const std::string kink =
      "dimensionless\nfield u(x) : number on x = -3 .. 3\nboundary left : u = -tanh(3/sqrt(2))\n"
      "boundary right : u = tanh(3/sqrt(2))\ndensity = 1/2 u'^2 - 1/2 u_x^2" +
      wells;
  const double slow = plane_modes_of(kink + "tanh(x/sqrt(2))\nrun 1\n", 1).frequencies[0];
  CHECK(slow > 0);
  CHECK(slow < 0.1);
  // From a straight line Newton's method comes to the same kink.
  const FieldModes found = plane_modes_of(kink + "x/3 tanh(3/sqrt(2))\nrun 1\n", 1);
  CHECK(found.frequencies[0] == doctest::Approx(slow).epsilon(1e-9));
  CHECK(found.about == "the equilibrium");
}

TEST_CASE("modes that nothing is known of are refused") {
  // Narrower than the distance of any points, infinite, without inertia, and a slope that says nothing of the force.
  CHECK(
      refusal(square + "boundary u = 0\ndensity = 1/2 (1 + 50 exp(-(400 (x - 0.5))^2)) u'^2 - 1/2 (u_x^2 + u_y^2)\n") ==
      "E0647");
  // Sixteen waves of a stiffness: sizes agree with each other on its mean, which is not what slow waves feel.
  CHECK(refusal(square + "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (1 + 0.5 sin(100 x)) u_x^2 - 1/2 u_y^2\n") ==
        "E0647");
  CHECK(refusal(square + "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - u^2/(x - 0.5)^2\n") == "E0644");
  CHECK(refusal(square + "boundary u = 0\nparam s = 0\ndensity = 1/2 s u'^2 - 1/2 (u_x^2 + u_y^2)\n") == "E0644");
  CHECK(refusal(square + "\nboundary left : u_x = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - 0.3 u_x u_y\n") ==
        "E0644");
  // Free on all sides, and forces sideways: some displacements cost nothing.
  CHECK(refusal("dimensionless\nfield u(x, y), v(x, y) : number on x = 0 .. 1, y = 0 .. 1\n"
                "density = 1/2 (u'^2 + v'^2) - 1/2 (u_x^2 + u_y^2 + v_x^2 + v_y^2) + 3 (u v' - v u')\n") == "E0644");
}

// ------------------------------------------------------------------------------------------------- one space variable

TEST_CASE("frequencies of lines are within their errors, where coefficients oscillate and jump too") {
  const auto first = [](const std::string& stiffness) {
    return plane_modes_of("dimensionless\nfield u(x) : number on x = 0 .. 1 boundary u = 0\ndensity = 1/2 u'^2 - 1/2 " +
                              stiffness + " u_x^2\n",
                          1);
  };
  // By shooting with 20,000 steps of Runge and Kutta's; the jump at x = 0.2 and 0.6 by tan and cot.
  const std::pair<const char*, double> known[] = {{"(1 + 0.5*sin(30 x))", 2.96247806},
                                                  {"(1 + 0.5*sin(100 x))", 2.9234},
                                                  {"piecewise(abs(x - 0.4) < 0.2 : 4, else : 1)", 3.36675809},
                                                  {"(1 + 3*step(0.2 - abs(x - 0.4)))", 3.36675809}};
  for (const auto& [stiffness, right] : known) {
    const FieldModes found = first(stiffness);
    REQUIRE(found.frequencies.size() == 1);
    CHECK_MESSAGE(std::abs(found.frequencies[0] - right) < found.errors[0] + 1e-8, stiffness);
    CHECK(found.errors[0] < 0.05);
  }
  // Elements end at 0.3: the points at their ends take the formula of their side.
  CHECK(first("(1 + 3*step(x - 0.3))").errors[0] < 1e-9);
  const FieldModes linear = first("abs(x - 0.5)");  // J_0(2 ω sqrt(1/2)) = 0
  CHECK(std::abs(linear.frequencies[0] - 2.404825557695773 / std::sqrt(2.0)) < linear.errors[0]);
  CHECK(refusal("dimensionless\nfield u(x) : number on x = 0 .. 1 boundary u = 0\ndensity = 1/2 u'^2*(1 + "
                "1000*exp(-((x - 0.512)/0.0003)^2)) - 1/2 u_x^2\n") == "E0647");
}

TEST_CASE("force densities that have a potential belong to the modes, others are refused") {
  const std::string line =
      "dimensionless\nfield u(x) : number on x = 0 .. 2\nboundary left : u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2\n";
  const double quarter = std::numbers::pi / 4;
  CHECK(plane_modes_of(line + "force density u = -4 u\n", 1).frequencies[0] ==
        doctest::Approx(std::sqrt(quarter * quarter + 4)).epsilon(1e-10));
  CHECK(plane_modes_of("dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 boundary u = 0\n"
                       "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\nforce density u = -4 u\n",
                       1)
            .frequencies[0] == doctest::Approx(std::sqrt(32 * quarter * quarter + 4)).epsilon(1e-10));
  CHECK(refusal(line + "force density u = -4 u'\n") == "E0644");
  CHECK(refusal(line + "force density u = -4 u_x\n") == "E0644");
  CHECK(refusal("dimensionless\nfield u(x), v(x) : number on x = 0 .. 2 boundary u = 0, v = 0\n"
                "density = 1/2 (u'^2 + v'^2) - 1/2 (u_x^2 + v_x^2)\nforce density u = v\nforce density v = -v\n") ==
        "E0644");
}

TEST_CASE("bodies on a line that are driven, that change in time or rest at a kink have no modes") {
  const std::string line =
      "dimensionless\nfield u(x) : number on x = 0 .. 2\nboundary left : u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
      "T = 1/2 u(2)'^2\n";
  CHECK(refusal(line + "V = -(1 + 0.5 cos(t)) cos(u(2))\n") == "E0644");
  CHECK(refusal(line + "V = -cos(u(2)) - u(2) cos(3 t)\n") == "E0644");
  CHECK(refusal(line + "V = abs(u(2) - 0.2)\n") == "E0644");
  CHECK(refusal(line + "V = piecewise(u(2) < 0 : 1/2 u(2)^2, else : 5 u(2)^2)\n") == "E0644");
  Study rubbed(SourceText("field.lag", line + "D = 1/2 u(2)'^2\n"));
  Diagnostics told;
  CHECK(field_modes(*rubbed.field_equations(), 1, told).frequencies.size() == 1);
  REQUIRE(told.items().size() == 1);
  CHECK(told.items()[0].code == "W0653");
  // Beside the kink, and with an input of a given value, there are.
  const double held = plane_modes_of(line + "V = 1/2 u(2)^2 - 0.5 u(2) + 3*abs(u(2) + 7)\n", 1).frequencies[0];
  const double given = plane_modes_of(line + "input F : [1] = 0.5\nV = 1/2 u(2)^2 - F u(2)\n", 1).frequencies[0];
  CHECK(held == doctest::Approx(given).epsilon(1e-10));
  // ω tan 2ω = 1 − ω² without the spring's part: tan 2ω (ω² − 1) = ω
  CHECK(std::abs(std::tan(2 * given) * (given * given - 1) - given) < 1e-9);
}

}  // namespace plane_modes_test

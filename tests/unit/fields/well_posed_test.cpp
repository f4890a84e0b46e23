#include <maupertuis/print.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {

/// What is said of a density: code and reason of the first error, or nothing.
std::string said_of(const std::string& text) {
  Study study(SourceText("field.lag", "dimensionless\n" + text));
  study.field_equations();
  for (const Diagnostic& d : study.diagnostics().items())
    if (d.severity == Severity::Error) return d.code + ": " + d.reason;
  return {};
}

bool ill_posed(const std::string& text) { return said_of(text).compare(0, 5, "E0641") == 0; }

}  // namespace

TEST_CASE("elliptic in time: one field, one of two, one direction of two") {
  CHECK(ill_posed("field u(x) : number\ndensity = 1/2 u'^2 + 1/2 u_x^2\n"));
  CHECK_FALSE(ill_posed("field u(x) : number\ndensity = 1/2 u'^2 - 1/2 u_x^2 + 1/2 u^2\n"));
  CHECK(ill_posed("field u(x) : number\ndensity = 1/2 u'^2 + 1/2 u_xx^2\n"));
  CHECK_FALSE(ill_posed("field u(x) : number\ndensity = 1/2 u'^2 - 1/2 u_xx^2 + 3 u_x^2\n"));
  const std::string two = "field a(x), b(x) : number\ndensity = 1/2 a'^2 + 1/2 b'^2 - 1/2 a_x^2 - 1/2 b_x^2 ";
  CHECK_FALSE(ill_posed(two + "- 0.9 a_x b_x\n"));
  CHECK(ill_posed(two + "- 1.1 a_x b_x\n"));
  const std::string plane = "field u(x, y) : number\ndensity = 1/2 u'^2 - 1/2 u_x^2 ";
  CHECK_FALSE(ill_posed(plane + "- 1/2 u_y^2\n"));
  CHECK(said_of(plane + "+ 1/2 u_y^2\n").find("along y") != std::string::npos);
  CHECK(said_of(plane + "- 1/2 u_y^2 + 1.2 u_x u_y\n").find("along the diagonal") != std::string::npos);
  CHECK(said_of(plane + "+ 1/2 u_y^2\n").find("dispersion relation is") != std::string::npos);
}

TEST_CASE("first order in time, and what is of no one order") {
  // Schrödinger's equation in two fields turns, whatever the sign
  for (const char* sign : {"-", "+"})
    CHECK_FALSE(
        ill_posed("field a(x), b(x) : number\ndensity = b a' - a b' " + std::string(sign) + " 1/2 (a_x^2 + b_x^2)\n"));
  // its parts of different sign: diffusion, in one field backwards in time
  CHECK(ill_posed("field a(x), b(x) : number\ndensity = b a' - a b' - 1/2 (a_x^2 - b_x^2)\n"));
  CHECK_FALSE(ill_posed("field h(x), p(x) : number\ndensity = -(h p' + 1/2 h p_x^2 + 1/2 h^2)\n"));
  CHECK_FALSE(ill_posed("field P(x), A(x) : number\ndensity = 1/2 (P_x + A')^2\n"));
}

TEST_CASE("a damped wave has one complex relation, and begins with no minus") {
  Study study(SourceText("damped.lag",
                         "dimensionless\nparam r = 0.2\nfield u(x) : number\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
                         "dissipation density = 1/2 r u'^2\n"));
  const FieldEquations* equations = study.field_equations();
  REQUIRE(equations);
  std::string trouble;
  const auto relation = dispersion(*equations, trouble);
  REQUIRE(relation);
  CHECK(to_plain(readable(with_imaginary_unit(*relation), equations->order), equations->order) == "r ω i + ω^2 - k^2");
}

TEST_CASE("coefficients count in the domain, wherever that lies") {
  // A chain that hangs down from x = 0, a tapered beam, a membrane whose tension ends beyond its corner.
  CHECK_FALSE(ill_posed("field u(x) : number on x = 0 .. 0.8\ndensity = 1/2 u'^2 - 1/2 (0.8 - x) u_x^2\n"));
  CHECK_FALSE(
      ill_posed("field w(x) : number on x = 0 .. 1\ndensity = 1/2 (1 - 0.9*x) w'^2 - 1/2 (1 - 0.9*x)^3 w_xx^2\n"));
  CHECK_FALSE(
      ill_posed("field u(x, y) : number on x = 0 .. 0.5, y = 0 .. 0.5\n"
                "density = 1/2 u'^2 - 1/2 (1.2 - x - y) (u_x^2 + u_y^2)\n"));
  CHECK(said_of("field u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 (0.4 - x)*(0.6 - x) u_x^2\n")
            .find("x = 0.47") != std::string::npos);
  CHECK(ill_posed("field u(x) : number on x = -0.5 .. 0.5\ndensity = 1/2 u'^2 - 1/2 (x^2 - 1) u_x^2\n"));
}

TEST_CASE("short waves are those of the domain, whatever its size and the speed of waves") {
  const auto said = [](const std::string& text) {
    Study study(SourceText("field.lag", text));
    study.field_equations();
    for (const Diagnostic& d : study.diagnostics().items())
      if (d.severity == Severity::Error) return d.code;
    return std::string();
  };
  // Elliptic at 0.1 mm/s: waves of 1e6/m grow at 100/s.
  CHECK(said("param μ = 1 kg/m, c = 1e-4 m/s\nfield u(x) : length on x = 0 m .. 1 m boundary u = 0\n"
             "density = 1/2 μ u'^2 + 1/2 μ c^2 u_x^2\n") == "E0641");
  // A ribbon of 2 nm, pressed: long waves buckle, those below its thickness are held by its stiffness.
  CHECK(said("param μ = 1e-15 kg/m, N = 1e-9 N, EI = 1e-27 N m^2\n"
             "field u(x) : length on x = 0 m .. 2 nm boundary u = 0\n"
             "density = 1/2 μ u'^2 + 1/2 N u_x^2 - 1/2 EI u_xx^2\n")
            .empty());
}

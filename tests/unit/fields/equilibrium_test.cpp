#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

/// Equilibria of fields that no formula of the model gives, against closed forms.
using namespace maupertuis;

namespace {

FieldModes modes_of(const std::string& text, Diagnostics& diagnostics) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  return field_modes(*equations, 3, diagnostics);
}

FieldModes found(const std::string& text) {
  Diagnostics diagnostics;
  FieldModes out = modes_of(text, diagnostics);
  REQUIRE_MESSAGE(out.equilibrium, text);
  CHECK(!diagnostics.has_errors());
  return out;
}

/// Each value is within its error of the closed form, and the error is small.
void check_values(const FieldEquilibrium& e, double small, const std::function<double(double, double)>& exact) {
  CHECK(e.errors[0] < small);
  const std::vector<double> upwards = e.upwards.empty() ? std::vector<double>{0} : e.upwards;
  for (std::size_t j = 0; j < upwards.size(); ++j)
    for (std::size_t i = 0; i < e.places.size(); ++i) {
      const double value = exact(e.places[i], upwards[j]);
      CHECK(std::abs(e.fields[0][j * e.places.size() + i] - value) <= e.errors[0] + 1e-14);
    }
}

std::string refusal(const std::string& text) {
  Diagnostics diagnostics;
  const FieldModes out = modes_of(text, diagnostics);
  CHECK(!out.equilibrium);
  REQUIRE(diagnostics.has_errors());
  return diagnostics.items().back().code + std::string(" ") + diagnostics.items().back().reason;
}

const std::string catenary =
    "dimensionless\nfield y(x) : number on x = -1 .. 1\ndensity = -y sqrt(1 + y_x^2)\nboundary y = cosh(1)\n";

}  // namespace

TEST_CASE("a catenary is cosh, of two the one next to the start") {
  const FieldModes stable = found(catenary + "start y = 1.2\n");
  check_values(*stable.equilibrium, 1e-13, [](double x, double) { return std::cosh(x); });
  CHECK(stable.frequencies.empty());
  CHECK(stable.equilibrium->energy == doctest::Approx(1 + std::sinh(1) * std::cosh(1)).epsilon(1e-13));
  CHECK(stable.equilibrium->falling == 0);
  CHECK(stable.equilibrium->lowest.value_or(0) > 0);
  // The deeper one, c cosh(x/c) with c cosh(1/c) = cosh 1, is no minimum.
  double c = 0.7;
  for (int i = 0; i < 60; ++i) c -= (c * std::cosh(1 / c) - std::cosh(1)) / (std::cosh(1 / c) - std::sinh(1 / c) / c);
  REQUIRE(c < 0.9);
  const FieldModes deep = found(catenary + "start y = 0.7 + 0.84 x^2\n");
  check_values(*deep.equilibrium, 1e-11, [&](double x, double) { return c * std::cosh(x / c); });
  CHECK(deep.equilibrium->falling == 1);
}

TEST_CASE("kinks, from straight lines") {
  // −1/2 u_x² − (1 − cos u): sin(u/2) has the energy 8 as the domain grows; here the ends are those of 4 atan exp x.
  const FieldModes sine = found(
      "dimensionless\nfield u(x) : number on x = -5 .. 5\ndensity = 1/2 u'^2 - 1/2 u_x^2 - (1 - cos u)\n"
      "boundary left : u = 4 atan(exp(-5))\nboundary right : u = 4 atan(exp(5))\nstart u = pi + 0.6 x\n");
  check_values(*sine.equilibrium, 1e-9, [](double x, double) { return 4 * std::atan(std::exp(x)); });
  REQUIRE(sine.frequencies.size() == 3);
  CHECK(sine.frequencies[0] > 0);
  CHECK(sine.frequencies[0] < 0.05);
  const FieldModes wells = found(
      "dimensionless\nfield u(x) : number on x = -10 .. 10\ndensity = 1/2 u'^2 - 1/2 u_x^2 - 1/4 (u^2 - 1)^2\n"
      "boundary left : u = -1\nboundary right : u = 1\nstart u = x/10\n");
  CHECK(wells.equilibrium->energy == doctest::Approx(2 * std::sqrt(2.0) / 3).epsilon(1e-9));
  // The mode of the shape of a kink: ω² = 3/2.
  CHECK(wells.frequencies[1] == doctest::Approx(std::sqrt(1.5)).epsilon(1e-4));
}

TEST_CASE("soap films: Scherk's surface") {
  const FieldModes film = found(
      "dimensionless\nfield z(x, y) : number on x = -0.5 .. 0.5, y = -0.5 .. 0.5\n"
      "density = -sqrt(1 + z_x^2 + z_y^2)\nboundary z = log(cos(y)/cos(x))\n");
  check_values(*film.equilibrium, 1e-11, [](double x, double y) { return std::log(std::cos(y) / std::cos(x)); });
  CHECK(film.equilibrium->falling == 0);
}

TEST_CASE("static deflections, with loads, given slopes and moments") {
  const FieldModes beam = found(
      "param EI = 20 N m^2, q = 3 N/m, l = 2 m, ρ = 1 kg/m\nfield w(x) : length on x = 0 m .. l\n"
      "density = 1/2 ρ w'^2 - 1/2 EI w_xx^2\nforce density w = -q\nboundary left : w = 0, w_x = 0\n"
      "force w(l) = -4 N\n");
  check_values(*beam.equilibrium, 1e-12, [](double x, double) {
    const double l = 2, load = 3 * x * x * (x * x - 4 * l * x + 6 * l * l) / 24;
    return -(load + 4 * x * x * (3 * l - x) / 6) / 20;
  });
  CHECK(beam.frequencies.size() == 3);
  const FieldModes rod = found(
      "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = -1/2 u_x^2 + x u\nboundary left : u = 0\n"
      "boundary right : u_x = 0.3\n");
  check_values(*rod.equilibrium, 1e-13, [](double x, double) { return 0.8 * x - x * x * x / 6; });
}

TEST_CASE("where there is no equilibrium, none is told") {
  CHECK(refusal("dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = -1/2 u_x^2 + u\n").substr(0, 5) ==
        "E0644");
  // Rings too far apart for a catenary between them.
  CHECK(refusal("dimensionless\nfield y(x) : number on x = -1 .. 1\ndensity = -y sqrt(1 + y_x^2)\nboundary y = 1.2\n"
                "start y = 1\n")
            .substr(0, 5) == "E0644");
}

TEST_CASE("a load that lies between the points of every size of functions is not passed by") {
  for (const char* width : {"2e4", "2e5"})
    for (const char* density : {"-1/2 u_x^2", "1/2 u'^2 - 1/2 u_x^2 - 1/4 u^4"}) {
      const std::string told =
          refusal("dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = " + std::string(density) +
                  " + 1000 u exp(-((x - 0.537)*" + width + ")^2)\nboundary u = 0\nstart u = 0\n");
      INFO(told);
      CHECK(told.starts_with("E0644"));
    }
}

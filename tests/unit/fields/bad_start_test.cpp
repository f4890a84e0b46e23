#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

/// What is wrong with a field or its start is told by its cause.
using namespace maupertuis;

namespace {

const std::string line = "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 4\n";

/// The first message of a run, with its reason and help.
std::string message_of(const std::string& text, bool run) {
  Study study(SourceText("field.lag", line + text));
  const FieldEquations* equations = study.field_equations();
  Diagnostics diagnostics;
  if (run) {
    REQUIRE_MESSAGE(equations, text);
    FieldRunOptions options;
    options.duration = 0.01, options.errors = false;
    (void)run_fields(*equations, {}, options, diagnostics);
  }
  const auto& items = run ? diagnostics.items() : study.diagnostics().items();
  REQUIRE_MESSAGE(!items.empty(), text);
  const Diagnostic& d = items.front();
  return d.code + std::string(" ") + d.message + " " + d.reason + " " + d.help;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a start about which short waves grow without bound is told as such") {
  const std::string density = "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2 + 1/3 u_x^3\n";
  const std::string steep = message_of(density + "start u = 3*x*(1-x)\n", true);
  CHECK(holds(steep, "E0641"));
  CHECK(holds(steep, "about the start at x = 0.04"));
  // Where 1 − 2 u_x stays positive the same density has waves.
  Study gentle(SourceText("field.lag", line + density + "start u = 0.3*x*(1-x)\n"));
  FieldRunOptions options;
  options.duration = 0.01, options.errors = false;
  Diagnostics none;
  CHECK(run_fields(*gentle.field_equations(), {}, options, none).has_value());
}

TEST_CASE("a dissipation density that feeds motion is told as the cause") {
  const std::string fed = message_of(
      "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 u_x^2\ndissipation density = -1/20 u_tx^2\nstart u = x (1 - x)\n",
      false);
  CHECK(holds(fed, "E0641"));
  CHECK(holds(fed, "dissipation density"));
  CHECK(!holds(fed, "elliptic"));
}

TEST_CASE("two numbers that differ in late digits are told by what they differ by") {
  const std::string text =
      message_of("boundary left : u = -2\ndensity = 1/2 u'^2 - 1/2 u_x^2\nstart u = -2.00000001 - x\n", true);
  CHECK(holds(text, "W0646"));
  CHECK(holds(text, "u = -2, off by -1e-08"));
}

TEST_CASE("a start beside a moving end: which rate is meant, and nothing of a field without waves") {
  const std::string moving =
      message_of("boundary left : u = 1/10 sin(3 t)\ndensity = 1/2 u'^2 - 1/2 u_x^2\nstart u = 0\n", true);
  CHECK(holds(moving, "W0646"));
  CHECK(holds(moving, "u' = 0 beside 0.3"));
  CHECK(holds(moving, "a jump of u' runs into the field"));
  CHECK(holds(moving, "a start whose u' is that"));
  // A massless string follows its mass at once: its start is that of the mass, and what else it says is a note.
  for (const char* start : {"start u = x/5\n", "start u = 1/10\n"}) {
    Study study(SourceText("field.lag", line + "boundary u = 0\ndensity = -1/2 u_x^2\nT = 1/2 u(1/2)'^2\n" + start));
    REQUIRE(study.field_equations());
    FieldRunOptions options;
    options.duration = 1, options.errors = false;
    Diagnostics none;
    const auto run = run_coupled(*study.model(), *study.field_equations(), {}, options, none);
    REQUIRE(run);
    REQUIRE(none.items().size() == 1);
    CHECK(none.items().front().code == "N0662");
  }
}

TEST_CASE("where the field stands still in a mode, its coordinate is 1") {
  Study study(SourceText("field.lag",
                         "param ρ = 0.1 kg/m, T0 = 20 N, l = 1 m, m = 0.2 kg, b = 0.3 m, g = 9.81 m/s^2\n"
                         "field u(x) : length on x = 0 m .. l\ncoord θ : angle\nboundary u = 0\n"
                         "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\npoint P mass m at (b sin θ, u(l/2) - b cos θ)\n"
                         "gravity (0, -g)\nstart u = 0, θ = 20 deg\nrun 1 s\n"));
  REQUIRE(study.field_equations());
  Diagnostics diagnostics;
  const FieldModes modes = field_modes(*study.field_equations(), 2, diagnostics);
  REQUIRE(modes.shapes.size() == 2);
  CHECK(modes.frequencies[0] == doctest::Approx(std::sqrt(9.81 / 0.3)).epsilon(1e-9));
  CHECK(modes.shapes[0].coordinates[0] == doctest::Approx(1));
  CHECK(std::abs(modes.shapes[1].coordinates[0]) < 1e-6);
}

TEST_CASE("a shaft that turns at the start whirls: as with the spin of its disk written by hand") {
  const std::string shaft =
      "param ρA = 1 kg/m, EI = 20 N m^2, l = 1 m, m = 0.5 kg, Jd = 0.02 kg m^2, Jp = 0.03 kg m^2, Ω = 100 rad/s\n"
      "field u(z), v(z) : length on z = 0 m .. l cells 2 order 8\n"
      "density = 1/2 ρA (u'^2 + v'^2) - 1/2 EI (u_zz^2 + v_zz^2)\nboundary u = 0, v = 0\n";
  const auto modes_of = [&](const std::string& disk) {
    Study study(SourceText("field.lag", shaft + disk));
    REQUIRE(study.field_equations());
    Diagnostics diagnostics;
    FieldModes out = field_modes(*study.field_equations(), 4, diagnostics);
    CHECK(!diagnostics.has_errors());
    return out;
  };
  const FieldModes turning = modes_of(
      "coord ψ : angle\nbody disk mass m inertia diag(Jd, Jd, Jp) at (u(l/4), v(l/4), l/4) rotation euler xyz "
      "(-v_z(l/4), u_z(l/4), ψ)\nstart ψ' = 100 rad/s\nrun 0.05 s\n");
  const FieldModes by_hand = modes_of(
      "T = 1/2 m (u(l/4)'^2 + v(l/4)'^2) + 1/2 Jd (u_z(l/4)'^2 + v_z(l/4)'^2) + Jp Ω u_z(l/4)' v_z(l/4)\n"
      "run 0.05 s\n");
  REQUIRE(turning.frequencies.size() == 4);
  REQUIRE(by_hand.frequencies.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(turning.frequencies[i] == doctest::Approx(by_hand.frequencies[i]).epsilon(1e-9));
  CHECK(turning.about == "ψ' = 100 (SI units)");
}

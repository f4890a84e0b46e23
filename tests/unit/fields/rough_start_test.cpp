#include "fields/resolution.hpp"

#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

/// Starts with kinks, or that do not fit their sides: all modes of the mesh have energy.
using namespace maupertuis;

namespace rough_start_test {
namespace {

FieldRunResult run_of(const std::string& text, double duration) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  Diagnostics diagnostics;
  const FieldCurrents currents = field_currents(*equations);
  FieldRunOptions options;
  options.duration = duration, options.errors = false, options.currents = &currents;
  const auto out = run_fields(*equations, {}, options, diagnostics);
  REQUIRE(out.has_value());
  CHECK(std::none_of(diagnostics.items().begin(), diagnostics.items().end(),
                     [](const Diagnostic& d) { return d.code == std::string("W0661"); }));
  return *out;
}

const FieldCharge& charge_named(const FieldRunResult& run, const std::string& name) {
  const auto at = std::find_if(run.charges.begin(), run.charges.end(), [&](const auto& c) { return c.name == name; });
  REQUIRE(at != run.charges.end());
  return *at;
}

const std::string line =
    "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 40 order 6\n"
    "density = 1/2 u'^2 - 1/2 u_x^2\n";

}  // namespace

TEST_CASE("a bar that is let go and a plucked string keep their energy") {
  CHECK(run_of(line + "boundary left : u = 0\nstart u = 0.1 x\n", 3).energy_drift < 1e-11);
  CHECK(run_of(line + "boundary u = 0\nstart u = 0.01 piecewise(x < 1/4 : 4 x, else : 4/3 (1 - x))\n", 3).energy_drift <
        1e-11);
}

TEST_CASE("no energy flows out of free and clamped sides, whatever the start") {
  const FieldRunResult run = run_of(
      "dimensionless\nfield u(x, y), v(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 6, 6 order 5\n"
      "density = 1/2 (u'^2 + v'^2) - 1/2 (u_x + v_y)^2 - 0.7 (u_x^2 + v_y^2 + 1/2 (u_y + v_x)^2)\n"
      "boundary left : u = 0, v = 0\nstart u = 0.01 x^2, v = 0\n",
      0.5);
  CHECK(run.energy_drift < 1e-13);
  const FieldCharge& energy = charge_named(run, "energy");
  CHECK(std::abs(energy.outflow) < 1e-12 * energy.size);
  CHECK(energy.left_over() < 1e-12);
}

TEST_CASE("a tap that is narrow in place and in time is seen, and a late pulse in a long run") {
  const auto codes = [](const std::string& text, double duration) {
    Study study(SourceText("field.lag", text));
    const FieldEquations* equations = study.field_equations();
    REQUIRE(equations);
    Diagnostics diagnostics;
    FieldRunOptions options;
    options.duration = duration, options.errors = false;
    run_fields(*equations, {}, options, diagnostics);
    std::string out;
    for (const Diagnostic& d : diagnostics.items()) out += d.code + " ";
    return out;
  };
  const std::string string_of_50 =
      "param μ = 1 kg/m, c = 1 m/s\nfield u(x) : length on x = 0 m .. 1 m cells 50 boundary u = 0\n"
      "density = 1/2 μ u'^2 - 1/2 μ c^2 u_x^2\nstart u = 0\n";
  CHECK(codes(string_of_50 + "param A = 1 N, x0 = 0.4003 m, w = 1e-6 m, t0 = 0.3 s, τ = 0.01 s\n"
                             "force density u = A/w exp(-((x - x0)/w)^2) exp(-((t - t0)/τ)^2)\n",
              0.01 /* the force acts later in the run that is asked for */)
            .find("E0647") == std::string::npos);
  CHECK(codes(string_of_50 + "param A = 1 N, x0 = 0.4003 m, w = 1e-6 m, t0 = 0.3 s, τ = 0.01 s\n"
                             "force density u = A/w exp(-((x - x0)/w)^2) exp(-((t - t0)/τ)^2)\n",
              1)
            .find("E0647") != std::string::npos);
  // A pulse that the mesh can follow, in place and in time, is nothing to refuse.
  CHECK(codes(string_of_50 + "param A = 1 N/m, t0 = 0.3 s, τ = 0.1 s\n"
                             "force density u = A sin(3 [1/m] x) exp(-((t - t0)/τ)^2)\n",
              1)
            .empty());
}

TEST_CASE("a pulse of 10 µs after half an hour is seen among more steps than can be looked at") {
  Study study(SourceText("field.lag",
                         "param μ = 1 kg/m, t0 = 1500.0037 s, τ = 1e-5 s\n"
                         "field u(x) : length on x = 0 m .. 1 m boundary u = 0\n"
                         "density = 1/2 μ u'^2 - 1/2 (1 [N]) u_x^2\n"
                         "force density u = (1e5 [N/m]) exp(-((t - t0)/τ)^2)\n"));
  const FieldEquations* equations = study.field_equations();
  REQUIRE(equations);
  const auto found = unresolved_moment(*equations, {}, 1e-3, {0, 1600});
  REQUIRE(found);
  CHECK(std::abs(*found - 1500.0037) < 1e-3);
  CHECK_FALSE(unresolved_moment(*equations, {}, 1e-3, {0, 1400}));
}

}  // namespace rough_start_test

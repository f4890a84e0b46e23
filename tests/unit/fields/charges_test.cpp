#include <maupertuis/field_run.hpp>
#include <maupertuis/study.hpp>
#include "../under_sanitizers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

/// Charges along runs against closed forms, and their books with what flows out at the ends.
using namespace maupertuis;

namespace {

std::vector<FieldCharge> charges_of(const std::string& text, double duration) {
  Study study(SourceText("field.lag", text));
  const FieldEquations* equations = study.field_equations();
  REQUIRE_MESSAGE(equations, text);
  const FieldCurrents currents = field_currents(*equations);
  FieldRunOptions options;
  options.duration = duration, options.errors = false, options.currents = &currents;
  Diagnostics diagnostics;
  const auto run = run_fields(*equations, {}, options, diagnostics);
  REQUIRE_MESSAGE(run, text);
  return run->charges;
}

FieldCharge named(const std::vector<FieldCharge>& charges, const std::string& label) {
  for (const FieldCharge& c : charges)
    if (c.label() == label) return c;
  FAIL("no charge " << label);
  return {};
}

}  // namespace

TEST_CASE("norm and momentum of a soliton of NLS: 2 η and 2 η v" * doctest::skip(under_sanitizers)) {
  const auto charges = charges_of(
      "dimensionless\nparam η = 1.3, v = 0.4\nfield ψ(x) : complex on x = -20 .. 24 cells 80 order 9\n"
      "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2 + 1/2 abs(ψ)^4\nstart ψ = η sech(η x) exp(i v x)\n",
      0.5);
  const FieldCharge norm = named(charges, "charge"), momentum = named(charges, "momentum along x");
  CHECK(std::abs(norm.start - 2.6) < 1e-9);
  CHECK(std::abs(norm.end - 2.6) < 1e-9);
  CHECK(std::abs(momentum.start - 1.04) < 1e-9);
  CHECK(momentum.left_over() < 1e-12);
  CHECK(norm.left_over() < 1e-12);
}

TEST_CASE("a wave that runs around a ring keeps its momentum, and none flows out") {
  // u = A sin(k (x − c t)): momentum −∫ ρ u' u_x = ρ c k² A² l/2
  const auto charges = charges_of(
      "dimensionless\nparam ρ = 2, T = 8, A = 0.3, l = 3\nlet k = 2 pi/l, c = sqrt(T/ρ)\n"
      "field u(x) : number on x = 0 .. l cells 20 order 6 boundary periodic\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"
      "start u = A sin(k x), u' = -A k c cos(k x)\n",
      2);
  const FieldCharge momentum = named(charges, "momentum along x");
  const double k = 2 * M_PI / 3, expected = 2 * 2 * k * k * 0.09 * 1.5;
  CHECK(std::abs(momentum.start - expected) < 1e-9 * expected);
  CHECK(std::abs(momentum.end - expected) < 1e-9 * expected);
  CHECK(momentum.outflow == 0);
  CHECK(momentum.left_over() < 1e-12);
}

TEST_CASE("the ends of a string take momentum from it") {
  // u = sin(2πx) cos(2πt) + sin(πx) cos(πt) on 0 .. 1 with ρ = T = 1: j^x = u_x²/2 at the ends, so that
  // dP/dt = ½ (u_x(0)² − u_x(1)²) = 4 π² cos(2πt) cos(πt)
  const auto charges = charges_of(
      "dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 6 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = sin(2 pi x) + sin(pi x)\n",
      0.5);
  const FieldCharge momentum = named(charges, "momentum along x");
  // ∫_0^{1/2} 4π² cos(2πt) cos(πt) dt = 2π² [sin(3πt)/(3π) + sin(πt)/π] = 2π² (−1/(3π) + 1/π) = 4π/3
  CHECK(std::abs(momentum.start) < 1e-12);
  CHECK(std::abs(momentum.end - 4 * M_PI / 3) < 1e-7);
  CHECK(std::abs(momentum.outflow + 4 * M_PI / 3) < 1e-7);
  CHECK(momentum.left_over() < 1e-8);
  CHECK(named(charges, "energy").left_over() < 1e-13);
}

TEST_CASE("a driven end and a force at an end are booked with the energy that they bring") {
  // u = sin(x) sin(t): u(0) = 0, u(1) = sin(1) sin(t), E = ¼ (1 + … ) from the start to the end
  const std::string density = "density = 1/2 u'^2 - 1/2 u_x^2\nstart u' = sin(x)\n";
  const auto driven = charges_of("dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 6\n" + density +
                                     "boundary left : u = 0\nboundary right : u = sin(1) sin(t)\n",
                                 1);
  const auto pulled = charges_of("dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 6\n" + density +
                                     "boundary left : u = 0\nforce u(1) = cos(1) sin(t)\n",
                                 1);
  // E(t) = ½ ∫ sin²x cos²t + cos²x sin²t dx; ∫_0^1 sin² = ½ − sin(2)/4
  const double s = 0.5 - std::sin(2) / 4, c = 0.5 + std::sin(2) / 4;
  const double start = s / 2, end = (s * std::cos(1) * std::cos(1) + c * std::sin(1) * std::sin(1)) / 2;
  for (const auto* charges : {&driven, &pulled}) {
    const FieldCharge energy = named(*charges, "energy");
    CHECK(std::abs(energy.start - start) < 1e-9);
    CHECK(std::abs(energy.end - end) < 1e-9);
    CHECK(std::abs(energy.outflow - (start - end)) < 1e-9);
    CHECK(energy.left_over() < 1e-9);
  }
}

TEST_CASE("the boost of a Klein-Gordon field: its centre of energy moves by P t") {
  const auto charges = charges_of(
      "dimensionless\nfield u(x) : number on x = -20 .. 20 cells 200 order 4\n"
      "density = 1/2 u'^2 - 1/2 u_x^2 - 1/2 u^2\nstart u = exp(-x^2) cos(2 x), u' = exp(-x^2) sin(2 x)\n",
      3);
  const FieldCharge boost = named(charges, "boost along x"), momentum = named(charges, "momentum along x");
  CHECK(std::abs(momentum.start) > 0.1);
  CHECK(std::abs(boost.start - boost.end) < 1e-8 * boost.size);
  CHECK(boost.left_over() < 1e-8);
}

TEST_CASE("sides of a rectangle: momentum and angular momentum flow out of a membrane") {
  const auto charges = charges_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 8, 8 order 6 boundary u = 0\n"
      "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\nstart u = sin(pi x) sin(pi y) + sin(2 pi x) sin(pi y)\n",
      0.4);
  const FieldCharge momentum = named(charges, "momentum along x");
  CHECK(std::abs(momentum.end) > 0.1);
  CHECK(momentum.left_over() < 1e-4);
  CHECK(std::abs(momentum.end + momentum.outflow) < 1e-4 * std::abs(momentum.end));
  CHECK(named(charges, "angular momentum").left_over() < 1e-4);
}

TEST_CASE("around a strip momentum stays, across it flows out of the sides") {
  const auto charges = charges_of(
      "dimensionless\nfield u(x, y) : number on x = 0 .. 2 pi, y = 0 .. 1 cells 8, 6 order 6 boundary periodic x\n"
      "boundary u = 0\ndensity = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\n"
      "start u = sin(pi y) cos(x) + sin(2*pi*y) cos(x), u' = 3 sin(pi y) sin(x)\n",
      0.4);
  const FieldCharge around = named(charges, "momentum along x"), across = named(charges, "momentum along y");
  CHECK(std::abs(around.start - 3 * std::acos(-1.0) / 2) < 1e-9);
  CHECK(std::abs(around.end - around.start) < 1e-11 * around.size);
  CHECK(around.outflow == 0);
  CHECK(std::abs(across.end - across.start) > 0.1);
  CHECK(across.left_over() < 1e-4);
}

TEST_CASE("friction is no part of a current: nothing is booked") {
  CHECK(charges_of("dimensionless\nfield u(x) : number on x = 0 .. 1 cells 10 order 4 boundary u = 0\n"
                   "density = 1/2 u'^2 - 1/2 u_x^2\ndissipation density = 1/2 u'^2\nstart u = sin(pi x)\n",
                   0.1)
            .empty());
}

TEST_CASE("names and signs of currents") {
  Study study(SourceText("field.lag",
                         "dimensionless\nfield ψ(x) : complex on x = 0 .. 1\n"
                         "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2\n"));
  const FieldCurrents found = field_currents(*study.field_equations());
  const auto charge = std::find_if(found.currents.begin(), found.currents.end(),
                                   [](const FieldCurrent& c) { return c.name == "charge"; });
  REQUIRE(charge != found.currents.end());
  Study string(
      SourceText("field.lag", "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"));
  std::vector<std::string> names;
  for (const FieldCurrent& c : field_currents(*string.field_equations()).currents) names.push_back(c.name);
  CHECK(std::count(names.begin(), names.end(), "boost along x") == 1);
  CHECK(std::count(names.begin(), names.end(), "dilation") == 1);
}

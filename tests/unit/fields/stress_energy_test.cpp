#include <maupertuis/evaluate.hpp>
#include <maupertuis/stress_energy.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

/// The symmetric stress-energy tensor against its closed forms.
using namespace maupertuis;

namespace {

/// Of a vector field (Φ, A) with E and B = curl A and a mass; c is a parameter.
const char* vector_field(bool massive) {
  return massive ? "dimensionless\nparam m = 2\nfield Φ(x, y, z), A1(x, y, z), A2(x, y, z), A3(x, y, z) : number\n"
                   "let E1 = -Φ_x - A1', E2 = -Φ_y - A2', E3 = -Φ_z - A3'\n"
                   "let B1 = A3_y - A2_z, B2 = A1_z - A3_x, B3 = A2_x - A1_y\n"
                   "density = 1/2 (E1^2 + E2^2 + E3^2) - 1/2 (B1^2 + B2^2 + B3^2) "
                   "+ 1/2 m^2 (Φ^2 - A1^2 - A2^2 - A3^2)\n"
                 : "dimensionless\nparam m = 0\nfield Φ(x, y, z), A1(x, y, z), A2(x, y, z), A3(x, y, z) : number\n"
                   "let E1 = -Φ_x - A1', E2 = -Φ_y - A2', E3 = -Φ_z - A3'\n"
                   "let B1 = A3_y - A2_z, B2 = A1_z - A3_x, B3 = A2_x - A1_y\n"
                   "density = 1/2 (E1^2 + E2^2 + E3^2) - 1/2 (B1^2 + B2^2 + B3^2)\n";
}

struct VectorField {
  Expr e[3], b[3], a[3], phi, m2;
};

VectorField closed_form(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  const auto jet = [&](std::size_t f, int along, int t) {
    FieldJet out{f, {0, 0, 0}, t};
    if (along >= 0) out.space[static_cast<std::size_t>(along)] = 1;
    return s.jet_symbol(out);
  };
  VectorField out;
  out.phi = jet(0, -1, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const int j = static_cast<int>((i + 1) % 3), k = static_cast<int>((i + 2) % 3);
    out.a[i] = jet(i + 1, -1, 0);
    out.e[i] = -jet(0, static_cast<int>(i), 0) - jet(i + 1, -1, 1);
    out.b[i] = jet(static_cast<std::size_t>(k) + 1, j, 0) - jet(static_cast<std::size_t>(j) + 1, k, 0);
  }
  for (const Parameter& p : equations.model->parameters)
    if (p.name == "m") out.m2 = p.si_value == 0 ? s.context->number(0) : p.symbol * p.symbol;
  return out;
}

bool equal(Expr a, Expr b) { return zero_test(a - b).verdict == Verdict::Zero; }

}  // namespace

TEST_CASE("Maxwell and Proca: (E² + B²)/2, E × B, Maxwell's stresses and what the mass adds") {
  for (const bool massive : {false, true}) {
    CAPTURE(massive);
    Study study(SourceText("field.lag", vector_field(massive)));
    const FieldEquations& equations = *study.field_equations();
    const auto tensor = stress_energy(equations, field_currents(equations));
    REQUIRE(tensor);
    CHECK(tensor->certified());
    CHECK(tensor->has_spin());
    CHECK(tensor->c_squared.is_one());
    const VectorField f = closed_form(equations);
    Expr square = f.m2 * f.phi * f.phi, difference = -square;
    for (std::size_t i = 0; i < 3; ++i) {
      square = square + f.e[i] * f.e[i] + f.b[i] * f.b[i] + f.m2 * f.a[i] * f.a[i];
      difference = difference + f.m2 * f.a[i] * f.a[i];
    }
    CHECK(equal(tensor->energy_density(), Rational(1, 2) * square));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      CHECK(equal(tensor->energy_flux(i), f.e[j] * f.b[k] - f.e[k] * f.b[j] + f.m2 * f.phi * f.a[i]));
      CHECK(equal(tensor->stress(3, i), tensor->energy_flux(i)));
      for (std::size_t l = 0; l < 3; ++l) {
        Expr stress = f.m2 * f.a[i] * f.a[l] - f.e[i] * f.e[l] - f.b[i] * f.b[l];
        // δ_il (E² + B²)/2 + m² (A_i A_l + δ_il (Φ² − A²)/2)
        if (i == l) {
          Expr diagonal = f.m2 * f.phi * f.phi;
          for (std::size_t n = 0; n < 3; ++n)
            diagonal = diagonal + f.e[n] * f.e[n] + f.b[n] * f.b[n] - f.m2 * f.a[n] * f.a[n];
          stress = stress + Rational(1, 2) * diagonal;
        }
        CHECK(equal(tensor->stress(i, l), stress));
      }
    }
  }
}

TEST_CASE("scalar fields: the canonical tensor, with the speed of their waves") {
  Study study(SourceText("field.lag",
                         "dimensionless\nparam T = 3, ρ = 2\nfield u(x, y) : number\n"
                         "density = 1/2 ρ u'^2 - 1/2 T (u_x^2 + u_y^2) - u^4\n"));
  const FieldEquations& equations = *study.field_equations();
  const auto tensor = stress_energy(equations, field_currents(equations));
  REQUIRE(tensor);
  CHECK(!tensor->has_spin());
  Expr rho, tension;
  for (const Parameter& p : equations.model->parameters) (p.name == "T" ? tension : rho) = p.symbol;
  CHECK(equal(tensor->c_squared, tension / rho));
  const FieldSystem& s = equations.system();
  const Expr v = s.jet_symbol({0, {0, 0}, 1}), ux = s.jet_symbol({0, {1, 0}, 0});
  CHECK(equal(tensor->energy_flux(0), -(tension * ux * v)));
}

TEST_CASE("no tensor where the density is not Lorentz-invariant") {
  for (const char* text : {"dimensionless\nfield ψ(x) : complex\n"
                           "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2\n",
                           "dimensionless\nfield u(x, y) : number\ndensity = 1/2 u'^2 - 1/2 u_x^2 - u_y^2 - u^4\n",
                           "dimensionless\nfield u(x) : number\ndensity = 1/2 u'^2 - 1/2 u_xx^2\n"}) {
    Study study(SourceText("field.lag", text));
    const FieldEquations& equations = *study.field_equations();
    CHECK(!stress_energy(equations, field_currents(equations)));
  }
}

TEST_CASE("no tensor where friction or forces take from what it counts") {
  const std::string wave = "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = 1/2 u'^2 - 1/2 u_x^2\n";
  const auto has_tensor = [](const std::string& text) {
    Study study(SourceText("field.lag", text));
    REQUIRE(study.field_equations());
    return stress_energy(*study.field_equations(), field_currents(*study.field_equations())).has_value();
  };
  CHECK(has_tensor(wave));
  CHECK(!has_tensor(wave + "dissipation density = 1/2*0.1*u'^2\n"));
  CHECK(!has_tensor(wave + "force density u = sin(3 x) cos(t)\n"));
}

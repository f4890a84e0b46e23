#include <maupertuis/evaluate.hpp>
#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <complex>

using namespace maupertuis;

namespace {

/// How many of the expectations of a model hold, and the codes of its messages.
std::string outcome(const std::string& text) {
  Study study(SourceText("field.lag", text));
  std::string codes;
  const auto verification = study.verification();
  for (const Diagnostic& d : study.diagnostics().items()) codes += d.code + " ";
  if (!verification) return codes;
  std::size_t passed = 0;
  for (const ExpectationResult& r : verification->results) passed += r.passed;
  return codes + std::to_string(passed) + " of " + std::to_string(verification->results.size());
}

const std::string schroedinger =
    "dimensionless\nparam g = 2\nfield ψ(x) : complex\n"
    "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2 + g/2 abs(ψ)^4\n";

}  // namespace

TEST_CASE("a complex equation is two real ones, by the real density of its parts") {
  CHECK(outcome(schroedinger + "expect equation i ψ' + 1/2 ψ_xx + g abs(ψ)^2 ψ = 0\n") == "2 of 2");
  CHECK(outcome(schroedinger + "expect equation i ψ' + 1/2 ψ_xx + g ψ^2 conj(ψ) = 0\n") == "2 of 2");
  CHECK(outcome(schroedinger + "expect equation -i ψ' + 1/2 ψ_xx + g abs(ψ)^2 ψ = 0\n") == "0 of 2");
  CHECK(outcome(schroedinger + "expect equation ψ_r' + 1/2 ψ_i_xx + g abs(ψ)^2 ψ_i = 0\n") == "1 of 1");
  CHECK(outcome("dimensionless\nfield a(x), b(x) : number\nparam g = 2\n"
                "density = b a' - a b' + 0 - (b a' - a b') + 1/2 (b' a - a' b) * (-2) + a' b - b' a - 1/2 (a_x^2 + "
                "b_x^2) + g/2 (a^2 + b^2)^2\n"
                "expect equation 4 a' + b_xx + 2 g (a^2 + b^2) b = 0\n") == "1 of 1");
}

TEST_CASE("solutions, currents and definitions in complex form") {
  CHECK(outcome(schroedinger + "let k = 0.7, w = 1/2 k^2 - 4*g\nlet z = 2 exp(i (k x - w t))\n"
                               "expect solution ψ = z\nexpect solution ψ = conj(z)\n"
                               "expect current abs(ψ)^2 flux im(conj(ψ) ψ_x)\n"
                               "expect current re(ψ conj(ψ)) flux im(ψ conj(ψ_x))\n") == "2 of 4");
  // Quotients and powers: (1 + i)^4 = −4, 1/i = −i
  CHECK(outcome(schroedinger + "expect equation (1 + i)^4 (ψ'/4 + ((1/8)/i) ψ_xx + g/4 abs(ψ)^2 (ψ/i)) = 0\n") ==
        "2 of 2");
}

TEST_CASE("a complex field with mass: second order in time, a charge") {
  CHECK(
      outcome("dimensionless\nparam m = 1.5\nfield φ(x) : complex on x = 0 .. 2*pi cells 8 order 8 boundary periodic\n"
              "density = abs(φ')^2 - abs(φ_x)^2 - m^2 abs(φ)^2\nlet w = sqrt(4 + m^2)\n"
              "start φ = exp(2 i x), φ' = -i w exp(2 i x)\nrun 1\n"
              "expect equation φ'' - φ_xx + m^2 φ = 0\nexpect current im(conj(φ) φ') flux -im(conj(φ) φ_x)\n"
              "expect re(φ(1)) at 1 = cos(2 - w) ± 1e-7\nexpect im(φ(1)) at 1 = sin(2 - w) ± 1e-7\n"
              "expect total im(conj(φ) φ') at 1 = -2*pi w ± 1e-7\n") == "6 of 6");
}

TEST_CASE("complex densities and values that are not real are told") {
  CHECK(outcome("dimensionless\nfield ψ(x) : complex\ndensity = i conj(ψ) ψ' - 1/2 abs(ψ_x)^2\n") == "E0293 ");
  CHECK(outcome(schroedinger + "expect total cos(ψ) at 1 = 0 ± 1\n") == "E0294 ");
  CHECK(outcome(schroedinger + "expect total ψ^2 at 1 = 0 ± 1\n") == "E0294 ");
  CHECK(outcome(schroedinger + "expect total abs(2^ψ) at 1 = 0 ± 1\n") == "E0294 ");
  std::string long_product = "1";
  for (int k = 0; k < 40; ++k) long_product += " (1 + i ψ)";
  CHECK(outcome(schroedinger + "expect total abs(" + long_product + ") at 1 = 0 ± 1\n") == "E0294 ");
}

TEST_CASE("equations in complex form: E_ψ* = (E_r + i E_i)/2 at random values") {
  Study study(SourceText("field.lag",
                         "dimensionless\nparam g = 2\nfield ψ(x) : complex\n"
                         "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2 + g/3 abs(ψ)^6 - abs(ψ)^2 x\n"));
  REQUIRE(study.field_equations());
  const FieldEquations& e = *study.field_equations();
  const auto found = complex_equations(e);
  REQUIRE(found.size() == 1);
  CHECK(found[0].field == "ψ");
  // One value of each jet: ψ = 0.3 − 0.8 i, ψ' = 0.5 + 0.2 i, ψ_xx = −0.4 + 0.9 i; x = 0.7
  using Complex = std::complex<double>;
  const Complex z[] = {{0.3, -0.8}, {0.5, 0.2}, {-0.4, 0.9}};
  const FieldSystem& s = e.system();
  Bindings real{{s.space[0].symbol, 0.7}}, in_re = real, in_im = real;
  for (const Parameter& p : e.model->parameters) real[p.symbol] = in_re[p.symbol] = in_im[p.symbol] = p.si_value;
  const FieldJet jets[] = {{0, {0}, 0}, {0, {0}, 1}, {0, {2}, 0}};
  for (int k = 0; k < 3; ++k)
    for (std::size_t part = 0; part < 2; ++part) {
      FieldJet jet = jets[k];
      jet.field = part;
      real[s.jet_symbol(jet)] = part == 0 ? z[k].real() : z[k].imag();
    }
  const Complex expected =
      0.5 * Complex(evaluate(s.expanded(e.euler[0]), real), evaluate(s.expanded(e.euler[1]), real));
  // The complex form is linear in ψ, ψ', ψ_xx beside |ψ|: by the real and imaginary parts of these.
  const Expr symbols[] = {s.context->symbol("ψ", Role::Coordinate, 0), s.context->symbol("ψ", Role::Coordinate, 1),
                          s.context->symbol("ψ_xx", Role::Coordinate, 0)};
  in_re[s.context->symbol("abs(ψ)", Role::Auxiliary)] = in_im[s.context->symbol("abs(ψ)", Role::Auxiliary)] =
      std::abs(z[0]);
  for (int k = 0; k < 3; ++k) in_re[symbols[k]] = z[k].real(), in_im[symbols[k]] = z[k].imag();
  const Complex re(evaluate(found[0].re, in_re), evaluate(found[0].re, in_im));
  const Complex im(evaluate(found[0].im, in_re), evaluate(found[0].im, in_im));
  CHECK(std::abs(re + Complex(0, 1) * im - expected) < 1e-14);
}

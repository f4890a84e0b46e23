// What follows from a density: conservation laws and what breaks them, waves, modes of complex fields, internal
// friction.
#include "program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace cli_test;

namespace {

const std::string timoshenko =
    "param ρA = 1.1 kg/m, ρI = 0.002 kg m, EI = 0.9 N m^2, S = 300 N\nfield w(x) : length on x = 0 m .. 2 m\n"
    "field ψ(x) : angle\ndensity = 1/2 ρA w'^2 + 1/2 ρI ψ'^2 - 1/2 EI ψ_x^2 - 1/2 S (w_x - ψ)^2\n";

const std::string hinged =
    "dimensionless\nfield w(x) : number on x = 0 .. 1 cells 6 order 9 boundary w = 0\n"
    "density = 1/2 w'^2 - 1/2 w_xx^2\ndissipation density = 0.01 w_txx^2\nstart w = sin(pi*x)\nrun 1/2\n";

Outcome with_line(const std::string& model, const std::string& line) {
  return maup({"test", "-"}, model + "expect " + line + "\n");
}

}  // namespace

TEST_CASE("laws that friction and forces break are told so, with what breaks them") {
  const std::string damped =
      "param ρ = 2 kg/m, T0 = 3 N, r = 0.1 kg/(m s)\nfield u(x) : length on x = 0 m .. 1 m\n"
      "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n";
  const Outcome free = maup({"invariants", "-"}, damped);
  CHECK(contains(free.out, "Conservation laws"));
  CHECK_FALSE(contains(free.out, "not conserved"));
  const Outcome broken = maup({"invariants", "-"}, damped + "dissipation density = 1/2 r u'^2\n");
  CHECK(contains(broken.out, "Balance laws"));
  CHECK(contains(broken.out, "not conserved: Q·E = -r u'^2"));
  // A force along x moves no charge of rotation of two fields.
  const std::string two =
      "dimensionless\nparam F = 2\nfield a(x), b(x) : number on x = 0 .. 1\n"
      "density = 1/2 (a'^2 + b'^2 - a_x^2 - b_x^2)\nforce density a = -F a\nforce density b = -F b\n";
  const auto document = nlohmann::json::parse(maup({"invariants", "-", "--json"}, two).out);
  bool charge_is_kept = false, energy_is_lost = false;
  for (const auto& c : document["currents"]) {
    if (c["name"] == "charge") charge_is_kept = c["conserved"].get<bool>();
    if (c["name"] == "energy") energy_is_lost = !c["conserved"].get<bool>();
  }
  CHECK(charge_is_kept);
  CHECK(energy_is_lost);
}

TEST_CASE("a shift of two fields together is no rotation") {
  const Outcome found = maup({"invariants", "-"}, timoshenko);
  CHECK(contains(found.out, "shift of w and ψ: together: w + ε x, ψ + ε"));
  CHECK_FALSE(contains(found.out, "into each other"));
}

TEST_CASE("waves of first order in time have a boost") {
  const Outcome found = maup({"invariants", "-"},
                             "dimensionless\nfield ψ(x) : complex on x = -9 .. 9\n"
                             "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2 + 1/2 abs(ψ)^4\n");
  CHECK(contains(found.out, "boost along x"));
}

TEST_CASE("a dispersion relation that is not solved for ω") {
  const std::string relation = "ρA ρI ω^4 - (ρA EI k^2 + ρA S + ρI S k^2) ω^2 + S EI k^4";
  CHECK(with_line(timoshenko, "dispersion " + relation + " = 0").code == 0);
  CHECK(with_line(timoshenko, "dispersion " + relation + " + ρA S ω^2 = 0").code == 4);
  const std::string wave =
      "param c = 2 m/s\nfield u(x) : [1] on x = 0 m .. 1 m\ndensity = 1/2*1 [J s^2/m] (u'^2 - c^2 u_x^2)\n";
  CHECK(with_line(wave, "dispersion c k - ω = 0").code == 0);  // one of its two branches
  CHECK(with_line(wave, "dispersion (ω - c k)^2 = 0").code == 4);
  CHECK(with_line(wave, "dispersion c k = 2 c k").code == 4);  // says nothing of ω
}

TEST_CASE("modes of a complex field: levels of an oscillator and of a box") {
  const std::string of = "dimensionless\nfield ψ(x) : complex on x = ";
  const std::string kinetic = "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2";
  CHECK(with_line(of + "-9 .. 9\nboundary ψ = 0\n" + kinetic + " - 1/2 x^2 abs(ψ)^2\n",
                  "frequencies of ψ : 0.5, 1.5, 2.5, 3.5 rel 1e-9")
            .code == 0);
  CHECK(with_line(of + "0 .. 1\nboundary ψ = 0\n" + kinetic + "\n",
                  "frequencies of ψ : 1/2 pi^2, 2 pi^2, 9/2 pi^2 rel 1e-9")
            .code == 0);
}

TEST_CASE("a beam with internal friction, against its damped oscillation") {
  // a'' + 0.02 π⁴ a' + π⁴ a = 0
  const double k4 = std::pow(std::acos(-1.0), 4), c = 0.02 * k4 / 2, w = std::sqrt(k4 - c * c), t = 0.5;
  const double a = std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
  char line[200];
  std::snprintf(line, sizeof line, "w(1/2) at 1/2 = %.16g ± 1e-9", a);
  CHECK(with_line(hinged, line).code == 0);
  CHECK(with_line(hinged, "equation w'' + w_xxxx + 0.02 w_txxxx = 0").code == 0);
  CHECK(with_line(hinged, "natural w_xx + 0.02 w_txx = 0, w_xxx + 0.02 w_txxx = 0").code == 0);
  const std::string with_tip =
      "param EI = 20 N m^2, η = 0.1 N m^2 s, ρ = 1 kg/m, l = 2 m, m = 0.5 kg\n"
      "field w(x) : length on x = 0 m .. l cells 4 order 8\nboundary left : w = 0, w_x = 0\n"
      "density = 1/2 ρ w'^2 - 1/2 EI w_xx^2\ndissipation density = 1/2 η w_txx^2\nT = 1/2 m w(l)'^2\n"
      "start w = 0.01 [1/m] x^2\nrun 0.1 s\n";
  const Outcome derived = maup({"derive", "-"}, with_tip);
  CHECK(derived.code == 0);
  CHECK(contains(derived.out, "w_xxx(l)'"));
  CHECK(with_line(with_tip, "equation m w(l)'' - EI w_xxx(l) - η w_txxx(l) = 0").code == 0);
}

TEST_CASE("limits from one side, and pieces that are decided at a border") {
  const std::string stepped =
      "dimensionless\nparam a = 0.4\nfield u(x) : number on x = 0 .. 1\nboundary left : u = 0\n"
      "density = 1/2 u'^2 - 1/2 piecewise(x < a : 8, else : 1) u_x^2\n";
  const Outcome derived = maup({"derive", "-", "--plain"}, stepped);
  CHECK(contains(derived.out, "8 u_x(a - 0) - u_x(a + 0) = 0"));
  CHECK(contains(derived.out, "natural "));
  CHECK(with_line(stepped, "equation 8 u_x(a - 0) - u_x(a + 0) = 0").code == 0);
  CHECK(with_line(stepped, "equation u_x(a - 0) - u_x(a + 0) = 0").code == 4);
  // In a run there is one value, not two.
  CHECK(contains(with_line(stepped + "start u = x\nrun 0.1\n", "u_x(a - 0) at 0.1 = 1 ± 1").err, "E0508"));
}

TEST_CASE("Schrödinger's field in SI units") {
  const std::string trap =
      "param ħ = 1.054571817e-34 J s, m = 1.44e-25 kg, ω0 = 600 1/s, l = 8 um\n"
      "field ψ(x) : complex [m^(-1/2)] on x = -l .. l\nboundary ψ = 0\n"
      "density = i ħ/2 (conj(ψ) ψ' - ψ conj(ψ')) - ħ^2/(2 m) abs(ψ_x)^2 - 1/2 m ω0^2 x^2 abs(ψ)^2\n";
  CHECK(with_line(trap, "frequencies of ψ : 1/2 ω0, 3/2 ω0, 5/2 ω0 rel 1e-9").code == 0);
  CHECK(with_line(trap, "equation i ħ ψ' + ħ^2/(2 m) ψ_xx - 1/2 m ω0^2 x^2 ψ = 0").code == 0);
  CHECK(maup({"check", "-"}, trap + "start ψ = 1 m\n").code == 1);
}

#include "boundary.hpp"

#include <maupertuis/simulation.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

// x = cos t: the state after 1 is known to all digits.
const std::string oscillator =
    "dimensionless\nparam m = 1, k = 1\ncoord x : number\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1\nrun 1\n";
// The same in centimetres and degrees: x = 1 cm cos t, θ = 10 deg + 10 deg/s t.
const std::string units = R"(param m = 1 kg, k = 1 N/m, J = 1 kg m^2
coord x : length, θ : angle
T = 1/2 m x'^2 + 1/2 J θ'^2
V = 1/2 k x^2
start x = 1 cm, θ = 10 deg, θ' = 10 deg/s
run 1 s
)";
// Free: x = 1 + t/1000.
const std::string slow = "dimensionless\ncoord x : number\nL = 1/2 x'^2\nstart x = 1, x' = 1/1000\nrun 1\n";
const std::string two_springs =
    "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + 4 y^2)\nstart x = 1\nrun 1\n";

}  // namespace

TEST_CASE("values at a time: absolute and relative, in the unit written") {
  const double cosine = 0.54030230586813977;
  boundary(oscillator, "expect x at 1 = 0.54031230586813977 ± TOL", 1e-5);
  boundary(oscillator, "expect x at 1 = 0.54031230586813977 rel TOL", 1e-5 / 0.54031230586813977);
  boundary(oscillator, "expect -1000 x at 1 = -540.31230586813977 rel TOL", 1e-5 / 0.54031230586813977);
  boundary(oscillator, "expect x'' at 1 = -0.54031230586813977 ± TOL", 1e-5);
  boundary(units, "expect x at 1 s = 0.54031230586813977 cm ± TOL", 1e-5);
  boundary(units, "expect x at 1 s = 0.54031230586813977 cm ± TOL mm", 1e-4);
  boundary(units, "expect θ at 1 s = 20.001 deg ± TOL", 1e-3);
  boundary(units, "expect θ at 1 s = 20.001 deg ± TOL rad", 1e-3 * 3.14159265358979 / 180);
  CHECK(cosine == doctest::Approx(std::cos(1.0)));
}

TEST_CASE("values without a time: the start, and the digits as written") {
  boundary(oscillator, "expect x + k/m = 2.01 ± TOL", 0.01);
  boundary(oscillator, "expect x + k/m = 2.01 rel TOL", 0.01 / 2.01);
  passes(oscillator, "expect 1000 x = 1000.00000099");
  fails(oscillator, "expect 1000 x = 1000.00000101");
  fails(oscillator, "expect 1000 x = 999.99999899");
}

TEST_CASE("values before the start are run for backwards") {
  const std::string from_one = "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart at 1, x = 1\nrun 1\n";
  boundary(from_one, "expect x at 0 = 0.54031230586813977 ± TOL", 1e-5);
}

TEST_CASE("what is not a number passes nothing") { fails(oscillator, "expect sqrt(x - 2) at 1 = 0 ± 1e300"); }

TEST_CASE("conservation along the run: the drift is that of the largest size") {
  boundary(slow, "expect conserved x rel TOL", 0.001 / 1.001);
  // The sign of the quantity does not matter, nor where along the run it is largest.
  boundary(slow, "expect conserved -x rel TOL", 0.001 / 1.001);
  boundary(slow, "expect conserved x - 2 rel TOL", 0.001 / 1);
}

TEST_CASE("energy: the drift of the run against the tolerance, by default 1e-12") {
  const std::string swing = "dimensionless\ncoord θ : angle\nL = 1/2 θ'^2 + cos θ\nstart θ = 1\nrun 1\n";
  const std::string steps = swing + "method variational order 2 step 0.1\n";
  const ModelText m(steps);
  Diagnostics told;
  const double drift = simulate(m.model, m.equations, {}, told)->statistics.energy_drift;
  CHECK(drift > 1e-8);
  boundary(steps, "expect energy conserved rel TOL", drift);
  // Just inside and just outside of the default.
  const auto with_step = [&](const std::string& step) {
    return swing + "method variational order 4 step " + step + "\n";
  };
  const auto drift_of = [&](const std::string& step) {
    const ModelText model(with_step(step));
    Diagnostics unheard;
    return simulate(model.model, model.equations, {}, unheard)->statistics.energy_drift;
  };
  REQUIRE(drift_of("0.02") > 1e-12);
  REQUIRE(drift_of("0.02") < 1e-7);
  fails(with_step("0.02"), "expect energy conserved");
  passes(with_step("0.02"), "expect energy conserved rel 1e-7");
  passes(oscillator, "expect energy conserved");
}

TEST_CASE("identities: a coefficient that is off in the twelfth digit fails") {
  passes(oscillator, "expect conserved 1/2 m x'^2 + 1/2 k x^2");
  fails(oscillator, "expect conserved 1/2 m x'^2 + 0.500000000001 k x^2");
  fails(oscillator, "expect 1/2 m x'^2 + 1/2 k x^2 not conserved");
  passes(oscillator, "expect 1/2 m x'^2 + 0.500000000001 k x^2 not conserved");
  passes(oscillator, "expect equation m x'' = -k x");
  fails(oscillator, "expect equation m x'' = -1.000000000001 k x");
  passes(oscillator, "claim m x'' = -k x");
  fails(oscillator, "claim m x'' = -1.000000000001 k x");
  passes(oscillator, "expect hamiltonian = p_x^2/(2 m) + 1/2 k x^2");
  fails(oscillator, "expect hamiltonian = p_x^2/(2 m) + 0.500000000001 k x^2");
  passes(oscillator, "expect bracket (x, p_x) = 1");
  fails(oscillator, "expect bracket (x, p_x) = 1.000000000001");
  passes(oscillator, "expect integral m x'^2 + k x^2");
  fails(oscillator, "expect integral m x'^2 + 1.000000000001 k x^2");
  const std::string polar = "dimensionless\ncoord r, φ : number\nL = 1/2 (r'^2 + r^2 φ'^2) + 1/r\n";
  passes(polar, "expect routhian of φ = 1/2 r'^2 - p_φ^2/(2 r^2) + 1/r");
  fails(polar, "expect routhian of φ = 1/2 r'^2 - 0.500000000001 p_φ^2/r^2 + 1/r");
  passes(polar, "expect conserved p_φ");
}

TEST_CASE("counts: one more and one less fail") {
  passes(two_springs, "expect freedoms = 2");
  fails(two_springs, "expect freedoms = 1");
  fails(two_springs, "expect freedoms = 3");
}

TEST_CASE("constraints that exclude each other decide nothing") {
  const std::string clash =
      "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nconstraint x = 0 name a\nconstraint x = 1 name b\n";
  for (const char* line :
       {"expect freedoms = 0", "expect freedoms = 1", "expect freedoms = 2", "expect constraint a is holonomic",
        "expect constraint a is scleronomic", "expect constraint b is holonomic"}) {
    const ExpectationResult r = only(clash + line + "\n");
    INFO(line, ": ", r.actual, " ", r.message);
    CHECK_FALSE(r.passed);
    CHECK(r.message == "The constraints exclude each other.");
  }
}

TEST_CASE("frequencies: each of them, absolute, relative, squared, in hertz") {
  boundary(two_springs, "expect frequencies at x = 0, y = 0 : 1, 2.01 ± TOL", 0.01);
  boundary(two_springs, "expect frequencies at x = 0, y = 0 : 2, 1.01 ± TOL", 0.01);
  boundary(two_springs, "expect frequencies at x = 0, y = 0 : 1, 2.01 rel TOL", 0.01 / 2.01);
  boundary(two_springs, "expect frequencies squared at x = 0, y = 0 : 1, 4.01 ± TOL", 0.01);
  boundary(two_springs, "expect frequencies squared at x = 0, y = 0 : 1.01, 4 rel TOL", 0.01 / 1.01);
  fails(two_springs, "expect frequencies at x = 0, y = 0 : 1 ± 10");
  fails(two_springs, "expect frequencies at x = 0, y = 0 : 1, 2, 2 ± 10");
  const std::string spring = "param m = 1 kg, k = 1 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n";
  boundary(spring, "expect frequencies at x = 0 : 0.16 Hz ± TOL Hz", 0.16 - 0.15915494309189535);
  boundary(spring, "expect frequencies at x = 0 : 0.16 Hz ± TOL", 0.16 - 0.15915494309189535);
  boundary(spring, "expect frequencies at x = 0 : 1.01 rad/s ± TOL rad/s", 0.01);
  // A stop far away: no modes in 100 digits, and rounding of 10¹² hides the spring that holds both.
  const std::string stiff =
      "dimensionless\ncoord x, y : number\nT = 1/2 x'^2 + 1/2 y'^2\n"
      "V = 1/2 * 1e12 (x - y)^2 + 1/2 * 1e-2 x^2 + max(x - 5, 0)^2\n";
  fails(stiff, "expect frequencies at x = 0, y = 0 : 0, sqrt(2e12 + 5e-3) ± 1e-3");
}

TEST_CASE("equilibria: the place within its tolerance, and the word") {
  const std::string wells = "dimensionless\ncoord x : number\nL = 1/2 x'^2 + 1/2 x^2 - 1/4 x^4\n";
  boundary(wells, "expect equilibrium at x = 1.001 ± TOL", 0.001);
  boundary(wells, "expect equilibrium at x = -1.001 rel TOL is stable", 0.001 / 1.001);
  fails(wells, "expect equilibrium at x = 1.001 ± 1e-2 is unstable");
  fails(wells, "expect equilibrium at x = 1.001");
  passes(wells, "expect equilibrium at x = 0 is unstable");
  fails(wells, "expect equilibrium at x = 0 is stable");
  fails(wells, "expect equilibrium at x = 0 is undecided");
  fails(wells, "expect equilibrium at x = 0.5 ± 1e-3");
  const std::string pendulum =
      "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\n";
  boundary(pendulum, "expect equilibrium at θ = 180.01 deg ± TOL is unstable", 0.01);
  boundary(pendulum, "expect equilibrium at θ = 180.01 deg ± TOL rad", 0.01 * 3.14159265358979 / 180);
}

TEST_CASE("paths: action, action of a given path, index, a place, and the second path") {
  // Between 0 and x = 1 in one unit of time, L = ½ x'²: S = ½.
  const std::string straight = "dimensionless\ncoord x : number\nL = 1/2 x'^2\npath from 0 at 0 to 1 at 1\n";
  boundary(straight, "expect action = 0.51 ± TOL", 0.01);
  boundary(straight, "expect action = 0.51 rel TOL", 0.01 / 0.51);
  boundary(straight, "expect action of (t^2) = 0.68 ± TOL", 0.68 - 2.0 / 3);
  boundary(straight, "expect path x at 0.5 = 0.51 ± TOL", 0.01);
  boundary(straight, "expect path 1 x at 0.5 = 0.51 ± TOL", 0.01);
  passes(straight, "expect index = 0");
  passes(straight, "expect index of path 1 = 0");
  fails(straight, "expect index = 1");
  fails(straight, "expect action of path 2 = 0.5 ± 1e9");
  // Of seven paths of the pendulum from 0 to 0 in 10 rest has the largest action, and conjugate points at π, 2π, 3π.
  const std::string oscillations =
      "dimensionless\ncoord θ : angle\nL = 1/2 θ'^2 + cos θ\npath from 0 at 0 to 0 at 10\n";
  const ExpectationResult first = only(oscillations + "expect action = 0 ± 1e-9\n"),
                          second = only(oscillations + "expect action of path 2 = 0 ± 1e-9\n");
  INFO(first.actual, " ", first.message, " | ", second.actual, " ", second.message);
  CHECK(second.message.find("number 2") != std::string::npos);
  CHECK(std::stod(second.actual) >= std::stod(first.actual));
  boundary(oscillations, "expect action of path 7 = 10.01 ± TOL", 0.01);
  passes(oscillations, "expect index of path 7 = 3");
  fails(oscillations, "expect index of path 7 = 2");
  boundary(oscillations, "expect path 7 θ at 5 = 0.01 ± TOL", 0.01);
}

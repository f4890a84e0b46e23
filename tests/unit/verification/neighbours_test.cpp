#include "boundary.hpp"

#include <maupertuis/simulation.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

// λ = −0.1 ± i √0.99
const std::string damped = "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nforce x = -1/5 x'\n";
const std::string driven =
    "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2 + x cos(t)\nD = 1/10 x'^2\nstart x = 0, x' = 5\nrun 20\n";
const std::string pendulum = "dimensionless\ncoord θ : angle\nL = 1/2 θ'^2 + cos θ\nstart θ = 1\nrun 20\n";
const std::string hoop = R"(param m = 1 kg, R = 50 cm, Ω = 2 rad/s, g = 9.81 m/s^2
coord θ : angle
let φ = Ω t
point bead mass m at R (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
)";
// Control Tutorials for MATLAB and Simulink, inverted pendulum: A, B and the open-loop poles.
const std::string cart_pole = R"(param M = 0.5 kg, m = 0.2 kg, b = 0.1 N s/m, I = 0.006 kg m^2, l = 0.3 m, g = 9.8 m/s^2
coord x : length, θ : angle
input u : [N] = 0 [N]
T = 1/2 (M + m) x'^2 + m l x' θ' cos θ + 1/2 (I + m l^2) θ'^2
V = -m g l cos θ
D = 1/2 b x'^2
force x = u
)";
const std::string arm = R"(param m1 = 1 kg, m2 = 2 kg, l1 = 1 m, l2 = 50 cm
coord θ1, θ2 : angle
point A mass m1 at l1 (sin θ1, -cos θ1)
point B mass m2 at A + l2 (sin θ2, -cos θ2)
)";
const std::string falling =
    "param m = 1 kg, g = 9.81 m/s^2\ncoord y : length\nT = 1/2 m y'^2\nV = m g y\nstart y = 1 m\n";
const std::string until = falling + "run until y = 0 within 60 s\n";

}  // namespace

TEST_CASE("eigenvalues: real and complex, in any order, with their conjugates") {
  boundary(damped, "expect eigenvalues at x = 0 : (-0.1, 1) ± TOL", 1 - 0.99498743710661997);
  boundary(damped, "expect eigenvalues at x = 0 : (-0.1, 1) rel TOL", (1 - 0.99498743710661997) / 1.0049875621120890);
  boundary(damped, "expect eigenvalues at x = 0 : (-0.11, 0.99498743710661997), (-0.11, -0.99498743710661997) ± TOL",
           0.01);
  // 0.9987 is nearer to 1.05 than 1.0989 is to 1.15, and 1.0989 is nearest to 1.05.
  passes(
      "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2*x^2 + 1/2*1.21*y^2\nD = 0.05*x'^2 + "
      "0.05*y'^2\n",
      "expect eigenvalues at x = 0, y = 0 : (-0.05, 1.05), (-0.05, 1.15) ± 0.06");
  fails(damped, "expect eigenvalues at x = 0 : -0.1 ± 10");
  fails(damped, "expect eigenvalues at x = 0 : -0.1, (-0.1, 1) ± 10");
  passes(cart_pole, "expect eigenvalues at θ = 180 deg : 5.5651 1/s, 0, -5.6041 1/s, -0.1428 1/s ± 5e-5");
  fails(cart_pole, "expect eigenvalues at θ = 180 deg : 5.5651 1/s, 0, -5.6041 1/s, -0.1430 1/s ± 5e-5");
}

TEST_CASE("matrices of the linearization: whole, in another order, and one entry") {
  passes(cart_pole,
         "expect A in (x, x', θ, θ') at x = 0 m, θ = 180 deg :\n    ((0, 1, 0, 0), (0, -0.1818, 2.6727, 0), (0, 0, 0, "
         "1), (0, -0.4545, 31.1818, 0)) ± 5e-5");
  fails(cart_pole,
        "expect A in (x, x', θ, θ') at x = 0 m, θ = 180 deg :\n    ((0, 1, 0, 0), (0, -0.1818, 2.6729, 0), (0, 0, 0, "
        "1), (0, -0.4545, 31.1818, 0)) ± 5e-5");
  passes(cart_pole,
         "expect A at θ = 180 deg : ((0, 0, 1, 0), (0, 0, 0, 1), (0, 2.6727, -0.1818, 0), (0, 31.1818, -0.4545, 0)) ± "
         "5e-5");
  passes(cart_pole, "expect B at θ = 180 deg : ((0), (0), (1.8182), (4.5455)) ± 5e-5");
  boundary(cart_pole, "expect A in θ' by θ at θ = 180 deg : 31.18 1/s^2 ± TOL", 31.181818181818181 - 31.18);
  boundary(cart_pole, "expect B in x' by u at θ = 180 deg : 1.82 1/kg rel TOL", (1.82 - 1.8181818181818181) / 1.82);
  boundary(cart_pole, "expect K in θ at θ = 180 deg : -0.589 ± TOL", 0.589 - 0.588);
  boundary(cart_pole, "expect C in x at θ = 0 deg : 0.11 N s/m ± TOL", 0.01);
  boundary(cart_pole, "expect K in θ at θ = 0 deg : 58.9 N cm ± TOL", 0.1);
  passes(cart_pole, "expect G at θ = 0 deg : ((0, 0), (0, 0)) ± 0");
}

TEST_CASE("the mass matrix anywhere, in SI or in units") {
  // m2 l1 l2 cos(θ1 − θ2) = cos 60°
  boundary(arm, "expect M at θ1 = 90 deg, θ2 = 30 deg : ((3, 0.5), (0.51, 0.5)) ± TOL", 0.01);
  boundary(arm, "expect M at θ1 = 90 deg, θ2 = 30 deg : ((3, 0.5), (0.51, 0.5)) kg m^2 rel TOL", 0.01 / 0.51);
  boundary(arm, "expect M in θ1 by θ2 at θ1 = 90 deg, θ2 = 30 deg : 5100 kg cm^2 ± TOL", 100);
  passes(arm, "expect M in (θ2, θ1) at θ1 = 90 deg, θ2 = 30 deg : ((0.5, 0.5), (0.5, 3)) ± 1e-15");
  fails(arm, "expect M in (θ2, θ1) at θ1 = 90 deg, θ2 = 30 deg : ((3, 0.5), (0.5, 0.5)) ± 1e-15");
}

TEST_CASE("critical parameters: the change lies within the tolerance, and the verdict holds beyond") {
  boundary(hoop, "expect stable for Ω < 4.43 rad/s ± TOL at θ = 0 deg", 4.43 - 4.4294469180700204);
  boundary(hoop, "expect unstable for Ω > 4.43 rad/s ± TOL at θ = 0 deg", 4.43 - 4.4294469180700204);
  boundary(hoop, "expect stable for Ω < 4.43 rad/s rel TOL at θ = 0 deg", (4.43 - 4.4294469180700204) / 4.43);
  fails(hoop, "expect unstable for Ω < 4.43 rad/s ± 1e-2 at θ = 0 deg");
  fails(hoop, "expect stable for Ω > 4.43 rad/s ± 1e-2 at θ = 0 deg");
  CHECK(only(hoop + "expect stable for Ω > 4.43 rad/s ± 1e-2 at θ = 0 deg\n").actual ==
        "stable on the other side, Ω < 4.429446918 rad/s");
  const ExpectationResult elsewhere = only(hoop + "expect stable for Ω < 3 rad/s ± 1e-2 at θ = 0 deg\n");
  CHECK_FALSE(elsewhere.passed);
  CHECK(elsewhere.actual.find("Ω < 4.42944691") != std::string::npos);
  // The stiffness (k − 1)(k − 2)(k − 4) changes its sign at 4, and below 2 once more.
  const std::string cubic =
      "dimensionless\nparam k = 4\ncoord x : number\nL = 1/2 x'^2 - 1/2 (k - 1) (k - 2) (k - 4) x^2\n";
  passes(cubic, "expect stable for k > 4 ± 1e-6 at x = 0");
  fails(cubic, "expect unstable for k < 4 ± 1e-6 at x = 0");
  passes(cubic + "sweep k = 2.5 .. 5 steps 3\n", "expect unstable for k < 4 ± 1e-6 at x = 0");
}

TEST_CASE("periodic motions: multipliers, trace and period") {
  boundary(driven, "expect multipliers over 2 pi : (0.53322, 0.017) ± TOL",
           std::hypot(0.53322 - 0.5332235225267918, 0.017 - 0.01679935594447845));
  boundary(driven, "expect trace over 2 pi = 1.07 ± TOL", 1.07 - 1.0664470450535837);
  fails(driven, "expect multipliers over 2 pi : 0.5 ± 10");
  boundary(pendulum, "expect period = 6.7 ± TOL", 6.7 - 6.699975664370453);
  boundary(pendulum, "expect period over 6.7 = 6.7 rel TOL", (6.7 - 6.699975664370453) / 6.7);
  passes(pendulum, "expect multipliers : 1, 1 ± 1e-9");
  passes(pendulum, "expect trace = 2 ± 1e-6");
  fails(falling + "run 1 s\n", "expect trace = 2 ± 1e6");
}

TEST_CASE("the end of `run until`: its time, and values there") {
  boundary(until, "expect until at 0.45 s ± TOL", 0.45152364098573094 - 0.45);
  boundary(until, "expect until at 450 ms ± TOL", 451.52364098573094 - 450);
  boundary(until, "expect until at 0.45 s rel TOL", (0.45152364098573094 - 0.45) / 0.45);
  boundary(until, "expect y' at until = -4.43 m/s ± TOL", 4.43 - 4.4294469180700204);
  const ExpectationResult never = only(falling + "run until y = 2 m within 1 s\nexpect until at 1 s ± 10\n");
  CHECK_FALSE(never.passed);
  CHECK(never.message.find("not met") != std::string::npos);
}

TEST_CASE("conservation on a level") {
  const std::string kepler =
      "dimensionless\ncoord r, φ : number\nL = 1/2 (r'^2 + r^2 φ'^2) + 1/r\nstart r = 1, φ' = 1\n";
  passes(kepler, "expect conserved 1/2 r'^2 - 1/r where p_φ = 0");
  fails(kepler, "expect conserved 1/2 r'^2 - 1/r");
  fails(kepler, "expect conserved 1/2 r'^2 - 1.000000000001/r where p_φ = 0");
  // The circular orbit: r = 1, r' = 0 is all of its level, at which the derivatives of the energy vanish.
  const ExpectationResult circle =
      only(kepler + "expect conserved r where p_φ = 1, 1/2 r'^2 + 1/2 p_φ^2/r^2 - 1/r = -0.5\n");
  CHECK_FALSE(circle.passed);
  CHECK(circle.actual == "undecided");
  const ExpectationResult leaves = only(kepler + "expect conserved r where r = 1\n");
  CHECK_FALSE(leaves.passed);
  CHECK(leaves.actual == "the motion leaves the level");
  // Goryachev and Chaplygin: a top with A = B = 4 C and its centre of mass in the plane of A and B.
  const std::string top = R"(dimensionless
param a = 1.3
body B inertia diag(4, 4, 1) rotation euler zxz (φ, θ, ψ)
coord φ, θ, ψ : angle
V = -a sin θ sin ψ
start φ = 0.3, θ = 1.1, ψ = 0.4, θ' = 0.2, ψ' = 1
)";
  const std::string integral = "expect conserved B.ω.z (B.ω.x^2 + B.ω.y^2) + a B.ω.x cos θ";
  passes(top, integral + " where p_φ = 0");
  fails(top, integral);
  fails(top, integral + " where p_φ = 1");
}

TEST_CASE("a model says how its runs step, and is overruled") {
  const ModelText m(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\nrun 1\nmethod variational order 2 step "
      "0.1\n");
  Diagnostics told;
  const auto run = simulate(m.model, m.equations, {}, told);
  CHECK(run->statistics.method == "variational");
  CHECK(run->statistics.order == 2);
  CHECK(run->statistics.steps == 10);
  SimulationOptions options;
  options.step = 0.05;
  CHECK(simulate(m.model, m.equations, options, told)->statistics.steps == 20);
  options.step = 0;
  options.method = StepMethod::Taylor;
  const auto taylor = simulate(m.model, m.equations, options, told);
  CHECK(taylor->statistics.method == "taylor");
  CHECK(taylor->statistics.order != 2);
  options.method = StepMethod::Automatic;
  CHECK(simulate(m.model, m.equations, options, told)->statistics.method == "taylor");
}

TEST_CASE("a model says with how many digits it is tested") {
  const std::string oscillator = "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\nrun 1\n";
  passes(oscillator + "precision quad\n", "expect x at 1 = 0.540302305868139717400936607443 ± 1e-29");
  boundary(oscillator + "precision quad\n", "expect x at 1 = 0.5403023058681397174009366 ± TOL", 7.44297660e-27);
  boundary(oscillator + "precision 100\n", "expect x' at 1 = -0.84147098480789650665250232163029 rel TOL",
           8.99962256e-33 / 0.8414709848);
  fails(oscillator, "expect x at 1 = 0.540302305868139717400936607443 ± 1e-18");
  const ExpectationResult too_many =
      only(oscillator + "precision quad\nexpect x at 1 = 0.5403023058681397174009366074429766037 ± 1e-36\n");
  CHECK_FALSE(too_many.passed);
  CHECK(too_many.message.find("Two runs") != std::string::npos);
}

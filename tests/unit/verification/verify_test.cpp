#include "boundary.hpp"

#include <maupertuis/verification.hpp>

using namespace maupertuis;

namespace verify_test {
namespace {

const std::string pendulum = R"(system pendulum
param m = 1 kg, l = 2 m, g = 9.81 m/s^2
coord θ : angle
T = 1/2 m l^2 θ'^2
V = -m g l cos θ
start θ = 60 deg
run 10 s
)";

const std::string spherical = R"(system spherical
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord θ, φ : angle
point P mass m at l (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
start θ = 1 rad, φ' = 2 rad/s
run 5 s
)";

void check_pitfall(const std::string& claim_text, const std::string& word) {
  const ExpectationResult r = only(claim_text);
  INFO(r.message, " | ", r.pitfall);
  CHECK_FALSE(r.passed);
  CHECK(r.pitfall.find(word) != std::string::npos);
}

}  // namespace

TEST_CASE("true statements pass") {
  const Verification v = verify_text(spherical + R"(
expect freedoms = 2
expect energy conserved rel 1e-13
expect conserved m l^2 sin^2 θ φ'
expect conserved m l^2 sin^2 θ φ' rel 1e-13
expect θ' not conserved
expect equation θ'' = sin θ cos θ φ'^2 - g/l sin θ
expect θ at 0 s = 1 rad ± 1e-15
claim sin θ φ'' = -2 cos θ θ' φ'
)");
  CHECK(v.results.size() == 8);
  for (const ExpectationResult& r : v.results) {
    INFO(r.text, ": ", r.message, " ", r.actual);
    CHECK(r.passed);
  }
}

TEST_CASE("lines that share times and formulas each get their own value, on both sides of the start") {
  const std::string oscillator =
      "system o\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 1\n"
      "run 4\n";
  const Verification v = verify_text(oscillator + R"(
expect x at 1 = 0.5403023058681398 ± 1e-12
expect x' at 2 = -0.9092974268256817 ± 1e-12
expect x at 2 = -0.4161468365471424 ± 1e-12
expect energy conserved rel 1e-13
expect x at -1 = 0.5403023058681398 ± 1e-12
expect x' at 1 = -0.8414709848078965 ± 1e-12
expect x at 1 = -0.4161468365471424 ± 1e-12
expect x at -2 = -0.4161468365471424 ± 1e-12
expect x' at -1 = 0.8414709848078965 ± 1e-12
expect conserved x^2 + x'^2 rel 1e-13
expect x at 1 = 0.5403023058681398 ± 1e-12
)");
  REQUIRE(v.results.size() == 11);
  for (std::size_t i = 0; i < v.results.size(); ++i) {
    INFO(v.results[i].text, ": ", v.results[i].message, " ", v.results[i].actual);
    CHECK(v.results[i].passed == (i != 6));
  }
}

TEST_CASE("numbers with units are what they are, however they are written") {
  const Verification v = verify_text(R"(system fall
param m = 1 kg, k = 2 N/m
coord x, y, z : length
point P mass m at (x, y, z)
gravity (0, -9.81, 0) m/s^2
force on P = (3, -4, 0) N
V += 1/2 (100 [N/m]) x^2 + 1/2 (0.1 [N/mm]) z^2
run 1 s
expect equation y'' = -9.81 [m/s^2] - 4 [N]/m
expect equation y'' = -981 [cm/s^2] - (1 [N] + 3000 [mN])/m
expect equation m x'' = 3 [N] - 0.1 [N/mm] x
expect conserved 1/2 m y'^2 + 9.81 [m/s^2] m y + 4 [N] y
expect conserved m y'^2 + (100 [N/m]) z^2 + m z'^2 + 2 (9.81 [m/s^2]) m y + 8 [N] y
)");
  CHECK(v.results.size() == 5);
  for (const ExpectationResult& r : v.results) {
    INFO(r.text, ": ", r.message, " ", r.actual);
    CHECK(r.passed);
  }
  CHECK_FALSE(only("system fall\nparam m = 1 kg\ncoord y : length\npoint P mass m at (0, y)\n"
                   "gravity (0, -9.81) m/s^2\nrun 1 s\nexpect equation y'' = 9.81 [m/s^2]\n")
                  .passed);
}

TEST_CASE("what an event sets belongs to what is conserved") {
  const auto judged = [](const std::string& set, const std::string& claim) {
    return only(
        "system s\ndimensionless\nparam k = 1\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 k (x^2 + "
        "y^2)\nstart x = 1, y' = 0.3\nrun 10\nevent kick when " +
        set + "\n" + claim + "\n");
  };
  const std::string energy = "expect conserved 1/2 (x'^2 + y'^2) + 1/2 k (x^2 + y^2)";
  const std::string doubled = "x = 0 falling : set x' = 2 x'", turned = "x = 0 falling : set x' = -x'";
  CHECK(judged(turned, energy).passed);
  CHECK(judged(turned, "expect energy conserved").passed);
  CHECK(judged("x = 1/2 : set x = 2 x - 1/2", energy).passed);  // where it happens x stays, elsewhere it would not
  CHECK_FALSE(judged(turned, "expect conserved x y' - y x'").passed);
  for (const std::string& claim :
       {energy, std::string("expect energy conserved"), std::string("expect integral 1/2 x'^2 + 1/2 k x^2")}) {
    const ExpectationResult r = judged(doubled, claim);
    INFO(claim, ": ", r.message, " ", r.actual);
    CHECK_FALSE(r.passed);
    CHECK(r.message.find("event") != std::string::npos);
  }
  CHECK(judged(doubled, "expect x'^2 + k x^2 not conserved").passed);
}

TEST_CASE("false statements fail, each with what came out") {
  for (const char* line :
       {"expect freedoms = 3", "expect conserved θ'", "expect conserved θ' rel 1e-3", "expect θ at 1 s = 0 rad ± 1e-3",
        "expect m l^2 sin^2 θ φ' not conserved", "expect equation θ'' = 0"}) {
    const ExpectationResult r = only(spherical + line + "\n");
    INFO(line, ": ", r.message, " ", r.actual);
    CHECK_FALSE(r.passed);
    CHECK_FALSE(r.actual.empty());
  }
}

TEST_CASE("a value with friction is not an energy conserved") {
  CHECK_FALSE(only(pendulum + "D = 1/2 (1 [N m s]) θ'^2\nexpect energy conserved rel 1\n").passed);
}

TEST_CASE("a false claim is recognised by the mistake that it follows from") {
  check_pitfall(spherical + "claim θ'' = -g/l sin θ\n", "∂T/∂q");
  check_pitfall(spherical + "claim φ'' = 0\n", "total time derivative");
  check_pitfall(pendulum + "claim θ'' = g/l sin θ\n", "sign");
  check_pitfall(pendulum + "claim θ'' = -g/(2 l) sin θ\n", "½");
  check_pitfall(pendulum + "D = 1/2 (1 [N m s]) θ'^2\nclaim θ'' = -g/l sin θ\n", "left out");
  check_pitfall(pendulum + "D = 1/2 (1 [N m s]) θ'^2\nclaim m l^2 θ'' = -m g l sin θ + (1 [N m s]) θ'\n", "wrong sign");
  // With units on, θ for θ' is an error of dimension before it is a false claim.
  check_pitfall(
      "system p\ndimensionless\nparam m = 1, l = 2, g = 9.81\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nV = -m g l cos "
      "θ\nclaim l θ = g sin θ\n",
      "(l θ)²");
  check_pitfall(spherical + "claim θ'' = -sin θ cos θ φ'^2 - g/l sin θ\n", "conserved momentum");
}

TEST_CASE("a run that ends early fails the lines that need it, with the reason") {
  const ExpectationResult r = only(R"(system plunge
param m = 1 kg, k = 1 N m^2
coord r : length
T = 1/2 m r'^2
V = -k/r
start r = 1 m
run 10 s
expect r at 5 s = 1 m ± 1
)");
  CHECK_FALSE(r.passed);
  CHECK(r.message.find("ended before") != std::string::npos);
}

TEST_CASE("an expected error is compared with what was found") {
  const SourceText source("test.lag", "system s\ncoord x : length\nexpect error E0401\n");
  Diagnostics parsed, found;
  const auto tree = syntax::parse(source, parsed);
  found.error("E0401", Span{0, 1}, "made up");
  CHECK(verify_errors(tree, source, found)->results.front().passed);
  CHECK_FALSE(verify_errors(tree, source, {})->results.front().passed);
}

TEST_CASE("expect integral: what the search finds, and functions of it") {
  const std::string kepler =
      "dimensionless\nparam m = 1, k = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\nV = -k/sqrt(x^2 + y^2)\n";
  CHECK(only(kepler + "expect integral x y' - y x'\n").passed);
  CHECK(only(kepler + "expect integral m y' (x y' - y x') - k x/sqrt(x^2 + y^2)\n").passed);
  CHECK(only(kepler + "expect integral (x y' - y x')^2 exp(1/2 m (x'^2 + y'^2) - k/sqrt(x^2 + y^2))\n").passed);
  const ExpectationResult momentum = only(kepler + "expect integral x'\n");
  CHECK_FALSE(momentum.passed);
  CHECK(momentum.actual == "not found");
  CHECK_FALSE(only(kepler + "expect integral x^2 + y^2\n").passed);
}

TEST_CASE("what is constant on each side of a switch and jumps there is not conserved") {
  const std::string pushed = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = -step(x)\nstart x = 1\nrun 3\n";
  const ExpectationResult step = only(pushed + "expect conserved step(x)\n");
  CHECK_FALSE(step.passed);
  CHECK(step.message.find("jumps by 1 (SI units) where x = 0") != std::string::npos);
  CHECK(only(pushed + "expect step(x) not conserved\n").passed);
  CHECK_FALSE(only(pushed + "expect conserved x' + t step(x)\n").passed);  // jumps by t
  for (const char* energy :
       {"1/2 x'^2 + max(x, 0)", "1/2 x'^2 + x step(x)", "1/2 x'^2 + piecewise(x < 0 : 0, else : x)"}) {
    const ExpectationResult r = only(pushed + "expect conserved " + energy + "\n");
    CHECK_MESSAGE(r.passed, energy);
    CHECK(r.message.find("it does not jump") != std::string::npos);
    CHECK_FALSE(only(pushed + "expect " + energy + " not conserved\n").passed);
  }
  CHECK_FALSE(only(pushed + "expect conserved 1/2 x'^2 + x step(x) + 0.001 sign(x)\n").passed);
  CHECK_FALSE(only(pushed + "expect integral step(x) (1/2 x'^2 + x step(x))\n").passed);
  CHECK(only(pushed + "expect integral 1/2 x'^2 + x step(x)\n").passed);
}

TEST_CASE("a switch that no motion passes does not count") {
  const std::string decaying = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nD = 1/2 x'^2\nstart x' = 1\nrun 3\n";
  CHECK(only(decaying + "expect conserved sign(x')\n").passed);          // x' = 0 is never reached
  CHECK(only(decaying + "expect conserved sign(x + x' - 2)\n").passed);  // x + x' is conserved
  CHECK_FALSE(only(decaying + "expect conserved sign(x - 2)\n").passed);
}

TEST_CASE("energy that a switch in time changes") {
  const std::string meissner =
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 (2 + sign(cos(t))) x^2\nstart x = 1\nrun 10\n";
  const ExpectationResult energy = only(meissner + "expect energy conserved\n");
  CHECK_FALSE(energy.passed);
  CHECK(energy.message.find("jumps where cos t = 0") != std::string::npos);
  CHECK_FALSE(only(meissner + "expect conserved 1/2 x'^2 + 1/2 (2 + sign(cos(t))) x^2\n").passed);
  CHECK(only("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = abs(x)\nstart x = 1\nrun 5\nexpect energy conserved\n")
            .passed);
}

TEST_CASE("what fails an identity is named: the derivative of a quantity, the difference of the sides of an equation") {
  const std::string fall =
      "system fall\nparam m = 1 kg, g = 9.81 m/s^2\ncoord y : length\npoint P mass m at (0, y)\ngravity (0, -g)\n";
  CHECK(only(fall + "expect conserved m y'\n").message == "Its time derivative along the motion is -m g, not 0.");
  CHECK(only(fall + "expect conserved p_y\n").message == "Its time derivative along the motion is -m g, not 0.");
  CHECK(only(fall + "expect equation m y = 2 m y\n").message ==
        "Along the motion, left side − right side is -m y, not 0.");
  CHECK(only(fall + "expect equation y''^2 = g y''\n").message ==
        "Along the motion, left side − right side is 2 g^2, not 0.");
}

TEST_CASE("accelerations in what is conserved stand for what the equations say of them") {
  const std::string fall = "dimensionless\nparam g = 9.81\ncoord y : number\nT = 1/2 y'^2\nV = g y\n";
  passes(fall, "expect conserved y''");
  fails(fall, "expect y'' + g not conserved");
  const std::string oscillator =
      "dimensionless\nparam m = 3, k = 2\ncoord x : number\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1\n";
  passes(oscillator, "expect conserved m x''^2 + k x'^2");
  passes(oscillator, "expect x''^2 not conserved");
  const std::string rod =
      "dimensionless\nparam g = 9.81\ncoord x, y : number\npoint P mass 1 at (x, y)\ngravity (0, -g)\n"
      "constraint x^2 + y^2 = 1\nstart x = 0.6, y = -0.8\n";
  passes(rod, "expect conserved x x'' + y y'' + x'^2 + y'^2");
  passes(rod, "expect conserved x y'' - y x'' + g x");
  passes(rod, "expect y'' not conserved");
}

}  // namespace verify_test

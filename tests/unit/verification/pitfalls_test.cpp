#include "../model_text.hpp"

#include <maupertuis/verification.hpp>

// Every classic mistake, made once in a closed form, is named by its own sentence and no other.

using namespace maupertuis;

namespace pitfalls_test {
namespace {

std::string mistake_of(const std::string& system, const std::string& claim) {
  const ModelText m(system + "claim " + claim + "\n");
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front().passed ? "none" : v.results.front().pitfall;
}

bool begins_with(const std::string& text, const std::string& words) {
  return text.compare(0, words.size(), words) == 0;
}

struct Mistake {
  const char *claim, *sentence;
};

/// m x'' + c x' + k x = F.
const std::string oscillator =
    "system oscillator\ndimensionless\nparam m = 1.5, c = 0.3, k = 2, F = 0.7\ncoord x : number\n"
    "T = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\nforce x = F\n";

}  // namespace

TEST_CASE("each mistake in the energies and forces of an oscillator is told from all others") {
  CHECK(mistake_of(oscillator, "m x'' = F - c x' - k x") == "none");
  for (const Mistake& mistake : {Mistake{"m x'' = F - c x' + k x", "V has the wrong sign"},
                                 {"2 m x'' = F - c x' - k x", "T has no factor ½"},
                                 {"m/2 x'' = F - c x' - k x", "T has a factor ½ too many"},
                                 {"m x'' = F - c x' - 2 k x", "V has a factor 2 too many"},
                                 {"m x'' = F - c x' - k/2 x", "V has a factor ½ too many"},
                                 {"m x'' = F - k x", "the dissipation was left out"},
                                 {"m x'' = F + c x' - k x", "the dissipation has the wrong sign"},
                                 {"m x'' = F - 2 c x' - k x", "D has no factor ½"},
                                 {"m x'' = F - c/2 x' - k x", "D has a factor ½ too many"},
                                 {"m x'' = -c x' - k x", "a force was left out"},
                                 {"m x'' = -F - c x' - k x", "a force has the wrong sign"},
                                 {"m x = k x + c x' - F", "a velocity was written as its coordinate"}}) {
    const std::string found = mistake_of(oscillator, mistake.claim);
    INFO(mistake.claim, " | ", found);
    CHECK(begins_with(found, mistake.sentence));
  }
  CHECK(begins_with(mistake_of(oscillator, "m x'' = 3 F - c x' - k x"),
                    "a generalized force has a factor 3"));           // by none of them
  CHECK(mistake_of(oscillator, "m x'' = F - c x' - k x + k") == "");  // wrong, and nobody knows why
}

TEST_CASE("a momentum put into L whose velocity also stands linearly, as in a magnetic field") {
  // p = m r² φ' + b r²/2; L with φ' = (p − b r²/2)/(m r²) is ½ m r'² + p²/(2 m r²) − b² r²/(8 m) + const.
  const std::string charge =
      "system charge\ndimensionless\nparam m = 1.5, b = 0.8\ncoord r, φ : number\n"
      "L = 1/2 m (r'^2 + r^2 φ'^2) + 1/2 b r^2 φ'\n";
  CHECK(mistake_of(charge, "m r'' = m r φ'^2 + b r φ'") == "none");
  CHECK(begins_with(mistake_of(charge, "m r'' = -m r φ'^2 - b r φ' - b^2 r/(2 m)"),
                    "the conserved momentum of φ was put into L"));
  CHECK(mistake_of(charge, "m r'' = -m r φ'^2 - b r φ' + b^2 r/(2 m)") == "");
}

TEST_CASE("a generalized potential stays in equations that have another mistake, and is told where it was left out") {
  // T − V − U with U = −½ q B (x y' − y x'): m x'' = q B y'.
  const std::string charge =
      "system charge\ndimensionless\nparam m = 1.5, q = 1, B = 2\ncoord x, y : number\n"
      "T = 1/2 m (x'^2 + y'^2)\nU = -1/2 q B (x y' - y x')\n";
  CHECK(mistake_of(charge, "m x'' = q B y'") == "none");
  CHECK(begins_with(mistake_of(charge, "m x'' = 0"), "the generalized potential U was left out"));
  CHECK(begins_with(mistake_of(charge, "m x'' = -q B y'"), "U has the wrong sign"));
  CHECK(begins_with(mistake_of(charge, "2 m x'' = q B y'"), "a part of the total time derivative is missing"));
}

TEST_CASE("a forgotten rotation is told, of a body and of a term with a moment of inertia") {
  // 3/2 m s'' = m g sin α of a cylinder that rolls; without its rotation m s'' = m g sin α, without the rest ½ m s''.
  const std::string given =
      "system rolling\nparam m = 2 kg, R = 10 cm, α = 20 deg, g = 9.81 m/s^2\nlet I = 1/2 m R^2\ncoord s : length\n"
      "T = 1/2 m s'^2 + 1/2 I (s'/R)^2\nV = -m g s sin α\n";
  const std::string body =
      "system rolling\nparam m = 2 kg, R = 10 cm, α = 20 deg, g = 9.81 m/s^2\ncoord s : length\n"
      "body c mass m inertia 1/2 m R^2 at (s cos α, -s sin α) rotation angle -s/R\ngravity (0, -g)\n";
  for (const std::string& system : {given, body}) {
    CHECK(mistake_of(system, "s'' = 2/3 g sin α") == "none");
    CHECK(begins_with(mistake_of(system, "s'' = g sin α"), "the energy of rotation is missing from T"));
    CHECK(begins_with(mistake_of(system, "s'' = 2 g sin α"), "the energy of the centre of mass is missing from T"));
  }
}

TEST_CASE(
    "where T and V alone act, a factor 2 of the one is a factor ½ of the other, and springs are named where they are") {
  const std::string pendulum =
      "system pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
      "gravity (0, -g)\n";
  CHECK(mistake_of(pendulum, "θ'' = -2 g sin θ/l") == "V has a factor 2 too many, or T has a factor ½ too many");
  CHECK(begins_with(mistake_of(pendulum, "2 l θ'' = -g sin θ"), "T has no factor ½ (the kinetic energy of a particle"));
  CHECK(begins_with(mistake_of(pendulum, "3 l θ'' = -g sin θ"),
                    "what stands beside the inertia lacks a factor 3, or the inertia has a factor 3"));
  const std::string spring =
      "system spring\nparam m = 1 kg, k = 2 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n";
  CHECK(
      begins_with(mistake_of(spring, "m x'' = -2 k x"), "V has a factor 2 too many: the energy of a spring is ½ k x²"));
  const std::string wire =  // no spring: gravity on a parabola, for small motions
      "system wire\nparam m = 1 kg, a = 2 m^-1, g = 9.81 m/s^2\ncoord x : length\nT = 1/2 m x'^2\nV = m g a x^2\n";
  CHECK(mistake_of(wire, "x'' = -4 g a x") == "V has a factor 2 too many, or T has a factor ½ too many");
}

TEST_CASE("of a pivot that is moved the motion that was left out is told, and small angles in several terms") {
  const std::string driven =  // l θ'' + (g − a Ω² cos Ω t) sin θ = 0
      "system driven\nparam m = 1 kg, l = 1 m, a = 5 cm, Ω = 120 rad/s, g = 9.81 m/s^2\ncoord θ : angle\n"
      "point P mass m at (l sin θ, a cos(Ω t) - l cos θ)\ngravity (0, -g)\n";
  CHECK(mistake_of(driven, "l θ'' + (g - a Ω^2 cos(Ω t)) sin θ = 0") == "none");
  CHECK(begins_with(mistake_of(driven, "l θ'' + g sin θ = 0"),
                    "a part of the total time derivative is missing: ∂L/∂q' holds t as well"));
  CHECK(mistake_of(driven, "l θ'' + (g + a Ω^2 cos(Ω t)) sin θ = 0").find("∂L/∂θ' holds t") != std::string::npos);
  CHECK(begins_with(mistake_of(driven, "l θ'' + (g - a Ω^2 cos(Ω t)) θ = 0"),
                    "sin θ is written as θ, which holds for small angles only"));
  const std::string cart =
      "system cart\nparam M = 1 kg, m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x : length, θ : angle\n"
      "point A mass M at (x, 0)\npoint B mass m at A + l (sin θ, -cos θ)\ngravity (0, -g)\n";
  CHECK(mistake_of(cart, "(M + m) x'' + m l θ'' = 0") == "the equation is linearized: it holds for small motions only");
}

TEST_CASE("with a distance that is |r| the textbook's equation is right where r > 0, and says so") {
  const std::string turntable =
      "system turntable\nparam m = 1 kg, k = 30 N/m, L0 = 20 cm, Ω = 3 rad/s\ncoord r : length\n"
      "point P mass m at (r cos(Ω t), r sin(Ω t))\npoint O1 at (0, 0)\nspring O1 - P stiffness k length L0\n";
  const auto judged = [&](const std::string& start, const std::string& claim) {
    const ModelText m(turntable + start + "claim " + claim + "\n");
    Diagnostics diagnostics;
    return verify(m.model, m.equations, m.source, {}, diagnostics).results.at(0);
  };
  const std::string outside = "start r = 30 cm\n", inside = "start r = -30 cm\n";
  const ExpectationResult right = judged(outside, "m r'' = m r Ω^2 - k (r - L0)");
  CHECK(right.passed);
  CHECK(right.where == "r > 0");
  CHECK(right.message == "follows where r > 0");
  CHECK_FALSE(judged(inside, "m r'' = m r Ω^2 - k (r - L0)").passed);
  CHECK(judged(inside, "m r'' = m r Ω^2 - k (r + L0)").where == "-r > 0");
  CHECK(judged(outside, "m r'' = m r Ω^2 - k (r - L0 r/abs(r))").where == "");  // everywhere
  CHECK(begins_with(judged(outside, "m r'' = -k (r - L0)").pitfall, "the term ∂T/∂q is missing"));
  CHECK(begins_with(judged(outside, "m r'' = m r Ω^2 + k (r - L0)").pitfall, "V has the wrong sign"));
  // abs(x) that is no distance: the two halves are two laws, and half of it is not the equation.
  CHECK_FALSE(mistake_of("system hill\ndimensionless\nparam m = 1, k = 2\ncoord x : number\nT = 1/2 m x'^2\n"
                         "V = k abs(x)\nstart x = 1\n",
                         "m x'' = -k") == "none");
}

}  // namespace pitfalls_test

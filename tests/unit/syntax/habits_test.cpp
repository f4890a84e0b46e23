#include <doctest/doctest.h>

#include "support.hpp"

#include <maupertuis/spelling.hpp>

using namespace maupertuis;
using namespace maupertuis::syntax;
using namespace maupertuis::syntax::test;

namespace {

struct Habit {
  const char *text, *code, *marked, *says;
};

}  // namespace

TEST_CASE("signs of paper, of LaTeX and of other languages are told with what to write") {
  for (const Habit& h : {
           Habit{"param g = 9,81 m/s^2", "E0105", "9,81", "Write 9.81."},
           Habit{"run 2,5 s", "E0105", "2,5", "Write 2.5."},
           Habit{"start x = 0,1 m", "E0105", "0,1", "Write 0.1."},
           Habit{"expect x at 2 s = 0,5 m ± 1e-3", "E0105", "0,5", "Write 0.5."},
           Habit{"let a = x**2", "E0104", "**", "Write x^2"},
           Habit{"let a = x ** n", "E0104", "**", "Write x^n"},
           Habit{"let a = 2;", "E0104", ";", "Leave it out"},
           Habit{"let a := 2", "E0104", ":=", "`=`"},
           Habit{"let a == 2", "E0104", "==", "one `=`"},
           Habit{"% comment", "E0104", "%", "#"},
           Habit{"let a = \\theta", "E0104", "\\theta", "Write θ or theta."},
           Habit{"let a = \\varphi", "E0104", "\\varphi", "Write φ."},
           Habit{"let a = \\sin θ", "E0104", "\\sin", "Write sin."},
           Habit{"let a = \\dot{\\theta}^2", "E0104", "\\dot{\\theta}", "Write θ'."},
           Habit{"let a = \\ddot x", "E0104", "\\ddot x", "Write x''."},
           Habit{"let a = \\frac{m l}{2}", "E0104", "\\frac{m l}{2}", "Write (m l)/2."},
           Habit{"let a = m \\cdot l", "E0104", "\\cdot", "*"},
           Habit{"let a = arctan(x)", "E0122", "arctan", "Write atan(x)."},
           Habit{"let a = Cos[x]", "E0119", "[", "Write cos(x)."},
           Habit{"param a = 1 kg b = 2 m", "E0111", "b", "Write …, b = …."},
           Habit{"m x'' = -l x", "E0110", "m", "write claim m x'' = -l x."},
           Habit{"x'' = -l x", "E0110", "x", "write claim x'' = -l x."},
           Habit{"x^2 + n^2 = l^2", "E0110", "x", "`constraint x^2 + n^2 = l^2`"},
           Habit{"F = -m x", "E0110", "F", "`force q = …`"},
           Habit{"Q = -m x", "E0110", "Q", "`force q = …`"},
           Habit{"coord b : degrees", "E0129", "degrees", "Write b : angle"},
           Habit{"force = -m x", "E0111", "=", "Write force q = …"},
           Habit{"start x: 60", "E0111", ":", "write x = …."},
           Habit{"run from 0 to 3", "E0111", "from", "write run 3 s"},
           Habit{"system double pendulum", "E0111", "pendulum", "Write double_pendulum"},
           Habit{"constraint x^2 + n^2 - l^2", "E0111", "", "Write constraint x^2 + n^2 - l^2 = 0."},
           Habit{"constraint: x^2 = l^2", "E0111", ":", "No colon stands here"},
           Habit{"expect x is conserved", "E0111", "is", "Write expect conserved x"},
           Habit{"claim x'' + l x", "E0111", "", "such as claim x'' + l x = 0."},
           Habit{"coord b : number\nexpect b(3) = 0.1", "E0121", "b(3)", "Write b at 3 s = …."},
           Habit{"coord b : number\nexpect b'(3 s) = 0.1", "E0121", "b'(3 s)", "Write b' at 3 s = …."},
       }) {
    CAPTURE(h.text);
    Parsed parsed(std::string("param m = 1, l = 1, x = 1, n = 2, θ = 0\n") + h.text + "\n");
    INFO(parsed.messages());
    REQUIRE_FALSE(parsed.diagnostics.empty());
    const Diagnostic& d = parsed.diagnostics.items()[0];
    CHECK(parsed.diagnostics.items().size() == 1);
    CHECK(d.code == h.code);
    CHECK(parsed.at(0) == h.marked);
    CHECK((d.message + " " + d.reason + " " + d.help).find(h.says) != std::string::npos);
  }
}

TEST_CASE("what has one meaning is read") {
  CHECK(shape_of("x´") == "x'");
  CHECK(shape_of("x‘") == "x'");
  CHECK(shape_of("x’ ") == "x'");
  CHECK(shape_of("x − y") == "(- x y)");
  CHECK(shape_of("x·y") == "(· x y)");
  CHECK(shape_of("x×y") == "(× x y)");
  CHECK(shape_of("x²") == "(^ x 2)");
  CHECK(shape_of("x ∗ y") == "(* x y)");
  CHECK(shape_of("x ÷ y") == "(/ x y)");
  CHECK(shape_of("θ̇") == "θ'");
  CHECK(shape_of("10 pi [rad/s]") == "(_ 10 [pi rad:1 s:-1])");
  CHECK(shape_of("(2 pi) [rad]") == "[(_ 2 pi) rad:1]");
  for (const char* title : {"“a”", "”a”", "„a“", "«a»", "\"a\""}) {
    CAPTURE(title);
    Parsed parsed(std::string("system s ") + title + "\n");
    CHECK_MESSAGE(parsed.fine(), parsed.messages());
  }
}

TEST_CASE("numbers in quantity places") {
  CHECK(quantity_of("10 pi rad/s") == "[(_ 10 pi) rad:1 s:-1]");
  CHECK(quantity_of("2*10^5 Pa") == "[(* 2 (^ 10 5)) Pa:1]");
  CHECK(quantity_of("2·10^-3 m") == "[(· 2 (^ 10 (neg 3))) m:1]");
  CHECK(quantity_of("1/2 m") == "[(/ 1 2) m:1]");
  CHECK(quantity_of("5 1/s") == "[5 s:-1]");
  CHECK(quantity_of("sqrt(2) m") == "[(sqrt 2) m:1]");
  CHECK(quantity_of("(1 m, 2 m)") == "(vector [1 m:1] [2 m:1])");
  CHECK(quantity_of("3/s") == "[3 s:-1]");
}

TEST_CASE("spellings that the names of a model allow") {
  const std::vector<std::string> names = {"m", "g", "l", "θ", "θ1", "x", "ω"};
  const auto meant = [&](const char* word) { return right_spelling(word, names).text; };
  CHECK(meant("mgl") == "m g l");
  CHECK(meant("mgx") == "m g x");
  CHECK(meant("mlq") == "");
  CHECK(meant("lcosθ") == "l cos θ");
  CHECK(meant("sqrtx") == "sqrt(x)");
  CHECK(meant("theta1dot") == "θ1'");
  CHECK(meant("x_ddot") == "x''");
  CHECK(meant("dotx") == "x'");
  CHECK(meant("ddot_x") == "x''");
  CHECK(meant("sgn") == "sign(…)");
}

TEST_CASE("the formatter keeps units as they are written") {
  CHECK(formatted("point P mass 1 kg at (1 m,2 m)\n") == "point P mass 1 kg at (1 m, 2 m)\n");
  CHECK(formatted("gravity (0,-9.81) m/s^2\n") == "gravity (0, -9.81) m/s^2\n");
  CHECK(formatted("body B inertia diag(1,2,3) kg m^2 rotation axis (0,0,1) angle 30 deg\n") ==
        "body B inertia diag(1, 2, 3) kg m^2 rotation axis (0, 0, 1) angle 30 deg\n");
}

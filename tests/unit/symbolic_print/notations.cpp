#include <maupertuis/print.hpp>

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace maupertuis;

namespace {

/// A few names that most cases need.
struct Names {
  Context c;
  ReadingOrder order;
  Expr m = parameter("m"), m1 = parameter("m1"), m2 = parameter("m2"), g = parameter("g"), l = parameter("l"),
       k = parameter("k"), r0 = parameter("r_0"), limit = parameter("θ_max");
  Expr x = coordinate("x"), a = coordinate("θ1"), b = coordinate("θ2");

  Expr parameter(const char* name) {
    order.parameters.push_back(c.symbol(name, Role::Parameter));
    return order.parameters.back();
  }
  Expr coordinate(const char* name) {
    order.coordinates.push_back(c.symbol(name, Role::Coordinate));
    return order.coordinates.back();
  }
  Expr dot(Expr e) { return c.time_derivative(e); }
  std::string plain(Expr e) { return to_plain(e, order); }
  std::string latex(Expr e) { return to_latex(e, order); }
  std::string mathml(Expr e) { return to_mathml(e, order); }
};

/// Every tag that opens closes again, in order; entities are known.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < xml.size();) {
    if (xml[i] == '&') {
      const std::size_t end = xml.find(';', i);
      if (end == std::string::npos || end - i > 9) return false;
      i = end;
    } else if (xml[i] == '<') {
      const std::size_t end = xml.find('>', i);
      if (end == std::string::npos) return false;
      const std::string tag = xml.substr(i + 1, end - i - 1);
      if (tag.front() == '/') {
        if (open.empty() || open.back() != tag.substr(1)) return false;
        open.pop_back();
      } else if (tag.back() != '/') {
        open.push_back(tag.substr(0, tag.find(' ')));
      }
      i = end + 1;
    } else {
      ++i;
    }
  }
  return open.empty();
}

}  // namespace

TEST_CASE("plain text: products, sums and signs") {
  Names n;
  CHECK(n.plain(n.g * n.m * n.l) == "m g l");
  CHECK(n.plain((n.m1 + n.m2) * n.g * n.l * sin(n.a)) == "(m1 + m2) g l sin θ1");
  CHECK(n.plain(n.k * n.x - n.m * n.g) == "k x - m g");
  CHECK(n.plain(n.k * (n.x - n.r0)) == "k (x - r_0)");
  CHECK(n.plain(-n.m * n.g) == "-m g");
  CHECK(n.plain(n.c.number(0)) == "0");
  CHECK(n.plain(-(n.x + n.l)) == "-(l + x)");
  CHECK(n.plain(n.m - (n.x + n.l)) == "m - (l + x)");
  CHECK(n.plain(n.m / (-(n.x + n.l))) == "-m/(l + x)");
  CHECK(n.plain(pow(-(n.x + n.l), Rational(1, 2))) == "sqrt(-(l + x))");
  CHECK(n.latex(-(n.x + n.l)) == "-(l + x)");
  CHECK(n.plain(n.m * n.dot(n.dot(n.x)) + n.k * n.x) == "m x'' + k x");
  CHECK(n.plain(n.k * n.x + n.m * n.dot(n.x) * n.dot(n.a) + n.m * pow(n.dot(n.x), Rational(2))) ==
        "m x'^2 + m x' θ1' + k x");
}

TEST_CASE("plain text: the row's own coordinate comes first") {
  Names n;
  const Expr e = n.m * n.dot(n.dot(n.a)) + n.m * n.dot(n.dot(n.b));
  CHECK(to_plain(ReadableForm{e, {}, n.b}, n.order) == "m θ2'' + m θ1''");
  CHECK(to_plain(ReadableForm{e, {}, {}}, n.order) == "m θ1'' + m θ2''");
}

TEST_CASE("plain text: numbers") {
  Names n;
  const auto times_x = [&](const char* text) { return n.plain(*Rational::parse(text) * n.x); };
  CHECK(times_x("1/2") == "1/2 x");
  CHECK(times_x("-3/4") == "-3/4 x");
  CHECK(times_x("2/15") == "2/15 x");
  CHECK(times_x("9.81") == "9.81 x");
  CHECK(times_x("0.1") == "0.1 x");
  CHECK(times_x("0.025") == "0.025 x");
  CHECK(times_x("1/300") == "1/300 x");
  CHECK(times_x("12") == "12 x");
  CHECK(n.plain(n.x / Rational(2) / n.m) == "x/(2 m)");
}

TEST_CASE("plain text: fractions, powers, roots") {
  Names n;
  CHECK(n.plain(n.k / n.m) == "k/m");
  CHECK(n.plain(n.m * n.g / (n.l + n.x)) == "m g/(l + x)");
  CHECK(n.plain(n.k / (n.m * pow(n.l, Rational(2)))) == "k/(m l^2)");
  CHECK(n.plain(pow(n.l, Rational(-1))) == "1/l");
  CHECK(n.plain(sqrt(n.k / n.m)) == "sqrt(k/m)");
  CHECK(n.plain(n.k * pow(pow(n.x, Rational(2)) + pow(n.l, Rational(2)), Rational(-3, 2))) == "k/(l^2 + x^2)^(3/2)");
  CHECK(n.plain(n.c.power(n.x, n.k)) == "x^k");
  CHECK(n.plain(n.c.power(n.x, n.k - Rational(1))) == "x^(k - 1)");
  CHECK(n.plain(n.c.power(n.x, n.k) / n.x) == "x^(k - 1)");
  CHECK(n.plain(pow(n.k / n.m, Rational(1, 3))) == "(k/m)^(1/3)");
}

TEST_CASE("plain text: functions") {
  Names n;
  CHECK(n.plain(sin(n.a)) == "sin θ1");
  CHECK(n.plain(pow(sin(n.a), Rational(2)) * cos(n.a)) == "sin^2 θ1 cos θ1");
  CHECK(n.plain(cos(Rational(2) * n.a)) == "cos(2 θ1)");
  CHECK(n.plain(sin(n.dot(n.a))) == "sin(θ1')");
  CHECK(n.plain(n.m * sin(n.b - n.a)) == "-m sin(θ1 - θ2)");
  CHECK(n.plain(cos(n.b - n.a)) == "cos(θ1 - θ2)");
  CHECK(n.plain(pow(sin(n.b - n.a), Rational(2))) == "sin^2(θ1 - θ2)");
  CHECK(n.plain(apply(Kind::Exp, -n.k * n.x)) == "exp(-k x)");
  CHECK(n.plain(apply(Kind::Log, n.x)) == "log(x)");
  CHECK(n.plain(apply(Kind::Erf, n.a - n.b)) == "erf(θ1 - θ2)");
  CHECK(n.plain(n.m * apply(Kind::Erf, n.b - n.a)) == "-m erf(θ1 - θ2)");
  CHECK(n.plain(pow(apply(Kind::LambertW, n.x), Rational(2))) == "lambert_w(x)^2");
  CHECK(n.latex(apply(Kind::Erf, n.x)) == "\\operatorname{erf}(x)");
  CHECK(n.latex(apply(Kind::LambertW, n.x)) == "W_0(x)");
  CHECK(n.latex(apply(Kind::Asinh, n.x)) == "\\operatorname{arsinh}(x)");
  CHECK(n.mathml(apply(Kind::LambertW, n.x)).find("<mi>W₀</mi>") != std::string::npos);
  const std::array branches{n.c.function(Kind::Less, std::array{n.x, n.c.number(0)}), -n.k * n.x, n.k * n.x};
  CHECK(n.plain(n.c.function(Kind::Piecewise, branches)) == "piecewise(x < 0 : -k x, else : k x)");
  CHECK(n.plain(n.c.function(Kind::Atan2, std::array{n.x, n.l})) == "atan2(x, l)");
  const Expr direction = n.c.function(Kind::Atan2, std::array{n.x, n.l});
  CHECK(n.plain(pow(direction, Rational(2))) == "atan2(x, l)^2");
  CHECK(n.latex(pow(direction, Rational(2))) == "(\\operatorname{atan2}(x, l))^{2}");
  CHECK(n.mathml(direction).find("<mo separator=\"true\">,</mo>") != std::string::npos);
}

TEST_CASE("plain text: quantities of the model") {
  Names n;
  const Expr three = n.c.symbol("3 [J]", Role::Constant);
  CHECK(n.plain(three * cos(n.a)) == "3 [J] cos θ1");
  CHECK(n.plain(Rational(2) * three * n.x) == "2 (3 [J]) x");
  CHECK(n.latex(three) == "3\\,\\mathrm{J}");
}

TEST_CASE("LaTeX") {
  Names n;
  const Expr mass = n.m1 + n.m2;
  CHECK(n.latex(mass * pow(n.l, Rational(2)) * n.dot(n.dot(n.a))) == "(m_1 + m_2)\\, l^{2}\\, \\ddot{\\theta}_1");
  CHECK(n.latex(n.m * cos(n.a - n.b) * pow(n.dot(n.b), Rational(2))) ==
        "m \\cos(\\theta_1 - \\theta_2)\\, \\dot{\\theta}_2^{2}");
  CHECK(n.latex(n.k / n.m) == "\\frac{k}{m}");
  CHECK(n.latex(Rational(1, 2) * n.m) == "\\frac{1}{2} m");
  CHECK(n.latex(sqrt(n.k)) == "\\sqrt{k}");
  CHECK(n.latex(n.limit) == "\\theta_{\\max}");
  CHECK(n.latex(n.r0) == "r_0");
  CHECK(n.latex(pow(sin(n.a), Rational(2))) == "\\sin^{2} \\theta_1");
  CHECK(n.latex(n.m * n.g * n.l) == "m\\, g\\, l");
  CHECK(n.latex(n.k / (n.m + n.k / n.l)) == "\\frac{k}{m + \\frac{k}{l}}");
  CHECK(n.latex(n.m * pow(n.l + n.k / n.l, Rational(2))) == "\\left(l + \\frac{k}{l}\\right)^{2} m");
  CHECK(symbol_to_latex(n.c.symbol("l12", Role::Parameter)) == "l_{12}");
  CHECK(symbol_to_latex(n.c.symbol("ω_rotor", Role::Parameter)) == "\\omega_{\\mathrm{rotor}}");
  CHECK(symbol_to_latex(n.c.symbol("q1_left", Role::Coordinate, 1)) == "\\dot{q}_{1,\\mathrm{left}}");
  CHECK(symbol_to_plain(n.c.symbol("q1_left", Role::Coordinate, 2)) == "q1_left''");
}

TEST_CASE("MathML") {
  Names n;
  CHECK(n.mathml(n.k / n.m) == "<mrow><mfrac><mi>k</mi><mi>m</mi></mfrac></mrow>");
  CHECK(n.mathml(n.m1 * n.dot(n.dot(n.a))) ==
        "<mrow><mrow><msub><mi>m</mi><mn>1</mn></msub><mo>&#x2062;</mo><mspace width=\"0.17em\"/>"
        "<msub><mover accent=\"true\"><mi>θ</mi><mo>&#x00A8;</mo></mover><mn>1</mn></msub></mrow></mrow>");
  CHECK(n.mathml(sin(n.a)) ==
        "<mrow><mrow><mi>sin</mi><mo>&#x2061;</mo><mspace "
        "width=\"0.17em\"/><msub><mi>θ</mi><mn>1</mn></msub></mrow></mrow>");
  const std::array branches{n.c.function(Kind::Less, std::array{n.x, n.c.number(0)}), -n.k * n.x, n.k * n.x};
  const Expr everything = n.c.function(Kind::Piecewise, branches) + sqrt(n.x + n.l) * pow(cos(n.a - n.b), Rational(2)) +
                          pow(n.x + n.l, Rational(-3, 2)) + apply(Kind::Abs, n.x) +
                          n.c.symbol("3 [N/m]", Role::Constant);
  CHECK(well_formed(n.mathml(everything)));
  CHECK(n.mathml(everything).find("&lt;") != std::string::npos);
}

TEST_CASE("a quotient in an exponent keeps its brackets") {
  Names n;
  const Expr e = n.c.power(n.c.number(Rational(3, 2)), n.m / (n.k * n.x));
  CHECK(n.plain(e) == "(3/2)^(m/(k x))");
  CHECK(n.latex(e) == "\\left(\\frac{3}{2}\\right)^{m/(k\\, x)}");
  CHECK(n.mathml(e).find("<mo>/</mo><mrow><mo stretchy=\"false\">(</mo><mrow><mi>k</mi>") != std::string::npos);
  CHECK(n.latex(n.c.power(n.l, -n.m / n.k)) == "l^{-m/k}");
}

TEST_CASE("names of several letters: two are a letter with one below, more a word") {
  Names n;
  const auto latex = [&](const char* name) { return symbol_to_latex(n.c.symbol(name, Role::Parameter)); };
  CHECK(latex("mt") == "m_t");
  CHECK(latex("Jw") == "J_w");
  CHECK(latex("EI") == "\\mathrm{EI}");
  CHECK(latex("ρA") == "{\\rho}\\mathrm{A}");
  CHECK(latex("φs") == "\\varphi_s");
  CHECK(latex("mt1") == "m_{t_1}");
  CHECK(latex("mt_0") == "m_{t,0}");
  CHECK(latex("cart") == "\\mathrm{cart}");
  CHECK(latex("close_x") == "\\mathrm{close}_x");
  CHECK(latex("I_xx") == "I_{\\mathrm{xx}}");
  CHECK(latex("Fθ1") == "F_{\\theta_1}");
  CHECK(latex("größe") == "\\mathrm{gr}{\\text{ö}}{\\text{ß}}\\mathrm{e}");
  CHECK(latex("λ̃_rod") == "\\tilde{\\lambda}_{\\mathrm{rod}}");
  CHECK(n.mathml(n.c.symbol("mt", Role::Parameter)) == "<mrow><msub><mi>m</mi><mi>t</mi></msub></mrow>");
}

TEST_CASE("the only body's quaternion is shown without its name, several with it") {
  Names n;
  const Expr q = n.coordinate("ball.qw"), dot = n.dot(q), p = n.c.symbol("∫p_ball.qw", Role::Coordinate, 1);
  CHECK(n.plain(dot) == "ball.qw'");
  CHECK(n.latex(dot) == "\\dot{q}_w");
  CHECK(n.latex(p) == "p_{q_w}");
  CHECK(n.mathml(q) == "<mrow><msub><mi>q</mi><mi>w</mi></msub></mrow>");
  n.coordinate("top.qw");
  CHECK(n.latex(dot) == "\\dot{q}_{w,\\mathrm{ball}}");
}

TEST_CASE("an exponent stands above the index") {
  Names n;
  CHECK(n.mathml(pow(n.a, Rational(2))) == "<mrow><msubsup><mi>θ</mi><mn>1</mn><mn>2</mn></msubsup></mrow>");
  CHECK(n.mathml(pow(n.x, Rational(2))) == "<mrow><msup><mi>x</mi><mn>2</mn></msup></mrow>");
}

TEST_CASE("brackets of plain height do not stretch, tall ones do") {
  Names n;
  CHECK(n.mathml(n.k * (n.x + n.l)).find("<mo stretchy=\"false\">(</mo>") != std::string::npos);
  CHECK(n.mathml(n.k * (n.x + n.l / n.m)).find("<mo>(</mo>") != std::string::npos);
}

TEST_CASE("the step function is no Θ, which is a name") {
  Names n;
  const Expr step = apply(Kind::Step, n.x) * n.parameter("Θ");
  CHECK(n.latex(step) == "\\Theta \\operatorname{step}(x)");
  CHECK(n.mathml(step).find("<mi>step</mi>") != std::string::npos);
}

TEST_CASE("cases are closed by brackets where something follows, or inside and") {
  Names n;
  const Expr less = n.c.function(Kind::Less, std::array{n.x, n.l}),
             other = n.c.function(Kind::Less, std::array{n.k, n.x});
  const Expr either = n.c.function(Kind::Or, std::array{less, other}),
             both = n.c.function(Kind::And, std::array{less, either});
  const Expr cases = n.c.function(Kind::Piecewise, std::array{both, n.k, n.m});
  CHECK(n.plain(cases) == "piecewise(x < l and (x < l or k < x) : k, else : m)");
  CHECK(n.latex(n.m * cases).find("\\left(") == std::string::npos);
  CHECK(n.latex(n.dot(n.x) * cases).find("\\left(\\begin{cases}") != std::string::npos);
}

TEST_CASE("left sides of derivations") {
  Names n;
  using namespace layouts;
  const Layout velocity = lay_out(n.dot(n.a), n.order), momentum = partial(name("L"), velocity);
  CHECK(to_plain(momentum) == "∂L/∂θ1'");
  CHECK(to_latex(momentum) == "\\frac{\\partial L}{\\partial \\dot{\\theta}_1}");
  CHECK(to_mathml(momentum) ==
        "<mrow><mfrac><mrow><mo>∂</mo><mi>L</mi></mrow><mrow><mo>∂</mo><msub><mover accent=\"true\"><mi>θ</mi>"
        "<mo>&#x02D9;</mo></mover><mn>1</mn></msub></mrow></mfrac></mrow>");
  const Layout total = rate(momentum, lay_out(n.c.time(), n.order), true);
  CHECK(to_plain(total) == "d/dt ∂L/∂θ1'");
  CHECK(to_latex(total) == "\\frac{\\mathrm{d}}{\\mathrm{d} t}\\, \\frac{\\partial L}{\\partial \\dot{\\theta}_1}");
  CHECK(to_plain(rate(name("H"), lay_out(n.c.time(), n.order))) == "dH/dt");
  const Layout speed = power(labelled("v_A", indexed(name("v"), {name("A")})), number("2"));
  CHECK(to_plain(speed) == "v_A^2");
  CHECK(to_latex(speed) == "v_{A}^{2}");
  CHECK(to_latex(indexed(name("A_1"), {name("t")})) == "A_{1,t}");  // one below: LaTeX refuses two
  CHECK(to_latex(indexed(name("u"), {name("t")})) == "u_{t}");
  CHECK(to_mathml(indexed(name("Q"), {lay_out(n.a, n.order)})) ==
        "<mrow><msub><mi>Q</mi><mrow><msub><mi>θ</mi><mn>1</mn></msub></mrow></msub></mrow>");
  CHECK(to_latex(name("y", 2, true)) == "y''");
  CHECK(to_latex(words("close_x & y")) == "\\text{close\\_x \\& y}");
  CHECK(to_plain(braces(velocity, number("1"))) == "{θ1', 1}");
  CHECK(to_plain(matrix({number("1"), number("2"), number("3"), number("4")}, 2)) == "((1, 2), (3, 4))");
  CHECK(to_latex(bold("M")) == "\\mathbf{M}");
}

TEST_CASE("the DAG as text") {
  Names n;
  const Expr weight = n.m * n.g, sine = sin(n.x), e = weight + sine;
  CHECK(to_dag_text({&e, 1}) == "%0 = mul m g\n%1 = sin x\n%2 = add %0 %1\nroot 0 = %2\n");
}

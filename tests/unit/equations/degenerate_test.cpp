// Degenerate Lagrangians: what the constraint algorithm finds, against closed forms.
#include "../model_text.hpp"

#include "equations/degenerate/real_part.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/print.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace maupertuis;

namespace {

std::vector<std::string> parts(const ModelText& m, Expr e) {
  ExprVector states;
  for (std::size_t i = 0; i < m.system->coordinates.size(); ++i) states.push_back(m.q(i)), states.push_back(m.v(i));
  std::vector<std::string> out;
  for (const Expr& part : real_parts(e, m.equations.order, states)) out.push_back(to_plain(part, m.equations.order));
  return out;
}

DegenerateAnalysis analysis_of(const ModelText& m) {
  return analyse_degenerate(m.equations, generic_state(m.model), true);
}

using Strings = std::vector<std::string>;

}  // namespace

TEST_CASE("zeros are written as regular equations") {
  const ModelText m("dimensionless\nparam a = 2\ncoord x, y : number\nL = x'^2/2 + y'^2/2\n");
  const Expr x = m.q(0), y = m.q(1), a = m.p("a");
  CHECK(parts(m, Rational(1, 2) * x * x) == Strings{"x"});
  CHECK(parts(m, x * x + Rational(3) * pow(y, 4)) == Strings{"x", "y"});
  CHECK(parts(m, x * x - y * y).size() == 1);  // two lines, no point
  CHECK(parts(m, a * x * apply(Kind::Exp, y)) == Strings{"x"});
  CHECK(parts(m, x / y) == Strings{"x"});
  CHECK(parts(m, -x - y) == Strings{"x + y"});
  CHECK(parts(m, x.context().number(-1)) == Strings{"1"});
  // exp(2 x) − exp(x) y, and quadratic forms written out.
  const Expr growth = apply(Kind::Exp, x);
  CHECK(parts(m, apply(Kind::Exp, Rational(2) * x) - growth * y).front() == parts(m, growth - y).front());
  CHECK(parts(m, x * x - Rational(2) * x + Rational(1)).front() == "1 - x");
  CHECK(parts(m, x * x - Rational(2) * x * y + Rational(3) * y * y) == Strings{"x - y", "y"});
  CHECK(parts(m, x * x + y * y - Rational(1)).size() == 1);  // a circle
  CHECK(parts(m, x * x - y * y).front().find("(x + y)") != std::string::npos);
}

TEST_CASE("a regular Lagrangian asks nothing, a massless joint is where its springs hold it") {
  const ModelText regular("dimensionless\ncoord x : number\nL = x'^2/2 - x^2/2\n");
  const DegenerateAnalysis none = analysis_of(regular);
  CHECK(none.closed());
  CHECK(none.chain.constraints.empty());
  CHECK(none.motions == 2);
  const ModelText joint("dimensionless\ncoord x, y : number\nL = x'^2/2 - (x - y)^2/2 - 3 y^2/2\n");
  const DegenerateAnalysis found = analysis_of(joint);
  REQUIRE(found.closed());
  REQUIRE(found.chain.constraints.size() == 2);
  CHECK(found.chain.constraints[1].follows);
  CHECK(found.motions == 2);
  CHECK(found.free.empty());
}

TEST_CASE("a sign decides about the class") {
  const auto counts = [](const char* s) {
    const ModelText m(std::string("dimensionless\nparam s = ") + s +
                      "\ncoord x, y : number\nL = x'^2/2 + x' y + s (x - y)^2/2\n");
    const DegenerateAnalysis a = analysis_of(m);
    return std::pair(a.motions, a.free.size());
  };
  CHECK(counts("1") == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK(counts("-1") == std::pair<std::size_t, std::size_t>(2, 0));
  CHECK(counts("0.99") == std::pair<std::size_t, std::size_t>(2, 0));
}

TEST_CASE("a gauge freedom moves what depends on it, and nothing else") {
  const ModelText m("dimensionless\ncoord r, θ, z : number\nL = r'^2/2 + r^2 (θ' - z)^2/2 - r^2/2\n");
  const DegenerateAnalysis a = analysis_of(m);
  REQUIRE(a.closed());
  CHECK(a.free.size() == 1);
  CHECK(a.motions == 2);  // Christ and Lee: r alone moves
  CHECK(a.is_determined(m.q(0)));
  CHECK(a.is_determined(m.v(0)));
  CHECK_FALSE(a.is_determined(m.q(1)));
  CHECK_FALSE(a.is_determined(m.q(2)));
  CHECK(a.is_determined(m.v(1) - m.q(2)));
}

TEST_CASE("reparametrizations leave the world line as it is") {
  const ModelText m(
      "dimensionless\nparam m = 1.1\ncoord T, x, e : number\nL = (x'^2 - T'^2)/(2 e) - e m^2/2\nstart e = 1\n");
  const DegenerateAnalysis a = analysis_of(m);
  REQUIRE(a.closed());
  CHECK(a.motions == 2);
  const Expr slope = m.v(1) / m.v(0);
  CHECK(a.is_determined(slope));
  CHECK(a.is_determined(m.q(1) - slope * m.q(0)));  // where the line meets T = 0
  CHECK_FALSE(a.is_determined(m.q(1) + slope * m.q(0)));
  CHECK_FALSE(a.is_determined(m.v(1)));
  CHECK(a.is_determined(m.v(1) / m.q(2)));  // the momentum
}

TEST_CASE("a freedom whose direction depends on the state: scaling") {
  // x → x e^ε, z → z + ε with any ε(t): x e^−z alone has a value, and it stays.
  const ModelText m("dimensionless\ncoord x, z : number\nL = (x' - x z')^2/2\nstart x = 1\n");
  const DegenerateAnalysis a = analysis_of(m);
  REQUIRE(a.closed());
  CHECK(a.orbits.size() == 2);
  CHECK(a.motions == 1);
  CHECK(a.is_determined(m.q(0) * apply(Kind::Exp, -m.q(1))));
  CHECK_FALSE(a.is_determined(m.q(0) * apply(Kind::Exp, m.q(1))));
}

TEST_CASE("first-order Lagrangians: the constraints are ω q̇ = ∇H, with any symplectic form") {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<int> digit(1, 9);
  for (int attempt = 0; attempt < 20; ++attempt) {
    const int a = digit(random), b = digit(random), c = digit(random);
    const ModelText m("dimensionless\ncoord x, y : number\nL = (" + std::to_string(a) + " + x^2) y' - " +
                      std::to_string(b) + " x^2/2 - " + std::to_string(c) + " y^2/2\nstart x = 1, y = 1\n");
    const DegenerateAnalysis found = analysis_of(m);
    REQUIRE(found.closed());
    CHECK(found.motions == 2);
    // ω_xy = 2x: 2x y' = b x, −2x x' = c y.
    const Expr x = m.q(0), y = m.q(1);
    for (const Expr& claim : ExprVector{m.v(1) - Rational(b, 2), Rational(2) * x * m.v(0) + Rational(c) * y})
      CHECK(found.chain.where->vanishes(claim) == Verdict::Zero);
    CHECK(found.chain.where->vanishes(m.v(1) - Rational(b + 1, 2)) == Verdict::Nonzero);
  }
}

TEST_CASE("contradictions are found in every generation") {
  CHECK(analysis_of(ModelText("dimensionless\ncoord q : number\nL = q\n")).chain.outcome ==
        ConstraintChain::Outcome::Contradiction);
  // y asks for x = 1, x' = 0, and x'' = 3 − y …: consistent; with L = x'^2/2 + y (x − t²) it drives x.
  CHECK(analysis_of(ModelText("dimensionless\ncoord x, y : number\nL = x'^2/2 + y (x - t^2)\n")).closed());
  CHECK(analysis_of(ModelText("dimensionless\ncoord x, y, z : number\nL = y x + z (x - 1)\n")).chain.outcome !=
        ConstraintChain::Outcome::Closed);
}

TEST_CASE("determined equations hold every row that they replaced") {
  const ModelText m(
      "dimensionless\nparam g = 9.81\ncoord x, y, z, u : number\n"
      "L = (x'^2 + y'^2 + z'^2)/2 - g z + u (x^2 + y^2 + z^2 - 1)/2\nstart x = 0.6, z = -0.8, y' = 0.5\n");
  const DegenerateAnalysis a = analysis_of(m);
  REQUIRE(a.closed());
  const auto determined = determined_equations(m.equations, a);
  REQUIRE(determined);
  const auto solved = accelerations_and_multipliers(*determined);
  REQUIRE(solved);
  // At consistent states all of Lagrange's rows hold with these accelerations, the replaced ones too.
  ExprMap accelerations;
  for (std::size_t i = 0; i < solved->accelerations.size(); ++i)
    accelerations.emplace(m.a(i), solved->accelerations[i]);
  for (const Expr& row : expand_time_derivatives(m.equations.residual))
    CHECK(a.chain.where->vanishes(substitute(row, accelerations)) == Verdict::Zero);
  // q̈ of the sphere: x'' = u x.
  CHECK(a.chain.where->vanishes(solved->accelerations[0] - m.q(3) * m.q(0)) == Verdict::Zero);
  CHECK(a.chain.where->vanishes(solved->accelerations[0] + m.q(3) * m.q(0)) == Verdict::Nonzero);
}

TEST_CASE("what vanishes near the start alone is no ground for a constraint") {
  const auto outcome = [](const std::string& lagrangian) {
    return analysis_of(ModelText("dimensionless\ncoord x, y : number\nL = " + lagrangian + "\nstart x = 1\n"))
        .chain.outcome;
  };
  using Outcome = ConstraintChain::Outcome;
  const std::string first_order = "x y' - (x^2 + y^2)/2";
  CHECK(outcome(first_order) == Outcome::Closed);
  CHECK(outcome(first_order + " - max(x - 3, 0)^2") == Outcome::Closed);  // a wall, no inertia
  CHECK(outcome(first_order + " + max(x - 3, 0)^2 x'^2/2") == Outcome::Varies);
  CHECK(outcome(first_order + " + exp(-1000 (x - 5)^2) x'^2/2") == Outcome::Varies);   // 1e-6949 at the start
  CHECK(outcome("x'^2/2 + max(x - 3, 0)^2 y'^2/2 - (x - y)^2/2") == Outcome::Varies);  // a mass beyond
  CHECK(outcome("x'^2/2 + max(x - 3, 0)^2 y") == Outcome::Varies);                     // a constraint beyond
}

TEST_CASE("coefficients that vanish on the constraints alone take no part in ranks") {
  // Henneaux and Teitelboim, 1.6.3: y' = f(x), z' = y; z is free and gives the others.
  for (const char* f : {"exp(x)", "tan(x)", "exp(x^2)", "x sin(x)", "sinh(x)", "x^2"}) {
    CAPTURE(f);
    const ModelText m("dimensionless\ncoord x, y, z : number\nL = ((y' - " + std::string(f) +
                      ")^2 + (z' - y)^2)/2\nstart x = 1\n");
    const DegenerateAnalysis a = analysis_of(m);
    REQUIRE(a.closed());
    CHECK(a.free.size() == 1);
    CHECK(a.motions == 0);
    CHECK(a.chain.manifold_dimension == 4);
  }
}

namespace {

/// "x = 0, x' = 0; free 0, motions 2", on the branch of the start.
std::string branch_at(const std::string& text) {
  const ModelText m("dimensionless\n" + text);
  const Bindings start = written_start(m.model);
  const DegenerateAnalysis a = analyse_degenerate(m.equations, generic_state(m.model), true, true, &start);
  REQUIRE(a.closed());
  Strings lines = constraint_lines(a, m.equations.order, true);
  std::sort(lines.begin(), lines.end());
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : ", ") + line;
  return out + "; free " + std::to_string(a.free.size()) + ", motions " + std::to_string(a.motions);
}

}  // namespace

TEST_CASE("of constraints that branch the branch of the start is taken") {
  const std::string crossing = "coord x, y, u : number\nL = (x'^2 + y'^2)/2 + u x y\n";
  CHECK(branch_at(crossing + "start x = 0, x' = 0, y = 1, y' = 0.3\n") ==
        "u = 0, u' = 0, x = 0, x' = 0; free 0, motions 2");
  CHECK(branch_at(crossing + "start x = 1, x' = 0.3, y = 0\n") == "u = 0, u' = 0, y = 0, y' = 0; free 0, motions 2");
  // (x' + y z)² + y²: at rest z is free, in motion it is 0.
  const std::string pushed = "coord x, y, z : number\nL = (x' + y z)^2/2 + y^2/2\n";
  CHECK(branch_at(pushed + "start x' = 0, z = 1\n") == "x' = 0, y = 0, y' = 0; free 1, motions 1");
  CHECK(branch_at(pushed + "start x' = 1, z = 0\n") == "y = 0, y' = 0, z = 0, z' = 0; free 0, motions 2");
}

TEST_CASE("squares are no regular constraints, and their zeros are") {
  // x² + y² = 0 asks for x = y = 0, where u y = 0 asks nothing of u.
  CHECK(branch_at("coord x, y, u : number\nL = x'^2/2 + u (x^2 + y^2)\nstart u = 0.7\n") ==
        "x = 0, x' = 0, y = 0, y' = 0; free 1, motions 0");
  CHECK(branch_at("coord x, y : number\nL = y (x' - 1)^2\nstart x' = 1, y = 1\n") == "1 - x' = 0; free 1, motions 1");
}

TEST_CASE("a constraint that the others make a product of numbers and times contradicts them") {
  // 0 = t x on the constraints, where x is not asked for: t = 0 at one instant alone.
  const ModelText m("dimensionless\ncoord x, y : number\nL = (x' - y)^2 + x'' + x t\n");
  const DegenerateAnalysis a = analyse_degenerate(m.equations, generic_state(m.model), true, true, nullptr);
  CHECK(a.chain.outcome == ConstraintChain::Outcome::Contradiction);
}

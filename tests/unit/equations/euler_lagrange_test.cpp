#include "../model_text.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

using namespace maupertuis;

namespace euler_lagrange_test {
namespace {

const char* const double_pendulum = R"(system double_pendulum
param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2
coord θ1, θ2 : angle
point A mass m1 at l1 (sin θ1, -cos θ1)
point B mass m2 at A + l2 (sin θ2, -cos θ2)
gravity (0, -g)
)";

bool equal(Expr a, Expr b) { return zero_test(a - b).verdict == Verdict::Zero; }
Expr square(Expr e) { return pow(e, Rational(2)); }

}  // namespace

TEST_CASE("the double pendulum from its points prints as in a textbook") {
  const ModelText m(double_pendulum);
  const Derivation d = readable_derivation(m.equations, false);
  CHECK(to_plain(d.equations[0], m.equations.order) ==
        "(m1 + m2) l1^2 θ1'' + m2 l1 l2 cos(θ1 - θ2) θ2'' + m2 l1 l2 sin(θ1 - θ2) θ2'^2 + (m1 + m2) g l1 sin θ1");
  CHECK(to_plain(d.equations[1], m.equations.order) ==
        "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' - m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2");
}

TEST_CASE("mass matrix, bias and momenta of the double pendulum") {
  const ModelText m(double_pendulum);
  const ExprMatrix mass = mass_matrix(m.equations);
  CHECK(equal(mass.at(0, 0), (m.p("m1") + m.p("m2")) * square(m.p("l1"))));
  CHECK(equal(mass.at(0, 1), m.p("m2") * m.p("l1") * m.p("l2") * cos(m.q(0) - m.q(1))));
  CHECK(equal(mass.at(0, 1), mass.at(1, 0)));
  const ExprVector h = bias(m.equations);
  CHECK(equal(h[1],
              m.p("m2") * m.p("l2") * (m.p("g") * sin(m.q(1)) - m.p("l1") * sin(m.q(0) - m.q(1)) * square(m.v(0)))));
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(equal(expand_time_derivatives(m.equations.residual[i]),
                mass.at(i, 0) * m.a(0) + mass.at(i, 1) * m.a(1) + h[i]));
}

TEST_CASE("conserved at a glance: the double pendulum keeps its energy and nothing else") {
  const ModelText m(double_pendulum);
  const ConservedQuantities c = conserved_quantities(m.equations);
  CHECK(c.cyclic.empty());
  CHECK(c.energy_conserved);
  CHECK(c.energy_is_t_plus_v);
}

TEST_CASE("a cyclic coordinate with friction does not keep its momentum") {
  const ModelText m(
      "system s\nparam m = 1 kg, c = 1 N s/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nD = 1/2 c x'^2\n");
  const ConservedQuantities c = conserved_quantities(m.equations);
  CHECK(c.cyclic.size() == 2);
  CHECK(c.conserved_momenta == std::vector<std::size_t>{1});
  CHECK_FALSE(c.energy_conserved);
  CHECK(equal(m.equations.power, -m.p("c") * square(m.v(0))));
}

TEST_CASE("prescribed motion: h_E is conserved and is not T + V") {
  const ModelText m(R"(system bead
param m = 100 g, R = 30 cm, Ω = 8 rad/s, g = 9.81 m/s^2
coord θ : angle
let φ = Ω t
point bead mass m at R (sin θ cos φ, sin θ sin φ, -cos θ)
gravity (0, 0, -g)
)");
  const ConservedQuantities c = conserved_quantities(m.equations);
  CHECK(c.energy_conserved);
  CHECK_FALSE(c.energy_is_t_plus_v);
  const Expr jacobi =
      m.p("m") * square(m.p("R")) * (square(m.v(0)) - square(m.p("Ω")) * square(sin(m.q(0)))) / Rational(2) -
      m.p("m") * m.p("g") * m.p("R") * cos(m.q(0));
  CHECK(equal(m.equations.energy_function, jacobi));
}

TEST_CASE("a driven and damped cart: Q by virtual work, D with its sign") {
  const ModelText m(R"(system cart
param M = 2 kg, m = 1 kg, l = 1 m, b = 1 N s/m, F0 = 3 N, w = 2 rad/s
coord x : length, θ : angle
point cart mass M at (x, 0)
point bob mass m at cart + l (sin θ, -cos θ)
D = 1/2 b x'^2
force on bob = (F0 cos(w t), 0)
)");
  const Expr force = m.p("F0") * cos(m.p("w") * m.system->context->time());
  CHECK(equal(m.equations.generalized_forces[0], force));
  CHECK(equal(m.equations.generalized_forces[1], force * m.p("l") * cos(m.q(1))));
  CHECK(equal(m.equations.dissipative_terms[0], m.p("b") * m.v(0)));
  CHECK(equal(m.equations.power, force * (m.v(0) + m.p("l") * cos(m.q(1)) * m.v(1)) - m.p("b") * square(m.v(0))));
}

TEST_CASE("accelerations by elimination satisfy the equations, also where the leading entry of M vanishes") {
  const ModelText m("system s\ndimensionless\nparam k = 2\ncoord x, y : number\nL = x' y' + 1/2 x'^2 x^2 - k x y\n");
  const auto solved = accelerations(m.equations);
  REQUIRE(solved);
  const ExprMap put_in{{m.a(0), (*solved)[0]}, {m.a(1), (*solved)[1]}};
  for (const Expr& row : m.equations.residual)
    CHECK(zero_test(substitute(expand_time_derivatives(row), put_in)).verdict == Verdict::Zero);
}

TEST_CASE("a singular mass matrix has no accelerations") {
  const ModelText m("system s\ndimensionless\ncoord x, y : number\nL = 1/2 (x' + y')^2 - x^2\n");
  CHECK_FALSE(accelerations(m.equations));
}

TEST_CASE("solved form: uncoupled coordinates are solved one by one") {
  const ModelText m(
      "system s\nparam m = 1 kg, k = 1 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x - y)^2\n");
  const auto solved = solved_accelerations(m.equations);
  REQUIRE(solved.size() == 2);
  CHECK(solved[0].coupled_with.size() == 1);
  CHECK(equal(solved[0].right.value, -m.p("k") * (m.q(0) - m.q(1)) / m.p("m")));
}

TEST_CASE("solved form: three links in closed form, that annihilates the equations; six links stay a matrix") {
  const auto chain = [](int links) {
    std::string text = "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n", before;
    for (int i = 1; i <= links; ++i) text += fmt::format("{}q{}", i == 1 ? "coord " : ", ", i);
    text += " : angle\n";
    for (int i = 1; i <= links; ++i, before = fmt::format("P{} + ", i - 1))
      text += fmt::format("point P{0} mass m at {1}l (sin q{0}, -cos q{0})\n", i, before);
    return text + "gravity (0, -g)\n";
  };
  const ModelText three(chain(3));
  const auto solved = solved_accelerations(three.equations);
  REQUIRE(solved.size() == 3);
  ExprMap put_in;
  for (std::size_t i = 0; i < 3; ++i) {
    REQUIRE(solved[i].right.value);
    CHECK(solved[i].coupled_with.size() == 3);
    put_in.emplace(three.a(i), solved[i].right.value);
  }
  for (const Expr& row : three.equations.residual)
    CHECK(zero_test(substitute(expand_time_derivatives(row), put_in)).verdict == Verdict::Zero);
  const ModelText six(chain(6));
  for (const SolvedAcceleration& a : solved_accelerations(six.equations)) CHECK_FALSE(a.right.value);
}

TEST_CASE("definitions of parameters stay symbols in print, with a legend, and the certificate's substitution closes") {
  const ModelText m(R"(system disk
param m = 1 kg, R = 2 m, k = 3 N m
let I = 1/2 m R^2
coord φ : angle
T = 1/2 I φ'^2
V = 1/2 k φ^2
)");
  const Derivation d = readable_derivation(m.equations, false);
  CHECK(to_plain(d.equations[0], m.equations.order) == "I φ'' + k φ");
  REQUIRE(d.intermediates.size() == 1);
  CHECK(to_plain(d.intermediates[0].value, m.equations.order) == "1/2 m R^2");
  CHECK(equal(substitute(d.equations[0].value, m.system->definition_values()),
              expand_time_derivatives(m.equations.residual[0])));
}

TEST_CASE("the textbook path shows every chain-rule term") {
  const ModelText m(double_pendulum);
  const Derivation d = readable_derivation(m.equations, true);
  const auto find = [&](const std::string& left) {
    for (const DerivationStep& step : d.steps)
      if (to_plain(step.left) == left) return to_plain(step.right, m.equations.order);
    return std::string("missing");
  };
  CHECK(find("B.x") == "l1 sin θ1 + l2 sin θ2");
  CHECK(find("A.x'") == "l1 cos θ1 θ1'");
  CHECK(find("v_A^2") == "l1^2 θ1'^2");
  CHECK(find("∂L/∂θ2'") == "m2 l2 (l1 cos(θ1 - θ2) θ1' + l2 θ2')");
  const std::string rate = find("d/dt ∂L/∂θ2'");
  CHECK(rate.find("θ1''") != std::string::npos);
  CHECK(rate.find("θ2''") != std::string::npos);
  CHECK(rate.find("sin(θ1 - θ2)") != std::string::npos);
}

TEST_CASE("the steps of a derivation stand in their sections, in the order of the textbook") {
  const ModelText m(double_pendulum);
  std::vector<std::string> sections;
  for (const DerivationStep& step : readable_derivation(m.equations, true).steps)
    if (sections.empty() || sections.back() != step.section) sections.push_back(step.section);
  CHECK(sections == std::vector<std::string>{"Coordinates", "Positions", "Velocities", "Speeds", "Kinetic energy",
                                             "Potential energy", "Lagrangian", "Equation of θ1", "Equation of θ2",
                                             "Solved for the accelerations"});
}

}  // namespace euler_lagrange_test

// H against closed forms of the literature, which stand here in other words than the transform finds.
#include "../under_sanitizers.hpp"
#include "phase_space.hpp"

#include <cmath>

using namespace maupertuis;

namespace {

const char* const kTop = R"(
param A = 2 g m^2, C = 0.8 g m^2, mgl = 30 mN m
coord θ, φ, ψ : angle
T = 1/2 A (θ'^2 + φ'^2 sin^2 θ) + 1/2 C (ψ' + φ' cos θ)^2
V = mgl cos θ
)";

const char* const kDoublePendulum = R"(
param m1 = 1 kg, m2 = 2 kg, l1 = 1 m, l2 = 3 m, g = 9.81 m/s^2
coord a, b : angle
point A mass m1 at l1 (sin a, -cos a)
point B mass m2 at A + l2 (sin b, -cos b)
gravity (0, -g)
)";

}  // namespace

TEST_CASE("the top of Lagrange has the Hamiltonian of the textbooks, as completed squares") {
  const PhaseSpaceOf top(kTop);
  const Expr A = top.p("A"), C = top.p("C"), s = sin(top.q(0)), c = cos(top.q(0));
  // SICM 3.4, Goldstein 5.7
  const Expr expected = (A * C * top.p("mgl") * pow(s, 2) * c + A * pow(top.mom(2), 2) * pow(s, 2) / 2 +
                         C * pow(top.mom(2), 2) * pow(c, 2) / 2 + C * pow(top.mom(0), 2) * pow(s, 2) / 2 -
                         C * top.mom(1) * top.mom(2) * c + C * pow(top.mom(1), 2) / 2) /
                        (A * C * pow(s, 2));
  CHECK(top.equal(top.h.value, expected));
  CHECK(top.plain() == "p_θ^2/(2 A) + (p_φ - p_ψ cos θ)^2/(2 A sin^2 θ) + p_ψ^2/(2 C) + mgl cos θ");
  CHECK(top.certified());
}

TEST_CASE("a free body in Euler angles: the squares are those of the angular momenta about its own axes") {
  const PhaseSpaceOf p(
      "param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 2.5 kg m^2\ncoord φ, θ, ψ : angle\n"
      "body sat inertia diag(I1, I2, I3) rotation euler zxz (φ, θ, ψ)\n");
  const Expr c = p.mom(0) - p.mom(2) * cos(p.q(1)), s = sin(p.q(1)), a = p.q(2);
  // SICM 3.3.3 in other letters; Whittaker, Analytical Dynamics, §69
  const Expr expected = pow(c * sin(a) + p.mom(1) * s * cos(a), 2) / (2 * p.p("I1") * pow(s, 2)) +
                        pow(c * cos(a) - p.mom(1) * s * sin(a), 2) / (2 * p.p("I2") * pow(s, 2)) +
                        pow(p.mom(2), 2) / (2 * p.p("I3"));
  CHECK(p.equal(p.h.value, expected));
  CHECK(p.plain().find("2 ψ") == std::string::npos);
  CHECK(p.plain().size() < 180);
  CHECK(p.certified());
}

TEST_CASE("the double pendulum by Cramer's rule") {
  const PhaseSpaceOf p(kDoublePendulum);
  const Expr m1 = p.p("m1"), m2 = p.p("m2"), l1 = p.p("l1"), l2 = p.p("l2"), g = p.p("g"), c = cos(p.q(0) - p.q(1));
  const Expr top = m2 * pow(l2, 2) * pow(p.mom(0), 2) + (m1 + m2) * pow(l1, 2) * pow(p.mom(1), 2) -
                   2 * m2 * l1 * l2 * p.mom(0) * p.mom(1) * c;
  const Expr expected = top / (2 * m2 * pow(l1 * l2, 2) * (m1 + m2 * pow(sin(p.q(0) - p.q(1)), 2))) -
                        (m1 + m2) * g * l1 * cos(p.q(0)) - m2 * g * l2 * cos(p.q(1));
  CHECK(p.h.legendre.blocks.size() == 1);
  CHECK(p.h.legendre.blocks[0].kind == LegendreKind::Quadratic);
  CHECK(p.equal(p.h.value, expected));
  CHECK(p.certified());
}

TEST_CASE("groups that M does not couple are transformed apart") {
  const PhaseSpaceOf p(
      "param m = 1 kg, k = 1 J\ncoord r : length, φ : angle\nT = 1/2 m (r'^2 + r^2 φ'^2)\nV = k log(r / 1 [m])\n");
  CHECK(p.h.legendre.blocks.size() == 2);
  CHECK(p.plain(p.h.velocities[1].right.value) == "p_φ/(m r^2)");
  CHECK(p.plain(p.h.forces[0].right.value).find("p_φ^2/(m r^3)") != std::string::npos);
  CHECK(p.h.forces[1].right.value.is_zero());
  CHECK(p.certified());
}

TEST_CASE("explicit time: H of the Caldirola-Kanai oscillator") {
  const PhaseSpaceOf p(
      "dimensionless\nparam m = 1, γ = 0.3, w = 2\ncoord x : number\nL = exp(γ t) (1/2 m x'^2 - 1/2 m w^2 x^2)\n");
  const Expr e = apply(Kind::Exp, p.p("γ") * p.t());
  CHECK(p.equal(p.h.value, pow(p.mom(0), 2) / (2 * p.p("m") * e) + e * p.p("m") * pow(p.p("w") * p.q(0), 2) / 2));
  CHECK(p.certified());
}

TEST_CASE("a driven support shifts the momentum, and H is not T + V") {
  const PhaseSpaceOf p(R"(
param m = 1 kg, l = 1 m, g = 9.8 m/s^2, a = 10 cm, w = 6 rad/s
coord θ : angle
point P mass m at (l sin θ, a cos(w t) - l cos θ)
gravity (0, -g)
)");
  const Expr m = p.p("m"), l = p.p("l"), a = p.p("a"), w = p.p("w"), g = p.p("g"), phase = w * p.t();
  // SICM 3.1 (emmy ch3_test p. 221)
  const Expr expected = (-pow(a * l * m * w * sin(phase) * cos(p.q(0)), 2) / 2 + a * g * pow(l * m, 2) * cos(phase) +
                         a * l * m * w * p.mom(0) * sin(phase) * sin(p.q(0)) - g * pow(l, 3) * pow(m, 2) * cos(p.q(0)) +
                         pow(p.mom(0), 2) / 2) /
                        (pow(l, 2) * m);
  CHECK(p.equal(p.h.value, expected));
  CHECK(p.certified());
}

TEST_CASE("a uniformly rotating frame: the centrifugal part of T cancels against the shift") {
  const PhaseSpaceOf p("param m = 1 kg, Ω = 2 rad/s\ncoord x, y : length\nT = 1/2 m ((x' - Ω y)^2 + (y' + Ω x)^2)\n");
  CHECK(p.equal(p.h.value, (pow(p.mom(0), 2) + pow(p.mom(1), 2)) / (2 * p.p("m")) +
                               p.p("Ω") * (p.q(1) * p.mom(0) - p.q(0) * p.mom(1))));
  CHECK(p.plain().find("Ω^2") == std::string::npos);
  CHECK(p.certified());
}

TEST_CASE("a relativistic particle is solved through its root") {
  const PhaseSpaceOf p(
      "dimensionless\nparam m = 2, c = 3, k = 0.1\ncoord x, y : number\n"
      "L = -m c^2 sqrt(1 - (x'^2 + y'^2)/c^2) - 1/2 k x^2\nstart x' = 0.5\n");
  CHECK(p.h.legendre.blocks[0].kind == LegendreKind::Root);
  Bindings at{{p.p("m"), 2.0}, {p.p("c"), 3.0}, {p.p("k"), 0.1}, {p.q(0), 0.4},
              {p.q(1), -1.0},  {p.mom(0), 4.0}, {p.mom(1), -3.0}};
  CHECK(evaluate(p.h.value, at) == doctest::Approx(std::sqrt(4.0 * 81 + 25.0 * 9) + 0.5 * 0.1 * 0.16).epsilon(1e-14));
  CHECK(p.certified());
}

TEST_CASE("a relativistic charge in a magnetic field beside a heavy body that is not") {
  const PhaseSpaceOf p(
      "dimensionless\nparam m = 2, q = 0.7, B = 1.5, M = 5\ncoord x, y, z : number\n"
      "L = -m sqrt(1 - x'^2 - y'^2) + 1/2 q B (x y' - y x') + 1/2 M z'^2 - x z\n");
  CHECK(p.h.legendre.blocks.size() == 2);
  CHECK(p.certified());
}

TEST_CASE("three coupled coordinates: M is not inverted, and H is still proved" * doctest::skip(under_sanitizers)) {
  const PhaseSpaceOf p(R"(
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord a, b, c : angle
point A mass m at l (sin a, -cos a)
point B mass m at A + l (sin b, -cos b)
point C mass m at B + l (sin c, -cos c)
gravity (0, -g)
)");
  CHECK(p.h.legendre.blocks[0].kind == LegendreKind::Implicit);
  CHECK_FALSE(p.h.legendre.readable.value);
  CHECK(p.h.regular());
  CHECK(p.certified());
}

TEST_CASE("dissipation and forces enter p'") {
  const PhaseSpaceOf p(
      "param m = 1 kg, k = 3 N/m, c = 2 N s/m, F = 1 N\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c "
      "x'^2\n"
      "force x = F cos(2 [1/s] t)\n");
  CHECK(p.plain(p.h.forces[0].right.value).find("c p_x/m") != std::string::npos);
  CHECK(p.certified());
}

TEST_CASE("a name that is taken moves the momentum to another") {
  const PhaseSpaceOf p("param p_x = 1 kg\ncoord x : length\nT = 1/2 p_x x'^2\n");
  CHECK(p.plain() == "P_x^2/(2 p_x)");
}

TEST_CASE("definitions stay symbols, and the legend tells them") {
  const PhaseSpaceOf p("param m = 1 kg, R = 20 cm\nlet I = 1/2 m R^2\ncoord φ : angle\nT = 1/2 I φ'^2\n");
  CHECK(p.plain() == "p_φ^2/(2 I)");
  REQUIRE(p.h.legend.size() == 1);
  CHECK(p.plain(p.h.legend[0].symbol) == "I");
  CHECK(p.certified());
}

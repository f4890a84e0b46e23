#include "phase_space.hpp"

using namespace maupertuis;

namespace {

const char* const kKepler = R"(
param m = 2 kg, k = 3 J m
coord x, y, z : length
T = 1/2 m (x'^2 + y'^2 + z'^2)
V = -k / sqrt(x^2 + y^2 + z^2)
)";

Expr bracket(const PhaseSpaceOf& p, Expr a, Expr b) {
  const auto found = poisson_bracket(a, b, p.h);
  REQUIRE(found);
  return found->value;
}

}  // namespace

TEST_CASE("fundamental brackets, and a velocity stands for its momentum") {
  const PhaseSpaceOf p(kKepler);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(bracket(p, p.q(i), p.mom(j)) == p.number(i == j));
      CHECK(bracket(p, p.q(i), p.q(j)).is_zero());
      CHECK(bracket(p, p.mom(i), p.mom(j)).is_zero());
    }
  CHECK(p.equal(bracket(p, p.q(0), p.v(0)), p.number(1) / p.p("m")));
  CHECK_FALSE(poisson_bracket(p.q(0), p.a(0), p.h));
}

TEST_CASE("angular momenta close under brackets, and commute with H, as the Laplace-Runge-Lenz vector does") {
  const PhaseSpaceOf p(kKepler);
  const Expr x = p.q(0), y = p.q(1), z = p.q(2), px = p.mom(0), py = p.mom(1), pz = p.mom(2);
  const Expr lx = y * pz - z * py, ly = z * px - x * pz, lz = x * py - y * px;
  CHECK(p.equal(bracket(p, lx, ly), lz));
  CHECK(p.equal(bracket(p, ly, lz), lx));
  CHECK(bracket(p, lz, p.h.value).is_zero());
  const Expr r = sqrt(pow(x, 2) + pow(y, 2) + pow(z, 2)), mk = p.p("m") * p.p("k");
  const Expr ax = py * lz - pz * ly - mk * x / r, ay = pz * lx - px * lz - mk * y / r;
  CHECK(bracket(p, ax, p.h.value).is_zero());
  CHECK(p.equal(bracket(p, ax, ay), Rational(-2) * p.p("m") * p.h.value * lz));  // Goldstein 9.7
}

TEST_CASE("Jacobi's identity and the product rule") {
  const PhaseSpaceOf p("dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + 1/2 (1 + x^2) y'^2 + x' y' sin y\n");
  const Expr a = p.q(0) * p.mom(1), b = pow(p.mom(0), 2) + sin(p.q(1)), c = p.q(0) * p.q(1) * p.mom(0);
  CHECK(p.equal(bracket(p, a, bracket(p, b, c)) + bracket(p, b, bracket(p, c, a)) + bracket(p, c, bracket(p, a, b)),
                p.number(0)));
  CHECK(p.equal(bracket(p, a * b, c), a * bracket(p, b, c) + b * bracket(p, a, c)));
}

TEST_CASE("{A, H} + ∂A/∂t is dA/dt along Lagrange's equations") {
  const PhaseSpaceOf p(
      "param m = 1 kg, l = 2 m, g = 9.81 m/s^2, w = 3 rad/s\ncoord θ : angle, s : length\n"
      "point P mass m at (s + l sin θ, -l cos θ + 0.1 [m] cos(w t))\npoint Q mass 2 m at (s, 0)\ngravity (0, -g)\n");
  const Expr a = p.mom(0) * sin(p.q(1) / p.p("l")) + p.t() * p.mom(1) * p.p("l");
  const Expr rate = bracket(p, a, p.h.value) + differentiate(a, p.t());
  ExprMap momenta;
  for (std::size_t i = 0; i < 2; ++i) momenta.emplace(p.mom(i), p.h.momentum_values[i]);
  const auto motion = accelerations(p.equations);
  REQUIRE(motion);
  const Expr along =
      substitute(total_time_derivative(substitute(a, momenta)), {{p.a(0), (*motion)[0]}, {p.a(1), (*motion)[1]}});
  CHECK(p.equal(along, substitute(rate, momenta)));
}

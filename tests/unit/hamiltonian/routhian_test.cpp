#include "phase_space.hpp"

using namespace maupertuis;

namespace {

struct RouthianOf : PhaseSpaceOf {
  std::optional<Routhian> r;
  explicit RouthianOf(const std::string& text, std::vector<std::size_t> replaced = {})
      : PhaseSpaceOf(text), r(routhian(equations, h, replaced.empty() ? nullptr : &replaced)) {}
  bool routhian_certified() const {
    const Certificate certificate = certify(*r, h, equations);
    for (const auto& check : certificate.checks)
      if (check.verdict != Verdict::Zero) MESSAGE(check.name << ": " << check.reason);
    return !certificate.checks.empty() && certificate.passed();
  }
};

}  // namespace

TEST_CASE("the top: both cyclic angles go, and the effective potential is that of the textbooks") {
  const RouthianOf top(R"(
param A = 2 g m^2, C = 0.8 g m^2, mgl = 30 mN m
coord θ, φ, ψ : angle
T = 1/2 A (θ'^2 + φ'^2 sin^2 θ) + 1/2 C (ψ' + φ' cos θ)^2
V = mgl cos θ
)");
  REQUIRE(top.r);
  CHECK(top.r->replaced == std::vector<std::size_t>{1, 2});
  CHECK(top.r->conserved);
  CHECK(top.plain(top.r->effective_potential.value) == "(p_φ - p_ψ cos θ)^2/(2 A sin^2 θ) + p_ψ^2/(2 C) + mgl cos θ");
  REQUIRE(top.r->equations.size() == 1);
  CHECK(top.routhian_certified());
}

TEST_CASE("a coordinate that is not cyclic may be replaced: L − Σ p q' (SICM's example, opposite sign)") {
  const RouthianOf p(
      "dimensionless\nparam mx = 1.1, kx = 2, my = 0.7, ky = 1.3\ncoord x, y : number\n"
      "T = 1/2 (mx x'^2 + my y'^2)\nV = 1/2 (kx x^2 + ky y^2) + x y^2\n",
      {1});
  REQUIRE(p.r);
  const Expr x = p.q(0), y = p.q(1), my = p.p("my");
  const Expr of_source = (p.p("kx") * my * pow(x, 2) / 2 + p.p("ky") * my * pow(y, 2) / 2 -
                          p.p("mx") * my * pow(p.v(0), 2) / 2 + my * x * pow(y, 2) + pow(p.mom(1), 2) / 2) /
                         my;
  CHECK(p.equal(p.r->value, -of_source));
  CHECK_FALSE(p.r->conserved);
  CHECK(p.r->equations.empty());
  CHECK(p.routhian_certified());
}

TEST_CASE("a cyclic coordinate that is coupled in T leaves a gyroscopic part") {
  const RouthianOf p(R"(
param M = 2 kg, m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord x : length, θ : angle
point cart mass M at (x, 0)
point bob mass m at cart + l (sin θ, -cos θ)
gravity (0, -g)
)");
  REQUIRE(p.r);
  CHECK(p.r->replaced == std::vector<std::size_t>{0});
  CHECK(p.routhian_certified());
}

TEST_CASE("a force on a cyclic coordinate takes it out of the default, and nothing is left") {
  const RouthianOf p("param m = 1 kg, F = 1 N\ncoord x : length\nT = 1/2 m x'^2\nforce x = F\n");
  CHECK_FALSE(p.r);
}

TEST_CASE("central force: l²/2mr²") {
  const RouthianOf p("param m = 1 kg, k = 1 J m\ncoord r : length, φ : angle\nT = 1/2 m (r'^2 + r^2 φ'^2)\nV = -k/r\n");
  REQUIRE(p.r);
  CHECK(p.plain(p.r->effective_potential.value) == "p_φ^2/(2 m r^2) - k/r");
  CHECK(p.routhian_certified());
}

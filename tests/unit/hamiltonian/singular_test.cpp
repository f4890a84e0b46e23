// Lagrangians whose Legendre transform has no inverse: the primary constraints, and H on them.
#include "phase_space.hpp"

using namespace maupertuis;

namespace {

std::vector<Expr> primary_constraints(const Hamiltonian& h) {
  std::vector<Expr> all;
  for (const LegendreBlock& block : h.legendre.blocks)
    all.insert(all.end(), block.primary_constraints.begin(), block.primary_constraints.end());
  return all;
}

}  // namespace

TEST_CASE("a coordinate without kinetic energy has no momentum") {
  const PhaseSpaceOf p("param m = 1 kg, k = 1 N/m\ncoord x, y : length\nT = 1/2 m x'^2\nV = 1/2 k (x - y)^2\n");
  CHECK_FALSE(p.h.regular());
  REQUIRE(primary_constraints(p.h).size() == 1);
  CHECK(primary_constraints(p.h)[0] == p.mom(1));
  CHECK(p.certified());
}

TEST_CASE("a Lagrangian of first order: both momenta are functions of the coordinates") {
  const PhaseSpaceOf p("dimensionless\nparam w = 2\ncoord x, y : number\nL = y x' - 1/2 (y^2 + w^2 x^2)\n");
  const auto constraints = primary_constraints(p.h);
  REQUIRE(constraints.size() == 2);
  CHECK(p.equal(constraints[0], p.mom(0) - p.q(1)));
  CHECK(p.equal(constraints[1], p.mom(1)));
  CHECK(p.equal(p.h.value, (pow(p.q(1), 2) + pow(p.p("w") * p.q(0), 2)) / 2));
  CHECK(p.certified());
}

TEST_CASE("only a sum of velocities has inertia: the difference of the momenta is bound") {
  const PhaseSpaceOf p("dimensionless\nparam m = 2\ncoord x, y : number\nL = 1/2 m (x' + y')^2 - x^2 y^2\n");
  const auto constraints = primary_constraints(p.h);
  REQUIRE(constraints.size() == 1);
  CHECK((p.equal(constraints[0], p.mom(0) - p.mom(1)) || p.equal(constraints[0], p.mom(1) - p.mom(0))));
  CHECK(p.certified());
}

TEST_CASE("a quaternion: q·p = 0") {
  const PhaseSpaceOf p(
      "param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2\nbody sat inertia diag(I1, I2, I3) rotation quaternion\n");
  const auto constraints = primary_constraints(p.h);
  REQUIRE(constraints.size() == 1);
  Expr product = p.number(0);
  for (std::size_t i = 0; i < 4; ++i) product = product + p.q(i) * p.mom(i);
  CAPTURE(p.plain(constraints[0]));
  CHECK(p.equal(constraints[0], product));
  CHECK(p.certified());
}

TEST_CASE("a Lagrangian of degree one: H vanishes, and the momenta lie on the mass shell") {
  const PhaseSpaceOf p("dimensionless\nparam m = 2\ncoord x, y : number\nL = -m sqrt(x'^2 - y'^2)\n");
  const auto constraints = primary_constraints(p.h);
  REQUIRE(constraints.size() == 1);
  const Expr shell = pow(p.mom(0), 2) - pow(p.mom(1), 2) - pow(p.p("m"), 2);
  CHECK((p.equal(constraints[0], shell) || p.equal(constraints[0], -shell)));
  CHECK(p.h.value.is_zero());
  CHECK(p.certified());
}

TEST_CASE("what is not solved is said, and its momenta stand") {
  const PhaseSpaceOf p("dimensionless\ncoord x : number\nL = 1/4 x'^4 + 1/2 x'^2 - x^2\n");
  CHECK(p.h.legendre.blocks[0].kind == LegendreKind::Unsolved);
  CHECK_FALSE(p.h.value);
  Diagnostics diagnostics;
  report_legendre(p.h, diagnostics);
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items()[0].code == "W1103");
  CHECK(phase_space_lines(p.h, nullptr, p.equations).size() >= 2);
}

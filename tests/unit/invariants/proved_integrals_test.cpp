#include "../model_text.hpp"

#include <maupertuis/invariants.hpp>

using namespace maupertuis;

namespace proved_integrals_test {

/// What `expect conserved` proves, `expect integral` finds: each integral is that of the literature.
namespace {

struct Found {
  ModelText m;
  std::optional<Invariants> invariants;
  explicit Found(const std::string& text) : m(text) {
    InvariantsOptions options;
    options.drift = options.relations = options.completeness = false;
    Diagnostics diagnostics;
    invariants = find_invariants(m.model, m.equations, options, diagnostics);
    REQUIRE(invariants);
  }
  bool has(Expr e) const { return is_function_of(e, *invariants, m.equations); }
};

}  // namespace

TEST_CASE("the three components of J of a charge in the field of a monopole") {
  const Found f(
      "dimensionless\nparam m = 1.3, q = 0.7\ncoord r, θ, φ : number\nT = 1/2 m (r'^2 + r^2 θ'^2 + r^2 sin(θ)^2 "
      "φ'^2)\nU = q cos(θ) φ'\n");
  const Expr r = f.m.q(0), sθ = sin(f.m.q(1)), cθ = cos(f.m.q(1)), sφ = sin(f.m.q(2)), cφ = cos(f.m.q(2));
  const Expr m = f.m.p("m"), q = f.m.p("q"), vθ = f.m.v(1), vφ = f.m.v(2);
  CHECK(f.has(m * r * r * sθ * sθ * vφ - q * cθ));
  CHECK(f.has(-(m * r * r * (sφ * vθ + sθ * cθ * cφ * vφ)) - q * sθ * cφ));
  CHECK(f.has(m * r * r * (cφ * vθ - sθ * cθ * sφ * vφ) - q * sθ * sφ));
  CHECK_FALSE(f.has(-(m * r * r * (sφ * vθ + sθ * cθ * cφ * vφ)) + q * sθ * cφ));
}

TEST_CASE("the integral of the swinging Atwood machine with the mass ratio 3") {
  const auto machine = [](const char* masses) {
    return std::string("dimensionless\nparam m = 1, g = 9.81\nlet M = ") + masses +
           "\ncoord r, θ : number\nT = 1/2 (M + m) r'^2 + 1/2 m r^2 θ'^2\nV = M g r - m g r cos θ\n";
  };
  const auto integral = [](const ModelText& m) {
    const Expr r = m.q(0), half = m.q(1) * Rational(1, 2), s = sin(half), c = cos(half);
    return r * r * m.v(1) * (m.v(0) * c - r * m.v(1) * s * Rational(1, 2)) + m.p("g") * r * r * s * c * c;
  };
  const Found three(machine("3 m"));
  CHECK(three.has(integral(three.m)));
  bool listed = false;
  for (const ConservedFunction& i : three.invariants->integrals)
    listed |= i.kind == IntegralKind::Hidden && i.velocity_degree == 2;
  CHECK(listed);
  const Found two(machine("2 m"));
  CHECK_FALSE(two.has(integral(two.m)));
}

}  // namespace proved_integrals_test

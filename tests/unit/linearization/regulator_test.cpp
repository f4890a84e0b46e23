#include "support.hpp"

#include <maupertuis/regulator.hpp>

using namespace maupertuis;

namespace {

RealMatrix diagonal(const std::vector<double>& x) {
  RealMatrix out{x.size(), x.size(), std::vector<double>(x.size() * x.size(), 0.0)};
  for (std::size_t i = 0; i < x.size(); ++i) out.entries[i * x.size() + i] = x[i];
  return out;
}

const char* const free_mass =
    "system carriage\nparam m = 1 kg\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\nforce x = u\n";

std::string code_of(Linearized& m, const RealMatrix& q, const RealMatrix& r) {
  Diagnostics told;
  CHECK_FALSE(linear_quadratic_regulator(m.here().linearization, q, r, told));
  return told.items().empty() ? "" : told.items()[0].code;
}

}  // namespace

TEST_CASE("A free mass: F = (√(q/r), √(q'/r + 2 √(q/r)))") {
  if (!has_lapack()) return;
  Linearized m(free_mass);
  Diagnostics told;
  const auto r = linear_quadratic_regulator(m.here().linearization, diagonal({4, 3}), diagonal({0.25}), told);
  REQUIRE(r);
  CHECK(near(r->gain.at(0, 0), 4, 1e-13));
  CHECK(near(r->gain.at(0, 1), std::sqrt(12.0 + 8), 1e-13));
  CHECK(r->residual < 1e-14);
  // λ² + F₂ λ + F₁ = 0
  for (const auto& z : r->poles) CHECK(std::abs(z * z + r->gain.at(0, 1) * z + r->gain.at(0, 0)) < 1e-12);
}

TEST_CASE("Units of states that differ by nine powers of ten") {
  if (!has_lapack()) return;
  Linearized m(
      "system small\nparam m = 1 mg, k = 1 N/m\ncoord x : length\ninput u : [N] = 0\nT = 1/2 m x'^2\nV = 1/2 k "
      "x^2\nforce x = u\n");
  Diagnostics told;
  const auto r = linear_quadratic_regulator(m.here().linearization, diagonal({1e12, 1e-3}), diagonal({1}), told);
  REQUIRE(r);
  CHECK(r->residual < 1e-10);
  CHECK(r->poles.back().real() < 0);
}

TEST_CASE("What a regulator cannot do is told") {
  if (!has_lapack()) return;
  Linearized free(free_mass);
  CHECK(code_of(free, diagonal({1}), diagonal({1})) == "E1311");
  CHECK(code_of(free, diagonal({1, -1}), diagonal({1})) == "E1311");
  CHECK(code_of(free, diagonal({1, 1}), diagonal({-1})) == "E1311");
  CHECK(code_of(free, diagonal({0, 1}), diagonal({1})) == "E1313");
  Linearized two(
      "system two\nparam m = 1 kg\ncoord x, y : length\ninput u : [N] = 0\nT = 1/2 m (x'^2 + y'^2)\nforce x = u\n");
  CHECK(code_of(two, diagonal({1, 1, 1, 1}), diagonal({1})) == "E1312");  // nothing acts on y
  Linearized without("system without\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n");
  CHECK(code_of(without, diagonal({1, 1}), {}) == "E1310");
}

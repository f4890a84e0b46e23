#include "support.hpp"

using namespace maupertuis;

namespace {

const char* const free_particle = "system s\ndimensionless\ncoord x : number\nL = 1/2 x'^2\n";

struct Along {
  std::optional<GivenPath> path;
  std::string code;  // of the first message; empty: none
};

/// Along formulas from 0 to 1.
Along along(const std::string& model, const std::string& formulas) {
  const ModelText m(model + "expect action of (" + formulas + ") from 0 to 1 = 0 ± 1\n");
  Diagnostics diagnostics;
  const auto& expectation = std::get<expectation::ActionAlong>(m.model.experiment.expectations[0].kind);
  auto path = action_of_path(m.model, m.equations, expectation.along.q, 0, 1, std::nullopt, {}, diagnostics);
  return {std::move(path), diagnostics.items().empty() ? "" : diagnostics.items().front().code};
}

void check_action(const std::string& model, const std::string& formulas, double wanted) {
  CAPTURE(formulas);
  const Along found = along(model, formulas);
  REQUIRE(found.path);
  CHECK(std::abs(found.path->action - wanted) <= found.path->action_error + 1e-15 * wanted);
  CHECK(found.path->action_error < 1e-6 * wanted);
}

}  // namespace

TEST_CASE("a broken line is not stationary: p jumps at the corner, and h_E where L is not convex") {
  const Along broken = along(free_particle, "abs(t - 0.5)");
  REQUIRE(broken.path);
  CHECK(broken.path->action == doctest::Approx(0.5).epsilon(1e-14));
  CHECK_FALSE(broken.path->stationary);
  REQUIRE(broken.path->corner);
  CHECK(broken.path->corner->t == doctest::Approx(0.5));
  CHECK(broken.path->corner->row == 0);
  CHECK(broken.path->corner->before == -1);
  CHECK(broken.path->corner->after == 1);

  // Neither p = 4 v (v² − 1) nor h_E = (v² − 1) (3 v² + 1) sees the corner between v = −1 and v = 1.
  const char* const two_wells = "system w\ndimensionless\ncoord x : number\nL = (x'^2 - 1)^2\n";
  const Along extremal = along(two_wells, "abs(t - 0.5)");
  REQUIRE(extremal.path);
  CHECK_FALSE(extremal.path->corner);
  CHECK(extremal.path->stationary);
  // p = 0 at v = 0 and v = 1, h_E = −1 at the first and 0 at the second.
  const Along energetic = along(two_wells, "max(0, t - 0.5)");
  REQUIRE(energetic.path);
  REQUIRE(energetic.path->corner);
  CHECK(energetic.path->corner->row == 1);
  CHECK(energetic.path->corner->before == doctest::Approx(-1));
}

TEST_CASE("corners of p that constraints take up are none") {
  const Along circle =
      along("system c\ndimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nconstraint x^2 + y^2 = 1\n",
            "cos(abs(t - 0.5)), sin(abs(t - 0.5))");
  REQUIRE(circle.path);
  REQUIRE(circle.path->corner);  // the tangential part of p turns round
  CHECK(circle.path->corner->t == doctest::Approx(0.5));
  const Along round =
      along("system c\ndimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nconstraint x^2 + y^2 = 1\n",
            "cos(t), sin(t)");
  REQUIRE(round.path);
  CHECK(round.path->stationary);
}

TEST_CASE("a polygon of a given length: its straight pieces leave λ open, and it is not stationary") {
  const Along polygon = along(
      "system c\ndimensionless\nindependent x : number\ncoord y : number\nL = y sqrt(1 + y'^2)\n"
      "constraint integral sqrt(1 + y'^2) = 2 name rope\n",
      "2 abs(x - 1/2)");
  REQUIRE(polygon.path);
  CHECK(polygon.path->action == doctest::Approx(std::sqrt(5.0) / 2).epsilon(1e-14));
  CHECK(polygon.path->integrals.at(0) == doctest::Approx(std::sqrt(5.0)).epsilon(1e-14));
  CHECK(std::isfinite(polygon.path->residual));
  CHECK_FALSE(polygon.path->stationary);
}

TEST_CASE("S along formulas with narrow features, kinks and steep ends: closed forms") {
  check_action(free_particle, "max(0, 0.01 - abs(t - 0.123))", 0.01);
  // ½ ∫ k² sech⁴ k t dt = ⅔ k
  check_action(free_particle, "tanh(10000 (t - 0.123))", 20000.0 / 3);
  check_action(free_particle, "tanh(1000 (t - 0.123))", 2000.0 / 3);
  // ½ ∫ (2 a u)² e^(−2 a u²) du = ½ √(π a/2)
  check_action(free_particle, "exp(-1e10 (t - 0.3)^2)", 0.5 * std::sqrt(pi * 1e10 / 2));
  check_action(free_particle, "t^(3/4)", 9.0 / 16);
  check_action(free_particle, "abs(t - 1/3)^1.5", 9.0 / 16 * (1.0 / 9 + 4.0 / 9));
  check_action("system g\ndimensionless\ncoord x : number\nL = 1/2 x'^2 + 5 exp(-1000000 (x - 0.3)^2)\n", "t",
               0.5 + 5e-3 * std::sqrt(pi));
}

TEST_CASE("a path that is stationary but for a narrow place is not stationary") {
  // Along y = 0 the potential y exp(…) vanishes, and its force does not.
  const Along bump =
      along("system b\ndimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - y exp(-1e12 (x - 0.3)^2)\n", "t, 0");
  REQUIRE(bump.path);
  CHECK_FALSE(bump.path->stationary);
  CHECK(bump.path->residual_at == doctest::Approx(0.3).epsilon(1e-4));
}

TEST_CASE("S that is infinite, a path that jumps, L without a value, a constraint left for a moment") {
  CHECK(along(free_particle, "sqrt(t)").code == "E1212");
  CHECK(along(free_particle, "t + 1e-9 sin(1e7 t)").code == "E1212");
  CHECK(along(free_particle, "sign(t - 1/3)").code == "E1213");
  CHECK(along(free_particle, "sqrt(t - 0.5)").code == "E1206");
  CHECK(along("system c\ndimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nconstraint x^2 + y^2 = 1\n",
              "cos(t) (1 + exp(-1e8 (t - 0.34567)^2)), sin(t)")
            .code == "E1202");
}

#include "support.hpp"

#include <fstream>
#include <sstream>

// Periods of reference cases of the literature, from the models of tests/problems.

using namespace maupertuis;

namespace {

std::string problem(const std::string& name) {
  std::ifstream in(std::string(PROJECT_DIR) + "/tests/problems/" + name + ".lag");
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace

TEST_CASE("the Cartesian pendulum of SUNDIALS, whose period is 2") {
  const FloquetResult r = floquet_of(ModelText(problem("pendulum_dae_period2")));
  CHECK(r.motion.period == doctest::Approx(2).epsilon(1e-13));
  CHECK(r.multipliers.size() == 2);
}

TEST_CASE("Kepler's ellipse e = 0.6: period 2π, all multipliers 1") {
  const FloquetResult r = floquet_of(ModelText(problem("celest_kepler_e06")));
  CHECK(r.motion.period == doctest::Approx(2 * std::numbers::pi).epsilon(1e-13));
  REQUIRE(r.multipliers.size() == 4);
  for (const auto& mu : r.multipliers)
    CHECK(std::abs(mu - 1.0) < 1e-5);  // a further defective pair, by the angular momentum
  CHECK(r.trace == doctest::Approx(4).epsilon(1e-10));
  CHECK(r.stability == OrbitalStability::Neutral);
}

TEST_CASE("the three-body orbit I.A 1 of Li and Liao, from its published digits") {
  FloquetOptions near;
  near.period = 6.3259139829;
  const FloquetResult r = floquet_of(ModelText(problem("celest_liliao_IA1")), near);
  CHECK(r.motion.period == doctest::Approx(6.3259139829).epsilon(1e-9));
  CHECK(r.motion.moved < 1e-8);
  CHECK(r.motion.closure < 1e-11);
}

TEST_CASE("a motion of the horizontally driven pendulum that repeats with its drive") {
  const FloquetResult r = floquet_of(ModelText(problem("heyoka_driven_pendulum")));
  CHECK(r.motion.driven);
  CHECK(r.motion.period == doctest::Approx(2 * std::numbers::pi / 0.4).epsilon(1e-15));
  CHECK(r.motion.closure < 1e-13);
  CHECK(std::abs(r.multipliers[0] * r.multipliers[1] - 1.0) < 1e-11);
}

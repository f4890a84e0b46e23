// Barriers that are met from far away, where exponentials in the force are beyond the doubles.
#include "../model_text.hpp"

#include <maupertuis/simulation.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

State end_of(const std::string& potential, const std::string& start, double duration) {
  ModelText m("dimensionless\nparam C = 2\ncoord x : number\nT = 1/2 x'^2\nV = " + potential + "\nstart " + start +
              "\n");
  SimulationOptions options;
  options.duration = duration;
  options.errors = ErrorEstimates::None;
  const auto result = simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  INFO(result->reason);
  REQUIRE(result->ok());
  return result->final;
}

}  // namespace

TEST_CASE("a particle that is too slow for a barrier comes back, however far it began") {
  // E = 1/2 below the top, 1.
  for (const char* start : {"x = -230, x' = 1", "x = -237, x' = 1", "x = -240, x' = 1", "x = -300, x' = 1"}) {
    INFO(start);
    CHECK(end_of("1/cosh(x)^2", start, 400).v[0] == doctest::Approx(-1).epsilon(1e-12));
  }
  for (const char* x : {"170", "176", "200", "300"}) {
    INFO(x);
    CHECK(end_of("1/(1 + C exp(2 x))", std::string("x = ") + x + ", x' = -1", 400).v[0] ==
          doctest::Approx(1).epsilon(1e-12));
    CHECK(end_of("1/(1 + C exp(-2 x))", std::string("x = -") + x + ", x' = 1", 400).v[0] ==
          doctest::Approx(-1).epsilon(1e-12));
  }
}

TEST_CASE("where the rounding of a force cannot be bounded nothing of it is taken for rounding") {
  // 1/(1 + C exp(2 x) + x^2) is no quotient of exponentials alone; C² exp(4 x) is near the largest double at 176.
  const State end = end_of("1/(1 + C exp(-2 x)/(1 + x^2))", "x = -176, x' = 1", 200);
  CHECK(0.5 * end.v[0] * end.v[0] + 1 / (1 + 2 * std::exp(-2 * end.q[0]) / (1 + end.q[0] * end.q[0])) ==
        doctest::Approx(0.5).epsilon(1e-12));
}

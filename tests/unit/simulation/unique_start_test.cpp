// Starts at rest where a force has no derivative: one motion, or many.
#include "../model_text.hpp"

#include <maupertuis/simulation.hpp>

using namespace maupertuis;

namespace {

/// The code of the refusal; empty where the run comes to its end.
std::string outcome(const std::string& text, std::size_t* steps = nullptr) {
  ModelText m("dimensionless\n" + text + "run 1\n");
  const auto result = simulate(m.model, m.equations, {}, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  if (!result) return m.diagnostics.items().front().code;
  CHECK(result->ok());
  if (steps) *steps = result->statistics.steps;
  return "";
}

}  // namespace

TEST_CASE("a rest that can be left at any time is refused: Norton's dome") {
  const std::string one = "coord s : number\nT = 1/2 s'^2\n", two = "coord s, y : number\nT = 1/2 (s'^2 + y'^2)\n";
  CHECK(outcome(one + "V = -2/3 s^(3/2)\nstart s = 0\n") == "E0735");
  CHECK(outcome(one + "V = -2/3 (s - 0.3)^(3/2)\nstart s = 0.3\n") == "E0735");
  CHECK(outcome(one + "force s = sqrt(abs(s))\nstart s = 0\n") == "E0735");
  CHECK(outcome(one + "force s = sign(s) abs(s)^(1/3)\nstart s = 0\n") == "E0735");
  CHECK(outcome(two + "V = -2/3 (s - y)^(3/2) + 1/2 (s + y)^2\nstart s = 0\n") == "E0735");
  CHECK(outcome(two + "V = -2/3 s^(3/2) + 1/2 y^2\nstart y = 1\n") == "E0735");  // s rests while y swings
}

TEST_CASE("what draws back, pushes on or passes has one motion") {
  const std::string one = "coord s : number\nT = 1/2 s'^2\n";
  std::size_t steps = 0;
  CHECK(outcome(one + "V = 2/3 abs(s)^(3/2)\nstart s = 0\n", &steps).empty());  // rest for ever
  CHECK(steps < 10);
  CHECK(outcome(one + "force s = sqrt(abs(s))\nstart s = -1, s' = 2\n").empty());
  CHECK(outcome(one + "V = -2/3 s^(3/2)\nstart s = 0.01\n").empty());
  CHECK(outcome(one + "force s = s + s^3\nstart s = 0\n").empty());
}

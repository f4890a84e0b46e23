#include "system/kinetic_form.hpp"
#include "support.hpp"

#include <algorithm>

using namespace maupertuis;

namespace {

bool is_definite(const std::string& text) {
  SourceText source("test.lag", text);
  Diagnostics diagnostics;
  const auto model = elaborate(syntax::parse(source, diagnostics), source, diagnostics);
  REQUIRE(model);
  const lint_rules::Subject subject(*model, source, diagnostics);
  return lint_rules::kinetic_form_is_definite(subject, lint_rules::sample(subject, 0));
}

std::string pendulum_tree(int links, int branches) {
  std::string text = "param m = 1 kg, l = 1 m\ncoord ";
  for (int i = 1; i <= links; ++i) text += (i == 1 ? "" : i % 8 == 0 ? ",\n    " : ", ") + ("θ" + std::to_string(i));
  text += " : angle\n";
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i),
                      before = i == 1 ? "" : "P" + std::to_string(std::max(1, i / branches)) + " + ";
    const std::string parent = branches == 1 && i > 1 ? "P" + std::to_string(i - 1) + " + " : before;
    text += "point P" + n + " mass m at " + parent + "l (sin θ" + n + ", -cos θ" + n + ")\n";
  }
  return text;
}

}  // namespace

TEST_CASE("the kinetic form says what M says") {
  CHECK(is_definite("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + x' y' + y'^2)\n"));
  CHECK_FALSE(is_definite("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x' + y')^2\n"));    // singular
  CHECK_FALSE(is_definite("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 - y'^2)\n"));  // indefinite
  CHECK_FALSE(is_definite("param m = 1 kg, k = 1 N/m\ncoord x, y : length\nT = 1/2 m x'^2\nV = 1/2 k (x - y)^2\n"));
  // What moves inside a root is a power; ∂²L/∂v² of the free relativistic particle is positive.
  CHECK(is_definite("dimensionless\ncoord x, y : number\nstart x' = 0.5\nL = -sqrt(1 - x'^2 - y'^2)\n"));
}

TEST_CASE("chains and trees of thousands of points: M is never made") {
  CHECK(is_definite(pendulum_tree(4000, 1)));
  CHECK(is_definite(pendulum_tree(4000, 2)));
}

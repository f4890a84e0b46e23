// Errors of motions that forget their start: what is left of it, and what companions that end early tell.
#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

using namespace maupertuis;

namespace {

const std::string billiard =
    "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
    "contact max(abs(x) - 1, 0)^2 + y^2 <= 1 restitution 1\nstart x = 0.1, y = 0.2, x' = 0.8, y' = 0.6\n";

SimulationResult run(const std::string& text, ErrorEstimates errors, std::vector<double> at = {}) {
  ModelText m(text);
  SimulationOptions options;
  options.duration = 300;
  options.output_every = 1;
  options.errors = errors;
  options.at = std::move(at);
  auto result = simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

bool same(double a, double b) { return a == b || (std::isinf(a) && std::isinf(b)); }

}  // namespace

TEST_CASE("companions that end where the motion is lost tell of it what whole ones do") {
  const SimulationResult whole = run(billiard, ErrorEstimates::Rows), ended = run(billiard, ErrorEstimates::States);
  REQUIRE(whole.uncertain.everything);
  REQUIRE(ended.uncertain.everything);
  CHECK(ended.uncertain.from == whole.uncertain.from);
  CHECK(ended.uncertain.columns == whole.uncertain.columns);
  CHECK(ended.uncertain.from > 20);
  CHECK(ended.uncertain.from < 150);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(std::isinf(ended.final.errors->q[i]));
    CHECK(std::isinf(ended.final.errors->v[i]));
  }
  REQUIRE(ended.happenings.size() == whole.happenings.size());
  std::size_t known = 0;
  for (std::size_t k = 0; k < ended.happenings.size(); ++k) {
    const double t = ended.happenings[k].t;
    if (t < ended.uncertain.from - 5) {
      CHECK(same(ended.happenings[k].error, whole.happenings[k].error));
      ++known;
    }
    if (t > ended.uncertain.from + 20) CHECK(std::isinf(ended.happenings[k].error));
  }
  CHECK(known > 10);
}

TEST_CASE("what is asked for later is told by companions that go on") {
  const SimulationResult r = run(billiard, ErrorEstimates::States, {10, 250});
  REQUIRE(r.at.size() == 2);
  CHECK(r.at[0].errors->q[0] < 1e-10);
  CHECK(std::isinf(r.at[1].errors->q[0]));
  const auto late =
      std::find_if(r.happenings.begin(), r.happenings.end(), [](const Happening& h) { return h.t > 200; });
  REQUIRE(late != r.happenings.end());
  CHECK(std::isfinite(late->error));
}

TEST_CASE("a coordinate that never moves is known although the others are lost") {
  std::string text = billiard;
  text.replace(text.find("x, y :"), 6, "x, y, u :");
  text.replace(text.find("y'^2)"), 5, "y'^2 + u'^2)");
  const SimulationResult r = run(text, ErrorEstimates::States);
  CHECK(r.final.errors->q[2] == 0);
  CHECK(std::isinf(r.final.errors->q[0]));
}

TEST_CASE("a force as small as rounding of another one is real where none cancels it: a floor with a slope of 1e-15") {
  const std::string body =
      "param m = 1 kg, g = 9.81 m/s^2, s = 1e-15\ncoord x, y : length\npoint P mass m at (x, y)\ngravity (0, -g)\n";
  const auto on = [&](const std::string& more) {
    SimulationResult r = run(body + more + "start x = 0, y = 0\n", ErrorEstimates::States);
    REQUIRE(r.ok());
    return r.final;
  };
  const State slides = on("contact y >= s x name floor\n");
  CHECK(slides.q[0] == doctest::Approx(-9.81e-15 / 2 * slides.t * slides.t).epsilon(1e-12).scale(0));
  CHECK(slides.v[0] == doctest::Approx(-9.81e-15 * slides.t).epsilon(1e-12).scale(0));
  // Pressed onto a floor that leaves it the way along, and pushed along by 1e-15 of that.
  const std::string pressed = "force on P = (1e-9 [N], -1e6 [N])\ncontact y >= 0 ";
  const State pushed = on(pressed + "name floor\n");
  CHECK(pushed.q[0] == doctest::Approx(0.5e-9 * pushed.t * pushed.t).epsilon(1e-12).scale(0));
  const State held = on(pressed + "friction 0.5 slip x' name floor\n");
  CHECK(held.q[0] == 0);
}

TEST_CASE("the errors of places after bounces on curved walls contain the true ones: literals are rounded too") {
  const std::string body = "dimensionless\ncoord x, y : length\npoint P mass 1 at (x, y)\ngravity (0, -9.81)\n",
                    circle = "contact x^2 + y^2 <= 1 restitution 1 name wall\n";
  const std::pair<std::string, double> motions[] = {
      {"contact y - 0.239*sin(1.305*x) >= 0 restitution 1 name floor\nstart x = -0.267, y = 0.878, x' = -0.913\n",
       1.93},
      {circle + "start x = -0.229, y = 0.397, x' = 0.273, y' = -0.915\n", 2.42},
      {circle + "start x = 0.077, y = -0.107, x' = 0.447, y' = -0.011\n", 0.91},
      {circle + "start x = -0.28, y = 0.291, x' = 0.682, y' = 0.494\n", 1.31},
      {"contact sqrt(x^2 + (y + 1)^2) >= 1 restitution 0.9 name floor\nstart x = 0.11, y = 0.4, x' = 0.13\n", 1.7}};
  for (const auto& [text, end] : motions) {
    CAPTURE(text);
    ModelText m(body + text);
    SimulationOptions options;
    options.duration = end;
    const auto r = simulate(m.model, m.equations, options, m.diagnostics);
    REQUIRE(r);
    REQUIRE(r->final.errors);
    ExtendedSimulationOptions quad;
    quad.duration = Rational::from_double(end);
    const auto exact = simulate_extended(m.model, m.equations, quad, m.diagnostics);
    REQUIRE(exact);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(std::abs(std::strtold(exact->final.q[i].text.c_str(), nullptr) - r->final.q[i]) <= r->final.errors->q[i]);
      CHECK(std::abs(std::strtold(exact->final.v[i].text.c_str(), nullptr) - r->final.v[i]) <= r->final.errors->v[i]);
      CHECK(r->final.errors->q[i] < 1e-12);
    }
  }
}

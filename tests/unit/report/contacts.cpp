// What pictures show of contacts, against closed forms of when they change.
#include <maupertuis/motion_pictures.hpp>

#include "../model_text.hpp"

#include <cmath>

using namespace maupertuis;

namespace {

SimulationResult run_of(const ModelText& m) {
  Diagnostics diagnostics;
  SimulationOptions options;
  options.errors = ErrorEstimates::None;
  auto result = simulate(m.model, m.equations, options, diagnostics);
  REQUIRE(result);
  return *std::move(result);
}

}  // namespace

TEST_CASE("a block shot up an incline: its bar slides until v/(g (sin α + μ cos α)), then sticks; an event is a mark") {
  const ModelText m(
      "system s\nparam m = 1 kg, g = 10 m/s^2, α = 0.3 rad, μ = 0.4, v = 2 m/s\ncoord s, n : length\n"
      "point P mass m at s (cos α, sin α) + n (-sin α, cos α)\ngravity (0, -g)\n"
      "contact n >= 0 friction μ slip s' name plane\ncontact s >= -1 [m] name never\n"
      "event half when s' = 1 [m/s] : record\nstart s' = v\nrun 1 s\n");
  const SimulationResult run = run_of(m);
  PlotOptions options;
  show_happenings(options, run, *m.system);
  const double stops = 2 / (10 * (std::sin(0.3) + 0.4 * std::cos(0.3)));
  REQUIRE(options.strips.size() == 1);  // the other contact is never closed
  CHECK(options.strips[0].name == "plane");
  const auto& parts = options.strips[0].parts;
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].from == 0);
  CHECK(parts[0].to == doctest::Approx(stops).epsilon(1e-12));
  CHECK(parts[0].state == PlotStrip::State::Forward);
  CHECK(parts[1].state == PlotStrip::State::Stick);
  CHECK(parts[1].to == 1);
  REQUIRE(options.marks.size() == 1);
  CHECK(options.marks[0].name == "half");
  CHECK(options.marks[0].dashed);
  CHECK(options.marks[0].t == doctest::Approx(stops / 2).epsilon(1e-12));
}

TEST_CASE("a ball that bounces: impacts are marks and impulses (1 + e) m v; it is in flight, so there is no bar") {
  const ModelText m(
      "system s\nparam m = 3 kg, g = 10 m/s^2\ncoord z : length\npoint P mass m at (0, z)\n"
      "gravity (0, -g)\ncontact z >= 0 restitution 0.5 name floor\nstart z = 0.2 m\nrun 0.55 s\n");
  const SimulationResult run = run_of(m);
  PlotOptions options;
  show_happenings(options, run, *m.system);
  CHECK(options.strips.empty());
  const std::vector<ContactImpulse> impulses = impulses_of(run, *m.system);
  REQUIRE(options.marks.size() == 3);
  REQUIRE(impulses.size() == 3);
  const double times[] = {0.2, 0.4, 0.5}, speeds[] = {2, 1, 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(options.marks[i].t == doctest::Approx(times[i]).epsilon(1e-12));
    CHECK_FALSE(options.marks[i].dashed);
    CHECK(impulses[i].contact == 0);
    CHECK(impulses[i].t == options.marks[i].t);
    CHECK(impulses[i].size == doctest::Approx(1.5 * 3 * speeds[i]).epsilon(1e-12));
  }
}

#include "support.hpp"

#include <algorithm>

using namespace maupertuis;

namespace {

const std::string henon_heiles =
    "system hh\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 (x^2 + y^2) + x^2 y - 1/3 y^3\n"
    "start y = 0.1, x' = 0.4\nrun 100\n";
const std::string two_oscillators =
    "system two\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = 1/2 x^2 + y^2\n"
    "start x' = 0.5, y = 0.3\nrun 100\n";

SectionResult section_of(const ModelText& m, const SectionOptions& options) {
  Diagnostics diagnostics;
  auto result = poincare_section(m.model, m.equations, options, diagnostics);
  INFO(render(diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

}  // namespace

TEST_CASE("two oscillators: crossings after whole periods of one, on the ellipse of the other") {
  const ModelText m(two_oscillators);
  SectionOptions options;
  options.section = m.q(0);
  options.direction = SectionDirection::Rising;
  options.crossings = 50;
  const SectionResult r = section_of(m, options);
  REQUIRE(r.crossings.size() == 50);
  for (const Crossing& c : r.crossings) {
    CHECK(std::abs(c.state.t - 2 * std::numbers::pi * static_cast<double>(c.number)) < 1e-12);
    CHECK(std::abs(c.state.q[0]) < 1e-13);
    CHECK(c.state.v[0] > 0);
    CHECK(c.state.q[1] == doctest::Approx(0.3 * std::cos(std::sqrt(2.0) * c.state.t)).epsilon(1e-11));
  }
  CHECK(r.across == 1);
  CHECK(r.largest_miss < 1e-13);  // what the resolution of t leaves
  CHECK(r.orbits[0].energy_drift < 1e-14);
  options.direction = SectionDirection::Both;
  const SectionResult both = section_of(m, options);
  CHECK(both.crossings[0].state.t == doctest::Approx(std::numbers::pi).epsilon(1e-13));
}

TEST_CASE(
    "Hénon-Heiles at E = 1/12: every start has the energy, the border is where it ends, and the drift is rounding") {
  const ModelText m(henon_heiles);
  SectionOptions options;
  options.section = m.q(0);
  options.direction = SectionDirection::Rising;
  options.crossings = 40;
  options.starts = 12;
  options.energy = 1.0 / 12;
  const SectionResult r = section_of(m, options);
  CHECK(r.orbits.size() == 12);
  CHECK(r.crossings.size() == 480);
  for (const SectionOrbit& o : r.orbits) {
    CHECK(o.energy == doctest::Approx(1.0 / 12).epsilon(1e-14));
    CHECK(o.energy_drift < 1e-13);
  }
  // ½ y² − y³/3 = 1/12 at y = ½ and (1 − √3)/2; y' = √(1/6) at y = 0.
  double low = 0, high = 0, top = 0;
  for (const auto& [y, rate] : r.outline) low = std::min(low, y), high = std::max(high, y), top = std::max(top, rate);
  CHECK(low == doctest::Approx((1 - std::sqrt(3)) / 2).epsilon(0.02));
  CHECK(low >= (1 - std::sqrt(3)) / 2);
  CHECK(high == doctest::Approx(0.5).epsilon(0.02));
  CHECK(high <= 0.5);
  CHECK(top == doctest::Approx(std::sqrt(1.0 / 6)).epsilon(1e-3));
  for (const Crossing& c : r.crossings) {
    const double y = c.state.q[1], left = 1.0 / 6 - y * y + 2.0 / 3 * y * y * y - c.state.v[1] * c.state.v[1];
    CHECK(left > -1e-14);
  }
}

TEST_CASE("the same motion as one long run: crossings of the events agree with a run until them") {
  const ModelText m(henon_heiles + "");
  SectionOptions options;
  options.section = m.q(1) - m.system->context->number(Rational(1, 20));
  options.direction = SectionDirection::Falling;
  options.crossings = 3;
  const SectionResult r = section_of(m, options);
  SimulationOptions run;
  run.at = {r.crossings[2].state.t};
  Diagnostics d;
  const auto s = simulate(m.model, m.equations, run, d);
  REQUIRE(s);
  CHECK(std::abs(s->at[0].q[1] - 0.05) < 1e-14);
  CHECK(s->at[0].v[1] < 0);
  CHECK(std::abs(s->at[0].q[0] - r.crossings[2].state.q[0]) < 1e-13);
}

TEST_CASE("a strobe: the driven oscillator at multiples of its period") {
  const ModelText m(
      "system driven\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2 - x cos(2 t)\nstart x = 1\n");
  SectionOptions options;
  options.strobe = std::numbers::pi;
  options.crossings = 20;
  const SectionResult r = section_of(m, options);
  REQUIRE(r.crossings.size() == 20);
  for (const Crossing& c : r.crossings)  // x = (4/3) cos t − (1/3) cos 2t
    CHECK(c.state.q[0] == doctest::Approx(4.0 / 3 * std::cos(c.state.t) - 1.0 / 3).epsilon(1e-12));
}

TEST_CASE("sections that are not there are told") {
  const auto code = [](const std::string& text, auto change) {
    const ModelText m(text);
    SectionOptions options;
    options.section = m.q(0);
    change(m, options);
    return code_of([&](Diagnostics& d) { return poincare_section(m.model, m.equations, options, d); });
  };
  CHECK(code(two_oscillators, [](const ModelText& m, SectionOptions& o) {
          o.section = m.q(0) - m.system->context->number(5), o.longest = 50;
        }) == "E1405");
  CHECK(code(two_oscillators, [](const ModelText&, SectionOptions& o) { o.longest = -1; }) == "E1406");
  CHECK(code(two_oscillators, [](const ModelText&, SectionOptions& o) { o.section = Expr(), o.strobe = 0; }) ==
        "E1406");
  CHECK(code(two_oscillators, [](const ModelText&, SectionOptions& o) { o.starts = 3, o.energy = -1; }) == "E1407");
  CHECK(code(two_oscillators, [](const ModelText& m, SectionOptions& o) { o.starts = 3, o.section = m.v(0); }) ==
        "E1407");
  CHECK(code("system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 1\n",
             [](const ModelText&, SectionOptions& o) { o.starts = 3; }) == "E1407");
  CHECK(code(two_oscillators,
             [](const ModelText& m, SectionOptions& o) { o.section = m.system->context->number(1); }) == "E1409");
  CHECK(code("system s\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = -1/x\nstart x = 1\n",
             [](const ModelText& m, SectionOptions& o) { o.section = m.q(0) - m.system->context->number(2); }) ==
        "E1408");
}

TEST_CASE("of an angle a section is a place in every turn, where the equations do not see turns") {
  const auto times = [](const ModelText& m, const Expr& section, SectionDirection direction) {
    SectionOptions options;
    options.section = section;
    options.direction = direction;
    options.crossings = 20;
    std::vector<double> out;
    for (const Crossing& c : section_of(m, options).crossings) out.push_back(c.state.t);
    REQUIRE(out.size() == 20);
    return out;
  };
  const std::string rotors = "dimensionless\ncoord a, b : angle\nL = 1/2 (a'^2 + b'^2)";
  const ModelText free(rotors + "\nstart a = 0.5, a' = 2.3, b' = 0.3\nrun 100\n");
  const Expr one = free.model.system.context->number(Rational(1));
  const double turn = 2 * std::numbers::pi;
  const auto rising = times(free, free.q(0) - one, SectionDirection::Rising);
  const auto backwards = times(free, one - free.q(0), SectionDirection::Falling);
  const auto relative = times(free, free.q(0) - free.q(1) - one, SectionDirection::Both);
  const ModelText spring(rotors + " - 1/2 a^2 - 1/2 b^2\nstart a' = 20\nrun 100\n");
  const auto untwisted = times(spring, spring.q(0), SectionDirection::Rising);
  for (std::size_t k = 0; k < 20; ++k) {
    const auto number = static_cast<double>(k);
    CHECK(rising[k] == doctest::Approx((0.5 + turn * number) / 2.3).epsilon(1e-13));
    CHECK(backwards[k] == doctest::Approx(rising[k]).epsilon(1e-13));
    CHECK(relative[k] == doctest::Approx((0.5 + turn * number) / 2).epsilon(1e-13));
    CHECK(untwisted[k] == doctest::Approx(turn * (number + 1)).epsilon(1e-13));
  }
}

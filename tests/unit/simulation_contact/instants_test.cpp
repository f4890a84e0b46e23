// Instants: what acts there, in double and in many digits, and what their rounding makes of the motion after them.
#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/simulation.hpp>

#include "run_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace maupertuis;

namespace {

SimulationResult with_errors(const std::string& text) {
  ModelText m(text);
  auto result = simulate(m.model, m.equations, {}, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  REQUIRE(result->final.errors);
  return std::move(*result);
}

ExtendedResult in_quad(const std::string& text) {
  ModelText m(text);
  auto result = simulate_extended(m.model, m.equations, {}, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

double number(const AgreedNumber& x) { return std::strtod(x.text.c_str(), nullptr); }

const std::string falls =
    "param m = 1 kg, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\nforce x = -m g\nstart x = 1 m\nrun 20 "
    "s\n";
const std::string slides_on_floor =
    "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\npoint P mass m at (x, z)\ngravity (0, -g)\n";

}  // namespace

TEST_CASE("bounces that end on a table that moves: the impulse that ends them is in the books of the energy") {
  ModelText m(
      "param m = 1 kg, g = 9.81 m/s^2, A = 5 mm, w = 60 rad/s, c = 0.1 N s/m\ncoord z, x : length\n"
      "point P mass m at (x, z)\ngravity (0, -g)\nD = 1/2 c (z'^2 + x'^2)\n"
      "contact z >= A sin(w t) restitution 0.6 friction 0.3 slip x' - 0.2 [m/s] name table\nstart z = 0.1 m\n");
  const auto r = run(m, 3);
  const auto made = std::count_if(r.happenings.begin(), r.happenings.end(),
                                  [](const Happening& h) { return h.kind == Happening::Kind::Made; });
  CHECK(made >= 1);
  CHECK(r.statistics.energy_drift < 1e-13);
}

// It falls for √(2/g), then bounces for twice e + e² + … of that.
TEST_CASE("a ball that bounces by an event does not fall through the floor") {
  for (const double e : {0.5, 0.9})
    for (const std::string direction : {"", " falling"}) {
      CAPTURE(e);
      const std::string text =
          falls + "event b when x = 0" + direction + " : set x' = -" + (e == 0.5 ? "0.5" : "0.9") + " x'\n";
      const double end = std::sqrt(2 / 9.81) * (1 + 2 * e / (1 - e));
      const SimulationResult r = with_errors(text);
      CHECK(r.ending == Ending::Unending);
      CHECK(r.final.t == doctest::Approx(end).epsilon(1e-9));
      CHECK(std::abs(r.final.q[0]) < 1e-12);
      const ExtendedResult quad = in_quad(text);
      CHECK(quad.ending == Ending::Unending);
      CHECK(quad.reached == doctest::Approx(end).epsilon(1e-12));
    }
}

TEST_CASE("events that set keep a particle in its box in many digits") {
  const ExtendedResult r = in_quad(
      "param m = 1 kg, L = 1 m\ncoord x : length\nT = 1/2 m x'^2\nevent a when x = L : set x' = -x'\n"
      "event b when x = 0 : set x' = -x'\nstart x' = 0.3 m/s, x = 0.1 m\nrun 1000 s\n");
  REQUIRE(r.ok());
  CHECK(r.happenings.size() == 300);  // 0.3·1000 m, of which the first is 0.9 m
  CHECK(number(r.final.q[0]) == 0.1);
  CHECK(number(r.final.v[0]) == 0.3);
}

TEST_CASE("two events at one instant both act, the later one last, and that is told") {
  const std::string text =
      "param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\nevent b when x = 1 m : set x' = 2 x'\n"
      "event c when x = 1 m : set x' = x' + 5 [m/s]\nevent a when x = 0 : set x' = 2 x'\n"
      "event d when t = 0 : record\nstart x' = 1 m/s\nrun 3 s\n";
  const SimulationResult r = run_text(text, 3);
  CHECK(r.final.q[0] == doctest::Approx(13).epsilon(1e-15));
  const auto told = [](const std::vector<std::string>& remarks) {
    return std::any_of(remarks.begin(), remarks.end(),
                       [](const std::string& s) { return s.find("`b` and `c` both set x'") != std::string::npos; });
  };
  CHECK(told(r.remarks));
  const ExtendedResult quad = in_quad(text);
  CHECK(number(quad.final.q[0]) == 13);
  CHECK(quad.happenings.size() == 4);
  CHECK(told(quad.remarks));
}

TEST_CASE("a slip that stops among bounces that accumulate stops after them") {
  const SimulationResult r = run_text(slides_on_floor +
                                          "contact z >= 0 restitution 0.5 friction 0.4 static 0.5 slip x' name floor\n"
                                          "force on P = (3 [N], 15 [N] sin(t 2 [rad/s]))\n",
                                      10);
  for (std::size_t i = 1; i < r.happenings.size(); ++i) CHECK(r.happenings[i - 1].t <= r.happenings[i].t);
}

TEST_CASE("friction that lets go again and again does so in many digits") {
  // It slides with x' = ∫ (2 − 5 + 4.9 exp(−((t − 100.3)/10⁻⁴)²)) dt from where the bracket is 0, the first time.
  const ExtendedResult pulse = in_quad(
      "coord x : length\npoint P mass 1 kg at (x, 0)\n"
      "friction x limit 5 [N] - 4.9 [N] exp(-((t - 100.3 [s])/(1e-4 [s]))^2)\nforce on P = (2 N, 0)\nrun 200 s\n");
  REQUIRE(pulse.ok());
  REQUIRE(pulse.happenings.size() == 2);
  CHECK(number(pulse.happenings[0].t) == doctest::Approx(100.3 - 1e-4 * std::sqrt(std::log(4.9 / 3))).epsilon(1e-14));
  const ExtendedResult blocks = in_quad(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint A mass m at (x, 0)\npoint B mass m at (y, 0)\n"
      "friction x coefficient 0.3 normal m g\nfriction y coefficient 0.3 normal m g\n"
      "spring A - B stiffness 100 N/m length 1 m\nforce on A = (2.943 [N] t/(1 [s]), 0)\nstart y = -1 m\nrun 3 s\n");
  REQUIRE(blocks.happenings.size() == 2);
  CHECK(blocks.happenings[1].name == "y");
  // x = 0.02943 (τ − sin(10 τ)/10), τ = t − 1, stretches the spring to 0.02943 m.
  double tau = 1;
  for (int turn = 0; turn < 50; ++turn) tau -= (tau - std::sin(10 * tau) / 10 - 1) / (1 - std::cos(10 * tau));
  CHECK(number(blocks.happenings[1].t) == doctest::Approx(1 + tau).epsilon(1e-13));
}

TEST_CASE("where a root ends no force is said to grow") {
  const std::string start = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nstart x = 1\nrun 5\n";
  CHECK(with_errors(start + "V = x^(3/2)\n").reason.find("no force grows") != std::string::npos);
  CHECK(with_errors(start + "V = -1/x\n").reason.find("a force grows without bound") != std::string::npos);
}

TEST_CASE("errors take in what rounding does to instants and to large states") {
  struct Model {
    std::string text;
    double q, v;
  };
  const std::string pulse = "coord x : length\nT = 1/2 m x'^2\nforce x = F (step(t - t0) - step(t - t0 - w))\n";
  const Model models[] = {
      {"param m = 1 kg, t0 = 1 s, w = 1 ns, F = 1e9 N\n" + pulse + "run 2 s\n", 1 - 0.5e-9, 1},
      {"param m = 1 kg, t0 = 1000 s, w = 10 ms, F = 1000 N\n" + pulse + "run 2000 s\n", 9999.95, 10},
      {"param m = 1 kg, w = 1 nm, F = 1e9 N, L = 1 m\ncoord x : length\nT = 1/2 m x'^2\nV = F max(0, w - abs(x - L))\n"
       "start x' = 2 m/s\nrun 2 s\n",
       4, 2},
      {slides_on_floor.substr(0, slides_on_floor.find("coord")) + "param v = 100 m/s, μ = 0.3\n" +
           slides_on_floor.substr(slides_on_floor.find("coord")) +
           "contact z >= 0 friction μ slip x' - v name belt\nstart x = -1e6 m\nrun 1e4 s\n",
       -1e4 / (2 * 0.3 * 9.81), 100}};
  for (const Model& model : models) {
    CAPTURE(model.text);
    const SimulationResult r = with_errors(model.text);
    CHECK(std::abs(r.final.q[0] - model.q) <= r.final.errors->q[0]);
    CHECK(std::abs(r.final.v[0] - model.v) <= r.final.errors->v[0]);
    CHECK(r.final.errors->v[0] < 1e-6);
  }
}

TEST_CASE("the time at which a gap comes to a root of third order is known to what rounding hides of it") {
  // x = (1/3 − t)³ − c
  for (const char* place : {"0", "0.7"}) {
    const SimulationResult r = with_errors(
        "dimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = 6 (1/3 - t)\nparam c = " + std::string(place) +
        "\ncontact x >= -c name wall\nstart x = 1/27 - c, x' = -1/3\nrun 3\n");
    REQUIRE(!r.happenings.empty());
    for (const Happening& h : r.happenings) {
      CHECK(std::abs(h.t - 1.0 / 3) <= h.error);
      CHECK(h.error < 1e-3);
    }
  }
  // One of first order is known to the rounding of time.
  const SimulationResult r = with_errors(falls + "contact x >= 0 name floor\n");
  REQUIRE(!r.happenings.empty());
  CHECK(r.happenings.front().error < 1e-14);
}

TEST_CASE("cards that lean on each other stay where they are, for any time") {
  const auto cards = [](double end) {
    return run_text(
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, α = 1.2 rad\ncoord x1, y1 : length, a : angle\n"
        "coord x2, y2 : length, b : angle\n"
        "L = 1/2 m (x1'^2 + y1'^2 + x2'^2 + y2'^2) + 1/24 m l^2 (a'^2 + b'^2) - m g (y1 + y2)\n"
        "contact y1 - l/2 sin a >= 0 friction 0.5 slip x1' + l/2 a' sin a name left\n"
        "contact y2 - l/2 sin b >= 0 friction 0.5 slip x2' - l/2 b' sin b name right\n"
        "contact (x2 - l/2 cos b) - (x1 + l/2 cos a) >= 0 friction 0.5 "
        "slip (y1' + l/2 a' cos a) - (y2' + l/2 b' cos b) name top\n"
        "start x1 = -l/2 cos α, y1 = l/2 sin α, a = α, x2 = l/2 cos α, y2 = l/2 sin α, b = α\n",
        end);
  };
  const auto begins = cards(1e-3);
  for (const double end : {100.0, 1e5}) {
    const auto r = cards(end);
    CHECK(r.happenings.empty());
    CHECK(r.final.q == begins.final.q);
    for (const double v : r.final.v) CHECK(v == 0);
  }
}

TEST_CASE("bounces that are too low to be followed rub as much as they would have") {
  // Gravity over the whole time is the impulse of all bounces and of the rest: x' = 50 − μ g t once it rests.
  for (const double e : {0.01, 0.003, 1e-3, 1e-4}) {
    CAPTURE(e);
    const SimulationResult r =
        run_text(fmt::format("dimensionless\nparam g = 10\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = g z\n"
                             "contact z >= 0 restitution {} friction 0.3 slip x' name floor\nstart z = 5, x' = 50\n",
                             e),
                 3);
    CHECK(r.final.v[0] == doctest::Approx(41).epsilon(1e-14));
    CHECK(r.final.q[0] == doctest::Approx(138).epsilon(1e-14));
    const auto made = std::find_if(r.happenings.begin(), r.happenings.end(),
                                   [](const Happening& h) { return h.kind == Happening::Kind::Made; });
    REQUIRE(made != r.happenings.end());
    CHECK(std::abs(made->t - (1 + 2 * e / (1 - e))) < 1e-12 + made->error);
  }
}

TEST_CASE("in space, where the slip is oblique, too") {
  const SimulationResult r = run_text(
      "dimensionless\nparam g = 10\ncoord x, y, z : number\npoint P mass 1 at (x, y, z)\ngravity (0, 0, -g)\n"
      "contact z >= 0 restitution 0.003 friction 0.3 slip (x', y') name floor\nstart z = 5, x' = 30, y' = 40\n",
      3);
  CHECK(r.final.v[0] == doctest::Approx(41 * 0.6).epsilon(1e-14));
  CHECK(r.final.v[1] == doctest::Approx(41 * 0.8).epsilon(1e-14));
}

TEST_CASE("a spring brings back to a wall at its rest as long as there is a speed, each half period") {
  const double pi = 3.14159265358979323846;
  const std::string text =
      "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2*x^2\ncontact x <= 0 restitution 0.5 name wall\n"
      "start x = -1\n";
  const SimulationResult r = run_text(text, 110);
  REQUIRE(count(r, Happening::Kind::Impact) == 35);
  for (std::size_t k = 0; k < 35; ++k)
    CHECK(std::abs(r.happenings[k].t - pi * (0.5 + static_cast<double>(k))) < 1e-9);
  const ExtendedResult quad = in_quad(text + "run 110\n");
  CHECK(std::count_if(quad.happenings.begin(), quad.happenings.end(),
                      [](const auto& h) { return h.kind == Happening::Kind::Impact; }) == 35);
}

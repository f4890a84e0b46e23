// Events where their formula, or the forces, have a kink, and at roots without a sign change.
#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using namespace maupertuis;

namespace {

/// A unit oscillator x = cos t, y = sin t, and one recorded event.
std::vector<double> instants_of(const std::string& condition, double end = 10) {
  const auto r = run_text(
      "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + y^2)\n"
      "start x = 1, y' = 1\nevent e when " +
          condition + " : record\n",
      end);
  std::vector<double> out;
  for (const Happening& h : r.happenings)
    if (h.t > 0) out.push_back(h.t);
  return out;
}

void check_instants(const std::string& condition, const std::vector<double>& expected, double digits = 1e-13) {
  CAPTURE(condition);
  const std::vector<double> found = instants_of(condition);
  REQUIRE(found.size() == expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) CHECK(std::abs(found[k] - expected[k]) <= digits);
}

const double half_turn = std::acos(-1.0);

}  // namespace

TEST_CASE("an event that comes to zero where a switch within it changes is met once") {
  const std::vector<double> zeros = {0.5 * half_turn, 1.5 * half_turn, 2.5 * half_turn};
  for (const char* touch : {"abs(x) = 0", "abs(sin(x)) = 0", "sqrt(x^2) = 0", "max(x, -x) = 0", "abs(x) + x^2 = 0",
                            "abs(x)^3 = 0", "x*abs(x) = 0", "min(x, 2 x) = 0"})
    check_instants(touch, zeros);
  check_instants("abs(x) = 0 rising", {});  // it comes to zero and goes back
  check_instants("x*abs(x) = 0 falling", {zeros[0], zeros[2]});
  check_instants("abs(x) - 1e-9 = 0", {zeros[0] - 1e-9, zeros[0] + 1e-9, zeros[1] - 1e-9, zeros[1] + 1e-9,
                                       zeros[2] - 1e-9, zeros[2] + 1e-9});
  check_instants("min(x, y) = 0", {0.5 * half_turn, 2 * half_turn, 2.5 * half_turn});
  check_instants("abs(x)*abs(y) = 0",
                 {0.5 * half_turn, half_turn, 1.5 * half_turn, 2 * half_turn, 2.5 * half_turn, 3 * half_turn});
  // One that stays at zero is met as it arrives there.
  check_instants("max(x, 0.2) = 0.2", {std::acos(0.2), 2 * half_turn + std::acos(0.2)});
  check_instants("abs(x) = x", {1.5 * half_turn});
}

TEST_CASE("an event whose formula has a root, without a series where it vanishes, is met") {
  const std::vector<double> zeros = {0.5 * half_turn, 1.5 * half_turn, 2.5 * half_turn};
  // x = cos t, y = sin t.
  for (const char* root : {"sqrt(abs(x)) = 0", "sqrt(4 x^2 + x^4) = 0", "3 (x^2)^(3/2) = 0", "abs(x)^(1/3) = 0"})
    check_instants(root, zeros);
  check_instants("sqrt(1 - x^2) = 0", {half_turn, 2 * half_turn, 3 * half_turn});
  check_instants("acos(x) = 0", {2 * half_turn});
  check_instants("sqrt(x) = 0", zeros);  // it has no value beyond
  check_instants("sqrt(x^2 + y^2) = 0", {});
  // Factors of a product too, and |x|^r with a direction: there its root changes no sign.
  check_instants("x*sqrt(abs(x)) = 0", zeros);
  check_instants("sqrt(abs(x))*x = 0 falling", {zeros[0], zeros[2]});
  check_instants("sign(x)*abs(x)^(1/2) = 0 rising", {zeros[1]});
  check_instants("2 x^2*acos(x) = 0", {zeros[0], zeros[1], 2 * half_turn, zeros[2]});
  check_instants("sqrt(x) = 0 rising", {});  // it has no value before
  for (const char* touch : {"abs(x)", "sqrt(x^2)", "sqrt(x^2 + x^2)", "norm((x, x))", "(x^2 + x^4)^(3/2)"})
    for (const char* direction : {" = 0 rising", " = 0 falling"}) check_instants(std::string(touch) + direction, {});
  check_instants("y*sqrt(x^2 + x^2) = 0 rising", {2 * half_turn});
  // Branches of a piecewise formula.
  check_instants("piecewise(x < 0 : sqrt(abs(x)), else : x^2) = 0", zeros);
  check_instants("piecewise(x < 0 : -abs(x)^(3/2), else : x) = 0", zeros);
  check_instants("piecewise(x < 0 : -abs(x)^(3/2), else : x) = 0 falling", {zeros[0], zeros[2]});
  check_instants("piecewise(x < 0 : -sqrt(abs(x)), else : x^2 (x - 1/2)) = 0",
                 {half_turn / 3, zeros[0], zeros[1], 5 * half_turn / 3, 7 * half_turn / 3, zeros[2]});
  check_instants("sqrt(x^2) = 0.5", {half_turn / 3, 2 * half_turn / 3, 4 * half_turn / 3, 5 * half_turn / 3,
                                     7 * half_turn / 3, 8 * half_turn / 3});
}

TEST_CASE("an event at the place where forces switch is met once at each passage") {
  const auto check = [&](const std::string& system, const std::string& condition, const std::vector<double>& expected,
                         double end) {
    CAPTURE(system);
    const auto found = [&] {
      const auto r =
          run_text("dimensionless\ncoord x : number\n" + system + "event e when " + condition + " : record\n", end);
      std::vector<double> out;
      for (const Happening& h : r.happenings) out.push_back(h.t);
      return out;
    }();
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) CHECK(std::abs(found[k] - expected[k]) < 1e-13);
  };
  const double fall = std::sqrt(2.0), quarter = half_turn / 2;
  check("L = 1/2 x'^2 - abs(x)\nstart x = 1\n", "x = 0", {fall, 3 * fall, 5 * fall, 7 * fall}, 10);
  check("L = 1/2 x'^2 - abs(x)\nstart x = 1\n", "x = 0 falling", {fall, 5 * fall}, 10);
  // A spring four times as stiff on one side.
  check("L = 1/2 x'^2 - 1/2 x^2 - 3/2 max(x, 0)^2\nstart x = 1\n", "x = 0",
        {quarter / 2, 2.5 * quarter, 3.5 * quarter, 5.5 * quarter}, 10);
  // x' changes its sign, and with it the damper's force.
  check("L = 1/2 x'^2 - 1/2 x^2\nforce x = -1/10 sign(x')\nstart x = 1\n", "x' = 0",
        {0, half_turn, 2 * half_turn, 3 * half_turn}, 10);
}

TEST_CASE("kinks of several events at one place do not take each other's certain digits") {
  const auto r = run_text(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1, x' = 1.3\n"
      "event a when abs(x - 0.5) = 0 : record\nevent b when abs((x - 0.5)*(x + 0.3)) = 0 : record\n",
      9);
  CHECK(count(r, Happening::Kind::Event, "a") == 3);
  CHECK(count(r, Happening::Kind::Event, "b") == 6);
  for (const Happening& h : r.happenings) CHECK(h.error < 1e-13);
}

TEST_CASE("an event at a kink stays open where forces switch too") {
  // Stiffness 4 for x > 0 and 1 below, from rest at 0.7: no event but the crossings of x = 0.
  const auto r = run_text(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2 - 3/2 max(x, 0)^2\nstart x = 0.7\n"
      "event e when x - 1 = 0 falling : set x' = -x'/2\nevent zero when abs(x*(x - 1)) = 0 : record\n",
      9);
  REQUIRE(count(r, Happening::Kind::Event, "zero") == 4);
  REQUIRE(r.happenings.size() == 4);
  const double quarter = half_turn / 4, expected[] = {quarter, 5 * quarter, 7 * quarter, 11 * quarter};
  for (std::size_t k = 0; k < 4; ++k) CHECK(std::abs(r.happenings[k].t - expected[k]) < 1e-13);
}

TEST_CASE("a zero that was met at a kink is not met again a rounding later") {
  // From rest at 0.5 and back: a half period of π/2 for x > 0, of π below.
  const auto r = run_text(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2 - 3/2 max(x, 0)^2\nstart x = 0.5\n"
      "event e when piecewise(x < 0.5 : (x - 0.5)^2, else : x - 0.5) = 0 : set x' = x'/2\n"
      "event beside when max(x - 0.5, 0) = 0 rising : set x' = 2*x'\n",
      5);
  REQUIRE(r.happenings.size() == 2);
  CHECK(r.happenings[0].t == 0);
  CHECK(std::abs(r.happenings[1].t - 1.5 * half_turn) < 1e-7);
}

TEST_CASE("an event that ends the run at a kink of another does so at once") {
  // Down from x = 1 with speed 0.3 under V = |x|, and back.
  const auto r = run_text(
      "dimensionless\ncoord x : number\nL = 1/2 x'^2 - abs(x)\ncontact 1 - x >= 0 restitution 1\n"
      "start x = 1, x' = -0.3\n"
      "event end when piecewise(x < 1 : (x - 1)^2, else : x - 1) = 0 : stop\n"
      "event told when piecewise(x < 1 : (x - 1)^2, else : x - 1) = 0 : record\n",
      9);
  const double fast = std::sqrt(0.09 + 2), back = 2 * (fast - 0.3) + 2 * fast;
  CHECK(r.ending == Ending::Stopped);
  CHECK(std::abs(r.final.t - back) < 1e-9);
  for (const char* name : {"end", "told"})
    CHECK(std::any_of(r.happenings.begin(), r.happenings.end(),
                      [&](const Happening& h) { return h.name == name && std::abs(h.t - back) < 1e-9; }));
}

TEST_CASE("an event passed against its direction leaves those at a kink of its place alone") {
  // x = −cos t: it rises through 0 at π/2, falls at 3π/2, rises at 5π/2.
  const auto r = run_text(
      "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2) - 1/2 x^2\nstart x = -1, y' = 1\n"
      "event thrown when x = 0 falling : set y' = 2 y'\nevent touch when abs(x (x - 0.3)) = 0 : record\n",
      9);
  CHECK(count(r, Happening::Kind::Event, "thrown") == 1);
  const double at = std::acos(-0.3);
  std::vector<double> touches;
  for (const Happening& h : r.happenings)
    if (h.name == "touch") touches.push_back(h.t);
  const std::vector<double> expected = {half_turn / 2,     at, 2 * half_turn - at, 1.5 * half_turn, 2.5 * half_turn,
                                        2 * half_turn + at};
  REQUIRE(touches.size() == expected.size());
  for (std::size_t k = 0; k < touches.size(); ++k) CHECK(std::abs(touches[k] - expected[k]) < 1e-12);
  CHECK(r.final.v[1] == 2);
}

TEST_CASE("a double root within a function whose argument rounds is met once, at its place") {
  // x + 1 touches 0 at half a turn.
  for (const char* touch : {"log(2 + x) = 0", "tan(x + 1) = 0", "tanh(x + 1) = 0", "sinh(x + 1) = 0", "exp(x + 1) = 1",
                            "erf(x + 1) = 0", "lambert_w(x + 1) = 0"})
    check_instants(touch, {half_turn, 3 * half_turn}, 1e-9);
}

TEST_CASE("an event whose formula changes at its own zero goes on by the formula beyond") {
  const auto angle = [](double x) { return std::acos(x); };  // x = cos t
  const double c = angle(-0.3);
  // A double zero on one side, a simple one on the other.
  check_instants("piecewise(x < -0.3 : (x + 0.3)^2, else : x*(x + 0.3)) = 0",
                 {half_turn / 2, c, 2 * half_turn - c, 1.5 * half_turn, 2.5 * half_turn, 2 * half_turn + c});
  check_instants("piecewise(x < -0.3 : (x + 0.3)^2, else : x + 0.3) = 0", {c, 2 * half_turn - c, 2 * half_turn + c});
  check_instants("max(x + 0.3, -(x + 0.3)^2) = 0", {c, 2 * half_turn - c, 2 * half_turn + c});
  check_instants("piecewise(x < -0.3 : sin(x + 0.3), else : (x + 0.3)^3) = 0",
                 {c, 2 * half_turn - c, 2 * half_turn + c});
}

TEST_CASE("sets at events that touch zero, beside one another") {
  const auto counts = [](const std::string& events, double end) {
    const auto r = run_text("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1\n" + events, end);
    std::map<std::string, int> out;
    for (const Happening& h : r.happenings) ++out[h.name];
    return out;
  };
  const auto both = counts(
      "event a when piecewise(x > 0: x, else: 2 x) = 0 : set x' = x'\nevent b when x^3 = 0 : set x' = x'\n"
      "event c when abs(x) = 0 : record\nevent d when max(x, -5) = 0 : set x' = x'\n",
      10.2 * half_turn);
  CHECK(both == std::map<std::string, int>{{"a", 10}, {"b", 10}, {"c", 10}, {"d", 10}});
  // A kink in time, which the motion does not turn back from; the start is told.
  CHECK(counts("event e when abs(sin(3 t)) = 0 : set x' = -x'\n", 5.5 * half_turn).at("e") == 17);
}

TEST_CASE("roots of even order are met once each") {
  const std::vector<double> zeros = {0.5 * half_turn, 1.5 * half_turn, 2.5 * half_turn};
  for (const char* power : {"x^2 = 0", "x^4 = 0", "x^6 = 0", "sin(x)^4 = 0"}) check_instants(power, zeros);
  check_instants("(1 - cos(x))^2 = 0", zeros, 1e-7);
  // What rounding leaves of x at its largest hides the time.
  for (const char* power : {"(x^2 - 1)^2 = 0", "(x^2 - 1)^3 = 0", "(x^2 - 1)^4 = 0"})
    check_instants(power, {half_turn, 2 * half_turn, 3 * half_turn}, 1e-6);
}

TEST_CASE("events of oscillators of all sizes: as many as there are, when they are") {
  std::uint64_t state = 1;
  const auto draw = [&](double low, double high) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return low + (high - low) * std::ldexp(static_cast<double>(state >> 11U), -53);
  };
  for (int k = 0; k < 60; ++k) {
    const double w = std::pow(10, draw(-3, 3)), size = std::pow(10, draw(-6, 6)), phase = draw(0, 2 * half_turn);
    const double end = draw(0.3, 8) * 2 * half_turn / w,
                 share = draw(0, 1) < 0.5 ? draw(-0.95, 0.95) : draw(-1e-9, 1e-9);
    const double at = share * size;
    // All t at which cos(w t + phase) = share, and whether it rises there.
    std::vector<std::pair<double, bool>> roots;
    for (int turn = -1; turn < 12; ++turn)
      for (const int side : {1, -1}) {
        const double t = (side * std::acos(share) + 2 * half_turn * turn - phase) / w;
        if (t > 0 && t < end) roots.push_back({t, side < 0});
      }
    std::sort(roots.begin(), roots.end());
    const auto text = [&](const std::string& name, const std::string& condition) {
      return fmt::format(fmt::runtime("event " + name + " when " + condition + " : record\n"), fmt::arg("at", at),
                         fmt::arg("size", size));
    };
    ModelText m(fmt::format("dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 ({:.17g})^2 x^2\n"
                            "start x = {:.17g}, x' = {:.17g}\n",
                            w, size * std::cos(phase), -size * w * std::sin(phase)) +
                text("all", "x = {at:.17g}") + text("upward", "x = {at:.17g} rising") +
                text("touching", "abs(x - ({at:.17g})) = 0") + text("square", "((x - ({at:.17g}))/{size:.17g})^2 = 0") +
                text("fourth", "((x - ({at:.17g}))/{size:.17g})^4 = 0") +
                text("fifth", "((x - ({at:.17g}))/{size:.17g})^5 = 0") +
                text("stays", "max(x, {at:.17g}) = {at:.17g}") + text("zero", "x*abs(x) = 0"));
    const auto r = run(m, end);
    CAPTURE(k);
    for (const std::string name : {"all", "upward", "touching", "square", "fourth", "fifth", "stays"}) {
      CAPTURE(name);
      std::vector<double> expected, found;
      for (const auto& [t, rises] : roots)
        if ((name != "upward" || rises) && (name != "stays" || !rises)) expected.push_back(t);
      for (const Happening& h : r.happenings)
        if (h.name == name) found.push_back(h.t);
      CHECK(found.size() == expected.size());
      for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i)
        CHECK(std::abs(found[i] - expected[i]) * w <= 1e-9);
    }
  }
}

// Rest with contacts and friction: which contacts press, and what static friction holds.
#include "../model_text.hpp"

#include <maupertuis/resting_modes.hpp>

#include <cmath>

using namespace maupertuis;

namespace {

std::vector<RestingMode> rests(const ModelText& m, Diagnostics& told) {
  const std::size_t n = m.system->coordinates.size();
  return resting_modes(*m.system, {0, std::vector<double>(n), std::vector<double>(n)}, told).found;
}
std::vector<RestingMode> rests(const ModelText& m) {
  Diagnostics told;
  const auto found = rests(m, told);
  CHECK_FALSE(told.has_errors());
  return found;
}

}  // namespace

TEST_CASE("a pendulum against a stop: where it presses, and where it hangs free") {
  // The stop is at −0.3: hanging down is free. At 0.3 from the other side the weight presses against it.
  const std::string text =
      "dimensionless\nparam w = 0.3\ncoord θ, s : number\nT = 1/2 (θ'^2 + s'^2)\nV = -cos θ + 2 s^2\n";
  const auto open = rests(ModelText(text + "contact θ >= -w name stop\n"));
  REQUIRE(open.size() == 1);
  CHECK(open[0].text == "free");
  const auto closed = rests(ModelText(text + "contact θ >= w name stop\n"));
  bool pressed = false;
  for (const RestingMode& mode : closed) {
    if (mode.text != "stop") continue;
    pressed = true;
    REQUIRE(mode.study.entries.size() == 1);
    CHECK(mode.study.entries[0].equilibrium.point.multipliers[0] == doctest::Approx(std::sin(0.3)).epsilon(1e-12));
    REQUIRE(mode.study.entries[0].analysis.modes.size() == 1);  // s alone
    CHECK(mode.study.entries[0].analysis.modes[0].frequency() == doctest::Approx(2).epsilon(1e-12));
  }
  CHECK(pressed);
}

TEST_CASE("static friction holds a spring within μs m g/k, not beyond") {
  const ModelText m(
      "dimensionless\nparam k = 40, g = 9.81, μ = 0.1, μs = 0.15\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\n"
      "V = 1/2 k (x - 0.2)^2 + g z\ncontact z >= 0 friction μ static μs slip x' name floor\n");
  const auto found = rests(m);
  REQUIRE(found.size() == 1);
  CHECK(found[0].text == "floor");
  CHECK(found[0].frictionless);
  REQUIRE(found[0].ranges.at(0));
  const double reach = 0.15 * 9.81 / 40;
  CHECK(found[0].ranges[0]->coordinate == 0);
  CHECK(found[0].ranges[0]->from == doctest::Approx(0.2 - reach).epsilon(1e-12));
  CHECK(found[0].ranges[0]->to == doctest::Approx(0.2 + reach).epsilon(1e-12));
  CHECK(found[0].study.entries[0].analysis.modes[0].frequency() == doctest::Approx(std::sqrt(40)).epsilon(1e-12));
}

TEST_CASE("what rests anywhere along a rough floor does so between the walls") {
  const auto range = [](const std::string& walls) {
    const ModelText m(
        "dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = y\n"
        "contact y >= 0 friction 0.3 slip x' name floor\n" +
        walls);
    const auto found = rests(m);
    REQUIRE(!found.empty());
    REQUIRE(found[0].text == "floor");
    REQUIRE(found[0].ranges.at(0));
    return *found[0].ranges[0];
  };
  const auto none = range("");
  CHECK(std::isinf(none.from));
  CHECK(std::isinf(none.to));
  const auto one = range("contact x - y >= -0.5 name wall\n");
  CHECK(one.from == doctest::Approx(-0.5).epsilon(1e-14));
  CHECK(std::isinf(one.to));
  const auto two = range("contact x >= -0.1 name left\ncontact x <= 3 name right\n");
  CHECK(two.from == doctest::Approx(-0.1).epsilon(1e-14));
  CHECK(two.to == doctest::Approx(3).epsilon(1e-14));
}

TEST_CASE("friction of a coordinate with a limit of its own") {
  const ModelText m("dimensionless\nparam M0 = 0.5\ncoord θ : angle\nT = 1/2 θ'^2\nV = -cos θ\nfriction θ limit M0\n");
  const auto found = rests(m);
  REQUIRE(found.size() == 1);
  bool hangs = false;
  for (std::size_t i = 0; i < found[0].study.entries.size(); ++i) {
    if (std::abs(found[0].study.entries[i].equilibrium.point.q[0]) > 1e-9) continue;
    hangs = true;
    REQUIRE(found[0].ranges.at(i));
    CHECK(found[0].ranges[i]->to == doctest::Approx(std::asin(0.5)).epsilon(1e-12));
  }
  CHECK(hangs);
}

TEST_CASE("a block on an incline rests by friction alone, up to its angle") {
  const auto incline = [](const char* friction) {
    return ModelText(std::string("dimensionless\nparam α = 0.3\ncoord s, n : number\nT = 1/2 (s'^2 + n'^2)\n"
                                 "V = s sin α + n cos α\ncontact n >= 0 friction ") +
                     friction + " slip s' name plane\n");
  };
  const auto held = rests(incline("0.31"));
  REQUIRE(held.size() == 1);
  CHECK(held[0].text == "plane sticking");
  CHECK(held[0].holds.at(0).at(0).force == doctest::Approx(std::sin(0.3)).epsilon(1e-12));
  CHECK(held[0].holds[0][0].limit == doctest::Approx(0.31 * std::cos(0.3)).epsilon(1e-12));
  Diagnostics told;
  CHECK(rests(incline("0.309"), told).empty());
  REQUIRE(told.items().size() == 1);
  CHECK(told.items().front().code == "E1308");
}

TEST_CASE("on a belt friction slides also at rest") {
  const ModelText m(
      "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nV = 2 x^2 + z\n"
      "contact z >= 0 friction 0.3 static 0.4 slip x' - 0.2 name belt\n");
  const auto found = rests(m);
  REQUIRE(found.size() == 1);
  CHECK(found[0].text == "belt sliding −");
  CHECK(found[0].study.entries.at(0).equilibrium.point.q[0] == doctest::Approx(0.075).epsilon(1e-12));
}

TEST_CASE("a contact that balanced forces leave without pressing does not count as closed; one that presses holds") {
  // The spring from above carries the ball, 9.81 = k 0.2, to rounding; with a weaker one the floor carries the rest.
  const auto ball = [](const std::string& k) {
    return ModelText("param m = 1 kg, k = " + k +
                     " N/m, g = 9.81 m/s^2\ncoord y : length\npoint C mass m at (0, y)\ngravity (0, -g)\n"
                     "point W at (0, 1 m)\nspring W - C stiffness k length 0.8 m\ncontact y >= 0 m name floor\n");
  };
  for (const RestingMode& mode : rests(ball("49.05"))) CHECK(mode.text != "floor");
  bool holds = false;
  for (const RestingMode& mode : rests(ball("24.525"))) {
    if (mode.text != "floor") continue;
    holds = true;
    REQUIRE(mode.study.entries.size() == 1);
    CHECK(mode.study.entries[0].equilibrium.point.multipliers[0] == doctest::Approx(4.905).epsilon(1e-12));
    CHECK(mode.study.entries[0].analysis.stability.verdict == Stability::Energetic);
  }
  CHECK(holds);
}

TEST_CASE("a box on a rough slope rests on two feet wherever some forces within the limits of friction hold it") {
  // The shortest forces share the friction equally, which the upper foot alone cannot; together they can to tan α.
  const auto flat = [](const char* friction) {
    const std::string rubs = std::string(" friction ") + friction + " slip x' + ";
    const ModelText m(
        "dimensionless\nparam α = 0.35\ncoord x, z : number, θ : angle\n"
        "T = 1/2 (x'^2 + z'^2) + 1/12 θ'^2\nV = x sin α + z cos α\n"
        "contact z - 1/2 (cos θ + sin θ) >= 0" +
        rubs +
        "1/2 (cos θ + sin θ) θ' name left\n"
        "contact z - 1/2 (cos θ - sin θ) >= 0" +
        rubs + "1/2 (cos θ - sin θ) θ' name right\n");
    std::optional<RestingMode> out;
    Diagnostics told;  // E1308 where it rests nowhere
    for (RestingMode& mode : rests(m, told))
      if (mode.text == "left sticking, right sticking") out = std::move(mode);
    return out;
  };
  for (const char* friction : {"0.8", "0.5", "0.37"}) {
    CAPTURE(friction);
    const auto held = flat(friction);
    REQUIRE(held);
    CHECK(held->forces_are_open.at(0));
    CHECK(held->study.entries.at(0).equilibrium.point.q[2] == 0);
    double friction_force = 0;
    for (const StaticHold& h : held->holds.at(0)) {
      CHECK(h.force <= h.limit);
      friction_force += h.force;
    }
    CHECK(friction_force == doctest::Approx(std::sin(0.35)).epsilon(1e-12));
  }
  CHECK_FALSE(flat("0.36"));  // tan 0.35 = 0.365
}

TEST_CASE("legs that the balance leaves open press wherever they can, also where the shortest forces would pull") {
  // Equal legs at −1, 0.8, 1 under a load at −0.9 share it with −0.019 on the last one by least squares.
  const auto plate = [](const char* load) {
    return ModelText(std::string("dimensionless\ncoord x, z : number, θ : angle\nT = 1/2 (x'^2 + z'^2 + θ'^2)\n"
                                 "V = x^2 + z + ") +
                     load +
                     " sin θ\ncontact z - sin θ >= 0 name a\n"
                     "contact z + 0.8 sin θ >= 0 name b\ncontact z + sin θ >= 0 name c\n");
  };
  bool rests_flat = false;
  for (const RestingMode& mode : rests(plate("(-0.9)"))) {
    if (mode.text != "a, b, c") continue;
    const std::vector<double>& force = mode.study.entries.at(0).equilibrium.point.multipliers;
    rests_flat = mode.study.entries[0].equilibrium.point.q[2] == 0;
    CHECK(mode.forces_are_open.at(0));
    for (const double x : force) CHECK(x > 1e-9);
    CHECK(force[0] + force[1] + force[2] == doctest::Approx(1).epsilon(1e-12));
    CHECK(-force[0] + 0.8 * force[1] + force[2] == doctest::Approx(-0.9).epsilon(1e-12));
  }
  CHECK(rests_flat);
  for (const RestingMode& mode : rests(plate("(-1.1)"))) CHECK(mode.text != "a, b, c");
}

TEST_CASE("one pose is said once, with all contacts that touch there") {
  // On its legs and on its back; c0, c1, c2 alone balance it too, and sin π is rounding of the gap of c3.
  std::string text = "dimensionless\ncoord x, z : number, θ : angle\nT = 1/2 (x'^2 + z'^2) + 1/24 θ'^2\nV = x^2 + z\n";
  for (const char* leg : {"-1/2", "-1/6", "1/6", "1/2"}) text += std::string("contact z + (") + leg + ") sin θ >= 0\n";
  std::size_t flat = 0;
  for (const RestingMode& mode : rests(ModelText(text))) {
    const auto closed = std::count(mode.mode.closed.begin(), mode.mode.closed.end(), true);
    CHECK((closed == 1 || closed == 4));
    if (closed == 4) flat += mode.study.entries.size();
  }
  CHECK(flat == 2);
}

TEST_CASE("of many contacts those are looked at that touch at the start, or below it, and all together") {
  // Six blocks stand on the floor, springs carry c and g above it.
  const auto blocks = [](double height) {
    std::string text = "dimensionless\ncoord x : number\n", kinetic = "T = 1/2 x'^2", potential = "V = x^2", contacts;
    for (const char c : std::string("abcdefgh")) {
      const std::string z = std::string("z_") + c;
      text += "coord " + z + " : number\n";
      kinetic += " + 1/2 " + z + "'^2";

      const bool carried = c == 'c' || c == 'g';
      potential += carried ? " + (" + z + " - 1)^2" : " + " + z;
      contacts += "contact " + z + " >= 0 name on_" + c + "\n";
    }
    const ModelText m(text + kinetic + "\n" + potential + "\n" + contacts);
    Diagnostics told;
    std::vector<double> q(9, height), v(9, 0.0);
    return resting_modes(*m.system, {0, q, v}, told);
  };
  for (const double height : {0.0, 5.0}) {
    CAPTURE(height);
    const RestingModes rests = blocks(height);
    REQUIRE(rests.found.size() == 1);
    CHECK(rests.found[0].text == "on_a, on_b, on_d, on_e, on_f, on_h");
    CHECK(rests.sets == 256);
    CHECK(rests.sets_looked_at == 64);
    CHECK_FALSE(rests.all_sets());
  }
}

TEST_CASE("a ladder between rough walls rests where it stands: the shortest of its open forces has a 0 in it") {
  const auto ladder = [](double angle) {
    const ModelText m(
        "dimensionless\ncoord x, y : number, θ : angle\nT = 1/2 (x'^2 + y'^2) + 1/24 θ'^2\nV = y\n"
        "contact y - 1/2 sin θ >= 0 friction 0.4 slip x' - 1/2 sin θ θ' name floor\n"
        "contact x - 1/2 cos θ >= 0 friction 0.3 slip y' + 1/2 cos θ θ' name wall\n");
    Diagnostics told;
    std::vector<double> q{0.5 * std::cos(angle), 0.5 * std::sin(angle), angle}, v(3, 0.0);
    for (RestingMode& mode : resting_modes(*m.system, {0, q, v}, told).found)
      if (mode.text == "floor sticking, wall sticking") return std::optional(std::move(mode));
    return std::optional<RestingMode>();
  };
  const auto held = ladder(1);
  REQUIRE(held);
  CHECK(held->study.entries.at(0).equilibrium.point.q[2] == doctest::Approx(1).epsilon(1e-12));
  CHECK(held->forces_are_open.at(0));
  // Where it cannot stand, at 0.7 rad, steeper places are found.
  const auto steeper = ladder(0.7);
  REQUIRE(steeper);
  CHECK(steeper->study.entries.at(0).equilibrium.point.q[2] > std::atan(0.88 / 0.8));
  // Down to tan θ = (1 - μ μ_w) / (2 μ) with the friction of both at its limit.
  REQUIRE(held->ranges.at(0));
  CHECK(held->ranges[0]->coordinate == 0);
  CHECK(held->ranges[0]->to == doctest::Approx(0.5 * std::cos(std::atan(0.88 / 0.8))).epsilon(1e-9));
}

TEST_CASE("E1308 claims no more than was looked at") {
  const auto message = [](const std::string& names) {
    std::string text = "dimensionless\n", kinetic = "T = 0", potential = "V = 0", contacts;
    for (const char c : names) {
      const std::string z = std::string("z_") + c;
      text += "coord " + z + " : number\n";
      kinetic += " + 1/2 " + z + "'^2";
      potential += " - " + z;  // away from the floor
      contacts += "contact " + z + " >= 0\n";
    }
    Diagnostics told;
    CHECK(rests(ModelText(text + kinetic + "\n" + potential + "\n" + contacts), told).empty());
    REQUIRE(told.items().size() == 1);
    CHECK(told.items().front().code == "E1308");
    return told.items().front().message;
  };
  CHECK(message("abcdef") == "no point of rest was found in any mode of the contacts");
  CHECK(message("abcdefg") ==
        "no point of rest was found in the 64 of 128 sets of closed contacts that were looked at");
}

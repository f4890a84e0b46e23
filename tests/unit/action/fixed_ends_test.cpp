#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <algorithm>

using namespace maupertuis;

namespace {

const char* oscillator = R"(
system oscillator
dimensionless
param m = 1, w = 1.3
coord x : number
T = 1/2 m x'^2
V = 1/2 m w^2 x^2
)";

double oscillator_action(double w, double T, double a, double b) {
  return w / (2 * std::sin(w * T)) * ((a * a + b * b) * std::cos(w * T) - 2 * a * b);
}

}  // namespace

TEST_CASE("the action of the harmonic oscillator in closed form, and its index by both counts") {
  const ModelText m(oscillator);
  for (const double halves : {0.5, 1.5, 2.5, 7.3}) {
    CAPTURE(halves);
    const double T = halves * pi / 1.3;
    const PathSearch found = paths_of(m, fixed_ends({0.4}, 0, {-1.1}, T));
    REQUIRE(found.paths.size() == 1);
    const StationaryPath& p = found.paths.front();
    const double S = oscillator_action(1.3, T, 0.4, -1.1);
    CHECK(p.action == doctest::Approx(S).epsilon(1e-12));
    CHECK(std::abs(p.action - S) <=
          p.action_error + 1e-15 * std::abs(S) / std::abs(std::sin(1.3 * T)));  // S itself is rounded
    CHECK(p.check.done);
    CHECK(p.check.missed < 1e-9);
    CHECK(p.check.action == doctest::Approx(S).epsilon(1e-9));
    const auto index = static_cast<std::size_t>(std::ceil(halves) - 1);
    REQUIRE(p.second.index);
    CHECK(*p.second.by_inertia == index);
    CHECK(*p.second.by_fields == index);
    CHECK(p.second.nullity == 0);
    REQUIRE(p.second.conjugate.size() == index);
    for (std::size_t k = 0; k < index; ++k) {
      CHECK(p.second.conjugate[k].t == doctest::Approx((static_cast<double>(k) + 1) * pi / 1.3).epsilon(1e-11));
      CHECK(p.second.conjugate[k].multiplicity == 1);
    }
    CHECK(kind_of(p.second) == (index == 0 ? "minimum" : "saddle"));
  }
}

TEST_CASE("members of a family are told to be such") {
  const ModelText m(oscillator);
  const PathSearch half_period = paths_of(m, fixed_ends({0}, 0, {0}, pi / 1.3));  // A sin(1.3 t), S = 0
  CHECK(half_period.paths.size() > 1);
  CHECK(half_period.bound.find("members of a family") != std::string::npos);
  const PathSearch shorter = paths_of(m, fixed_ends({0}, 0, {0}, 2));
  CHECK(shorter.bound.find("family") == std::string::npos);
}

TEST_CASE("the reference value of action_harmonic, and dS/dx2 = p, -dS/dT = E by differences") {
  const ModelText m(oscillator);
  const auto S = [&](double x, double T) { return paths_of(m, fixed_ends({0.4}, 0, {x}, T)).paths.at(0); };
  const StationaryPath p = S(-1.1, 2);
  CHECK(p.action == doctest::Approx(-0.3706283733057027281).epsilon(1e-13));
  const double h = 1e-4;
  CHECK((S(-1.1 + h, 2).action - S(-1.1 - h, 2).action) / (2 * h) == doctest::Approx(p.end_momentum[0]).epsilon(1e-7));
  CHECK(-(S(-1.1, 2 + h).action - S(-1.1, 2 - h).action) / (2 * h) == doctest::Approx(*p.end_energy).epsilon(1e-7));
  CHECK(*p.start_energy == doctest::Approx(*p.end_energy).epsilon(1e-10));
}

TEST_CASE("swings of a pendulum that are back after 7 s: six amplitudes, both ways, and rest" *
          doctest::skip(under_sanitizers)) {
  const ModelText m(R"(
system pendulum
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord θ : angle
T = 1/2 m l^2 θ'^2
V = -m g l cos θ
)");
  ActionOptions options;
  options.paths = 20;
  Diagnostics unheard;
  const auto found = stationary_paths(m.model, m.equations, fixed_ends({0}, 0, {0}, 7), options, unheard);
  REQUIRE(found);
  CHECK(found->paths.size() == 13);  // 7 s are k half periods, k = 1 … 6, of no less than 1.003 s each
}

TEST_CASE("the pendulum from 0 to 0 in 7 s has five paths") {
  const ModelText m(R"(
system pendulum
dimensionless
coord θ : angle
T = 1/2 θ'^2
V = -cos θ
)");
  const PathSearch found = paths_of(m, fixed_ends({0}, 0, {0}, 7));
  REQUIRE(found.paths.size() == 5);
  std::vector<std::size_t> indices;
  for (const StationaryPath& p : found.paths) {
    REQUIRE(p.second.index);
    indices.push_back(*p.second.index);
  }
  std::sort(indices.begin(), indices.end());
  CHECK(indices == std::vector<std::size_t>{0, 0, 1, 1, 2});
}

TEST_CASE("paths of several arcs through a kink: S = -T^3/(24 n^2), none of the first is lost") {
  const ModelText m("system v\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - abs(x)\n");
  Diagnostics diagnostics;
  const auto found = stationary_paths(m.model, m.equations, fixed_ends({0}, 0, {0}, 10), {}, diagnostics);
  REQUIRE(found);
  REQUIRE(found->paths.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    const double arcs = static_cast<double>(i / 2 + 1);  // each up first, and down first
    CHECK(std::abs(found->paths[i].action + 1000 / (24 * arcs * arcs)) < 1e-12);
    CHECK(std::abs(found->paths[i].start_velocity[0]) == doctest::Approx(5 / arcs).epsilon(1e-12));
  }
  CHECK(found->bound.find("8 with the smallest action are shown. ") != std::string::npos);
  CHECK(found->bound.find("tell apart no more than these") != std::string::npos);
}

TEST_CASE("shots of a catenary that all escape to one side are not halved: no more than twice the even ones") {
  const ModelText m("system c\ndimensionless\nindependent x : number\ncoord y : number\nL = y sqrt(1 + y'^2)\n");
  const PathSearch found = paths_of(m, fixed_ends({1}, -0.5, {1}, 0.5));
  REQUIRE(found.paths.size() == 2);
  // y = c cosh(x/c) with c cosh(1/(2c)) = 1, both roots: S = (c² sinh(1/c) + c)/2
  for (const auto& [path, c] : {std::pair{0, 0.848337938094979}, std::pair{1, 0.2350949902345327}})
    CHECK(found.paths[static_cast<std::size_t>(path)].action ==
          doctest::Approx((c * c * std::sinh(1 / c) + c) / 2).epsilon(1e-12));
  CHECK(std::stoi(found.bound) > 400);
  CHECK(std::stoi(found.bound) < 802);
}

TEST_CASE("a path through a kink gets no index, and the search says what it may miss") {
  const ModelText m("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = abs(x)\n");
  Diagnostics told;
  const auto through = stationary_paths(m.model, m.equations, fixed_ends({1}, 0, {-1}, 2), {}, told);
  REQUIRE(through);
  for (const StationaryPath& p : through->paths) {
    CHECK_FALSE(p.second.index);
    CHECK(p.second.reason.find("kink of L, x = 0,") != std::string::npos);
    CHECK(kind_of(p.second) == "stationary");
  }
  REQUIRE(told.items().size() == 1);
  CHECK(told.items()[0].code == "W1202");
  // Beside the kink all is as ever: x'' = -1 up to x > 0 all along.
  const auto beside = stationary_paths(m.model, m.equations, fixed_ends({1}, 0, {1}, 1), {}, told);
  REQUIRE(beside);
  const bool minimum = std::any_of(beside->paths.begin(), beside->paths.end(),
                                   [](const StationaryPath& p) { return p.second.index == 0u; });
  CHECK(minimum);
  // max(x, 0)^2 has a continuous derivative: no kink.
  const ModelText smooth("dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = max(x, 0)^2\n");
  const PathSearch found = paths_of(smooth, fixed_ends({1}, 0, {-1}, 1));
  CHECK(found.paths.front().second.index == 0u);
}

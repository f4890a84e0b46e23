#include "support.hpp"

#include <cstdint>

using namespace maupertuis;

namespace {

const char* const brachistochrone = R"(
system brachistochrone
dimensionless
param g = 9.81
coord y : number
L = sqrt((1 + y'^2) / (2 g y))
)";

}  // namespace

TEST_CASE("the long way round the sphere is a saddle of index 1") {
  const ModelText m(R"(
system sphere
dimensionless
coord θ, φ : angle
L = 1/2 (θ'^2 + sin(θ)^2 φ'^2)
)");
  const double a = 1.2, b = 1.3, dphi = 4;
  const double d = std::acos(std::cos(a) * std::cos(b) + std::sin(a) * std::sin(b) * std::cos(dphi));
  const PathSearch found = paths_of(m, fixed_ends({a, 0}, 0, {b, dphi}, 1));
  bool long_way = false;
  for (const StationaryPath& p : found.paths) {
    REQUIRE(p.second.index);
    if (std::abs(std::sqrt(2 * p.action) - (2 * pi - d)) > 1e-9) continue;
    long_way = true;
    CHECK(*p.second.index == 1);
    REQUIRE(p.second.conjugate.size() == 1);
    CHECK(p.second.conjugate[0].t == doctest::Approx(pi / (2 * pi - d)).epsilon(1e-10));
  }
  CHECK(long_way);
}

TEST_CASE("the sphere by a constraint gives the paths and indices of its coordinates") {
  const ModelText m(R"(
system sphere
dimensionless
coord x, y, z : number
T = 1/2 (x'^2 + y'^2 + z'^2)
constraint x^2 + y^2 + z^2 = 1 name sphere
)");
  const double a = 1.2, b = 1.3, dphi = 4;
  const auto at = [](double theta, double phi) {
    return std::vector<double>{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  const double d = std::acos(std::cos(a) * std::cos(b) + std::sin(a) * std::sin(b) * std::cos(dphi));
  const PathSearch found = paths_of(m, fixed_ends(at(a, 0), 0, at(b, dphi), 1));
  REQUIRE(found.paths.size() >= 2);
  std::size_t seen = 0;
  for (const StationaryPath& p : found.paths) {
    const double length = std::sqrt(2 * p.action);
    const double turns = std::round((length - d) / (2 * pi)), back = std::round((length + d) / (2 * pi));
    const bool direct = std::abs(length - d - turns * 2 * pi) < 1e-8;
    CHECK((direct || std::abs(length + d - back * 2 * pi) < 1e-8));
    REQUIRE(p.second.index);
    CHECK(*p.second.index == static_cast<std::size_t>(std::floor(length / pi)));
    ++seen;
  }
  CHECK(seen == found.paths.size());
}

TEST_CASE("conjugate points of two equal freedoms are double") {
  const ModelText m(R"(
system isotropic
dimensionless
coord x, y : number
L = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + y^2)
)");
  const PathSearch found = paths_of(m, fixed_ends({1, 0}, 0, {0.3, 0.7}, 2.5 * pi));
  REQUIRE(found.paths.size() == 1);
  const SecondVariation& s = found.paths[0].second;
  REQUIRE(s.index);
  CHECK(*s.index == 4);
  REQUIRE(s.conjugate.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(s.conjugate[k].multiplicity == 2);
    CHECK(s.conjugate[k].t == doctest::Approx((static_cast<double>(k) + 1) * pi).epsilon(1e-11));
  }
}

TEST_CASE("two different freedoms: each adds its own conjugate points") {
  const ModelText m(R"(
system anisotropic
dimensionless
coord x, y : number
L = 1/2 (x'^2 + y'^2) - 1/2 (x^2 + 4 y^2)
)");
  const PathSearch found = paths_of(m, fixed_ends({1, 0}, 0, {0.3, 0.7}, 2.3 * pi));
  REQUIRE(found.paths.size() == 1);
  const SecondVariation& s = found.paths[0].second;
  REQUIRE(s.index);
  CHECK(*s.index == 2 + 4);  // at π and 2π both, at π/2 and 3π/2 the second alone
  CHECK(s.conjugate.size() == 4);
}

TEST_CASE("half a period of the oscillator back to its mirror is degenerate, elsewhere not reachable") {
  const ModelText m(R"(
system oscillator
dimensionless
coord x : number
L = 1/2 x'^2 - 1/2 x^2
)");
  const PathSearch found = paths_of(m, fixed_ends({0.4}, 0, {-0.4}, pi));
  REQUIRE_FALSE(found.paths.empty());
  CHECK(kind_of(found.paths[0].second) == "degenerate");
  CHECK(found.paths[0].second.nullity == 1);
  CHECK(code_of_search(m, fixed_ends({0.4}, 0, {0.7}, pi)) == "E1204");
}

TEST_CASE("a straight line past the origin of polar coordinates takes less than half a turn; with more there is none") {
  ModelText m("dimensionless\ncoord r, φ : number\nL = 1/2 (r'^2 + r^2 φ'^2)\n");
  for (const double angle : {3.0, 3.14}) {
    Diagnostics diagnostics;
    const auto found = stationary_paths(m.model, m.equations, fixed_ends({1, 0}, 0, {1, angle}, 1), {}, diagnostics);
    REQUIRE(found);
    REQUIRE(found->paths.size() == 1);
    CHECK(found->paths[0].action == doctest::Approx(2 * std::pow(std::sin(angle / 2), 2)).epsilon(1e-12));
  }
  for (const double angle : {3.15, 4.0, 7.0}) CHECK(code_of_search(m, fixed_ends({1, 0}, 0, {1, angle}, 1)) == "E1204");
}

TEST_CASE("the brachistochrone from rest to a vertical line, which it meets at a right angle") {
  const ModelText m(brachistochrone);
  ActionEnds ends = fixed_ends({0}, 0, {0}, pi);
  ends.to[0].reset();
  const PathSearch found = paths_of(m, ends);
  REQUIRE(found.paths.size() == 1);
  const StationaryPath& p = found.paths[0];
  CHECK(p.action == doctest::Approx(pi / std::sqrt(9.81)).epsilon(1e-10));  // half the arch of a wheel of radius 1
  CHECK(p.path.at(pi).q[0] == doctest::Approx(2).epsilon(1e-8));
  CHECK(kind_of(p.second) == "minimum");
}

TEST_CASE("the brachistochrone, from a point of the cycloid") {
  const ModelText m(brachistochrone);
  // The cycloid x = a − sin a, y = 1 − cos a is run through in a time proportional to a.
  const double first = 0.3;
  const PathSearch found = paths_of(m, fixed_ends({1 - std::cos(first)}, first - std::sin(first), {2}, pi));
  REQUIRE(found.paths.size() == 1);
  const StationaryPath& p = found.paths[0];
  CHECK(p.action == doctest::Approx((pi - first) / std::sqrt(9.81)).epsilon(1e-11));
  REQUIRE(p.second.index);
  CHECK(*p.second.index == 0);
  for (const double a : {0.5, 1.5, 2.5})
    CHECK(p.path.at(a - std::sin(a)).q[0] == doctest::Approx(1 - std::cos(a)).epsilon(1e-9));
}

TEST_CASE("the brachistochrone from rest, where L is infinite") {
  const ModelText m(brachistochrone);
  const PathSearch found = paths_of(m, fixed_ends({0}, 0, {2}, pi));
  REQUIRE(found.paths.size() == 1);
  const StationaryPath& p = found.paths[0];
  CHECK(p.action == doctest::Approx(pi / std::sqrt(9.81)).epsilon(1e-12));
  CHECK(p.action_error < 1e-11);
  CHECK(p.second.by_inertia == std::optional<std::size_t>(0));
  for (const double a : {0.01, 0.5, 1.5, 2.5})
    CHECK(p.path.at(a - std::sin(a)).q[0] == doctest::Approx(1 - std::cos(a)).epsilon(1e-9));
  // The other way round, and up to rest: the same cycloid.
  const PathSearch back = paths_of(m, fixed_ends({2}, -pi, {0}, 0));
  REQUIRE(back.paths.size() == 1);
  CHECK(back.paths[0].action == doctest::Approx(pi / std::sqrt(9.81)).epsilon(1e-12));
}

TEST_CASE("the catenary: one multiplier for the whole path, both counts with the length held") {
  const ModelText m(R"(
system chain
dimensionless
param l = 3
coord y : number
L = y sqrt(1 + y'^2)
constraint integral sqrt(1 + y'^2) = l name rope
)");
  // y = c cosh(t / c) − λ with 2 c sinh(1 / c) = 3.
  double c = 0.7;
  for (int turn = 0; turn < 60; ++turn) {
    const double f = 2 * c * std::sinh(1 / c) - 3, slope = 2 * std::sinh(1 / c) - 2 / c * std::cosh(1 / c);
    c -= f / slope;
  }
  const double lambda = c * std::cosh(1 / c);
  const PathSearch found = paths_of(m, fixed_ends({0}, -1, {0}, 1));
  const StationaryPath& p = found.paths.front();
  CHECK(p.path.at(0).q[0] == doctest::Approx(c - lambda).epsilon(1e-9));
  REQUIRE(p.multipliers.size() == 1);
  CHECK(p.multipliers[0] == doctest::Approx(lambda).epsilon(1e-9));
  REQUIRE(p.second.index);
  CHECK(*p.second.index == 0);
}

TEST_CASE("S along formulas: the free particle of SICM, a path that misses its ends, a singular end") {
  const ModelText m(R"(
system particle
dimensionless
param m = 3
coord x, y, z : number
T = 1/2 m (x'^2 + y'^2 + z'^2)
expect action of (4 t + 7, 3 t + 5, 2 t + 1) from 0 to 10 = 435 ± 1e-10
expect action of (4 t + 7 + 1/1000 t (t - 10) sin t, 3 t + 5 + 1/1000 t (t - 10) cos t, 2 t + 1 + )"
                    R"(1/1000 t (t - 10) t^2) from 0 to 10 = 436.29121428571428571 ± 1e-10
)");
  Diagnostics diagnostics;
  const double wanted[] = {435, 436.29121428571428571};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto found = action_of_path(
        m.model, m.equations, std::get<expectation::ActionAlong>(m.model.experiment.expectations[k].kind).along.q, 0,
        10, std::nullopt, {}, diagnostics);
    REQUIRE(found);
    CHECK(found->action == doctest::Approx(wanted[k]).epsilon(1e-13));
    CHECK(found->stationary == (k == 0));
  }
  CHECK_FALSE(action_of_path(m.model, m.equations,
                             std::get<expectation::ActionAlong>(m.model.experiment.expectations[0].kind).along.q, 0, 10,
                             fixed_ends({7, 5, 1}, 0, {47, 35, 22}, 10), {}, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  CHECK(diagnostics.items().front().code == "E1205");
}

TEST_CASE("a free end: the momentum vanishes there, and its freedom adds to the index") {
  const ModelText m("system o\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\n");
  for (const double halves : {0.3, 0.8, 1.7}) {
    ActionEnds ends = fixed_ends({1}, 0, {0}, halves * pi);
    ends.to[0].reset();
    const PathSearch found = paths_of(m, ends);
    REQUIRE(found.paths.size() == 1);
    CHECK(std::abs(found.paths[0].end_momentum[0]) < 1e-9);
    REQUIRE(found.paths[0].second.index);
    // Fixed at 0, free at T: eigenvalues 1 − (T / ((k − ½) π))²
    CHECK(*found.paths[0].second.index == static_cast<std::size_t>(std::floor(halves + 0.5)));
  }
}

TEST_CASE("a closed orbit of the pendulum: both counts agree, and the abbreviated action is that of the orbit") {
  const ModelText m("system p\ndimensionless\ncoord θ : angle\nT = 1/2 θ'^2\nV = -cos θ\nstart θ = 1\nrun 10\n");
  Diagnostics diagnostics;
  const auto found = action_of_orbit(m.model, m.equations, std::nullopt, {}, diagnostics);
  REQUIRE(found);
  REQUIRE(found->path.second.by_inertia);
  CHECK(found->path.second.nullity == 1);  // the same orbit, begun later
  REQUIRE(found->path.second.index);
  // ∮ p dq = 4 ∫ √(2 (cos θ − cos 1)) dθ over [0, 1] = 16 (E(k) − (1 − k²) K(k)), k = sin ½
  const double k = std::sin(0.5);
  CHECK(found->abbreviated ==
        doctest::Approx(16 * (std::comp_ellint_2(k) - (1 - k * k) * std::comp_ellint_1(k))).epsilon(1e-10));
}

TEST_CASE("along the motion: a minimum up to the first conjugate point") {
  const ModelText m(
      "system o\ndimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2\nstart x = 1, x' = 0.3\nrun 5\n");
  Diagnostics diagnostics;
  const auto found = action_of_motion(m.model, m.equations, {}, diagnostics);
  REQUIRE(found);
  REQUIRE(found->path.second.index);
  CHECK(*found->path.second.index == 1);
  CHECK(found->path.second.conjugate.at(0).t == doctest::Approx(pi).epsilon(1e-11));
  const double x = std::cos(5) + 0.3 * std::sin(5);
  CHECK(found->path.action ==
        doctest::Approx(1 / (2 * std::sin(5)) * ((1 + x * x) * std::cos(5) - 2 * x)).epsilon(1e-11));
}

TEST_CASE("random quadratic actions: both counts agree") {
  std::uint64_t seed = 7;
  const auto random = [&] {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(seed >> 11) / 9007199254740992.0 - 0.5;
  };
  std::size_t largest = 0;
  for (int trial = 0; trial < (under_sanitizers ? 4 : 12); ++trial) {
    const ModelText m("system r\ndimensionless\nparam a = " + std::to_string(1.3 + random()) +
                      ", b = " + std::to_string(random()) + ", c = " + std::to_string(8 * random()) +
                      ", d = " + std::to_string(8 * random()) + ", e = " + std::to_string(4 * random()) +
                      ", g = " + std::to_string(2 * random()) +
                      "\ncoord x, y : number\nL = 1/2 (a x'^2 + 2 b x' y' + y'^2) - 1/2 (c x^2 + 2 e x y + d y^2) + g "
                      "(x y' - y x')\n");
    const PathSearch found = paths_of(m, fixed_ends({random(), random()}, 0, {random(), random()}, 4 + 3 * random()));
    REQUIRE(found.paths.size() == 1);
    REQUIRE(found.paths[0].second.index);
    largest = std::max(largest, *found.paths[0].second.index);
  }
  CHECK(largest >= 2);
}

TEST_CASE("what has no action, ends off the constraints, ends in the wrong order") {
  const ModelText damped("system d\ndimensionless\ncoord x : number\nL = 1/2 x'^2\nD = 1/2 x'^2\n");
  CHECK(code_of_search(damped, fixed_ends({0}, 0, {1}, 1)) == "E1201");
  const ModelText knife(
      "system k\ndimensionless\ncoord x, y, φ : number\nT = 1/2 (x'^2 + y'^2 + φ'^2)\nconstraint x' sin φ = y' cos "
      "φ\n");
  CHECK(code_of_search(knife, fixed_ends({0, 0, 0}, 0, {1, 0, 0}, 1)) == "E1201");
  for (const char* held : {"constraint x = 1/2\nconstraint x + y = 1\n", "constraint x = t\nconstraint y = 2 t\n"}) {
    const ModelText given("system g\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n" + std::string(held));
    CHECK(code_of_search(given, fixed_ends({0.5, 0.5}, 0, {0.5, 0.5}, 1)) == "E1201");
  }
  const ModelText circle(
      "system c\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nconstraint x^2 + y^2 = 1 name ring\n");
  CHECK(code_of_search(circle, fixed_ends({1, 0}, 0, {1, 1}, 1)) == "E1202");
  CHECK(code_of_search(circle, fixed_ends({1, 0}, 1, {0, 1}, 0)) == "E1203");
  CHECK(code_of_search(circle, fixed_ends({1, 0}, -1.5e308, {0, 1}, 1.5e308)) == "E1203");
}

TEST_CASE("neighbours of a rest that swing many times are counted to the end, by elements that follow them too") {
  // x has a conjugate point every half period π/√2; y and z, which are free, have none.
  for (const double end : {100.0, 3000.0}) {
    if (under_sanitizers && end > 100) break;
    const ModelText m("system o\ndimensionless\ncoord x, y, z : number\nL = 1/2 x'^2 + y'^2 + z'^2 - x^2\nrun " +
                      std::to_string(end) + "\n");
    Diagnostics diagnostics;
    const auto found = action_of_motion(m.model, m.equations, {}, diagnostics);
    REQUIRE(found);
    const auto count = static_cast<std::size_t>(end * std::sqrt(2.0) / pi);
    const SecondVariation& second = found->path.second;
    REQUIRE(second.conjugate.size() == count);
    CHECK(second.conjugate.back().t ==
          doctest::Approx(static_cast<double>(count) * pi / std::sqrt(2.0)).epsilon(1e-11));
    REQUIRE(second.by_inertia);
    CHECK(*second.by_inertia == count);
    CHECK(diagnostics.items().empty());
  }
}

TEST_CASE(
    "conjugate points of a double pendulum: det ∂q/∂q̇(0) of differences in 113 bits changes its sign at "
    "3.935433753879") {
  for (const std::string run : {"5.3", "6"}) {
    if (under_sanitizers && run == "6") break;
    const ModelText m(
        "system dp\ndimensionless\ncoord a, b : angle\nL = a'^2 + 1/2 b'^2 + a' b' cos(a - b) + 9.81 (2 cos a + cos "
        "b)\n"
        "start a = 1.2, b = -0.4\nrun " +
        run + "\n");
    Diagnostics diagnostics;
    const auto found = action_of_motion(m.model, m.equations, {}, diagnostics);
    REQUIRE(found);
    REQUIRE(found->path.second.conjugate.size() == 10);
    CHECK(std::abs(found->path.second.conjugate[6].t - 3.935433753879) < 1e-10);
  }
}

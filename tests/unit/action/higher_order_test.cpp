// Paths of Lagrangians that hold q'': static beams, splines and Pais-Uhlenbeck oscillators between two ends.
#include "support.hpp"

#include <maupertuis/degenerate.hpp>

#include <fmt/format.h>

#include <array>
#include <functional>

using namespace maupertuis;

namespace {

ModelText with_motion(const std::string& text) {
  ModelText m("system paths\ndimensionless\n" + text);
  auto analysis =
      std::make_shared<const DegenerateAnalysis>(analyse_degenerate(m.equations, generic_state(m.model), true));
  auto determined = determined_equations(m.equations, *analysis);
  REQUIRE(determined);
  m.equations.degenerate = analysis;
  m.equations.determined = std::make_shared<const EquationsOfMotion>(std::move(*determined));
  return m;
}

StationaryPath only_path(const std::string& text) {
  const ModelText m = with_motion(text);
  REQUIRE(m.model.experiment.path);
  const PathSearch found = paths_of(m, ends_of(m.model));
  REQUIRE(found.paths.size() == 1);
  const StationaryPath& p = found.paths.front();
  CHECK(p.check.done);
  CHECK(p.check.missed < 1e-9);
  CHECK(p.check.action == doctest::Approx(p.action).epsilon(1e-9));
  for (const TestVariation& v : p.second.variations) CHECK(std::abs(v.slope) < 1e-9);
  return p;
}

double value(const StationaryPath& p, double t) { return p.path.at(t).q.front(); }

/// ½ EI v''² − w v from x = 0 to l.
std::string beam(const std::string& left, const std::string& right, double stiffness, double load, double length) {
  return fmt::format(
      "independent x : number\ncoord v : number\nparam EI = {:.17g}, w = {:.17g}, l = {:.17g}\nL = 1/2 EI v''^2 - w "
      "v\npath from ({}) at 0 to ({}) at l\n",
      stiffness, load, length, left, right);
}

/// ½ v''² − ½ k² v'² − w v from x = 0 to 1: a column of the load k² that bends the more, or not at all.
StationaryPath column(const std::string& left, const std::string& right, double k) {
  return only_path(
      fmt::format("independent x : number\ncoord v : number\nparam k = {:.17g}\nL = 1/2 v''^2 - 1/2 k^2 v'^2 - v\n"
                  "path from ({}) at 0 to ({}) at 1\n",
                  k, left, right));
}

/// The zeros of a function between two places, by halving where it changes sign.
std::vector<double> zeros_of(const std::function<double(double)>& f, double from, double to) {
  std::vector<double> out;
  constexpr int pieces = 1000;
  for (int i = 0; i < pieces; ++i) {
    double low = from + (to - from) * i / pieces, high = from + (to - from) * (i + 1) / pieces;
    if ((f(low) < 0) == (f(high) < 0)) continue;
    for (int turn = 0; turn < 60; ++turn) {
      const double middle = (low + high) / 2;
      ((f(middle) < 0) == (f(low) < 0) ? low : high) = middle;
    }
    out.push_back(low);
  }
  return out;
}

}  // namespace

TEST_CASE("a static beam under its own weight, whatever holds its ends") {
  for (const auto& [stiffness, load, length] :
       {std::array{2.0, 3.0, 1.7}, std::array{5.0e6, 1.2e4, 8.0}, std::array{1e-3, 1e-6, 0.1}}) {
    CAPTURE(stiffness);
    const double unit = load * std::pow(length, 4) / stiffness;
    const auto of = [&](const std::string& left, const std::string& right) {
      return only_path(beam(left, right, stiffness, load, length));
    };
    const StationaryPath clamped = of("v = 0, v' = 0", "v = 0, v' = 0");
    CHECK(value(clamped, length / 2) == doctest::Approx(unit / 384).epsilon(1e-11));
    CHECK(clamped.action == doctest::Approx(-load * load * std::pow(length, 5) / (1440 * stiffness)).epsilon(1e-11));
    CHECK(value(of("v = 0", "v = 0"), length / 2) == doctest::Approx(5 * unit / 384).epsilon(1e-11));
    CHECK(value(of("v = 0, v' = 0", "v = free"), length) == doctest::Approx(unit / 8).epsilon(1e-11));
    const StationaryPath propped = of("v = 0, v' = 0", "v = 0, v' = free");
    const double x = length / 3, s = 1.0 / 3;
    CHECK(value(propped, x) == doctest::Approx(unit * s * s * (1 - s) * (3 - 2 * s) / 48).epsilon(1e-11));
    for (const StationaryPath* p : {&clamped, &propped}) {
      REQUIRE(p->second.index);
      CHECK(*p->second.index == 0);
    }
  }
}

TEST_CASE("shifts and turns of a free beam leave its energy as it is: each counts once") {
  const auto nullity = [](const std::string& left, const std::string& right) {
    const StationaryPath p = only_path("independent x : number\ncoord w : number\nL = 1/2 w''^2\npath from (" + left +
                                       ") at 0 to (" + right + ") at 3\n");
    REQUIRE(p.second.index);
    CHECK(*p.second.index == 0);
    return p.second.nullity;
  };
  CHECK(nullity("w = free, w' = 0", "w = free, w' = 0") == 1);
  CHECK(nullity("w = free, w' = free", "w = free, w' = free") == 2);
  CHECK(nullity("w = free, w' = 0", "w = free, w' = free") == 1);
  CHECK(nullity("w = 0, w' = 0", "w = free, w' = free") == 0);
}

TEST_CASE("the spline between two slopes has the least square of its curvature") {
  const double D = 0.7, v0 = 1.2, v1 = -2.1, T = 1.9;
  const StationaryPath p = only_path(
      fmt::format("coord q : number\nL = 1/2 q''^2\npath from (q = 0.3, q' = {}) at 0 to (q = {}, q' = {}) at {}\n", v0,
                  0.3 + D, v1, T));
  const double S = (2 * (v0 * v0 + v0 * v1 + v1 * v1) / T) - 6 * D * (v0 + v1) / (T * T) + 6 * D * D / (T * T * T);
  CHECK(p.action == doctest::Approx(S).epsilon(1e-13));
  const double s = 0.4, h = s * T;  // Hermite's cubic
  const double at = 0.3 + D * s * s * (3 - 2 * s) + v0 * h * (1 - s) * (1 - s) + v1 * T * s * s * (s - 1);
  CHECK(value(p, h) == doctest::Approx(at).epsilon(1e-13));
  CHECK(kind_of(p.second) == "minimum");
  CHECK(p.end_momentum[0] == doctest::Approx(-(6 * (v0 + v1) * T - 12 * D) / (T * T * T)).epsilon(1e-11));
}

TEST_CASE("an oscillator of Pais and Uhlenbeck between two states, with its conjugate points") {
  const double a = 1, b = 1.7;
  const auto q = [&](double t, int order) {  // 0.4 cos at + 0.3 sin at − 0.2 cos bt + 0.5 sin bt
    const double turn = order * pi / 2;
    return std::pow(a, order) * (0.4 * std::cos(a * t + turn) + 0.3 * std::sin(a * t + turn)) +
           std::pow(b, order) * (-0.2 * std::cos(b * t + turn) + 0.5 * std::sin(b * t + turn));
  };
  const auto half_of_ends = [&](double t) {  // ½ (p₁ q + p₂ q')
    const double p1 = -(a * a + b * b) * q(t, 1) - q(t, 3);
    return (p1 * q(t, 0) + q(t, 2) * q(t, 1)) / 2;
  };
  // Neighbours that leave with the same q and q' are cos at − cos bt and sin at/a − sin bt/b.
  const auto meet = [&](double t) {
    return 2 - 2 * std::cos(a * t) * std::cos(b * t) - (a / b + b / a) * std::sin(a * t) * std::sin(b * t);
  };
  for (const double T : {2.0, 9.0, 16.0}) {
    CAPTURE(T);
    const StationaryPath p = only_path(fmt::format(
        "coord q : number\nparam a = {}, b = {}\nL = 1/2 q''^2 - 1/2 (a^2 + b^2) q'^2 + 1/2 a^2 b^2 q^2\npath from (q "
        "= {:.17g}, q' = {:.17g}) at 0 to (q = {:.17g}, q' = {:.17g}) at {}\n",
        a, b, q(0, 0), q(0, 1), q(T, 0), q(T, 1), T));
    CHECK(value(p, 0.37 * T) == doctest::Approx(q(0.37 * T, 0)).epsilon(1e-10));
    CHECK(p.action == doctest::Approx(half_of_ends(T) - half_of_ends(0)).epsilon(1e-10));
    const std::vector<double> expected = zeros_of(meet, 0.1, T);
    REQUIRE(p.second.index);
    CHECK(*p.second.index == expected.size());
    REQUIRE(p.second.conjugate.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      CHECK(p.second.conjugate[k].t == doctest::Approx(expected[k]).epsilon(1e-9));
  }
}

TEST_CASE("the action along a motion with q'' in L has the index of its conjugate points") {
  // q = 1 + t/5 + cos 2t; neighbours that leave with its q and q' meet it at 2t = 2π and at 2t = tan t
  const ModelText m =
      with_motion("coord q : number\nL = 1/2 q''^2 - 2 q'^2\nstart q = 2, q' = 0.2, q'' = -4, q''' = 0\nrun 5\n");
  Diagnostics diagnostics;
  const auto found = action_of_motion(m.model, m.equations, {}, diagnostics);
  REQUIRE_MESSAGE(found, render(diagnostics, m.source));
  const double S = 2 * std::sin(20) - 0.4 + 0.8 * (1 - std::cos(10));
  CHECK(found->path.action == doctest::Approx(S).epsilon(1e-12));
  const SecondVariation& second = found->path.second;
  REQUIRE(second.index);
  CHECK(*second.index == 2);
  REQUIRE(second.conjugate.size() == 2);
  CHECK(second.conjugate[0].t == doctest::Approx(pi).epsilon(1e-10));
  CHECK(second.conjugate[1].t == doctest::Approx(8.986818915818128 / 2).epsilon(1e-10));
}

TEST_CASE("a column loses its minimum at Euler's load, whatever holds its ends") {
  const std::string held = "v = 0, v' = 0", hinged = "v = 0", free = "v = free";
  const auto index = [](const StationaryPath& p) { return p.second.index ? static_cast<int>(*p.second.index) : -1; };
  CHECK(index(column(held, held, 0.99 * 2 * pi)) == 0);
  CHECK(index(column(held, held, 1.01 * 2 * pi)) == 1);
  CHECK(index(column(held, held, 1.01 * 8.986818915818128)) == 2);
  CHECK(index(column(hinged, hinged, 0.99 * pi)) == 0);
  CHECK(index(column(hinged, hinged, 1.01 * pi)) == 1);
  CHECK(index(column(hinged, hinged, 2.01 * pi)) == 2);
  CHECK(index(column(held, free, 0.99 * pi / 2)) == 0);
  CHECK(index(column(held, free, 1.01 * pi / 2)) == 1);
  CHECK(index(column(held, hinged, 0.99 * 4.493409457909064)) == 0);
  CHECK(index(column(held, hinged, 1.01 * 4.493409457909064)) == 1);
}

TEST_CASE("a coordinate with q'' in L beside one without") {
  // y'' + c q'' = 0 and q'''' = c y'': q = A + B t + C cos ct + D sin ct, y = −c q + α t
  const double c = 1.4, T = 2.3;
  const auto q = [&](double t) { return 0.2 + 0.3 * t + 0.5 * std::cos(c * t) - 0.7 * std::sin(c * t); };
  const auto rate = [&](double t) { return 0.3 - c * (0.5 * std::sin(c * t) + 0.7 * std::cos(c * t)); };
  const auto y = [&](double t) { return -c * q(t) + 0.9 * t; };
  const StationaryPath p = only_path(
      fmt::format("coord y, q : number\nparam c = {}\nL = 1/2 q''^2 + 1/2 y'^2 + c q' y'\npath from (q = {:.17g}, q' = "
                  "{:.17g}, y = {:.17g}) at 0 to (y = {:.17g}, q = {:.17g}, q' = {:.17g}) at {}\n",
                  c, q(0), rate(0), y(0), y(T), q(T), rate(T), T));
  CHECK(p.path.at(1).q[0] == doctest::Approx(y(1)).epsilon(1e-12));
  CHECK(p.path.at(1).q[1] == doctest::Approx(q(1)).epsilon(1e-12));
  REQUIRE(p.second.index);
  CHECK(p.second.variations.size() > 2);
}

TEST_CASE("where the sign of q'' squared is wrong there is no index, and the path is found all the same") {
  const StationaryPath p =
      only_path("coord q : number\nL = -1/2 q''^2 + q\npath from (q = 0, q' = 0) at 0 to (q = 0, q' = 0) at 2\n");
  CHECK(value(p, 1) == doctest::Approx(16.0 / 384).epsilon(1e-12));
  CHECK_FALSE(p.second.index);
  CHECK(p.second.reason.find("∂²L/∂q''∂q''") != std::string::npos);
}

// Rests whose friction several places share: tied together by constraints, many legs of one body.
#include "linear_algebra/resting_forces.hpp"
#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

using namespace maupertuis;

namespace {

constexpr double g = 9.81;

/// Blocks of 1 kg in a row, joined by rods; the first is pulled by A t. `on_floor`: by contacts, not by coordinates.
std::string blocks_on_rods(int n, bool on_floor) {
  std::string coordinates, bodies, frictions, rods, starts;
  for (int i = 0; i < n; ++i) {
    const std::string x = fmt::format("x{}", i), y = fmt::format("y{}", i);
    coordinates += fmt::format("{}{}", i == 0 ? "" : ", ", x);
    if (on_floor) coordinates += ", " + y;
    bodies += fmt::format("point P{} mass m at ({}, {})\n", i, x, on_floor ? y : "0");
    frictions += on_floor ? fmt::format("contact {} >= 0 friction 0.2 static 0.3 slip {}' name f{}\n", y, x, i)
                          : fmt::format("friction {} coefficient 0.2 static 0.3 normal m g\n", x);
    if (i > 0) rods += fmt::format("constraint x{} - x{} = 1 [m] name rod{}\n", i, i - 1, i);
    starts += fmt::format("{}x{} = {} m", i == 0 ? "start " : ", ", i, i);
  }
  return "param m = 1 kg, g = 9.81 m/s^2, A = 1 N/s\ncoord " + coordinates + " : length\n" + bodies +
         (on_floor ? "gravity (0, -g)\n" : "") + frictions + rods + "force on P0 = (A t, 0)\n" + starts + "\n";
}

}  // namespace

TEST_CASE("blocks on rods, one of them pulled, rest until friction of all is overcome") {
  // From t₀ = n μ_s m g/A on n m x'' = A t − n μ m g.
  for (const int n : {2, 3, 8})
    for (const bool on_floor : {false, true}) {
      CAPTURE(n);
      CAPTURE(on_floor);
      const double begins = 0.3 * n * g, end = begins + 2, friction = 0.2 * n * g;
      const auto r = run_text(blocks_on_rods(n, on_floor), end);
      const double speed = ((end * end - begins * begins) / 2 - friction * 2) / n;
      const double way = ((end * end * end - begins * begins * begins) / 6 - begins * begins - 2 * friction) / n;
      CHECK(r.final.v[0] == doctest::Approx(speed).epsilon(1e-11));
      CHECK(r.final.q[0] == doctest::Approx(way).epsilon(1e-11));
      CHECK(count(r, Happening::Kind::Slip) == static_cast<std::size_t>(n));
      for (const Happening& h : r.happenings) CHECK(h.t == doctest::Approx(begins).epsilon(1e-11));
      REQUIRE(!r.remarks.empty());
      CHECK(r.remarks.front().find("statically indeterminate") != std::string::npos);
    }
}

TEST_CASE("what the end of a shared rest leaves open is in the errors, where static friction is more than kinetic") {
  // 3 x'' = A t − 5 N − 6 N from t₀ on, A t₀ = 5 N + 8 N.
  ModelText m(
      "param m = 1 kg, A = 2 N/s\ncoord x1, x2, x3 : length\npoint P1 mass m at (x1, 0)\npoint P2 mass m at (x2, 0)\n"
      "point P3 mass m at (x3, 0)\nfriction x1 limit 1 [N]\nfriction x2 limit 2 [N] static 3 [N]\n"
      "friction x3 limit 3 [N] static 4 [N]\nconstraint x2 - x1 = 1 [m] name r1\nconstraint x3 - x2 = 1 [m] name r2\n"
      "force x1 = A t - 5 [N]\nstart x2 = 1 m, x3 = 2 m\n");
  SimulationOptions options;
  options.duration = 20;
  const auto r = simulate(m.model, m.equations, options, m.diagnostics);
  REQUIRE(r);
  REQUIRE(r->ok());
  REQUIRE(r->final.errors);
  CHECK(std::abs(r->final.v[0] - 69.75) <= 2 * r->final.errors->v[0]);
  CHECK(r->final.errors->v[0] < 1e-10);
  for (const Happening& h : r->happenings) CHECK(std::abs(h.t - 6.5) <= h.error);
}

TEST_CASE("friction of what a constraint holds anyway may be any within its limits") {
  const auto r = run_text(
      "param m = 1 kg\ncoord x, y : length\npoint P mass m at (x, y)\nconstraint x = 0 name pin\n"
      "friction x limit 1 [N]\nforce on P = (2 [N/s] t, 1 [N])\n",
      3);
  CHECK(r.final.q[0] == 0);
  CHECK(r.final.q[1] == doctest::Approx(4.5).epsilon(1e-14));
  CHECK(r.happenings.empty());
}

TEST_CASE("two frictions on one slider by a gear share its limit") {
  // s = 2 x: m x'' = −k x ∓ (1 + 2) N; it stops where k |x| < 3 N.
  const auto r = run_text(
      "param m = 1 kg, k = 10 N/m\ncoord x, s : length\npoint P mass m at (x, 0)\nconstraint s = 2 x name gear\n"
      "V = 1/2 k x^2\nfriction x limit 1 [N]\nfriction s limit 1 [N]\nstart x = 1 m, s = 2 m\n",
      10);
  CHECK(r.final.q[0] == doctest::Approx(-0.2).scale(1).epsilon(1e-12));  // 1 → −0.4 → −0.2
  CHECK(r.final.v[0] == 0);
}

TEST_CASE("a plate on many rough legs rests with all of them, and begins to slide together") {
  constexpr double A = 3, friction = 0.3, begins = friction * g / A, end = 2, since = end - begins;
  for (const int n : {24, 60}) {
    CAPTURE(n);
    std::string text =
        "param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length, θ : angle\n"
        "body B mass m inertia 0.1 kg m^2 at (x, z) rotation angle θ\ngravity (0, -g)\n";
    for (int i = 0; i < n; ++i)
      text +=
          fmt::format("point L{0} in B at ({1:.4f} m, 0)\ncontact L{0}.y >= 0 friction 0.3 slip L{0}.x' name c{0}\n", i,
                      (2.0 * i - n + 1) / n);
    const auto r = run_text(text + "force on B = (3 [N/s] t, 0)\n", end);
    CHECK(r.final.q[0] == doctest::Approx(A * since * since * since / 6).epsilon(1e-11));
    CHECK(count(r, Happening::Kind::Slip) == static_cast<std::size_t>(n));
    CHECK(r.happenings.size() == static_cast<std::size_t>(n));
    for (const Happening& h : r.happenings) CHECK(h.t == doctest::Approx(begins).epsilon(1e-11));
  }
}

TEST_CASE("forces of many contacts in the plane are the least within their limits") {
  // A plate on n feet with μ = 0.5, pushed by a force F: each foot carries 1/n, and −F/n.
  constexpr int n = 40;
  constexpr double push = 0.3;
  ConeProblem p;
  p.contacts.assign(n, {1, 0.5});
  Eigen::MatrixXd rows(2 * n, 3);  // of x, z, θ
  for (int k = 0; k < n; ++k) {
    rows.row(2 * k) << 0, 1, (2.0 * k - n + 1) / n;
    rows.row(2 * k + 1) << 1, 0, 0;
  }
  p.response = rows * rows.transpose();
  p.free = rows * Eigen::Vector3d(push, -1, 0);
  auto found = resting_forces(p);
  REQUIRE(found);
  for (int k = 0; k < n; ++k) {
    CHECK((*found)(2 * k) == doctest::Approx(1.0 / n).epsilon(1e-12));
    CHECK((*found)(2 * k + 1) == doctest::Approx(-push / n).epsilon(1e-12));
  }
  p.free = rows * Eigen::Vector3d(0.5 + 1e-9, -1, 0);
  CHECK_FALSE(resting_forces(p));
  p.free = rows * Eigen::Vector3d(0.5 - 1e-9, -1, 0.9);  // near the last feet, which alone have to carry
  found = resting_forces(p);
  REQUIRE(found);
  CHECK((p.free + p.response * *found).cwiseAbs().maxCoeff() < 1e-12);
  for (int k = 0; k < n; ++k) CHECK(std::abs((*found)(2 * k + 1)) <= 0.5 * (*found)(2 * k) + 1e-14);
}

TEST_CASE("a leg that carries nothing while others keep it closed is not lost") {
  // Four smooth legs, pulled up at one end: the plate tips over the last leg at 30 N/s t (0.6 + a) …
  const auto r = run_text(
      "param m = 1 kg, g = 9.81 m/s^2, J = 0.1 kg m^2\ncoord x, z : length, θ : angle\n"
      "body B mass m inertia J at (x, z) rotation angle θ\ngravity (0, -g)\n"
      "point L0 in B at (-0.75 m, 0)\ncontact L0.y >= 0 name c0\npoint L1 in B at (-0.25 m, 0)\n"
      "contact L1.y >= 0 name c1\npoint L2 in B at (0.25 m, 0)\ncontact L2.y >= 0 name c2\n"
      "point L3 in B at (0.75 m, 0)\ncontact L3.y >= 0 name c3\npoint T in B at (0.6 m, 0)\n"
      "force on T = (0, -20 [N/s] t)\npoint U in B at (-0.6 m, 0)\nforce on U = (0, 30 [N/s] t)\n",
      0.5);
  const double tips = 0.75 * g / (30 * (0.6 + 0.75) + 20 * (0.6 - 0.75));
  for (int i = 0; i < 3; ++i) {
    const std::string name = fmt::format("c{}", i);
    CHECK(count(r, Happening::Kind::Lost, name) == 1);
    CHECK(count(r, Happening::Kind::Made, name) == 0);
    for (const Happening& h : r.happenings)
      if (h.name == name && h.kind == Happening::Kind::Lost) CHECK(h.t == doctest::Approx(tips).epsilon(1e-11));
  }
}

#include "support.hpp"

#include <cmath>

using namespace maupertuis;
using namespace maupertuis::test;
using doctest::Approx;

namespace {

const std::vector<double> kAngles = {0.7, 1.1, -0.4}, kRates = {0.3, -0.8, 1.7};

Elaborated body(const std::string& rotation, const std::string& before = "") {
  return Elaborated("param I = 1 kg m^2\ncoord φ, θ, ψ : angle\n" + before + "body B inertia diag(I, I, I) rotation " +
                    rotation + "\n");
}

/// Rᵀ Ṙ by central differences: the angular velocity along the axes of the body, by its definition.
std::array<double, 3> omega_by_differences(const Elaborated& e, const ExprMatrix& r, const std::vector<double>& q,
                                           const std::vector<double>& v, double t) {
  const double h = 1e-5;
  const auto rotation = [&](double dt) {
    std::vector<double> moved = q;
    for (std::size_t i = 0; i < q.size(); ++i) moved[i] += v[i] * dt;
    return evaluate(r.entries, e.at(moved, v, t + dt));
  };
  const auto now = rotation(0), later = rotation(h), before = rotation(-h);
  double w[3][3] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) w[i][j] += now[k * 3 + i] * (later[k * 3 + j] - before[k * 3 + j]) / (2 * h);
  return {w[2][1], w[0][2], w[1][0]};
}

void check_omega(const Elaborated& e, const std::vector<double>& q, const std::vector<double>& v, double t = 0) {
  const Body& b = e.system().bodies.back();
  const auto expected = omega_by_differences(e, b.rotation, q, v, t);
  const Bindings at = e.at(q, v, t);
  for (std::size_t i = 0; i < 3; ++i) CHECK(value(b.angular_velocity[i], at) == Approx(expected[i]).epsilon(1e-7));
  // along the axes of the world: R ω
  for (std::size_t i = 0; i < 3; ++i) {
    double turned = 0;
    for (std::size_t j = 0; j < 3; ++j) turned += value(b.rotation.at(i, j), at) * value(b.angular_velocity[j], at);
    CHECK(value(b.angular_velocity_world[i], at) == Approx(turned).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("Euler angles zxz: the angular velocity of the textbook") {
  // Goldstein (4.87), Landau-Lifshitz (35.1)
  const Elaborated e = body("euler zxz (φ, θ, ψ)");
  const auto at = e.at(kAngles, kRates);
  const double th = kAngles[1], psi = kAngles[2], dphi = kRates[0], dth = kRates[1], dpsi = kRates[2];
  const ExprVector& w = e.system().bodies[0].angular_velocity;
  CHECK(value(w[0], at) == Approx(dphi * std::sin(th) * std::sin(psi) + dth * std::cos(psi)));
  CHECK(value(w[1], at) == Approx(dphi * std::sin(th) * std::cos(psi) - dth * std::sin(psi)));
  CHECK(value(w[2], at) == Approx(dphi * std::cos(th) + dpsi));
  // the body axis z points along (sin θ sin φ, -sin θ cos φ, cos θ)
  const ExprMatrix& r = e.system().bodies[0].rotation;
  CHECK(value(r.at(0, 2), at) == Approx(std::sin(th) * std::sin(kAngles[0])));
  CHECK(value(r.at(1, 2), at) == Approx(-std::sin(th) * std::cos(kAngles[0])));
  CHECK(value(r.at(2, 2), at) == Approx(std::cos(th)));
}

TEST_CASE("every sequence of Euler angles: the angular velocity is Rᵀ Ṙ") {
  for (const char* sequence : {"zxz", "zyz", "xyx", "xzx", "yxy", "yzy", "xyz", "xzy", "yxz", "yzx", "zxy", "zyx"}) {
    CAPTURE(sequence);
    check_omega(body("euler " + std::string(sequence) + " (φ, θ, ψ)"), kAngles, kRates);
  }
}

TEST_CASE("roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll)") {
  const Elaborated e = body("rpy (φ, θ, ψ)");
  check_omega(e, kAngles, kRates);
  const auto at = e.at(kAngles, kRates);
  const double r = kAngles[0], p = kAngles[1], y = kAngles[2];
  const ExprMatrix& m = e.system().bodies[0].rotation;
  CHECK(value(m.at(0, 0), at) == Approx(std::cos(y) * std::cos(p)));
  CHECK(value(m.at(0, 1), at) == Approx(std::cos(y) * std::sin(p) * std::sin(r) - std::sin(y) * std::cos(r)));
  CHECK(value(m.at(2, 0), at) == Approx(-std::sin(p)));
  CHECK(value(m.at(2, 2), at) == Approx(std::cos(p) * std::cos(r)));
}

TEST_CASE("axis and angle, nested frames, moving axes, motion in time: the angular velocity is Rᵀ Ṙ") {
  SUBCASE("an axis that is no coordinate axis") { check_omega(body("axis (1, 2, -2) angle φ + θ ψ"), kAngles, kRates); }
  SUBCASE("an axis that moves") { check_omega(body("axis (cos φ, sin φ, θ) angle ψ"), kAngles, kRates); }
  SUBCASE("frames in frames") {
    check_omega(
        Elaborated(
            "param I = 1 kg m^2, a = 1 m\ncoord φ, θ, ψ : angle\nframe F at (a, 0, 0) rotation axis (0, 0, 1) angle φ\n"
            "frame G at (0, a, 0) rotation euler xyz (θ, φ, 2 [rad]) in F\nbody B inertia diag(I, I, I) at (0, 0, a) "
            "rotation rpy (ψ, θ, φ) in G\n"),
        kAngles, kRates);
  }
  SUBCASE("about one axis again and again") {
    const Elaborated e(
        "param I = 1 kg m^2\ncoord φ, θ, ψ : angle\nframe F at (0, 0, 0) rotation axis (0, 1, 0) angle φ\n"
        "frame G at (0, 0, 0) rotation axis (0, -2, 0) angle θ in F\nbody B inertia diag(I, I, I) rotation axis (0, 1, "
        "0) angle ψ in G\n");
    check_omega(e, kAngles, kRates);
    // turns about one axis add their angles: one sine and one cosine are left
    CHECK(topological_order(e.system().bodies[0].rotation.entries).size() <= 12);
  }
  SUBCASE("in time") {
    check_omega(Elaborated("param I = 1 kg m^2, Ω = 3 rad/s\ncoord φ, θ, ψ : angle\nframe F at (0, 0, 0) rotation axis "
                           "(0, 0, 1) angle Ω t\n"
                           "body B inertia diag(I, I, I) rotation euler xzx (φ, θ, ψ) in F\n"),
                kAngles, kRates, 0.35);
  }
}

TEST_CASE("places in frames: components along the axes of the frame, points of the world") {
  const Elaborated e(
      "param m = 1 kg, a = 2 m, b = 3 m\ncoord x : length, θ, φ : angle\n"
      "frame F at (x, 0) rotation angle θ\nframe G at (a, 0) rotation angle φ in F\n"
      "point P mass m at (b, 0) in G\npoint Q mass m at P + (0, b) in F\npoint R mass m at (P + Q)/2\n"
      "let d = (b, b)\npoint S mass m at d in G\n"
      "let there = P - Q, back = -Q + P, far = -(Q - 2 P) - P\npoint U at there in F\npoint V at back in F\npoint W at "
      "far in F\n");
  const double x = 0.4, th = 0.7, phi = -0.3, a = 2, b = 3;
  const auto at = e.at({x, th, phi}, {0, 0, 0});
  const auto place = [&](const char* name, int k) {
    return value(e.system().find_point(name)->position[static_cast<std::size_t>(k)], at);
  };
  const double px = x + a * std::cos(th) + b * std::cos(th + phi), py = a * std::sin(th) + b * std::sin(th + phi);
  CHECK(place("P", 0) == Approx(px));
  CHECK(place("P", 1) == Approx(py));
  CHECK(place("Q", 0) == Approx(px - b * std::sin(th)));
  CHECK(place("Q", 1) == Approx(py + b * std::cos(th)));
  CHECK(place("R", 0) == Approx(px - b * std::sin(th) / 2));
  CHECK(place("S", 0) == Approx(x + a * std::cos(th) + b * std::cos(th + phi) - b * std::sin(th + phi)));
  // From Q to P, a direction however it is written: laid off from the origin of F along its axes.
  for (const char* name : {"U", "V", "W"}) {
    CHECK(place(name, 0) == Approx(place("U", 0)));
    CHECK(place(name, 1) == Approx(place("U", 1)));
  }
}

TEST_CASE("in the plane the angular velocity is the sum of the rates") {
  const Elaborated e(
      "param J = 1 kg m^2, Ω = 2 rad/s\ncoord θ, φ : angle\nframe F at (0, 0) rotation angle θ + Ω t\nbody B inertia J "
      "rotation angle 2 φ in F\n");
  CHECK(value(e.system().bodies[0].angular_velocity[0], e.at({0.1, 0.2}, {0.5, 0.25})) == Approx(0.5 + 2 + 0.5));
}

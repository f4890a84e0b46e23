#include "support.hpp"

#include <eigen3/Eigen/LU>

#include <array>
#include <cmath>
#include <random>

using namespace maupertuis;
using test::Elaborated;

namespace {

using Quaternion = std::array<double, 4>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr const char* kSatellite =
    "param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2\nbody sat inertia diag(I1, I2, I3) rotation quaternion\n";

Quaternion random(std::mt19937& generator) {
  std::uniform_real_distribution<double> between(-1, 1);
  return {between(generator), between(generator), between(generator), between(generator)};
}

double norm2(const Quaternion& q) { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]; }

/// q v q̄ by Hamilton's product: independent of the matrix.
std::array<double, 3> turn(const Quaternion& q, const std::array<double, 3>& v) {
  const auto product = [](const Quaternion& a, const Quaternion& b) {
    return Quaternion{
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
  };
  const Quaternion turned = product(product(q, {0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {turned[1], turned[2], turned[3]};
}

Matrix rotation_of(const Elaborated& m, const Body& b, const Quaternion& q, const Quaternion& rate = {}) {
  const Bindings at = m.at({q.begin(), q.end()}, {rate.begin(), rate.end()});
  Matrix out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = test::value(b.rotation.at(i, j), at);
  return out;
}

}  // namespace

TEST_CASE("a quaternion turns as q v q̄, and its matrix has R Rᵀ = |q|⁴ 1") {
  const Elaborated m(kSatellite);
  std::mt19937 generator(1);
  for (int k = 0; k < 20; ++k) {
    const Quaternion q = random(generator);
    const Matrix r = rotation_of(m, m.system().bodies[0], q);
    for (std::size_t j = 0; j < 3; ++j) {
      std::array<double, 3> axis = {};
      axis[j] = 1;
      const std::array<double, 3> expected = turn(q, axis);
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(r[i][j] == doctest::Approx(expected[i]).epsilon(1e-12));
        double dot = 0;
        for (std::size_t l = 0; l < 3; ++l) dot += r[i][l] * r[j][l];
        CHECK(dot == doctest::Approx(i == j ? norm2(q) * norm2(q) : 0).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("the angular velocity is that of R' Rᵀ, found by differences on |q| = 1") {
  const Elaborated m(kSatellite);
  const Body& b = m.system().bodies[0];
  std::mt19937 generator(2);
  for (int k = 0; k < 10; ++k) {
    Quaternion q = random(generator), rate = random(generator);
    const double size = std::sqrt(norm2(q));
    double along = 0;
    for (std::size_t i = 0; i < 4; ++i) along += (q[i] /= size) * rate[i];
    for (std::size_t i = 0; i < 4; ++i) rate[i] -= along * q[i];
    const double h = 1e-5;
    Quaternion before = q, after = q;
    for (std::size_t i = 0; i < 4; ++i) before[i] -= h * rate[i], after[i] += h * rate[i];
    const Matrix r = rotation_of(m, b, q), r0 = rotation_of(m, b, before), r1 = rotation_of(m, b, after);
    const auto spin = [&](std::size_t i, std::size_t j, bool world) {  // R' Rᵀ, or Rᵀ R'
      double sum = 0;
      for (std::size_t l = 0; l < 3; ++l)
        sum += world ? (r1[i][l] - r0[i][l]) / (2 * h) * r[j][l] : r[l][i] * (r1[l][j] - r0[l][j]) / (2 * h);
      return sum;
    };
    const Bindings at = m.at({q.begin(), q.end()}, {rate.begin(), rate.end()});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
      CHECK(test::value(b.angular_velocity_world[i], at) == doctest::Approx(spin(l, j, true)).epsilon(1e-8));
      CHECK(test::value(b.angular_velocity[i], at) == doctest::Approx(spin(l, j, false)).epsilon(1e-8));
    }
  }
}

TEST_CASE("a body with a quaternion of its own has four coordinates, T = ½ ω·Iω, and the norm as a constraint") {
  const Elaborated m(kSatellite);
  const MechanicalSystem& s = m.system();
  CHECK(m.codes() == "");
  REQUIRE(s.coordinates.size() == 4);
  CHECK(s.coordinates[0].name == "sat.qw");
  CHECK(s.coordinates[3].name == "sat.qz");
  REQUIRE(s.constraints.size() == 1);
  CHECK(s.constraints[0].body == "sat");
  CHECK(s.constraints[0].level == Constraint::Level::Position);
  CHECK(s.constraints[0].multiplier.name() == "λ_sat");
  const Bindings at = m.at({0.1, 0.2, 0.3, 0.4}, {0.5, -0.6, 0.7, -0.8});
  CHECK(evaluate(s.constraints[0].value, at) == doctest::Approx(0.01 + 0.04 + 0.09 + 0.16 - 1));
  double kinetic = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double w = test::value(s.bodies[0].angular_velocity[i], at);
    kinetic += 0.5 * static_cast<double>(i + 1) * w * w;
  }
  CHECK(test::value(s.kinetic_energy(), at) == doctest::Approx(kinetic));
  REQUIRE(m.experiment().start.size() == 1);
  CHECK(m.experiment().start[0].coordinate == 0);
  CHECK(m.experiment().start[0].value.is_one());
}

TEST_CASE("the coordinates of a quaternion stand in starts, expectations, lets and draws") {
  const Elaborated m(std::string("coord u : length\nparam m = 1 kg\nT += 1/2 m u'^2\n") + kSatellite +
                     "start sat.qx = 0.6, sat.qy' = 1 /s, sat.ω = (1, 2, 3) rad/s\nlet c = sat.qw^2\n"
                     "draw O - (sat.qx * 1 [m], 0, 0)\nexpect sat.qw at 3 s = 0.5 ± 1e-9\n"
                     "expect conserved c + sat.qx^2 + sat.qy^2 + sat.qz^2\nV = 1 [J] sat.qz\n");
  CHECK_MESSAGE(m.codes() == "", m.messages());
  CHECK(m.system().coordinates.size() == 5);
  const auto& start = m.experiment().start;
  REQUIRE(start.size() == 3);
  CHECK(start[0].coordinate == 2);
  CHECK(start[1].order == 1);
  CHECK(start[2].coordinate == 1);  // the w that belongs to the x of the text
  CHECK(evaluate(start[2].value, {}) == doctest::Approx(0.8));
  REQUIRE(m.experiment().start_conditions.size() == 3);
  const Bindings at = m.at({0, 1, 0, 0, 0}, {0, 0, 0.5, 0, 0});
  CHECK(evaluate(m.experiment().start_conditions[0].formula, at) == doctest::Approx(1));
  CHECK(evaluate(m.experiment().start_conditions[1].value, {}) == doctest::Approx(2));
  CHECK(m.expected<expectation::ValueAt>(0).subject == m.system().coordinates[1].q);

  const Elaborated o(
      std::string(kSatellite) + "start sat.ω.y = 1 rad/s\n",
      {{OverrideKind::Start, "--start", "sat.qw=0.5"}, {OverrideKind::Start, "--start", "sat.ω=(7,8,9)rad/s"}});
  REQUIRE_MESSAGE(o.experiment().start_conditions.size() == 3, o.messages());
  CHECK(evaluate(o.experiment().start_conditions[1].value, {}) == doctest::Approx(8));
  REQUIRE(o.experiment().start.size() == 1);
  CHECK(evaluate(o.experiment().start[0].value, {}) == doctest::Approx(0.5));
}

TEST_CASE("body rates at the start, for every kind of rotation") {
  const auto codes = [](const std::string& text) { return Elaborated(text + "\n").codes(); };
  const std::string wheel = "param J = 1 kg m^2\ncoord θ : angle\nbody wheel inertia J rotation angle θ\n";
  CHECK(codes(wheel + "start wheel.ω = 2 rad/s") == "");
  CHECK(codes(wheel + "start wheel.ω = 2 Hz") == "E0306");
  CHECK(codes(wheel + "start wheel.ω = 2 m") == "E0304");
  CHECK(codes(wheel + "start wheel.ω' = 2 rad/s^2") == "E0223");
  CHECK(codes(wheel + "start wheel.ω = θ'") == "E0222");
  const std::string top =
      "param I = 1 kg m^2\ncoord φ, θ, ψ : angle\n"
      "body B inertia diag(I, I, I) rotation euler zxz (φ, θ, ψ)\nstart θ = 1 rad\n";
  CHECK(codes(top + "start B.ω = (1, 2, 3) rad/s") == "");
  CHECK(codes(top + "start B.ω_world = (1, 2, 3) rad/s") == "");
  CHECK(codes(top + "start B.ω.x = 1 rad/s, B.ω.z = 2 rad/s") == "");
  CHECK(codes(top + "start B.ω = 3 rad/s") == "E0210");
  CHECK(codes(top + "start B.ω = (1, 2, 3) rad/s, B.ω.x = 1 rad/s") == "E0208");
  const std::string axle =
      "param I = 1 kg m^2\ncoord θ : angle\n"
      "body B inertia diag(I, I, I) rotation axis (0, 0, 1) angle θ\n";
  CHECK(codes(axle + "start B.ω = (0, 0, 3) rad/s") == "");
  CHECK(codes(axle + "start B.ω = (0, 1, 3) rad/s") == "E0223");
  CHECK(codes(axle + "start B.qw = 1") == "E0504");
  CHECK(codes(axle + "V = 1 [J] B.qw") == "E0216");
}

TEST_CASE("a quaternion of expressions: half angles turn as the angle does") {
  const Elaborated q(
      "param I = 1 kg m^2, J = 2 kg m^2\ncoord θ : angle\nbody B inertia diag(I, I, J) rotation "
      "quaternion (cos(θ/2), 0, 0, sin(θ/2))\n");
  const Elaborated a(
      "param I = 1 kg m^2, J = 2 kg m^2\ncoord θ : angle\nbody B inertia diag(I, I, J) rotation "
      "axis (0, 0, 1) angle θ\n");
  CHECK_MESSAGE(q.fine(), q.messages());
  for (const double θ : {0.3, 2.0}) {
    const Bindings x = q.at({θ}, {1.5}), y = a.at({θ}, {1.5});
    for (std::size_t i = 0; i < 9; ++i)
      CHECK(evaluate(q.system().bodies[0].rotation.entries[i], x) ==
            doctest::Approx(evaluate(a.system().bodies[0].rotation.entries[i], y)));
    CHECK(test::value(q.system().kinetic_energy(), x) == doctest::Approx(test::value(a.system().kinetic_energy(), y)));
  }
  CHECK(Elaborated(
            "param I = 1 kg m^2\ncoord a : length\nbody B inertia diag(I, I, I) rotation quaternion (a, 0, 0, 0)\n")
            .codes() == "E0304");
}

TEST_CASE("quaternions without units, in frames, and not in the plane") {
  const auto codes = [](const std::string& text) { return Elaborated(text + "\n").codes(); };
  CHECK(codes("dimensionless\nparam I = 1\nbody B inertia diag(I, I, I) rotation quaternion\nstart B.ω = (1, 2, 3)") ==
        "");
  CHECK(codes("param I = 1 kg m^2\ncoord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\n"
              "body B inertia I rotation quaternion") == "E0402");
  // A frame that turns as it likes, with three particles in it: the kinetic energy of the body that they are.
  const Elaborated f(
      "param m = 1 kg, a = 1 m\nframe F at (0, 0, 0) rotation quaternion\npoint A mass m at (a, 0, 0) in F\n"
      "point B mass m at (0, 2 a, 0) in F\npoint C mass m at (0, 0, 3 a) in F\n");
  const Elaborated b("param m = 1 kg, a = 1 m\nbody F inertia diag(13 m a^2, 10 m a^2, 5 m a^2) rotation quaternion\n");
  REQUIRE_MESSAGE(f.codes() == "", f.messages());
  REQUIRE_MESSAGE(b.codes() == "", b.messages());
  CHECK(f.system().constraints[0].body == "F");
  const std::vector<double> q = {0.1, 0.5, -0.7, 0.5}, v = {0.6, -0.9, 0.2, 1.06};  // |q| = 1, q·v = 0
  CHECK(q[0] * v[0] + q[1] * v[1] + q[2] * v[2] + q[3] * v[3] == doctest::Approx(0));
  CHECK(test::value(f.system().kinetic_energy(), f.at(q, v)) ==
        doctest::Approx(test::value(b.system().kinetic_energy(), b.at(q, v))));
}

TEST_CASE("with its norm as a constraint a quaternion moves by Euler's equations") {
  const Elaborated m(std::string(kSatellite) + "param a = 3 N m, b = 5 N m\ntorque on sat = (a, 0, b)\n");
  const MechanicalSystem& s = m.system();
  const Body& body = s.bodies[0];
  ExprVector q, accelerations;
  for (const Coordinate& c : s.coordinates) q.push_back(c.q), accelerations.push_back(c.acceleration);
  const ExprVector forces = s.generalized_forces();
  ExprVector balance = expand_time_derivatives(variational_residual(s.lagrangian(), q));
  for (std::size_t i = 0; i < 4; ++i) balance[i] = balance[i] - forces[i];
  const Expr norm = total_time_derivative(total_time_derivative(s.constraints[0].value));
  const ExprVector row = gradient(s.constraints[0].value, q);

  std::mt19937 generator(3);
  for (int trial = 0; trial < 10; ++trial) {
    Quaternion x = random(generator), v = random(generator);
    const double size = std::sqrt(norm2(x));
    double along = 0;
    for (std::size_t i = 0; i < 4; ++i) along += (x[i] /= size) * v[i];
    for (std::size_t i = 0; i < 4; ++i) v[i] -= along * x[i];
    Bindings at = m.at({x.begin(), x.end()}, {v.begin(), v.end()});
    for (const Expr& a : accelerations) at[a] = 0;
    // M q̈ − Aᵀ λ = −h,  A q̈ = b
    Eigen::Matrix<double, 5, 5> left = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> right;
    for (int i = 0; i < 4; ++i) {
      const auto k = static_cast<std::size_t>(i);
      right(i) = -evaluate(balance[k], at);
      const std::vector<double> mass = evaluate(gradient(balance[k], accelerations), at);
      for (int j = 0; j < 4; ++j) left(i, j) = mass[static_cast<std::size_t>(j)];
      left(4, i) = evaluate(row[k], at);
      left(i, 4) = -left(4, i);
    }
    right(4) = -evaluate(norm, at);
    Eigen::FullPivLU<Eigen::Matrix4d> mass_matrix(left.topLeftCorner<4, 4>());
    CHECK(mass_matrix.setThreshold(1e-10).rank() == 3);
    const Eigen::Matrix<double, 5, 1> solution = left.fullPivLu().solve(right);
    for (int i = 0; i < 4; ++i) at[accelerations[static_cast<std::size_t>(i)]] = solution(i);

    const Matrix r = rotation_of(m, body, x);
    const double inertia[] = {1, 2, 3}, torque[] = {3, 0, 5};
    std::array<double, 3> w = {}, rate = {};
    for (std::size_t i = 0; i < 3; ++i) {
      w[i] = test::value(body.angular_velocity[i], at);
      rate[i] = evaluate(total_time_derivative(body.angular_velocity[i]), at);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      double along_axis = 0;
      for (std::size_t l = 0; l < 3; ++l) along_axis += r[l][i] * torque[l];
      CHECK(inertia[i] * rate[i] ==
            doctest::Approx((inertia[j] - inertia[k]) * w[j] * w[k] + along_axis).epsilon(1e-10).scale(1));
    }
  }
}

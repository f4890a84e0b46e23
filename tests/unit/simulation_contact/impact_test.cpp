// Impulses against closed forms and against what energy allows.
#include "simulation/contact/impact.hpp"
#include "linear_algebra/complementarity.hpp"
#include "linear_algebra/least_distance.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace maupertuis;

namespace {

/// Particles on a line in contact with their neighbours: g_i = x_{i+1} − x_i.
ImpactProblem row_of_balls(const std::vector<double>& masses, double restitution) {
  ImpactProblem p;
  const auto n = static_cast<Eigen::Index>(masses.size());
  p.response = Eigen::MatrixXd::Zero(n, n - 1);
  p.tangent_response = Eigen::MatrixXd::Zero(n, n - 1);
  for (std::size_t i = 0; i + 1 < masses.size(); ++i) {
    p.contacts.push_back(i);
    p.normal.push_back({{i, -1.0}, {i + 1, 1.0}});
    p.tangent.emplace_back();
    for (auto* list : {&p.drive, &p.slip_drive, &p.friction, &p.static_friction}) list->push_back(0);
    p.restitution.push_back(restitution);
    p.sticking.push_back(false);
    p.rest.push_back(1e-13);
    p.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = -1 / masses[i];
    p.response(static_cast<Eigen::Index>(i) + 1, static_cast<Eigen::Index>(i)) = 1 / masses[i + 1];
  }
  return p;
}

Eigen::VectorXd velocities(std::initializer_list<double> v) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(v.size()));
  std::copy(v.begin(), v.end(), out.data());
  return out;
}

}  // namespace

TEST_CASE("the shortest solution of inequalities, and none where they exclude each other") {
  Eigen::MatrixXd g(4, 2);
  Eigen::VectorXd h(4);
  g << 1, 0, 0.6, 0.8, 0.6, 0.8, -1, 0;  // x ≥ 1, twice 0.6 x + 0.8 y ≥ 2, x ≤ 3
  h << 1, 2, 2, -3;
  const auto corner = least_distance(g, h);
  REQUIRE(corner);
  CHECK((*corner)(0) == doctest::Approx(1.2).epsilon(1e-13));  // on the aslant line, the foot of the perpendicular
  CHECK((*corner)(1) == doctest::Approx(1.6).epsilon(1e-13));
  h << 2, 2, 2, -3;
  const auto both = least_distance(g, h);
  REQUIRE(both);
  CHECK((*both)(0) == doctest::Approx(2).epsilon(1e-13));
  CHECK((*both)(1) == doctest::Approx(1).epsilon(1e-13));
  h << 3.001, 2, 2, -3;
  CHECK_FALSE(least_distance(g, h));
  h << -1, -2, -2, -3;
  CHECK(least_distance(g, h)->norm() == 0);
}

TEST_CASE("a contact that opens is turned round by what is hit beside it, and is not pressed through") {
  // A wall of great mass, a ball that leaves it, another that hits this one.
  const ImpactResult r = simultaneous_impact(row_of_balls({1e30, 1, 1}, 0), velocities({0, 0.1, -1}), true);
  CHECK(r.v[1] == doctest::Approx(0).epsilon(1e-13));
  CHECK(r.v[2] == doctest::Approx(0).epsilon(1e-13));
}

TEST_CASE("Newton's cradle of five sends out as many as come in, one impact after the other") {
  const ImpactProblem p = row_of_balls({1, 1, 1, 1, 1}, 1);
  for (int in = 1; in <= 4; ++in) {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(5);
    v.head(in).setOnes();
    const ImpactResult r = sequential_impact(p, v, ImpactOrder::FastestFirst);
    for (Eigen::Index i = 0; i < 5; ++i) CHECK(r.v(i) == doctest::Approx(i >= 5 - in ? 1 : 0));
    CHECK(r.loss == doctest::Approx(0));
  }
}

TEST_CASE("three equal balls by complementarity: -1/3, 2/3, 2/3") {
  const ImpactResult r = simultaneous_impact(row_of_balls({1, 1, 1}, 1), velocities({1, 0, 0}), false);
  CHECK(r.v(0) == doctest::Approx(-1.0 / 3));
  CHECK(r.v(1) == doctest::Approx(2.0 / 3));
  CHECK(r.v(2) == doctest::Approx(2.0 / 3));
}

TEST_CASE("impacts at once: what each takes is the loss of kinetic energy, and its speed is the one before") {
  // 2 Λ1 − Λ2 = 1.7, 2 Λ2 − Λ1 = 0: ½ − ½ Σ v² of (−2/15, 17/30, 17/30)
  const ImpactResult r = simultaneous_impact(row_of_balls({1, 1, 1}, 0.7), velocities({1, 0, 0}), false);
  CHECK(r.loss == doctest::Approx(0.5 - 0.5 * r.v.squaredNorm()));
  CHECK(r.loss > 0.1);
  REQUIRE(r.impulses.size() == 2);
  CHECK(r.impulses[0].speed == doctest::Approx(1));
  CHECK(r.impulses[1].speed == 0);
  CHECK(r.impulses[0].loss + r.impulses[1].loss == doctest::Approx(r.loss));
  const ImpactResult end = end_of_bounces(row_of_balls({1, 1}, 0.7), velocities({1, 0}));
  CHECK(end.loss == doctest::Approx(0.25));
  REQUIRE(end.impulses.size() == 1);
  CHECK(end.impulses[0].speed == doctest::Approx(1));
  CHECK(end.impulses[0].loss == doctest::Approx(0.25));
}

TEST_CASE("two stacked balls 3 : 1 that fall with speed 1: the floor first, then each other, give (0, 2)") {
  ImpactProblem p = row_of_balls({3, 1}, 1);
  p.contacts.push_back(1);
  p.normal.push_back({{0, 1.0}});
  p.tangent.emplace_back();
  for (auto* list : {&p.drive, &p.slip_drive, &p.friction, &p.static_friction}) list->push_back(0);
  p.restitution.push_back(1);
  p.sticking.push_back(false);
  p.rest.push_back(1e-13);
  p.response.conservativeResize(2, 2);
  p.response.col(1) << 1.0 / 3, 0;
  p.tangent_response = Eigen::MatrixXd::Zero(2, 2);
  const ImpactResult r = sequential_impact(p, velocities({-1, -1}), ImpactOrder::FastestFirst);
  CHECK(r.v(0) == doctest::Approx(0));
  CHECK(r.v(1) == doctest::Approx(2));
}

TEST_CASE("a wall that comes towards a ball does work -Λ ∂g/∂t") {
  ImpactProblem p = row_of_balls({1, 1}, 1);
  p.normal[0] = {{0, 1.0}};
  p.response = Eigen::MatrixXd::Zero(2, 1);
  p.response(0, 0) = 1;
  p.drive[0] = -0.5;  // g = x − 0.5 t: the floor rises
  const ImpactResult r = sequential_impact(p, velocities({-1, 0}), ImpactOrder::FastestFirst);
  CHECK(r.v(0) == doctest::Approx(2));  // −(−1) + 2 · 0.5
  CHECK(0.5 * (4 - 1) == doctest::Approx(r.moving - r.loss));
}

TEST_CASE("friction at an impact never adds energy, and Newton's law would") {
  std::mt19937_64 random(1687);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
  };
  int reversed = 0, stuck = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double w_nn = uniform(0.1, 3), w_tt = uniform(0.1, 3), w_nt = uniform(-0.99, 0.99) * std::sqrt(w_nn * w_tt);
    const double v_n = -uniform(0.1, 2), v_t = uniform(-3, 3), mu = uniform(0, 1.5), e = uniform(0, 1);
    const PlaneImpulse p = frictional_impulse(w_nn, w_nt, w_tt, v_n, v_t, mu, mu * uniform(1, 1.5), false, e);
    if (p.normal == 0) continue;  // jammed
    const double n = v_n + w_nn * p.normal + w_nt * p.tangential, t = v_t + w_nt * p.normal + w_tt * p.tangential;
    // ½ Δp · (v⁻ + v⁺) is the work on the motion.
    const double work = 0.5 * (p.normal * (v_n + n) + p.tangential * (v_t + t));
    CHECK(work <= 1e-12);
    CHECK(n >= -1e-12);
    CHECK(std::abs(p.tangential) <= 1.5 * mu * p.normal + 1e-12);
    reversed += t * v_t < -1e-12;
    stuck += std::abs(t) < 1e-12;
  }
  CHECK(reversed > 100);
  CHECK(stuck > 100);
}

TEST_CASE("a ball that bounces without loss and slides through: Δv_t = μ (1 + e) |v_n|") {
  const PlaneImpulse p = frictional_impulse(1, 0, 1, -2, 10, 0.3, 0.3, false, 0.5);
  CHECK(p.normal == doctest::Approx(3));  // (1 + e) |v_n|, since the normal does not feel friction
  CHECK(p.tangential == doctest::Approx(-0.9));
}

TEST_CASE("complementarity: a solution is one, for semidefinite matrices with redundant rows too") {
  std::mt19937_64 random(1965);
  std::normal_distribution<double> normal;
  for (int turn = 0; turn < 500; ++turn) {
    const Eigen::Index n = 1 + turn % 12, rank = 1 + turn % 7;
    Eigen::MatrixXd g(n, rank);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < rank; ++j) g(i, j) = normal(random);
    const Eigen::MatrixXd w = g * g.transpose();
    Eigen::VectorXd velocity(rank);
    for (Eigen::Index j = 0; j < rank; ++j) velocity(j) = normal(random);
    const Eigen::VectorXd q = g * velocity;  // always solvable: impulses stop any velocity
    const auto z = linear_complementarity(w, q);
    REQUIRE(z);
    const Eigen::VectorXd rest = q + w * *z;
    CHECK(z->minCoeff() >= 0);
    CHECK(rest.minCoeff() >= -1e-9);
    CHECK(std::abs(z->dot(rest)) < 1e-8);
  }
}

TEST_CASE("complementarity without a solution says so") {
  Eigen::MatrixXd w(1, 1);
  w << -1;
  Eigen::VectorXd q(1);
  q << -1;
  CHECK_FALSE(linear_complementarity(w, q));
}

TEST_CASE("the energy of a point that is thrown back a hundred thousand times wanders with the root of their number") {
  // At walls that lie every way, with a gradient of length 2: its square is next to a power of 2 at each of them.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(0, 2 * std::acos(-1.0));
  ImpactProblem p;
  p.contacts = {0};
  p.tangent = {{}};
  for (auto* list : {&p.drive, &p.slip_drive, &p.friction, &p.static_friction}) list->push_back(0);
  p.restitution = {1};
  p.sticking = {false};
  p.rest = {1e-13};
  p.tangent_response = Eigen::MatrixXd::Zero(2, 1);
  Eigen::VectorXd v = velocities({0.8, 0.6});
  const double before = v.squaredNorm();
  double worst = 0;
  for (int k = 0; k < 100'000; ++k) {
    const double a = angle(random);
    Eigen::VectorXd n = velocities({2 * std::cos(a), 2 * std::sin(a)});
    if (n.dot(v) > 0) n = -n;
    p.normal = {{{0, n(0)}, {1, n(1)}}};
    p.response = n;
    v = sequential_impact(p, v, ImpactOrder::FastestFirst).v;
    worst = std::max(worst, std::abs(v.squaredNorm() / before - 1));
  }
  CHECK(worst < 1e-13);
}

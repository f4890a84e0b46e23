// Large systems are solved through their tangents: the same motion as by the full matrix, whatever the shape of the tree.
#include "kernel/interpreter/lifted_solve.hpp"

#include <doctest/doctest.h>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace {

using namespace maupertuis;

using Parents = std::function<int(int)>;  // of a point, by its index; −1: the fixed one

/// Points of mass 1 on rods of length l from one point to the next, in the plane, gravity 9.81.
struct Rods {
  Context context;
  KernelSource source;

  Rods(int count, const Parents& parent) {
    const Expr l = context.symbol("l", Role::Parameter), zero = context.number(0), half = context.number(Rational(1, 2));
    source.parameters = {l};
    std::vector<Expr> x, y;
    Expr lagrangian = zero;
    for (int i = 0; i < count; ++i) {
      const Expr angle = context.symbol("a" + std::to_string(i), Role::Coordinate);
      source.coordinates.push_back(angle);
      const auto from = static_cast<std::size_t>(parent(i));
      x.push_back((parent(i) < 0 ? zero : x[from]) + l * sin(angle));
      y.push_back((parent(i) < 0 ? zero : y[from]) - l * cos(angle));
      const Expr speed = pow(context.time_derivative(x.back()), 2) + pow(context.time_derivative(y.back()), 2);
      lagrangian = lagrangian + half * speed - context.number(Rational(981, 100)) * y.back();
    }
    source.residual = variational_residual(lagrangian, source.coordinates);
  }
};

/// M of the rods in closed form: M_ij = (points that both carry) l² cos(a_i − a_j).
double mass_of_rods(int count, const Parents& parent, const std::vector<double>& a, std::size_t i, std::size_t j) {
  int shared = 0;
  for (int point = 0; point < count; ++point) {
    bool has_i = false, has_j = false;
    for (int p = point; p >= 0; p = parent(p)) has_i |= p == static_cast<int>(i), has_j |= p == static_cast<int>(j);
    shared += has_i && has_j;
  }
  return shared * std::cos(a[i] - a[j]);
}

int chain(int i) { return i - 1; }
int binary_tree(int i) { return i == 0 ? -1 : (i - 1) / 2; }
int comb(int i) { return i == 0 ? -1 : i % 3 == 0 ? i - 3 : i - 1; }

struct Point {
  std::vector<double> q, v;
};

Point random_point(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-3, 3);
  Point p;
  for (std::size_t i = 0; i < n; ++i) p.q.push_back(uniform(random)), p.v.push_back(uniform(random));
  return p;
}

const std::vector<double> one{1.0};

/// The lifted system of a program at a point, as a workspace uses it.
struct Lifted {
  explicit Lifted(const Kernel& k)
      : kernel(k), program(kernel.program()), packed(packed::pack(program)), memory(packed.program, 1 - program.first_stage, packed.cells),
        solve(program, packed, memory.stride) {
    interpreter::compute_constants(memory, one, {});
    solve.set_constants(memory);
  }
  void move_to(const Point& p) {
    interpreter::set_leaves(memory, 0, 1 - program.first_stage);
    std::copy(p.q.begin(), p.q.end(), memory.row(0));
    std::copy(p.v.begin(), p.v.end(), memory.row(1));
    std::fill_n(memory.row(2), p.q.size(), 0.0);
    for (int stage = program.first_stage; stage <= 0; ++stage) interpreter::run_section(memory, Dynamics, stage);
  }

  Kernel kernel;
  const Program& program;
  packed::PackedProgram packed;
  interpreter::Memory memory;
  interpreter::LiftedSolve solve;
};

}  // namespace

TEST_CASE("chains, trees and combs: M x = b with M in closed form") {
  for (const auto& [parent, count] : {std::pair<Parents, int>{chain, 40}, {binary_tree, 63}, {comb, 50}}) {
    Rods rods(count, parent);
    Lifted lifted(build_kernel(rods.source));
    const auto n = static_cast<std::size_t>(count);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Point p = random_point(n, seed);
      lifted.move_to(p);
      REQUIRE(lifted.solve.factor(lifted.memory));
      const std::vector<double> b = random_point(n, seed + 100).q;
      std::vector<double> x = b;
      REQUIRE(lifted.solve.solve_first(x));
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0, size = std::abs(b[i]);
        for (std::size_t j = 0; j < n; ++j) {
          const double term = mass_of_rods(count, parent, p.q, i, j) * x[j];
          sum += term, size += std::abs(term);
        }
        CHECK(std::abs(sum - b[i]) <= 1e-13 * size);
      }
    }
  }
}

TEST_CASE("the tangents of the stored slots come with the solution") {
  Rods rods(30, chain);
  Lifted lifted(build_kernel(rods.source));
  lifted.move_to(random_point(30, 3));
  REQUIRE(lifted.solve.factor(lifted.memory));
  std::vector<double> x = random_point(30, 4).q;
  REQUIRE(lifted.solve.solve_first(x));
  std::vector<double> tangents(lifted.memory.stride, 0.0);
  std::copy(x.begin(), x.end(), tangents.begin());
  interpreter::tangents<1>(lifted.memory, tangents.data(), interpreter::moved_instructions(lifted.packed.program));
  for (Slot slot = 0; slot < lifted.packed.program.stored_end[2]; ++slot)
    CHECK(lifted.solve.tangents()[slot] == doctest::Approx(tangents[slot]).epsilon(1e-11));
}

TEST_CASE("the cost of chains grows as their length") {
  const auto products = [](int links) {
    Rods rods(links, chain);
    Lifted lifted(build_kernel(rods.source));
    lifted.move_to(random_point(static_cast<std::size_t>(links), 1));
    REQUIRE(lifted.solve.factor(lifted.memory));
    return std::pair(lifted.solve.solver()->factor_products(), lifted.solve.solver()->solve_products());
  };
  const auto hundred = products(100), thousand = products(1000);
  CHECK(hundred.second < 20 * 100);
  CHECK(thousand.second < 10.2 * static_cast<double>(hundred.second));
  CHECK(thousand.first < 10.2 * static_cast<double>(hundred.first));
}

TEST_CASE("accelerations of large systems satisfy Lagrange's equations, whatever the size and the shape") {
  for (const auto& [parent, count] : {std::pair<Parents, int>{chain, 17}, {chain, 50}, {chain, 200}, {binary_tree, 127}, {comb, 90}}) {
    Rods rods(count, parent);
    const auto n = static_cast<std::size_t>(count);
    KernelWorkspace work(build_kernel(rods.source), 4);
    work.set_parameters(one);
    const Point p = random_point(n, 7);
    REQUIRE(work.expand(0, p.q, p.v) == KernelStatus::Ok);
    // Each point: Σ_i M_ki q̈_i = Σ_i (shared) sin(a_i − a_k) q̇_i² − (points carried by k) 9.81 sin a_k
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0, size = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double mass = mass_of_rods(count, parent, p.q, k, i);
        const double shared = mass == 0 ? 0 : mass / std::cos(p.q[k] - p.q[i]);
        const double left = mass * work.acceleration(i), right = shared * std::sin(p.q[i] - p.q[k]) * p.v[i] * p.v[i];
        sum += left - right, size += std::abs(left) + std::abs(right);
      }
      const double carried = mass_of_rods(count, parent, p.q, k, k);
      sum += carried * 9.81 * std::sin(p.q[k]);
      CHECK(std::abs(sum) <= 1e-12 * (size + carried * 9.81));
    }
    CHECK(work.mass(0, n - 1) == doctest::Approx(mass_of_rods(count, parent, p.q, 0, n - 1)).epsilon(1e-12));
  }
}

TEST_CASE("a large system whose M is singular is told so, with its coordinate") {
  Rods rods(30, chain);
  const Expr idle = rods.context.symbol("idle", Role::Coordinate);
  rods.source.coordinates.push_back(idle);
  // No inertia at idle = 0.
  const Expr acceleration = rods.context.symbol("idle", Role::Coordinate, 2);
  rods.source.residual.push_back(idle * acceleration + rods.context.number(1));
  KernelWorkspace work(build_kernel(rods.source), 3);
  work.set_parameters(one);
  Point p = random_point(31, 2);
  CHECK(work.evaluate(0, p.q, p.v) == KernelStatus::Ok);
  CHECK(work.acceleration(30) == doctest::Approx(-1 / p.q[30]).epsilon(1e-13));
  p.q[30] = 0;
  REQUIRE(work.evaluate(0, p.q, p.v) == KernelStatus::SingularMass);
  CHECK(work.singular_coordinate() == 30);
  p.q[30] = 1e-3;
  CHECK(work.evaluate(0, p.q, p.v) == KernelStatus::Ok);
  CHECK(work.acceleration(30) == doctest::Approx(-1e3).epsilon(1e-13));
}

TEST_CASE("angles at which sines or cosines vanish are as good as any") {
  Rods rods(40, chain);
  KernelWorkspace work(build_kernel(rods.source), 3);
  work.set_parameters(one);
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    Point p{std::vector<double>(40), std::vector<double>(40, 0.0)};
    for (double& a : p.q) a = static_cast<double>(random() % 4) * std::numbers::pi / 2;
    REQUIRE(work.evaluate(0, p.q, p.v) == KernelStatus::Ok);
    for (std::size_t k = 0; k < 40; ++k) {
      double sum = static_cast<double>(40 - k) * 9.81 * std::sin(p.q[k]), size = std::abs(sum);
      for (std::size_t i = 0; i < 40; ++i) {
        const double term = static_cast<double>(40 - std::max(i, k)) * std::cos(p.q[k] - p.q[i]) * work.acceleration(i);
        sum += term, size += std::abs(term);
      }
      CHECK(std::abs(sum) <= 1e-13 * (1 + size));
    }
  }
}

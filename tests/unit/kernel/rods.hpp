#pragma once
#include "kernel/packed/code.hpp"
#include "kernel/workspace/lifted_solve.hpp"

#include <doctest/doctest.h>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

using namespace maupertuis;

using Parents = std::function<int(int)>;  // of a point, by its index; −1: the fixed one

/// Points of mass 1 on rods of length l from one point to the next, in the plane, gravity 9.81.
struct Rods {
  Context context;
  KernelSource source;

  Rods(int count, const Parents& parent) {
    const Expr l = context.symbol("l", Role::Parameter), zero = context.number(0),
               half = context.number(Rational(1, 2));
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
class MassOfRods {
 public:
  MassOfRods(int count, const Parents& parent) : shared_(static_cast<std::size_t>(count)) {
    for (auto& row : shared_) row.assign(shared_.size(), 0);
    for (int point = 0; point < count; ++point)
      for (int i = point; i >= 0; i = parent(i))
        for (int j = point; j >= 0; j = parent(j)) ++shared_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }

  double operator()(const std::vector<double>& a, std::size_t i, std::size_t j) const {
    return shared_[i][j] * std::cos(a[i] - a[j]);
  }

 private:
  std::vector<std::vector<int>> shared_;
};

inline int chain(int i) { return i - 1; }
inline int binary_tree(int i) { return i == 0 ? -1 : (i - 1) / 2; }
inline int comb(int i) { return i == 0 ? -1 : i % 3 == 0 ? i - 3 : i - 1; }

struct Point {
  std::vector<double> q, v;
};

inline Point random_point(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-3, 3);
  Point p;
  for (std::size_t i = 0; i < n; ++i) p.q.push_back(uniform(random)), p.v.push_back(uniform(random));
  return p;
}

inline const std::vector<double> one{1.0};

/// A stage whose tangents come with the solution.
inline constexpr int later = 5;

/// The lifted system of a program at a point, as a workspace uses it.
struct Lifted {
  explicit Lifted(const Kernel& k)
      : kernel(k),
        program(kernel.program()),
        strip(program.unknowns > packed::most_by_inverse ? sparse::strip_of(program) : sparse::Strip{}),
        packed(packed::pack(program, {strip.order, strip.whole})),
        memory(packed.program, 1 - program.first_stage, packed.cells),
        solve(program, strip, packed, memory.stride) {
    reference::compute_constants(memory, one, {});
    solve.set_constants(memory);
  }
  void move_to(const Point& p) {
    reference::set_leaves(memory, 0, 1 - program.first_stage);
    std::copy(p.q.begin(), p.q.end(), memory.row(0));
    std::copy(p.v.begin(), p.v.end(), memory.row(1));
    std::fill_n(memory.row(2), p.q.size(), 0.0);
    for (int stage = program.first_stage; stage <= 0; ++stage) reference::run_section(memory, Dynamics, stage);
  }

  bool factor() { return solve.has_pivots(memory) && solve.factor(memory); }

  Kernel kernel;
  const Program& program;
  sparse::Strip strip;
  packed::PackedProgram packed;
  reference::Memory memory;
  workspace::LiftedSolve solve;
};

/// One more coordinate, without inertia at 0: idle idle'' + 1 = 0.
inline void add_idle_coordinate(Rods& rods) {
  const Expr idle = rods.context.symbol("idle", Role::Coordinate);
  rods.source.coordinates.push_back(idle);
  const Expr acceleration = rods.context.symbol("idle", Role::Coordinate, 2);
  rods.source.residual.push_back(idle * acceleration + rods.context.number(1));
}

/// 30 rods and the idle coordinate: solved, then singular at idle = 0 and told so. The point at which it is.
inline Point check_idle_coordinate(KernelWorkspace& work) {
  Point p = random_point(31, 2);
  CHECK(work.evaluate(0, p.q, p.v) == KernelStatus::Ok);
  CHECK(work.acceleration(30) == doctest::Approx(-1 / p.q[30]).epsilon(1e-13));
  p.q[30] = 0;
  REQUIRE(work.evaluate(0, p.q, p.v) == KernelStatus::SingularMass);
  CHECK(work.singular_coordinate() == 30);
  return p;
}

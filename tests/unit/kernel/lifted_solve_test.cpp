// Large systems are solved through their tangents: the same motion as by the full matrix, whatever the shape of the
// tree.
#include "rods.hpp"

TEST_CASE("chains, trees and combs: M x = b with M in closed form") {
  for (const auto& [parent, count] : {std::pair<Parents, int>{chain, 40}, {binary_tree, 63}, {comb, 50}}) {
    Rods rods(count, parent);
    const MassOfRods mass_of_rods(count, parent);
    Lifted lifted(build_kernel(rods.source));
    const auto n = static_cast<std::size_t>(count);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Point p = random_point(n, seed);
      lifted.move_to(p);
      REQUIRE(lifted.factor());
      const std::vector<double> b = random_point(n, seed + 100).q;
      std::vector<double> x = b;
      REQUIRE(lifted.solve.solve_first(lifted.memory, x));
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0, size = std::abs(b[i]);
        for (std::size_t j = 0; j < n; ++j) {
          const double term = mass_of_rods(p.q, i, j) * x[j];
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
  REQUIRE(lifted.factor());
  std::vector<double> x = random_point(30, 4).q;
  REQUIRE(lifted.solve.solve_first(lifted.memory, x));
  std::vector<double> tangents(lifted.memory.stride, 0.0);
  std::copy(x.begin(), x.end(), tangents.begin());
  reference::tangents<1>(lifted.memory, tangents.data(), sparse::tangent_edges(lifted.packed.program));
  for (Slot slot = 0; slot < lifted.packed.program.stored_end[2]; ++slot)
    CHECK(lifted.solve.tangents(later)[slot] == doctest::Approx(tangents[slot]).epsilon(1e-11));
}

TEST_CASE("the cost of chains grows as their length") {
  const auto products = [](int links) {
    Rods rods(links, chain);
    Lifted lifted(build_kernel(rods.source));
    lifted.move_to(random_point(static_cast<std::size_t>(links), 1));
    REQUIRE(lifted.factor());
    return std::pair(lifted.solve.solver()->factor_products(), lifted.solve.solver()->solve_products());
  };
  const auto hundred = products(100), thousand = products(1000);
  CHECK(hundred.second < 20 * 100);
  CHECK(thousand.second < 10.2 * static_cast<double>(hundred.second));
  CHECK(thousand.first < 10.2 * static_cast<double>(hundred.first));
}

TEST_CASE("accelerations of large systems satisfy Lagrange's equations, whatever the size and the shape") {
  for (const auto& [parent, count] :
       {std::pair<Parents, int>{chain, 17}, {chain, 50}, {chain, 200}, {binary_tree, 127}, {comb, 90}}) {
    Rods rods(count, parent);
    const MassOfRods mass_of_rods(count, parent);
    const auto n = static_cast<std::size_t>(count);
    KernelWorkspace work(build_kernel(rods.source), 4);
    work.set_parameters(one);
    const Point p = random_point(n, 7);
    REQUIRE(work.expand(0, p.q, p.v) == KernelStatus::Ok);
    // Each point: Σ_i M_ki q̈_i = Σ_i (shared) sin(a_i − a_k) q̇_i² − (points carried by k) 9.81 sin a_k
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0, size = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double mass = mass_of_rods(p.q, k, i);
        const double shared = mass == 0 ? 0 : mass / std::cos(p.q[k] - p.q[i]);
        const double left = mass * work.acceleration(i), right = shared * std::sin(p.q[i] - p.q[k]) * p.v[i] * p.v[i];
        sum += left - right, size += std::abs(left) + std::abs(right);
      }
      const double carried = mass_of_rods(p.q, k, k);
      sum += carried * 9.81 * std::sin(p.q[k]);
      CHECK(std::abs(sum) <= 1e-12 * (size + carried * 9.81));
    }
    CHECK(work.mass(0, n - 1) == doctest::Approx(mass_of_rods(p.q, 0, n - 1)).epsilon(1e-12));
  }
}

TEST_CASE("a large system whose M is singular is told so, with its coordinate") {
  Rods rods(30, chain);
  add_idle_coordinate(rods);
  KernelWorkspace work(build_kernel(rods.source), 3);
  work.set_parameters(one);
  Point p = check_idle_coordinate(work);
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

// Compiled solutions of large systems against the loops, and against M in closed form.
#include "rods.hpp"

#include <limits>

TEST_CASE("chains, trees and combs: unknowns and tangents as by the loops, M x = b with M in closed form") {
  for (const auto& [parent, count] :
       {std::pair<Parents, int>{chain, 20}, {chain, 100}, {binary_tree, 63}, {comb, 50}}) {
    Rods rods(count, parent);
    const MassOfRods mass_of_rods(count, parent);
    Lifted loops(build_kernel(rods.source)), code(build_kernel(rods.source));
    // Factors by code too, and not; no pivots yet.
    code.solve.compile({.cache = false, .long_run = count != 100, .in_tiers = false, .processor = {}});
    CHECK_FALSE(code.solve.compile_report());
    const auto n = static_cast<std::size_t>(count);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Point p = random_point(n, seed);
      for (Lifted* const lifted : {&loops, &code}) {
        lifted->move_to(p);
        REQUIRE(lifted->factor());
      }
      REQUIRE(code.solve.compile_report());
      REQUIRE_MESSAGE(code.solve.compile_report()->compiled, code.solve.compile_report()->trouble);
      CHECK_FALSE(loops.solve.compile_report());
      for (unsigned turn = 0; turn < 3; ++turn) {
        const std::vector<double> b = random_point(n, seed + turn + 100).q;
        std::vector<double> x = b, y = b;
        if (turn == 0) {
          REQUIRE(loops.solve.solve_first(loops.memory, x));
          REQUIRE(code.solve.solve_first(code.memory, y));
        } else {
          loops.solve.solve(x);
          code.solve.solve(y);
        }
        for (std::size_t i = 0; i < n; ++i) {
          double sum = 0, size = std::abs(b[i]);
          for (std::size_t j = 0; j < n; ++j) {
            const double term = mass_of_rods(p.q, i, j) * y[j];
            sum += term, size += std::abs(term);
          }
          CHECK(std::abs(sum - b[i]) <= 1e-13 * size);
        }
        const Slot stored = code.packed.program.stored_end[2];
        double largest = 0;
        for (Slot slot = 0; slot < stored; ++slot)
          largest = std::max(largest, std::abs(loops.solve.tangents(later)[slot]));
        for (Slot slot = 0; slot < stored; ++slot)
          CHECK(std::abs(code.solve.tangents(later)[slot] - loops.solve.tangents(later)[slot]) <= 1e-10 * largest);
      }
    }
  }
}

TEST_CASE("chains are cut into parts side by side, whose sums wait for each other far less; trees are not") {
  for (const auto& [parent, count] : {std::pair<Parents, int>{chain, 64}, {chain, 100}, {binary_tree, 63}}) {
    Rods rods(count, parent);
    Lifted loops(build_kernel(rods.source)), code(build_kernel(rods.source));
    code.solve.compile({.cache = false, .processor = {}});
    for (Lifted* const lifted : {&loops, &code}) {
      lifted->move_to(random_point(static_cast<std::size_t>(count), 1));
      REQUIRE(lifted->factor());
    }
    const bool is_tree = count == 63;
    CHECK(code.solve.is_rough(0) == !is_tree);
    CHECK_FALSE(code.solve.is_rough(later));
    if (!is_tree) CHECK(10 * code.solve.solver()->solve_depth() < 6 * loops.solve.solver()->solve_depth());
  }
}

TEST_CASE("up to 48 unknowns: −M₀⁻¹ by eight columns at once, times M in closed form") {
  for (const auto& [parent, count] : {std::pair<Parents, int>{chain, 17}, {chain, 48}, {binary_tree, 31}, {comb, 30}}) {
    CAPTURE(count);
    Rods rods(count, parent);
    const MassOfRods mass_of_rods(count, parent);
    Lifted code(build_kernel(rods.source));
    code.solve.compile({.cache = false, .processor = {}});
    const auto n = static_cast<std::size_t>(count), padded = (n + 7) / 8 * 8;
    reference::Doubles inverse(padded * padded, 0.0);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Point p = random_point(n, seed);
      code.move_to(p);
      REQUIRE(code.factor());
      REQUIRE(code.solve.negative_inverse(code.memory, inverse.data()));
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < padded; ++j) {
          double sum = i == j ? 1 : 0, size = 1;
          for (std::size_t k = 0; k < n; ++k) {
            const double term = mass_of_rods(p.q, i, k) * inverse[k * padded + j];
            sum += term, size += std::abs(term);
          }
          CHECK(std::abs(sum) <= 1e-13 * size);
        }
    }
  }
  Rods rods(64, chain);
  Lifted larger(build_kernel(rods.source)), loops(build_kernel(rods.source));
  larger.solve.compile({.cache = false, .processor = {}});
  for (Lifted* const lifted : {&larger, &loops}) {
    lifted->move_to(random_point(64, 1));
    REQUIRE(lifted->factor());
    CHECK_FALSE(lifted->solve.negative_inverse(lifted->memory, nullptr));
  }
}

TEST_CASE("factors by code: a singular M is told so, with its coordinate, and what follows is solved again") {
  Rods rods(30, chain);
  add_idle_coordinate(rods);
  KernelWorkspace work(build_kernel(rods.source), 3);
  work.set_parameters(one);
  work.compile({.cache = false, .long_run = true, .in_tiers = false, .processor = {}});
  Point p = check_idle_coordinate(work);
  p.q[30] = std::numeric_limits<double>::quiet_NaN();
  CHECK(work.evaluate(0, p.q, p.v) != KernelStatus::Ok);
  for (const double value : {1e-3, 0.5, 0.7, 0.9}) {
    p.q[30] = value;
    CHECK(work.evaluate(0, p.q, p.v) == KernelStatus::Ok);
    CHECK(work.acceleration(30) == doctest::Approx(-1 / value).epsilon(1e-13));
  }
}

TEST_CASE("a workspace whose expansions are not compiled has compiled solutions: the same coefficients to rounding") {
  Rods rods(30, chain);
  KernelWorkspace loops(build_kernel(rods.source), 8), code(build_kernel(rods.source), 8);
  code.compile({.cache = false, .processor = {}});
  const Point p = random_point(30, 9);
  for (KernelWorkspace* const work : {&loops, &code}) {
    work->set_parameters(one);
    REQUIRE(work->expand(0, p.q, p.v) == KernelStatus::Ok);
  }
  for (int k = 2; k <= 9; ++k) {
    double largest = 0;
    for (std::size_t i = 0; i < 30; ++i) largest = std::max(largest, std::abs(loops.coordinate(k)[i]));
    for (std::size_t i = 0; i < 30; ++i)
      CHECK(std::abs(code.coordinate(k)[i] - loops.coordinate(k)[i]) <= 1e-10 * largest);
  }
}

TEST_CASE("a bad start leaves nothing behind: the same coefficients as by a workspace that never saw it") {
  Rods rods(20, chain);
  const Kernel kernel = build_kernel(rods.source);
  const Point p = random_point(20, 3);
  for (const bool is_position : {true, false}) {
    KernelWorkspace work(kernel, 8), fresh(kernel, 8);
    for (KernelWorkspace* const w : {&work, &fresh}) {
      w->compile({.cache = false, .long_run = true, .in_tiers = false, .processor = {}});
      w->set_parameters(one);
      REQUIRE(w->expand(0, p.q, p.v) == KernelStatus::Ok);  // pivots are chosen
      w->set_parameters(one);                               // what the inverse is asked is made anew
    }
    Point bad = p;
    (is_position ? bad.q : bad.v)[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(work.expand(0, bad.q, bad.v) != KernelStatus::Ok);
    for (KernelWorkspace* const w : {&work, &fresh}) {
      REQUIRE(w->evaluate(0, p.q, p.v) == KernelStatus::Ok);
      REQUIRE(w->expand(0, p.q, p.v) == KernelStatus::Ok);
    }
    for (int k = 2; k <= 9; ++k)
      for (std::size_t i = 0; i < 20; ++i) CHECK(work.coordinate(k)[i] == fresh.coordinate(k)[i]);
  }
}

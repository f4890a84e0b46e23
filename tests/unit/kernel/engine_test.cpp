#include "kernel/packed/engine.hpp"

#include <doctest/doctest.h>
#include <boost/align/aligned_allocator.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace maupertuis;
using Doubles = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

std::size_t padded(std::size_t n) { return (n + 7) / 8 * 8; }

Doubles random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Doubles values(count);
  for (double& x : values) x = number(generator);
  return values;
}

/// B Bᵀ + 1
std::vector<double> positive_matrix(std::size_t n) {
  const Doubles b = random_numbers(n * n, static_cast<unsigned>(n));
  std::vector<double> m(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      m[i * n + j] = i == j ? 1 : 0;
      for (std::size_t k = 0; k < n; ++k) m[i * n + j] += b[i * n + k] * b[j * n + k];
    }
  return m;
}

bool is_inverted(const std::vector<double>& m, std::size_t n) {
  Doubles inverse(n * padded(n));
  return packed::engine().negative_inverse(m.data(), n, inverse.data());
}

}  // namespace

TEST_CASE("engine: −M⁻¹ solves for the accelerations") {
  for (std::size_t n = 1; n <= 16; ++n) {
    CAPTURE(n);
    const std::vector<double> m = positive_matrix(n);
    Doubles inverse(n * padded(n)), solution(padded(n)), row = random_numbers(40, 7);
    REQUIRE(packed::engine().negative_inverse(m.data(), n, inverse.data()));
    std::vector<Slot> residual;
    for (std::size_t i = 0; i < n; ++i) residual.push_back(static_cast<Slot>(39 - 2 * i));
    CHECK(
        packed::engine().solve_by_inverse(inverse.data(), padded(n), row.data(), residual.data(), n, solution.data()));
    for (std::size_t i = 0; i < n; ++i) {
      double left = row[residual[i]];
      for (std::size_t j = 0; j < n; ++j) left += m[i * n + j] * solution[j];
      CHECK(std::abs(left) < 1e-13);
    }
    for (std::size_t i = n; i < padded(n); ++i) CHECK(solution[i] == 0);
    row[residual[n - 1]] = std::numeric_limits<double>::infinity();
    CHECK_FALSE(
        packed::engine().solve_by_inverse(inverse.data(), padded(n), row.data(), residual.data(), n, solution.data()));
  }
}

TEST_CASE("engine: what is not positive definite is left to a solver that pivots") {
  for (const std::size_t n : {std::size_t{3}, std::size_t{11}}) {
    std::vector<double> m = positive_matrix(n);
    CHECK(is_inverted(m, n));
    auto changed = m;
    changed[1] += 1e-6;
    CHECK_FALSE(is_inverted(changed, n));  // not symmetric
    changed = m;
    changed[n * n - 1] = -1;
    CHECK_FALSE(is_inverted(changed, n));
    changed = m;
    for (std::size_t i = 0; i < n; ++i) changed[(n - 1) * n + i] = changed[i], changed[i * n + n - 1] = changed[i];
    changed[n * n - 1] = changed[0];  // the last row is the first
    CHECK_FALSE(is_inverted(changed, n));
    changed = m;
    changed[n] = changed[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(is_inverted(changed, n));
  }
}

TEST_CASE("engine: corrections are sums over the directions, scaled by lag") {
  const std::size_t stride = 40, directions = 15;  // blocks of 8, 4, 2 and 1
  const int stage = 3;
  Doubles rows = random_numbers(6 * stride, 1);
  const Doubles before = rows, values = random_numbers(directions * stride, 2), weights = random_numbers(16, 3);
  packed::Tables tables;
  tables.rows = rows.data();
  tables.stride = stride;
  const std::vector<packed::Order> orders = packed::orders_of(rows.data(), stride, 6);
  tables.orders = orders.data();
  packed::engine().correct(tables, stage, {values.data(), stride, directions, 8, {16, 16, 32}}, weights.data());
  for (std::size_t order = 0; order < 6; ++order)
    for (std::size_t slot = 0; slot < stride; ++slot) {
      const bool position = order == 5 && 8 <= slot && slot < 16, acceleration = order == 3 && 16 <= slot && slot < 32;
      double expected = before[order * stride + slot];
      for (std::size_t d = 0; d < directions; ++d)
        expected += (position ? 1 / 20.0 : acceleration ? 1.0 : 0.0) * weights[d] * values[d * stride + slot];
      CHECK(rows[order * stride + slot] == doctest::Approx(expected).epsilon(1e-14));
    }
}

TEST_CASE("engine: stages by −M⁻¹ give accelerations and what the coefficients owe to them") {
  const std::size_t stride = 72;
  for (std::size_t turn = 0; turn < 32; ++turn) {
    const std::size_t n = 1 + turn / 2;
    const bool side_by_side = turn % 2 == 1;
    CAPTURE(n);
    CAPTURE(side_by_side);
    const std::vector<double> m = positive_matrix(n);
    Doubles inverse(padded(n) * padded(n)), answers(n * stride), values = random_numbers(n * stride, 2),
                                                                 rows = random_numbers(8 * stride, 1);
    REQUIRE(packed::engine().negative_inverse(m.data(), n, inverse.data()));
    std::vector<Slot> residual;
    for (std::size_t i = 0; i < n; ++i) residual.push_back(static_cast<Slot>(side_by_side ? 50 + i : 71 - 2 * i));
    packed::Tables tables;  // without packs
    tables.rows = rows.data();
    tables.stride = stride;
    tables.unknowns = n;
    const std::vector<packed::Order> orders = packed::orders_of(rows.data(), stride, 8);
    tables.orders = orders.data();
    const packed::TangentMatrix tangents{values.data(), stride, n, 16, {24, 28, 40}};
    const std::vector<std::int8_t> own{-1, static_cast<std::int8_t>(turn % 4 < 2 ? 0 : -1),
                                       static_cast<std::int8_t>(n > 8           ? 1
                                                                : turn % 3 == 0 ? 0
                                                                                : -1)};
    for (std::size_t vector = 0; vector < own.size(); ++vector)
      for (std::size_t d = 0; own[vector] >= 0 && d < n; ++d)
        for (std::size_t lane = 0; lane < 8; ++lane)
          if (d != static_cast<std::size_t>(own[vector]) * 8 + lane) values[d * stride + 16 + 8 * vector + lane] = 0;
    const packed::InverseSolution solution{inverse.data(), residual.data(), side_by_side,
                                           tangents,       own.data(),      answers.data()};
    for (int stage = 1; stage <= 5; ++stage) {
      CAPTURE(stage);
      const Doubles before = rows;
      Doubles expected(padded(n));
      packed::engine().solve_by_inverse(inverse.data(), padded(n),
                                        rows.data() + static_cast<std::size_t>(stage) * stride, residual.data(), n,
                                        expected.data());
      packed::engine().run_stages_by_inverse(tables, solution, stage, stage + 1, true);
      const auto change = [&](int order, std::size_t slot) {
        const std::size_t place = static_cast<std::size_t>(order) * stride + slot;
        return rows[place] - (slot < padded(n) ? 0 : before[place]);
      };
      for (std::size_t i = 0; i < n; ++i)
        CHECK(change(stage + 2, i) == doctest::Approx(expected[i] / ((stage + 1) * (stage + 2))).epsilon(1e-13));
      for (std::size_t slot = 16; slot < 40; ++slot) {
        const int lag = slot < 24 ? 0 : slot < 32 ? 1 : 2;
        double owed = 0;
        for (std::size_t d = 0; d < n; ++d) owed += expected[d] * values[d * stride + slot];
        const double factor = lag == 0 ? 1.0 / ((stage + 1) * (stage + 2)) : lag == 1 ? 1.0 / (stage + 1) : 1.0;
        CHECK(std::abs(change(stage + 2 - lag, slot) - factor * owed) < 1e-13);
      }
    }
  }
}

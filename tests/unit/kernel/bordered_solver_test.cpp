#include "kernel/dense/bordered_solver.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using maupertuis::dense::BorderedSolver;

namespace {

struct Problem {
  std::size_t n, m;
  std::vector<double> mass, rows;  // [n × n], [m × n]

  std::vector<double> bordered() const {
    const std::size_t size = n + m;
    std::vector<double> out(size * size, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) out[i * size + j] = mass[i * n + j];
    for (std::size_t k = 0; k < m; ++k)
      for (std::size_t j = 0; j < n; ++j) out[(n + k) * size + j] = out[j * size + n + k] = -rows[k * n + j];
    return out;
  }

  BorderedSolver factored() const {
    BorderedSolver solver(n, m);
    const auto entries = bordered();
    std::copy(entries.begin(), entries.end(), solver.matrix().begin());
    REQUIRE(!solver.factor());
    return solver;
  }

  /// max |K x − b| over the rows
  double residual(const std::vector<double>& x, const std::vector<double>& b) const {
    const auto k = bordered();
    double worst = 0;
    for (std::size_t i = 0; i < n + m; ++i) {
      double sum = -b[i];
      for (std::size_t j = 0; j < n + m; ++j) sum += k[i * (n + m) + j] * x[j];
      worst = std::max(worst, std::abs(sum));
    }
    return worst;
  }
};

}  // namespace

TEST_CASE("random bordered systems are solved to rounding, whatever their units") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    Problem p{6, 3, std::vector<double>(36), std::vector<double>(18)};
    std::vector<double> factor(36);
    for (double& x : factor) x = uniform(random);
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < 6; ++k) p.mass[i * 6 + j] += factor[i * 6 + k] * factor[j * 6 + k];
    for (double& x : p.rows) x = uniform(random);
    // One coordinate in micrometres: the factor 1e6 must not count as a singularity.
    for (std::size_t k = 0; k < 6; ++k) p.mass[k] *= 1e-6, p.mass[6 * k] *= 1e-6;
    for (std::size_t k = 0; k < 3; ++k) p.rows[6 * k] *= 1e-6;
    std::vector<double> b(9);
    for (double& x : b) x = uniform(random);
    b[0] *= 1e-6;
    auto x = b;
    p.factored().solve(x);
    CHECK(p.residual(x, b) < 1e-9);
  }
}

TEST_CASE(
    "a mass matrix that is singular alone is regular with its constraint: a point on a circle in polar coordinates") {
  const Problem p{2, 1, {0, 0, 0, 1}, {1, 0}};  // no inertia along r, and r is held
  std::vector<double> x{3, 2, -5};
  p.factored().solve(x);
  CHECK(x[0] == 5);  // −A x = −5
  CHECK(x[1] == 2);
  CHECK(x[2] == -3);  // M x − Aᵀλ = 3
}

TEST_CASE("dependent rows are dropped and their multipliers are not determined; independent ones are") {
  const Problem p{3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0, 0, 1, 0, 2, 0, 0}};
  const BorderedSolver solver = p.factored();
  CHECK(solver.determines(1));
  CHECK(!solver.determines(0));
  CHECK(!solver.determines(2));
  CHECK(solver.keeps(0) != solver.keeps(2));
  CHECK(solver.keeps(1));
  std::vector<double> x{0, 0, 1, -1, -2, -2};  // x₀ = 1, x₁ = 2, 2 x₀ = 2
  solver.solve(x);
  CHECK(x[0] == doctest::Approx(1).epsilon(1e-15));
  CHECK(x[1] == doctest::Approx(2).epsilon(1e-15));
  CHECK(x[2] == doctest::Approx(1).epsilon(1e-15));
}

TEST_CASE("what neither M nor A determines is named") {
  BorderedSolver solver(3, 1);
  const Problem p{3, 1, {1, 0, 0, 0, 0, 0, 0, 0, 1}, {1, 0, 1}};
  const auto entries = p.bordered();
  std::copy(entries.begin(), entries.end(), solver.matrix().begin());
  const auto undetermined = solver.factor();
  REQUIRE(undetermined);
  CHECK(*undetermined == 1);
}

TEST_CASE("the negative inverse, where no row was dropped and the pivots are good") {
  const Problem p{3, 1, {4, 1, 0, 1, 3e6, 0, 0, 0, 2}, {1, 2e3, -1}};
  constexpr std::size_t size = 4, stride = 8;
  std::vector<double> inverse(size * stride, 7.0);
  REQUIRE(p.factored().negative_inverse(inverse.data(), stride));
  for (std::size_t d = 0; d < size; ++d) {
    std::vector<double> x(size), b(size, 0.0);
    for (std::size_t i = 0; i < size; ++i) x[i] = -inverse[d * stride + i];
    b[d] = 1;
    CHECK(p.residual(x, b) < 1e-12);
    CHECK(inverse[d * stride + size] == 7.0);
  }
  std::fill(inverse.begin(), inverse.end(), 7.0);
  const Problem dependent{2, 2, {1, 0, 0, 1}, {1, 2, 2, 4}}, nearly{2, 1, {1, 1, 1, 1 + 1e-6}, {1, 1}};
  for (const Problem& bad : {dependent, nearly}) CHECK_FALSE(bad.factored().negative_inverse(inverse.data(), stride));
  CHECK(inverse == std::vector<double>(size * stride, 7.0));
}

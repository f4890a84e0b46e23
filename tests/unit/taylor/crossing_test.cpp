#include "integrator/taylor/crossing.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using maupertuis::taylor::first_crossing;

namespace {

/// Π (x − r_i), times a factor.
std::vector<double> from_roots(const std::vector<double>& roots, double factor = 1) {
  std::vector<double> p{factor};
  for (const double root : roots) {
    p.insert(p.begin(), 0.0);
    for (std::size_t k = 0; k + 1 < p.size(); ++k) p[k] -= root * p[k + 1];
  }
  return p;
}

constexpr double unit = 1e-15;

}  // namespace

TEST_CASE("a polynomial without roots in the step has none") {
  CHECK(!first_crossing(std::vector{1.0, 0.5, 0.25}, 1, unit, 1));
  CHECK(!first_crossing(from_roots({1.2, 2, -0.5}, -1), -1, unit, 1));
}

TEST_CASE("one root is found to rounding, on either side") {
  for (const double root : {1e-9, 0.1, 0.5, 0.77, 1.0 - 1e-12}) {
    CHECK(first_crossing(from_roots({root}, -1), 1, unit, 1).value() == doctest::Approx(root).epsilon(1e-15));
    CHECK(first_crossing(from_roots({root}), -1, unit, 1).value() == doctest::Approx(root).epsilon(1e-15));
  }
}

TEST_CASE("the first of many roots") {
  for (double first = 0.05; first < 0.45; first += 0.05)
    CHECK(first_crossing(from_roots({first, 0.5, 0.7, 0.9}), 1, unit, 1).value() ==
          doctest::Approx(first).epsilon(1e-13));
}

TEST_CASE("two close roots are not missed") {
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    CAPTURE(gap);
    const auto x = first_crossing(from_roots({0.6 - gap / 2, 0.6 + gap / 2}), 1, 1e-16, 1);
    REQUIRE(x);
    CHECK(std::abs(*x - (0.6 - gap / 2)) < 1e-15 / gap + 1e-15);
  }
}

TEST_CASE("a touch is no crossing; a touch before a crossing does not hide it") {
  CHECK(!first_crossing(from_roots({0.3, 0.3}), 1, unit, 1));
  CHECK(!first_crossing(from_roots({0.3, 0.3, 0.8, 0.8}), 1, unit, 1));
  CHECK(first_crossing(from_roots({0.3, 0.3, 0.8}, -1), 1, unit, 1).value() == doctest::Approx(0.8).epsilon(1e-13));
  CHECK(first_crossing(from_roots({0.3, 0.3, 0.3}, -1), 1, unit, 1).value() == doctest::Approx(0.3).epsilon(1e-4));
}

#include "kernel/series/elementary.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace maupertuis;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

double of(Kind kind, double x, double y = 0) { return series::operation<double>(kind, std::array{x, y}); }

}  // namespace

TEST_CASE("what is no number chooses no side") {
  CHECK(std::isnan(of(Kind::Sign, no_number)));
  CHECK(std::isnan(of(Kind::Step, no_number)));
  for (const Kind kind : {Kind::Min, Kind::Max}) {
    CHECK(std::isnan(of(kind, no_number, 1)));
    CHECK(std::isnan(of(kind, 1, no_number)));
  }
}

TEST_CASE("signs, steps and extrema of numbers") {
  CHECK(of(Kind::Sign, -3) == -1);
  CHECK(of(Kind::Sign, 0) == 0);
  CHECK(of(Kind::Sign, 0.5) == 1);
  CHECK(of(Kind::Step, -1e-300) == 0);
  CHECK(of(Kind::Step, 0) == 1);
  CHECK(of(Kind::Min, 2, -1) == -1);
  CHECK(of(Kind::Min, -1, 2) == -1);
  CHECK(of(Kind::Max, 2, -1) == 2);
  CHECK(of(Kind::Max, -1, 2) == 2);
}

#include "simulation/matched_times.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace maupertuis;

TEST_CASE("times of two runs belong together in their order") {
  constexpr double none = std::numeric_limits<double>::infinity();
  using Times = std::vector<double>;
  CHECK(matched_times(Times{1, 2, 3}, Times{1.1, 2.2, 3.3}) == Times{1.1, 2.2, 3.3});
  // The other run has one more: at its start, on its way, at its end.
  CHECK(matched_times(Times{1, 2, 3}, Times{1e-8, 1, 2, 3}) == Times{1, 2, 3});
  CHECK(matched_times(Times{1, 2, 3}, Times{1, 1.9, 2, 3}) == Times{1, 2, 3});
  CHECK(matched_times(Times{1, 2, 3}, Times{1, 2, 3, 4}) == Times{1, 2, 3});
  CHECK(matched_times(Times{1, 2, 3}, Times{0.1, 0.5, 1, 1.5, 2, 2.5, 3}) == Times{1, 2, 3});
  // This one has more: what the other run has not has the nearest time there, unless it comes last.
  CHECK(matched_times(Times{0.1, 1, 2}, Times{1, 2}) == Times{1, 1, 2});
  CHECK(matched_times(Times{1, 1.4, 1.8, 2, 2.5}, Times{1, 2}) == Times{1, 1, 2, 2, none});
  CHECK(matched_times(Times{1, 2}, Times{}) == Times{none, none});
  // Of one instant the other run may have fewer.
  CHECK(matched_times(Times{1, 1}, Times{1.25}) == Times{1.25, 1.25});
  CHECK(matched_times(Times{1, 2, 2}, Times{1, 2.25}) == Times{1, 2.25, 2.25});
  CHECK(matched_times(Times{}, Times{1}).empty());
  // As many, but each has one that the other has not.
  CHECK(matched_times(Times{1, 2, 3, 4, 5, 5.1, 6}, Times{1, 1.1, 2, 3, 4, 5, 6}) == Times{1, 2, 3, 4, 5, 5, 6});
  CHECK(matched_times(Times{1}, Times{0, 0.9}) == Times{0.9});
  CHECK(matched_times(Times{1}, Times{3}) == Times{3});
  // Later and later, as in runs that part: they stay pairs.
  CHECK(matched_times(Times{1, 2, 3, 4, 5}, Times{1.2, 2.4, 3.6, 4.8, 6}) == Times{1.2, 2.4, 3.6, 4.8, 6});
  // Backwards in time.
  CHECK(matched_times(Times{-1, -2, -3}, Times{-1e-8, -1, -2, -3}) == Times{-1, -2, -3});
  // Beyond some millions of steps one by one.
  CHECK(matched_times(Times(4000, 1.0), Times(8000, 2.0)) == Times(4000, 2.0));
}

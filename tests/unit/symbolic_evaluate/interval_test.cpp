#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "symbolic/evaluate/real100.hpp"

using namespace maupertuis::evaluation;

namespace {

template <class R>
std::vector<Interval<R>> intervals_of_all_signs() {
  const double ends[] = {-HUGE_VAL, -3, -2, -0.5, 0, 0.25, 2, 3, HUGE_VAL};
  std::vector<Interval<R>> out;
  for (const double low : ends)
    for (const double high : ends)
      if (low <= high && low < HUGE_VAL && high > -HUGE_VAL) out.push_back({R(low), R(high)});
  return out;
}

template <class R>
void products_are_those_of_ends() {
  for (const Interval<R>& a : intervals_of_all_signs<R>())
    for (const Interval<R>& b : intervals_of_all_signs<R>()) {
      const R c[] = {bounded_product(a.low, b.low), bounded_product(a.low, b.high), bounded_product(a.high, b.low),
                     bounded_product(a.high, b.high)};
      const Interval<R> found = products(a, b), wide = a * b;
      CAPTURE(static_cast<double>(a.low));
      CAPTURE(static_cast<double>(a.high));
      CAPTURE(static_cast<double>(b.low));
      CAPTURE(static_cast<double>(b.high));
      CHECK(found.low == *std::min_element(c, c + 4));
      CHECK(found.high == *std::max_element(c, c + 4));
      CHECK(wide.low <= found.low);
      CHECK(wide.high >= found.high);
      CHECK((wide.low < 0) == (found.low < 0));
      CHECK((wide.high > 0) == (found.high > 0));
    }
}

}  // namespace

TEST_CASE("the ends of a product are those of all products of ends") {
  products_are_those_of_ends<double>();
  products_are_those_of_ends<Real100>();
}

TEST_CASE("an operation gives ten of the hundred digits away") {
  const Real100 third = Real100(1) / 3;
  const Interval<Real100> square = Interval<Real100>{third, third} * Interval<Real100>{third, third};
  CHECK(square.high - square.low > Real100("1e-91"));
  CHECK(square.high - square.low < Real100("1e-90"));
  CHECK((square.low < Real100(1) / 9 && Real100(1) / 9 < square.high));
}

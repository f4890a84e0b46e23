#include <maupertuis/evaluate.hpp>
#include <maupertuis/linear_system.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

namespace {
struct Fixture {
  Context c;
  Expr x = c.symbol("x", Role::Coordinate), m = c.symbol("m", Role::Parameter), zero = c.number(0), one = c.number(1);
  Expr hidden_one = pow(sin(x), 2) + pow(cos(x), 2);  // 1, which does not show
};
}  // namespace

TEST_CASE_FIXTURE(Fixture, "the solution of a system whose first pivot stands in a later row") {
  const ExprMatrix a{3, 4, {zero, m, one, x, one, zero, m, one, m, x, zero, m}};
  const auto solved = solve_linear(a);
  REQUIRE(solved);
  for (std::size_t i = 0; i < 3; ++i) {
    Expr sum = -a.at(i, 3);
    for (std::size_t k = 0; k < 3; ++k) sum = sum + a.at(i, k) * (*solved)[k];
    CHECK(zero_test(sum).verdict == Verdict::Zero);
  }
}

TEST_CASE_FIXTURE(Fixture, "a matrix that is singular, which does not show, has no solution") {
  CHECK_FALSE(solve_linear({2, 3, {one, one, m, one, hidden_one, m}}));
  // The third row is the sum of the others, which change places first.
  const Expr e = hidden_one;
  CHECK_FALSE(solve_linear({3, 4, {zero, one, m, m, one, zero, x, m, e, e, m + x, m}}));
}

TEST_CASE_FIXTURE(Fixture, "where the point has no value the zero test decides") {
  const Expr out_of_reach = sqrt(-pow(m, 2) - Rational(1));
  CHECK_FALSE(solve_linear({2, 3, {one, one, out_of_reach, one, hidden_one, m}}));
}

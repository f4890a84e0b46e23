// Identities on a manifold where a relation has a single term: ψ'' = 0 is met by a number that is never small beside itself.
#include <maupertuis/evaluate.hpp>

#include <doctest/doctest.h>

using namespace maupertuis;

TEST_CASE("a relation of one term is met, and what follows from it vanishes") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate), m = c.symbol("m", Role::Parameter);
  const Expr relations[] = {m * sin(x), m * (x * x + y * y) - m};
  const Expr unknowns[] = {x, y};
  const Bindings center{{x, 0.1}, {y, 0.9}, {m, 3.0}};
  const Expr follows[] = {m * x, y * y - c.number(1), x * y};
  for (const Expr& e : follows) CHECK(zero_test_where({&e, 1}, relations, unknowns, center).verdict == Verdict::Zero);
  const Expr small = c.number(Rational(1, 1000000000000)) * y;
  const ZeroTest not_zero = zero_test_where({&small, 1}, relations, unknowns, center);
  CHECK(not_zero.verdict == Verdict::Nonzero);
  CHECK(not_zero.witness_value == doctest::Approx(1e-12));
}

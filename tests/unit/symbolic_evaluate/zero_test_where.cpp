#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>

#include <array>
#include <cmath>

using namespace maupertuis;

namespace {

struct Circle {
  Context c;
  Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate), l = c.symbol("l", Role::Parameter);
  Expr vx = c.symbol("x", Role::Coordinate, 1), vy = c.symbol("y", Role::Coordinate, 1);
  std::array<Expr, 2> relations{x * x + y * y - l * l, x* vx + y* vy};
  std::array<Expr, 4> unknowns{x, y, vx, vy};
  Bindings center{{x, 0.6}, {y, 0.8}, {l, 1}, {vx, 0}, {vy, 0}};

  ZeroTest test(Expr e) { return zero_test_where({&e, 1}, relations, unknowns, center); }
};

}  // namespace

TEST_CASE_FIXTURE(Circle, "what vanishes on the circle alone") {
  for (const Expr e : {x * x + y * y - l * l, sqrt(x * x + y * y) - l,
                       (x * vy - y * vx) * (x * vy - y * vx) - l * l * (vx * vx + vy * vy)}) {
    const ZeroTest test = this->test(e);
    CHECK(test.verdict == Verdict::Zero);
    CHECK(test.points == 3);
    CHECK(test.error_bound == 1);  // evidence, no proof
    CHECK(zero_test(e).verdict == Verdict::Nonzero);
  }
}

TEST_CASE_FIXTURE(Circle, "what does not vanish there, were it by 1e-30") {
  const Expr tiny = c.number(Rational(1, 1000000000000000)) * c.number(Rational(1, 1000000000000000));
  const ZeroTest test = this->test(x * x + y * y - l * l + tiny * x);
  CHECK(test.verdict == Verdict::Nonzero);
  CHECK(test.witness_value != 0);
  CHECK(std::abs(test.witness.at(x) * test.witness.at(x) + test.witness.at(y) * test.witness.at(y) -
                 test.witness.at(l) * test.witness.at(l)) < 1e-14);
}

TEST_CASE("relations that nothing satisfies leave the question open") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), e = x;
  const Expr relation = x * x + Rational(1);
  const ZeroTest test = zero_test_where({&e, 1}, {&relation, 1}, {&x, 1}, {{x, 0.5}});
  CHECK(test.verdict == Verdict::Undecided);
  CHECK(!test.reason.empty());
}

TEST_CASE_FIXTURE(Circle, "repeated relations do no harm") {
  const std::array<Expr, 3> twice{relations[0], relations[1], 2 * relations[0]};
  const Expr e = sqrt(x * x + y * y) - l;
  CHECK(zero_test_where({&e, 1}, twice, unknowns, center).verdict == Verdict::Zero);
}

TEST_CASE_FIXTURE(Circle, "symbols that are held keep their size, whatever it is") {
  const Expr k = c.symbol("k", Role::Parameter);
  for (const double held : {0.0, 1e-9, 3.0, 1e9}) {
    CAPTURE(held);
    center[k] = held;
    CHECK(test(k * (x * x + y * y - l * l)).verdict == Verdict::Zero);
    if (held == 0) continue;
    const ZeroTest different = test(x * x + y * y - l * l + k);
    CHECK(different.verdict == Verdict::Nonzero);
    CHECK(different.witness.at(k) == doctest::Approx(held).epsilon(0.02));
  }
}

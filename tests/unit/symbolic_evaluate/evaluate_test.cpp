#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>

#include "symbolic/evaluate/interval.hpp"
#include "symbolic/evaluate/prime_field.hpp"

#include <array>
#include <cmath>

using namespace maupertuis;
using namespace maupertuis::evaluation;

TEST_CASE("values in double") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
  const Bindings at{{x, 0.6}, {y, -2.0}};
  const auto f = [&](Kind kind, Expr a, Expr b) { return c.function(kind, std::array{a, b}); };
  CHECK(evaluate(x * y + Rational(3), at) == doctest::Approx(1.8));
  CHECK(evaluate(pow(x, Rational(-2)), at) == doctest::Approx(1 / 0.36));
  CHECK(evaluate(sqrt(x), at) == std::sqrt(0.6));
  CHECK(evaluate(f(Kind::Atan2, x, y), at) == std::atan2(0.6, -2.0));
  CHECK(evaluate(f(Kind::Min, x, y), at) == -2.0);
  CHECK(evaluate(f(Kind::Max, x, y), at) == 0.6);
  CHECK(evaluate(apply(Kind::Asinh, y), at) == std::asinh(-2.0));
  CHECK(evaluate(apply(Kind::Abs, y), at) == 2.0);
  CHECK(std::isnan(evaluate(apply(Kind::Log, y), at)));
  CHECK(std::isnan(evaluate(sqrt(y), at)));
}

TEST_CASE("values at a switch: sign(0) = 0, step(0) = 1, <= holds at equality") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate);
  const Bindings zero{{x, 0.0}};
  CHECK(evaluate(apply(Kind::Sign, x), zero) == 0);
  CHECK(evaluate(apply(Kind::Step, x), zero) == 1);
  const auto choice = [&](Kind relation) {
    const Expr condition = c.function(relation, std::array{x, c.number(0)});
    return evaluate(c.function(Kind::Piecewise, std::array{condition, c.number(1), c.number(2)}), zero);
  };
  CHECK(choice(Kind::Less) == 2);
  CHECK(choice(Kind::LessEqual) == 1);
}

TEST_CASE("intervals contain the exact value") {
  using I = Interval<double>;
  const I third = I{1, 1} / I{3, 3};
  CHECK(third.low < third.high);
  CHECK((third * I{3, 3}).low <= 1);
  CHECK((third * I{3, 3}).high >= 1);
  CHECK((I{0.1, 0.1} + I{0.2, 0.2} - I{0.3, 0.3}).contains_zero());
  CHECK(integer_power(I{-1, 2}, 2).low == 0);
  CHECK(integer_power(I::whole(), 2).low == 0);
  CHECK((integer_power(I::whole(), 2) + I{1, 1}).low > 0);
  CHECK(sin(I::whole()).high == 1);
  CHECK(sin(I{1, 1}).low <= std::sin(1.0));
  CHECK(sin(I{1, 1}).high >= std::sin(1.0));
  CHECK(log(I{-2, -1}).is_nan());
  CHECK((I{1, 1} / I{-1, 1}).contains_zero());
  CHECK(atan2(I{1, 1}, I{-1, -1}).low == doctest::Approx(std::atan2(1.0, -1.0)));
}

TEST_CASE("prime fields") {
  CHECK(is_prime(2305843009213693951ull));  // 2^61 − 1
  CHECK(!is_prime(2305843009213693951ull - 2));
  CHECK(!is_prime(3215031751ull));  // a strong pseudoprime to the bases 2, 3, 5, 7
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const PrimeTriple t = random_prime_triple(840 * (seed + 1), seed);
    CHECK(is_prime(t.p));
    CHECK(is_prime(t.q));
    CHECK(is_prime(t.r));
    CHECK(t.p == t.m * t.r - 1);
    CHECK(t.p == 2 * t.q + 1);
    CHECK((t.p >> 60) == 1);
    const PrimeField field(t.p);
    const auto x = field.from(Rational(-22, 7));
    CHECK(field.residue(field.multiply(x, field.from(7))) == t.p - 22);
    CHECK(field.multiply(x, field.inverse(x)) == field.one());
    CHECK(field.character(field.from(-1)) == -1);
    for (const int n : {2, 3, 5, 7, 9}) CHECK(field.character(field.from(n)) == 1);
    // Euler's criterion is an independent way to the character.
    for (std::uint64_t k = 11; k < 60; ++k) {
      const auto value = field.from(Rational(static_cast<std::int64_t>(k)));
      CHECK((field.power(value, t.q) == field.one()) == (field.character(value) == 1));
    }
  }
}

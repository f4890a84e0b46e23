#include <maupertuis/rational.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>
#include <limits>

using maupertuis::Rational;

TEST_CASE("decimal literals are read exactly") {
  CHECK(*Rational::parse("9.81") == Rational(981, 100));
  CHECK(*Rational::parse("-3/4") == Rational(-3, 4));
  CHECK(*Rational::parse("6.674e-11") == Rational(6674) / pow(Rational(10), 14));
  CHECK(*Rational::parse("007") == Rational(7));
  CHECK(*Rational::parse(".5") == Rational(1, 2));
  CHECK_FALSE(Rational::parse("1e"));
  CHECK_FALSE(Rational::parse("1e99999"));
  CHECK_FALSE(Rational::parse("x"));
  CHECK_FALSE(Rational::parse("1/0"));
  CHECK_FALSE(Rational::parse(""));
}

TEST_CASE("large values leave and re-enter the small representation") {
  const Rational big = pow(Rational(10), 40);
  CHECK(!big.small());
  CHECK((big / big).is_one());
  CHECK((big + Rational(1) - big).is_one());
  CHECK(pow(big, -1).to_string() == "1/1" + std::string(40, '0'));
  const Rational edge(std::numeric_limits<std::int64_t>::max());
  CHECK((edge + Rational(1)).to_string() == "9223372036854775808");
  CHECK(edge + Rational(1) - Rational(1) == edge);
}

TEST_CASE("conversion to double rounds to nearest") {
  CHECK(Rational(1, 3).to_double() == 1.0 / 3.0);
  CHECK(Rational::parse("0.1")->to_double() == 0.1);
  CHECK(Rational::parse("1e400")->to_double() == std::numeric_limits<double>::infinity());
  CHECK(Rational::parse("4.9e-324")->to_double() == 4.9e-324);
  CHECK(Rational::parse("2.2250738585072011e-308")->to_double() == 2.2250738585072011e-308);
  rc::check("strtod agrees", [] {
    const auto mantissa = *rc::gen::arbitrary<std::int64_t>();
    const auto exponent = *rc::gen::inRange(-330, 300);
    const std::string text = std::to_string(mantissa) + "e" + std::to_string(exponent);
    RC_ASSERT(Rational::parse(text)->to_double() == std::strtod(text.c_str(), nullptr));
  });
  rc::check("doubles survive the way there and back", [](double value) {
    RC_PRE(std::isfinite(value));
    RC_ASSERT(Rational::from_double(value).to_double() == value);
  });
}

TEST_CASE("field axioms hold across the boundary of the small representation") {
  rc::check([](std::int64_t a, std::int64_t b, std::int64_t c) {
    const auto scale = [](std::int64_t v) {
      return std::max<std::int64_t>(v, -std::numeric_limits<std::int64_t>::max());
    };
    const Rational x(scale(a)), y(scale(b)), z = Rational(scale(c)) / Rational(7);
    RC_ASSERT((x + y) * z == x * z + y * z);
    RC_ASSERT(x - x == Rational(0));
    if (!y.is_zero()) RC_ASSERT(x / y * y == x);
    RC_ASSERT((x < y) == (Rational(0) < y - x));
  });
}

TEST_CASE("sums and products are in lowest terms, whatever stands below") {
  const auto is = [](const Rational& value, std::int64_t numerator, std::int64_t denominator) {
    const auto parts = value.small();
    return parts && parts->numerator == numerator && parts->denominator == denominator;
  };
  CHECK(is(Rational(-6, 4) * Rational(2, 3), -1, 1));
  CHECK(is(Rational(3, 8) + Rational(1, 8), 1, 2));
  CHECK(is(Rational(3, 8) + Rational(-3, 8), 0, 1));
  CHECK(is(Rational(0) * Rational(5, 16), 0, 1));
  CHECK(is(Rational(1, 6) + Rational(1, 3), 1, 2));
  CHECK(is(Rational(-24, 32), -3, 4));
  const std::int64_t large = std::int64_t{1} << 62;
  CHECK(is(Rational(large) * Rational(-3, large), -3, 1));
  CHECK(is(Rational(-large, 3) * Rational(3, large), -1, 1));
}

TEST_CASE("exact roots") {
  CHECK(*exact_root(Rational(9, 4), 2) == Rational(3, 2));
  CHECK(*exact_root(Rational(27), 3) == Rational(3));
  CHECK_FALSE(exact_root(Rational(2), 2));
  for (int k = 2; k <= 7; ++k) {
    Rational root(1), power(1);
    for (int i = 0; i < 400; ++i) root = root * Rational(98765432101234567);  // 6800 digits
    root = root / Rational(3);
    for (int i = 0; i < k; ++i) power = power * root;
    CHECK(*exact_root(power, k) == root);
    CHECK_FALSE(exact_root(power + Rational(1), k));
  }
  CHECK_FALSE(exact_root(Rational(-4), 2));
  CHECK(*exact_root(Rational(0), 2) == Rational(0));
}

#include <maupertuis/expression.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace maupertuis;

namespace {
struct Fixture {
  Context c;
  Expr m = c.symbol("m", Role::Parameter), x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
};
}  // namespace

TEST_CASE_FIXTURE(Fixture, "equal expressions are one node") {
  CHECK(x * y + m == m + y * x);
  CHECK(x + x == x * Rational(2));
  CHECK((x - x).is_zero());
  CHECK((x * pow(x, Rational(-1))).is_one());
  CHECK(x * x == pow(x, Rational(2)));
  CHECK(pow(x * y * Rational(2), Rational(2)) == Rational(4) * pow(x, Rational(2)) * pow(y, Rational(2)));
}

TEST_CASE_FIXTURE(Fixture, "sums inside sums stay shared, products are flat") {
  const Expr partial = x + y;
  const Expr total = partial + m;
  CHECK(total.size() == 2);
  CHECK((partial - partial).is_zero());
  CHECK((m * (x * y)).size() == 3);
}

TEST_CASE_FIXTURE(Fixture, "roots keep the sign") {
  const Expr root = sqrt(pow(x, Rational(2)));
  CHECK(root == apply(Kind::Abs, x));
  CHECK(root * root == pow(x, Rational(2)));
  CHECK(x * root * root == pow(x, Rational(3)));
  CHECK(pow(sqrt(x), Rational(2)) == x);
  CHECK(sqrt(c.number(Rational(9, 4))) == c.number(Rational(3, 2)));
  CHECK(sqrt(c.number(2)) * sqrt(c.number(2)) == c.number(2));
}

TEST_CASE_FIXTURE(Fixture, "a sign times the size is the number itself") {
  const Expr size = apply(Kind::Abs, x), sign = apply(Kind::Sign, x);
  CHECK(sign * size == x);
  CHECK(m * size * sign * y == m * x * y);
  CHECK(sign * pow(size, Rational(3)) == pow(x, Rational(3)));
  CHECK(sign * pow(size, Rational(-1)) == pow(x, Rational(-1)));
  CHECK(sign * size * x == pow(x, Rational(2)));
  CHECK(sign * apply(Kind::Abs, y) != y);
  CHECK((sign * sqrt(size)).size() == 2);  // no whole power
  CHECK((sign * sign).is(Kind::Power));    // 0 at 0
}

TEST_CASE_FIXTURE(Fixture, "parity of functions") {
  CHECK(sin(-x) == -sin(x));
  CHECK(cos(-x) == cos(x));
  CHECK(sin(x - y) == -sin(y - x));
  CHECK(cos(x - y) == cos(y - x));
  CHECK(sin(((-x) + y) + m) == -sin(-((-x) + y) - m));  // a sum inside a sum that begins with a minus
  CHECK(sin(c.number(0)).is_zero());
  CHECK(apply(Kind::Abs, c.number(-3)) == c.number(3));
}

TEST_CASE_FIXTURE(Fixture, "zero to a negative power is kept, never folded to a number") {
  CHECK_FALSE(pow(c.number(0), Rational(-1)).is_number());
}

TEST_CASE_FIXTURE(Fixture, "the time derivative stays an operator but for leaves and constant factors") {
  CHECK(c.time_derivative(x) == c.symbol("x", Role::Coordinate, 1));
  CHECK(c.time_derivative(m).is_zero());
  CHECK(c.time_derivative(c.time()).is_one());
  CHECK(c.time_derivative(m * sin(x)) == m * c.time_derivative(sin(x)));
  CHECK(c.time_derivative(sin(x)).is(Kind::TimeDerivative));
}

TEST_CASE_FIXTURE(Fixture, "children come before parents in a topological order, each once") {
  const std::array roots{sin(x) * cos(y), sin(x) + m};
  const auto order = topological_order(roots);
  for (std::size_t i = 1; i < order.size(); ++i) CHECK(order[i - 1].id() < order[i].id());
  CHECK(symbols_of(roots).size() == 3);
}

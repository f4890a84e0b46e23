#include "symbolic/transform/small_polynomial.hpp"

#include <doctest/doctest.h>
#include <maupertuis/transform.hpp>

using namespace maupertuis;
using namespace maupertuis::terms;

namespace {

/// a x + b y + c
SmallPolynomial linear(int a, int b, int c) {
  SmallPolynomial out;
  if (a) out[{1, 0}] = Rational(a);
  if (b) out[{0, 1}] = Rational(b);
  if (c) out[{0, 0}] = Rational(c);
  return out;
}

}  // namespace

TEST_CASE("each factor stands once, with its multiplicity, and their product is the polynomial") {
  const SmallPolynomial a = linear(1, 1, 0), b = linear(1, -2, 3), c = linear(0, 1, 5);
  struct Case {
    SmallPolynomial product;
    std::size_t factors;
    int sum_of_multiplicities;
  };
  for (const Case& k : {Case{a * b, 2, 2},
                        {a * a, 1, 2},
                        {a * a * b, 2, 3},
                        {a * b * a * b, 2, 4},
                        {c * a * c, 2, 3},
                        {a * a * a * b, 2, 4},
                        {a * b * c, 3, 3}}) {
    Rational content;
    const auto found = factors(primitive(k.product, content));
    CHECK(found.size() == k.factors);
    int sum = 0;
    SmallPolynomial product = constant_polynomial(content, 2);
    for (const SmallFactor& f : found) {
      sum += f.multiplicity;
      for (int i = 0; i < f.multiplicity; ++i) product = product * f.value;
    }
    CHECK(sum == k.sum_of_multiplicities);
    CHECK((product == k.product || scaled(product, -1) == k.product));
  }
}

TEST_CASE("angles add in one order, whichever came first") {
  Context context;
  const Expr a = context.symbol("a", Role::Coordinate), b = context.symbol("b", Role::Coordinate),
             c = context.symbol("c", Role::Coordinate);
  const Expr early[] = {b, c, c * c, b * c, apply(Kind::Exp, c), apply(Kind::Exp, c) * b};
  const Expr sum = sin(a + b + c), parts = sin(a) * cos(b + c) + cos(a) * sin(b) * cos(c) + cos(a) * cos(b) * sin(c);
  for (const Expr& first : early)
    for (const Expr& e : {first + sum - parts, first * (sum - parts) + first, first + sum * sin(b) - parts * sin(b)}) {
      const Expr form = fourier_form(e);
      REQUIRE(form);
      CHECK(form == first);
    }
}

#include "equations/antiderivative.hpp"

#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

using namespace maupertuis;

TEST_CASE("powers times functions are integrated by parts, up to the twelfth power") {
  Context context;
  const Expr z = context.symbol("z", Role::Coordinate), a = context.symbol("a", Role::Parameter);
  for (const Expr& f :
       {sin(a * z), cos(a * z), apply(Kind::Exp, a * z), apply(Kind::Sinh, a * z), apply(Kind::Cosh, a * z)}) {
    for (const int n : {1, 2, 5, 12}) {
      CAPTURE(n);
      const Expr e = pow(z, Rational(n)) * f, integral = antiderivative(e, z);
      REQUIRE(integral);
      CHECK(zero_test(differentiate(integral, z) - e).verdict == Verdict::Zero);
    }
    CHECK_FALSE(antiderivative(pow(z, Rational(13)) * f, z));  // what nobody would read
    CHECK_FALSE(antiderivative(pow(z, Rational(1, 2)) * f, z));
    CHECK_FALSE(antiderivative(f / z, z));
  }
}

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace maupertuis;

namespace {

struct Line {
  Context c;
  Expr x = c.symbol("x", Role::Coordinate), a = c.symbol("a", Role::Parameter);
  Expr one = c.number(1);

  Expr rewritten(Expr e) { return without_overflow({&e, 1}).front(); }
  double value(Expr e, int u) { return evaluate(e, {{x, u}}); }
};

Expr exponential(Expr e) { return apply(Kind::Exp, e); }
Expr power(Expr e, int k) { return pow(e, Rational(k)); }

}  // namespace

TEST_CASE_FIXTURE(Line, "quotients of exponentials are finite where exponentials are not") {
  const Expr e = exponential(x), cosh = apply(Kind::Cosh, x), sinh = apply(Kind::Sinh, x);
  struct Case {
    Expr given;
    double far_left, far_right;
  };
  for (const Case& k :
       {Case{power(one + e, -1), 1, 0}, Case{e * power(one + e, -1), 0, 1}, Case{e * power(one + e, -2), 0, 0},
        Case{sinh * power(cosh, -1), -1, 1}, Case{sinh * power(cosh, -3), 0, 0},
        Case{power(e + exponential(-x), -1), 0, 0}, Case{(e - exponential(-x)) * power(e + exponential(-x), -1), -1, 1},
        Case{exponential(Rational(2) * x) * power(one + e, -2), 0, 1},
        Case{exponential(x + Rational(3)) * power(one + e, -1), 0, std::exp(3.0)},
        Case{power(one + e, -1) * exponential(-Rational(2) * x) * power(one + exponential(-x), -2), 1, 0}}) {
    const Expr finite = rewritten(k.given);
    CHECK(finite != k.given);
    for (const int u : {-299, -40, -3, 0, 2, 35, 299})
      CHECK(value(finite, u) == doctest::Approx(value(k.given, u)).epsilon(1e-14));
    for (const int u : {720, 5000, 2000000}) {
      CHECK(std::abs(value(finite, u) - k.far_right) <= 1e-14 * std::abs(k.far_right) + 1e-120);
      CHECK(std::abs(value(finite, -u) - k.far_left) <= 1e-14 * std::abs(k.far_left) + 1e-120);
    }
  }
}

TEST_CASE_FIXTURE(Line, "logarithms of sums of exponentials become straight lines") {
  const auto log = [](Expr e) { return apply(Kind::Log, e); };
  const Expr softplus = rewritten(log(one + exponential(x))), cosh = rewritten(log(apply(Kind::Cosh, x)));
  for (const int u : {-290, -5, 0, 7, 290}) {
    CHECK(value(softplus, u) ==
          doctest::Approx(u > 0 ? u + std::log1p(std::exp(-u)) : std::log1p(std::exp(u))).epsilon(1e-14));
    CHECK(value(cosh, u) == doctest::Approx(std::log(std::cosh(u))).epsilon(1e-14));
  }
  for (const int u : {400, 5000}) {
    CHECK(value(softplus, u) == doctest::Approx(u).epsilon(1e-15));
    CHECK(std::abs(value(softplus, -u)) < 1e-120);
    for (const int sign : {-1, 1}) CHECK(value(cosh, sign * u) == doctest::Approx(u - std::log(2.0)).epsilon(1e-15));
  }
}

TEST_CASE_FIXTURE(Line, "what grows, or may begin elsewhere, stays") {
  const Expr e = exponential(x), y = c.symbol("y", Role::Coordinate);
  const Rational tiny = Rational::from_double(0x1p-300);
  for (const Expr& given :
       {e, exponential(-x), x * e, sqrt(one + e), power(one + tiny * e, -1), power(one + a * e, -1),
        power(one + y * e, -1), power(one + e + exponential(x + Rational(400)), -1),
        power(one + e + exponential(a * x), -1), power(one + e + exponential(x + y), -1),
        power(one + exponential(exponential(x)) * e, -1), apply(Kind::Log, x), power(one + exponential(a), -1)})
    CHECK(rewritten(given) == given);
  // It grows to the right, where it keeps its u; to the left exp(−u) overflows and does not count.
  const Expr grows = power(e, 2) * power(one + exponential(-x), -1), finite = rewritten(grows);
  CHECK(value(grows, -5000) == 0);
  CHECK(value(finite, 305) == doctest::Approx(std::exp(610.0)).epsilon(1e-13));
  CHECK(value(finite, -5000) < 1e-120);
}

TEST_CASE_FIXTURE(Line, "powers on the way do not overflow either") {
  const Expr cosh = apply(Kind::Cosh, x), sinh = apply(Kind::Sinh, x), e = exponential(x);
  // At 240 cosh³ is beyond the doubles, and the quotient e^(-480) is not.
  const Expr cubed = rewritten(sinh * power(cosh, -3));
  CHECK(value(cubed, 240) > 0);
  CHECK(value(cubed, 190) == doctest::Approx(4 * std::exp(-380.0)).epsilon(1e-12));
  const Expr squared = rewritten(power(e, 2) * power(one + power(e, 2), -2));
  CHECK(value(squared, 300) > 0);
  CHECK(value(squared, 120) == doctest::Approx(std::exp(-240.0)).epsilon(1e-12));
}

TEST_CASE_FIXTURE(Line, "a parameter before an exponential counts by its value") {
  const Expr quotient = exponential(x) * power(one + a * exponential(x), -2);
  const auto with = [&](double value) {
    return without_overflow({&quotient, 1}, [value](Expr) { return value; }).front();
  };
  CHECK(rewritten(quotient) == quotient);
  CHECK(with(1e100) == quotient);  // it switches beyond what is kept
  const Expr finite = with(3);
  CHECK(evaluate(finite, {{x, 400}, {a, 3}}) > 0);
  CHECK(evaluate(finite, {{x, 100}, {a, 3}}) == doctest::Approx(std::exp(-100.0) / 9).epsilon(1e-12));
}

TEST_CASE_FIXTURE(Line, "series in double leave room for their coefficients") {
  const Expr pulse = power(apply(Kind::Cosh, x), -2), finite = without_overflow({&pulse, 1}, {}, 400).front();
  CHECK(value(finite, 190) == doctest::Approx(4 * std::exp(-380.0)).epsilon(1e-12));
  CHECK(value(finite, 5000) == doctest::Approx(4 * std::exp(-400.0)).epsilon(1e-12));
  CHECK(value(rewritten(pulse), 290) == doctest::Approx(4 * std::exp(-580.0)).epsilon(1e-12));
}

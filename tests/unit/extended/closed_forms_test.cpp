#include "../under_sanitizers.hpp"
#include "decimal.hpp"

using namespace maupertuis;

TEST_CASE("the harmonic oscillator to 100 digits; 0.1 is the decimal, a third is a third") {
  const ModelText m(
      "system o\nparam m = 0.3 kg, k = 0.1 N/m, w = 1 m/s\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
      "start x = 0.1 m, x' = w/7\nrun 3 s\n");
  const Decimal w = sqrt(Decimal("0.1") / Decimal("0.3"));
  const auto x = [&](const Decimal& t) { return Decimal(Decimal("0.1") * cos(w * t) + sin(w * t) / (7 * w)); };
  for (const Precision precision : {Precision::Quad, Precision::Digits100}) {
    ExtendedSimulationOptions options;
    options.precision = precision;
    options.at = {Rational(7, 10), Rational(-0), *Rational::parse("2.3")};
    const ExtendedResult r = run(m, options);
    REQUIRE(r.ok());
    const int least = precision == Precision::Quad ? 31 : 100;
    CHECK(r.statistics.seconds > 0);
    CHECK(r.statistics.check_seconds > 0);
    check_digits(r.at[0].q[0], x(Decimal("0.7")), least);
    check_digits(r.at[1].q[0], Decimal("0.1"), least);
    check_digits(r.at[2].q[0], x(Decimal("2.3")), least);
    check_digits(r.final.q[0], x(3), least);
    check_digits(r.final.v[0], -w * Decimal("0.1") * sin(w * 3) + cos(w * 3) / 7, least);
    check_digits(r.final.energy, Decimal("0.1") * Decimal("0.01") / 2 + Decimal("0.3") / 98, least);
  }
}

TEST_CASE("backwards, with degrees, minutes and a start at another time") {
  const ModelText m(
      "system o\nparam k = 1 N m, J = 1 kg m^2\ncoord θ : angle\nT = 1/2 J θ'^2\nV = 1/2 k θ^2\n"
      "start θ = 30 deg\nrun 1 min\n");
  ExtendedSimulationOptions options = digits100();
  options.duration = Rational(-3, 2);
  const ExtendedResult r = run(m, options);
  const Decimal pi = boost::math::constants::pi<Decimal>();
  check_digits(r.final.q[0], pi / 6 * cos(Decimal("1.5")), 100);
  check_digits(r.final.v[0], pi / 6 * sin(Decimal("1.5")), 100);
  CHECK(r.reached == -1.5);
}

TEST_CASE("the period of the pendulum, 2π / agm(1, cos(θ0/2)) √(l/g), to 100 digits") {
  const ModelText m(
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\n"
      "gravity (0, -g)\nstart θ = 2.0 rad\nrun 1 s\n");
  Decimal a = 1, b = cos(Decimal(1));
  for (int i = 0; i < 12; ++i) {
    const Decimal mean = (a + b) / 2;
    b = sqrt(a * b);
    a = mean;
  }
  const Decimal period = 2 * boost::math::constants::pi<Decimal>() / a / sqrt(Decimal("9.81"));
  ExtendedSimulationOptions options = digits100();
  options.duration = rational(period);
  options.at = {rational(period / 4)};
  const ExtendedResult r = run(m, options);
  check_zero(r.at[0].q[0], 1e-101);
  check_digits(r.final.q[0], 2, 100);
  check_zero(r.final.v[0], 1e-101);
}

TEST_CASE("Kepler's equation, e = 0.6, after three quarters of a period") {
  const ModelText m(
      "system k\nparam μ = 1 m^3/s^2, m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = -μ m / sqrt(x^2 + "
      "y^2)\n"
      "start x = 0.4 m, y' = 2 m/s\nrun 4.5 s\n");
  const Decimal t("4.5"), e("0.6");
  Decimal anomaly = t;
  for (int i = 0; i < 20; ++i) anomaly -= (anomaly - e * sin(anomaly) - t) / (1 - e * cos(anomaly));
  const ExtendedResult r = run(m, digits100());
  check_digits(r.final.q[0], cos(anomaly) - e, 100);
  check_digits(r.final.q[1], Decimal("0.8") * sin(anomaly), 100);
  check_digits(r.final.energy, Decimal("-0.5"), 100);
}

TEST_CASE("every function of the language, along a motion that is t itself") {
  const ModelText m(
      "system f\ndimensionless\nparam c = 0.3\ncoord x : number\nT = 1/2 x'^2\nstart x = 0.2, x' = 1\n"
      "point P at (sin(x) + cos(x)*tan(x) + exp(c x), log(1 + x) + sqrt(x) + x^c)\n"
      "point Q at (asin(x) + acos(x/2) + atan(x), atan2(x, 1 + x) + sinh(x) - cosh(x) tanh(x/3))\n"
      "point R at (asinh(x) + acosh(1 + x), atanh(x/2) + x^(-3) + 1/(1 + x^2))\n"
      "point S at (erf(x), lambert_w(x exp(x)))\nrun 0.5\n");
  const ExtendedResult r = run(m, digits100());
  const Decimal x("0.7"), c("0.3");
  REQUIRE(r.final.points.size() == 8);
  check_digits(r.final.points[0], 2 * sin(x) + exp(c * x), 99);
  check_digits(r.final.points[1], log(1 + x) + sqrt(x) + pow(x, c), 99);
  check_digits(r.final.points[2], asin(x) + acos(x / 2) + atan(x), 99);
  check_digits(r.final.points[3], atan2(x, Decimal(1 + x)) + sinh(x) - cosh(x) * tanh(x / 3), 99);
  check_digits(r.final.points[4], log(x + sqrt(x * x + 1)) + log(1 + x + sqrt(x * (2 + x))), 99);
  check_digits(r.final.points[5], log((1 + x / 2) / (1 - x / 2)) / 2 + 1 / (x * x * x) + 1 / (1 + x * x), 99);
  Decimal erf = 0, power = x;  // its power series
  for (int n = 0; n < 120; ++n) {
    erf += power / (2 * n + 1);
    power *= -x * x / (n + 1);
  }
  check_digits(r.final.points[6], 2 * erf / sqrt(boost::math::constants::pi<Decimal>()), 99);
  check_digits(r.final.points[7], x, 99);
}

TEST_CASE("functions as forces: their series, not their values alone" * doctest::skip(under_sanitizers)) {
  // x'' = −V'(x) with V = log cosh x: energy tells whether all coefficients are right.
  const ModelText m(
      "system f\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = log(cosh(x)) + atan(x)/3 + asinh(x)/5 + (2 + "
      "x)^0.3 - exp(-x^2)\n"
      "start x = 0.4, x' = 0.5\nrun 2\n");
  const ExtendedResult r = run(m, digits100());
  const Decimal x("0.4");
  check_digits(r.final.energy,
               Decimal(1) / 8 + log(cosh(x)) + atan(x) / 3 + log(x + sqrt(x * x + 1)) / 5 + pow(2 + x, Decimal("0.3")) -
                   exp(-x * x),
               99);
}

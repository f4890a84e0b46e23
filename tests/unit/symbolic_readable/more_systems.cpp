#include "numeric.hpp"
#include "systems.hpp"

#include <doctest/doctest.h>

using namespace maupertuis;
using test::Lagrangian;
using test::square;

namespace {
const Rational half(1, 2);
}

TEST_CASE("pendulum on a driven cart with friction") {
  Lagrangian s;
  const Expr M = s.parameter("M"), m = s.parameter("m"), g = s.parameter("g"), l = s.parameter("l"),
             c = s.parameter("c"), F = s.parameter("F0"), w = s.parameter("ω");
  const Expr x = s.coordinate("x"), a = s.coordinate("θ");
  s.value = s.kinetic(M, {x}) + s.kinetic(m, {x + l * sin(a), -l * cos(a)}) + m * g * l * cos(a);
  auto rows = s.residuals();
  rows[0] = rows[0] + c * s.dot(x) - F * cos(w * s.context.time());
  const auto forms = readable_equations(rows, s.order);
  CHECK(to_plain(forms[0], s.order) == "(M + m) x'' + m l cos θ θ'' - m l sin θ θ'^2 + c x' - F0 cos(ω t)");
  CHECK(to_plain(forms[1], s.order) == "m l^2 θ'' + m l cos θ x'' + m g l sin θ");
  CHECK(s.text(s.value) == "1/2 (M + m) x'^2 + 1/2 m l^2 θ'^2 + m l cos θ x' θ' + m g l cos θ");
}

TEST_CASE("Kepler's problem in two charts") {
  Lagrangian cartesian;
  {
    Lagrangian& s = cartesian;
    const Expr m = s.parameter("m"), k = s.parameter("k"), x = s.coordinate("x"), y = s.coordinate("y");
    s.value = s.kinetic(m, {x, y}) + k * pow(square(x) + square(y), Rational(-1, 2));
    CHECK(s.equations()[0] == "m x'' + k x/(x^2 + y^2)^(3/2)");
    CHECK(s.equations()[1] == "m y'' + k y/(x^2 + y^2)^(3/2)");
  }
  Lagrangian polar;
  const Expr m = polar.parameter("m"), k = polar.parameter("k"), r = polar.coordinate("r"), f = polar.coordinate("φ");
  polar.value = polar.kinetic(m, {r * cos(f), r * sin(f)}) + k / r;
  CHECK(polar.equations()[0] == "m r'' - m r φ'^2 + k/r^2");
  CHECK(polar.equations()[1] == "m r^2 φ'' + 2 m r r' φ'");
}

TEST_CASE("relativistic particle: one fraction") {
  Lagrangian s;
  const Expr m = s.parameter("m"), c = s.parameter("c"), x = s.coordinate("x");
  s.value = -m * square(c) * sqrt(s.number(1) - square(s.dot(x)) / square(c));
  CHECK(s.equations()[0] == "m x''/(1 - x'^2/c^2)^(3/2)");
}

TEST_CASE("charged particle in a magnetic field") {
  Lagrangian s;
  const Expr m = s.parameter("m"), q = s.parameter("q"), B = s.parameter("B"), x = s.coordinate("x"),
             y = s.coordinate("y");
  s.value = s.kinetic(m, {x, y}) + half * q * B * (x * s.dot(y) - y * s.dot(x));
  CHECK(s.equations()[0] == "m x'' - q B y'");
  CHECK(s.equations()[1] == "m y'' + q B x'");
}

TEST_CASE("springs between points") {
  Lagrangian s;
  const Expr m = s.parameter("m"), g = s.parameter("g"), k = s.parameter("k"), l = s.parameter("l"),
             a = s.parameter("a"), l0 = s.parameter("l0");
  const Expr t = s.coordinate("θ");
  const Expr x = l * sin(t), y = -l * cos(t), length = sqrt(square(x - a) + square(y));
  const Expr V = m * g * y + half * k * square(length - l0);
  s.value = s.kinetic(m, {x, y}) - V;
  CHECK(s.equations()[0] == "m l^2 θ'' + m g l sin θ - k l a cos θ (1 - l0/sqrt(l^2 + a^2 - 2 l a sin θ))");
  CHECK(s.text(V) == "1/2 k (sqrt(l^2 + a^2 - 2 l a sin θ) - l0)^2 - m g l cos θ");
}

TEST_CASE("spring pendulum with the stretch as coordinate keeps (l + x)") {
  Lagrangian s;
  const Expr m = s.parameter("m"), k = s.parameter("k"), g = s.parameter("g"), l = s.parameter("l");
  const Expr x = s.coordinate("x"), a = s.coordinate("θ");
  const Expr X = (l + x) * sin(a), Y = -(l + x) * cos(a);
  s.value = s.kinetic(m, {X, Y}) - m * g * Y - half * k * square(x);
  CHECK(s.equations()[0] == "m x'' - m (l + x) θ'^2 + k x - m g cos θ");
  CHECK(s.equations()[1] == "m (l + x)^2 θ'' + 2 m (l + x) x' θ' + m g (l + x) sin θ");
}

TEST_CASE("arm with two links in relative angles") {
  Lagrangian s;
  const Expr m1 = s.parameter("m1"), m2 = s.parameter("m2"), I1 = s.parameter("I1"), I2 = s.parameter("I2"),
             g = s.parameter("g"), a1 = s.parameter("a1"), l1 = s.parameter("l1"), a2 = s.parameter("a2");
  const Expr a = s.coordinate("θ1"), b = s.coordinate("θ2");
  const Expr y1 = -a1 * cos(a), y2 = -l1 * cos(a) - a2 * cos(a + b);
  s.value = s.kinetic(m1, {a1 * sin(a), y1}) + s.kinetic(m2, {l1 * sin(a) + a2 * sin(a + b), y2}) +
            half * I1 * square(s.dot(a)) + half * I2 * square(s.dot(a) + s.dot(b)) - m1 * g * y1 - m2 * g * y2;
  const auto lines = s.equations();
  CHECK(lines[0] ==
        "(m1 a1^2 + I1 + I2 + m2 (l1^2 + a2^2 + 2 l1 a2 cos θ2)) θ1'' + (m2 a2^2 + I2 + m2 l1 a2 cos θ2) θ2''"
        " - m2 l1 a2 sin θ2 θ2'^2 - 2 m2 l1 a2 sin θ2 θ1' θ2' + (m1 a1 + m2 l1) g sin θ1 + m2 g a2 sin(θ1 + θ2)");
  CHECK(lines[1] ==
        "(m2 a2^2 + I2) θ2'' + (m2 a2^2 + I2 + m2 l1 a2 cos θ2) θ1'' + m2 l1 a2 sin θ2 θ1'^2 + m2 g a2 sin(θ1 + θ2)");
}

TEST_CASE("springs and masses in line") {
  Lagrangian s;
  const Expr m1 = s.parameter("m1"), m2 = s.parameter("m2"), k1 = s.parameter("k1"), k2 = s.parameter("k2");
  const Expr x1 = s.coordinate("x1"), x2 = s.coordinate("x2");
  s.value = s.kinetic(m1, {x1}) + s.kinetic(m2, {x2}) - half * k1 * square(x1) - half * k2 * square(x2 - x1);
  CHECK(s.equations()[0] == "m1 x1'' + k1 x1 + k2 (x1 - x2)");
  CHECK(s.equations()[1] == "m2 x2'' + k2 (x2 - x1)");
  CHECK(s.text(s.value) == "1/2 m1 x1'^2 + 1/2 m2 x2'^2 - 1/2 k1 x1^2 - 1/2 k2 (x1 - x2)^2");
}

TEST_CASE("potentials that are no polynomials") {
  Lagrangian s;
  const Expr m = s.parameter("m"), k = s.parameter("k"), n = s.parameter("n"), a = s.parameter("a"),
             x0 = s.parameter("x0");
  const Expr x = s.coordinate("x");
  const auto row = [&](Expr V) {
    s.value = s.kinetic(m, {x}) - V;
    return s.equations()[0];
  };
  CHECK(row(k * s.context.power(x, n)) == "m x'' + k n x^(n - 1)");
  CHECK(row(k * square(s.number(1) - apply(Kind::Exp, -a * (x - x0)))) ==
        "m x'' + 2 k a exp(-a (x - x0)) (1 - exp(-a (x - x0)))");
  CHECK(row(k * apply(Kind::Abs, x)) == "m x'' + k sign(x)");
  CHECK(row(k * apply(Kind::Log, x)) == "m x'' + k/x");
  CHECK(row(half * k * square(sqrt(square(x) + square(a)) - x0)) == "m x'' + k x (1 - x0/sqrt(a^2 + x^2))");
}

TEST_CASE("fractions are brought together where that helps") {
  Lagrangian s;
  const Expr x = s.coordinate("x"), y = s.coordinate("y");
  const Expr r2 = square(x) + square(y);
  CHECK(s.text(square(x) / r2 + square(y) / r2) == "1");
  CHECK(s.text(x / square(x)) == "1/x");
  CHECK(s.text(sqrt(r2) * sqrt(r2)) == "x^2 + y^2");
  CHECK(s.text(square(sin(x)) + square(cos(x))) == "1");
  CHECK(s.text(sin(x) / cos(x) * cos(x)) == "sin x");
}

TEST_CASE("a system beyond the budget gets intermediates with the same value") {
  Lagrangian s;
  const Expr m = s.parameter("m"), l = s.parameter("l");
  Expr x = s.number(0), y = s.number(0), phase = s.number(0);
  s.value = s.number(0);
  for (int i = 1; i <= 4; ++i) {
    const Expr q = s.coordinate("q" + std::to_string(i));
    phase = phase + square(q);
    x = x + l * cos(phase) * sin(q);
    y = y + l * sin(phase) * cos(q);
    s.value = s.value + s.kinetic(m, {x, y});
  }
  const auto rows = expand_time_derivatives(s.residuals());
  ReadableOptions small;
  small.term_budget = 100;
  const auto forms = readable_equations(rows, s.order, small);
  REQUIRE(!forms.front().intermediates.empty());
  CHECK(symbol_to_plain(forms.front().intermediates.front().symbol).size() >= 2);
  ExprMap values;
  for (const Intermediate& i : forms.front().intermediates) values.emplace(i.symbol, substitute(i.value, values));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(forms[i].own == s.order.coordinates[i]);
    for (unsigned seed = 1; seed <= 3; ++seed) CHECK(test::agree(rows[i], substitute(forms[i].value, values), seed));
  }
}

TEST_CASE("no number is taken out that makes the others longer") {
  Lagrangian s;
  const Expr k = s.parameter("k"), x = s.coordinate("x"), y = s.coordinate("y");
  const auto number = [&](const char* text) { return s.context.number(*Rational::parse(text)); };
  CHECK(s.text(number("1.99999985") * square(x) - number("0.00000005") * square(y)) ==
        "1.99999985 x^2 - 0.00000005 y^2");
  CHECK(s.text(half * k * square(x) + half * k * square(y)) == "1/2 k (x^2 + y^2)");
}

#include "systems.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace maupertuis;
using test::Lagrangian;

TEST_CASE("double pendulum from massive points") {
  Lagrangian s;
  const Expr m1 = s.parameter("m1"), m2 = s.parameter("m2"), g = s.parameter("g"), l1 = s.parameter("l1"),
             l2 = s.parameter("l2");
  const Expr a = s.coordinate("θ1"), b = s.coordinate("θ2");
  const Expr x1 = l1 * sin(a), y1 = -l1 * cos(a), x2 = x1 + l2 * sin(b), y2 = y1 - l2 * cos(b);
  s.value = s.kinetic(m1, {x1, y1}) + s.kinetic(m2, {x2, y2}) - m1 * g * y1 - m2 * g * y2;
  const auto lines = s.equations();
  CHECK(lines[0] ==
        "(m1 + m2) l1^2 θ1'' + m2 l1 l2 cos(θ1 - θ2) θ2'' + m2 l1 l2 sin(θ1 - θ2) θ2'^2 + (m1 + m2) g l1 sin θ1");
  CHECK(lines[1] == "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' - m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2");
}

TEST_CASE("spherical pendulum keeps the powers of sin θ") {
  Lagrangian s;
  const Expr m = s.parameter("m"), g = s.parameter("g"), l = s.parameter("l");
  const Expr a = s.coordinate("θ"), f = s.coordinate("φ");
  s.value = s.kinetic(m, {l * sin(a) * cos(f), l * sin(a) * sin(f), -l * cos(a)}) + m * g * l * cos(a);
  const auto lines = s.equations();
  CHECK(lines[0] == "m l^2 θ'' - m l^2 sin θ cos θ φ'^2 + m g l sin θ");
  CHECK(lines[1] == "m l^2 sin^2 θ φ'' + 2 m l^2 sin θ cos θ θ' φ'");
}

TEST_CASE("bead on a rotating hoop") {
  Lagrangian s;
  const Expr m = s.parameter("m"), g = s.parameter("g"), R = s.parameter("R"), w = s.parameter("Ω");
  const Expr a = s.coordinate("θ");
  const Expr f = w * s.context.time();
  s.value = s.kinetic(m, {R * sin(a) * cos(f), R * sin(a) * sin(f), -R * cos(a)}) + m * g * R * cos(a);
  CHECK(s.equations()[0] == "m R^2 θ'' - m R^2 Ω^2 sin θ cos θ + m g R sin θ");
}

TEST_CASE("elastic pendulum") {
  Lagrangian s;
  const Expr m = s.parameter("m"), k = s.parameter("k"), g = s.parameter("g"), l0 = s.parameter("l0");
  const Expr r = s.coordinate("r"), a = s.coordinate("θ");
  const Expr x = r * sin(a), y = -r * cos(a);
  s.value = s.kinetic(m, {x, y}) - m * g * y - Rational(1, 2) * k * pow(r - l0, Rational(2));
  const auto lines = s.equations();
  CHECK(lines[0] == "m r'' - m r θ'^2 + k (r - l0) - m g cos θ");
  CHECK(lines[1] == "m r^2 θ'' + 2 m r r' θ' + m g r sin θ");
}

TEST_CASE("Lagrange top") {
  Lagrangian s;
  const Expr m = s.parameter("m"), I1 = s.parameter("I1"), I3 = s.parameter("I3"), g = s.parameter("g"),
             l = s.parameter("l");
  const Expr f = s.coordinate("φ"), a = s.coordinate("θ"), p = s.coordinate("ψ");
  const Expr fd = s.context.time_derivative(f), ad = s.context.time_derivative(a), pd = s.context.time_derivative(p);
  const Rational half(1, 2), two(2);
  const Expr w1 = fd * sin(a) * sin(p) + ad * cos(p), w2 = fd * sin(a) * cos(p) - ad * sin(p), w3 = fd * cos(a) + pd;
  const Expr T = half * I1 * (pow(w1, two) + pow(w2, two)) + half * I3 * pow(w3, two);
  s.value = T - m * g * l * cos(a);
  const auto lines = s.equations();
  CHECK(lines[0] == "(I1 sin^2 θ + I3 cos^2 θ) φ'' + I3 cos θ ψ'' + 2 (I1 - I3) sin θ cos θ φ' θ' - I3 sin θ θ' ψ'");
  CHECK(lines[1] == "I1 θ'' - (I1 - I3) sin θ cos θ φ'^2 + I3 sin θ φ' ψ' - m g l sin θ");
  CHECK(lines[2] == "I3 ψ'' + I3 cos θ φ'' - I3 sin θ φ' θ'");
  CHECK(to_plain(readable(T, s.order).value, s.order) == "1/2 I1 (sin^2 θ φ'^2 + θ'^2) + 1/2 I3 (cos θ φ' + ψ')^2");
}

TEST_CASE("eight links from points") {
  Lagrangian s;
  std::vector<Expr> m, l, a;
  for (int i = 1; i <= 8; ++i) m.push_back(s.parameter("m" + std::to_string(i)));
  const Expr g = s.parameter("g");
  for (int i = 1; i <= 8; ++i) l.push_back(s.parameter("l" + std::to_string(i)));
  for (int i = 1; i <= 8; ++i) a.push_back(s.coordinate("θ" + std::to_string(i)));
  Expr x = s.number(0), y = s.number(0);
  s.value = s.number(0);
  for (std::size_t i = 0; i < 8; ++i) {
    x = x + l[i] * sin(a[i]);
    y = y - l[i] * cos(a[i]);
    s.value = s.value + s.kinetic(m[i], {x, y}) - m[i] * g * y;
  }
  // Row i: masses from max(i, j) on, the sine positive for the links after it.
  const auto masses = [](std::size_t from) {
    if (from == 8) return std::string("m8");
    std::string text = "(";
    for (std::size_t k = from; k <= 8; ++k) text += (k > from ? " + m" : "m") + std::to_string(k);
    return text + ")";
  };
  const auto pair = [&](std::size_t i, std::size_t j, const std::string& function) {
    const std::string low = std::to_string(std::min(i, j)), high = std::to_string(std::max(i, j));
    return masses(std::max(i, j)) + " l" + low + " l" + high + " " + function + "(θ" + low + " - θ" + high + ") θ" +
           std::to_string(j);
  };
  const auto lines = s.equations();
  for (std::size_t i = 1; i <= 8; ++i) {
    const std::string own = std::to_string(i);
    std::string expected = masses(i) + " l" + own + "^2 θ" + own + "''";
    for (std::size_t j = 1; j <= 8; ++j)
      if (j != i) expected += " + " + pair(i, j, "cos") + "''";
    for (std::size_t j = 1; j <= 8; ++j)
      if (j != i) expected += (j < i ? " - " : " + ") + pair(i, j, "sin") + "'^2";
    expected += " + " + masses(i) + " g l" + own + " sin θ" + own;
    CHECK(lines[i - 1] == expected);
  }
}

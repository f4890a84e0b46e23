#include <maupertuis/rate_products.hpp>
#include <maupertuis/transform.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace maupertuis;

namespace {

struct TwoAngles {
  Context c;
  Expr m = c.symbol("m", Role::Parameter), a = c.symbol("a", Role::Coordinate), b = c.symbol("b", Role::Coordinate),
       x = c.symbol("x", Role::Coordinate), da = c.time_derivative(a), db = c.time_derivative(b),
       dx = c.time_derivative(x);
  std::array<Expr, 3> coordinates{a, b, x};

  Expr rate(Expr e) { return c.time_derivative(e); }
  Expr of(Expr lagrangian) { return with_rate_products(lagrangian, coordinates); }
  bool has_rates(Expr e) { return c.has_time_derivative(e.id()); }
  bool is_same(Expr e) { return fourier_form(of(e)) == fourier_form(e); }
};

}  // namespace

TEST_CASE_FIXTURE(TwoAngles, "products of velocities with a cosine of both angles are products of rates") {
  CHECK(of(m * da * db * cos(a - b)) == m * (rate(sin(a)) * rate(sin(b)) + rate(cos(a)) * rate(cos(b))));
  CHECK(of(da * db * sin(a + b)) == -(rate(cos(a)) * rate(sin(b))) - rate(sin(a)) * rate(cos(b)));
  CHECK(of(m * dx * da * cos(a)) == m * dx * rate(sin(a)));
  CHECK(of(dx * da * sin(Rational(3) * a)) == Rational(-1, 3) * (dx * rate(cos(Rational(3) * a))));
}

TEST_CASE_FIXTURE(TwoAngles, "the function stays the same") {
  const Expr speeds = pow(dx + m * da * cos(a), Rational(2)) + pow(m * da * sin(a), Rational(2));
  for (const Expr& e : {m * da * db * cos(Rational(2) * a - Rational(3, 2) * b), x * da * db * sin(b - a), speeds,
                        da * db * cos(a) * sin(b) * x + m * pow(da, Rational(2)) - cos(a - b)}) {
    CHECK(has_rates(of(e)));
    CHECK(is_same(e));
  }
}

TEST_CASE_FIXTURE(TwoAngles, "what gains nothing keeps its form") {
  const Expr t = c.time();
  for (const Expr& e :
       {pow(da, Rational(2)) * pow(sin(b), Rational(2)), m * da * db, da * db * x, cos(a - b) * m, da * cos(a),
        dx * da * cos(b), da * db * cos(a - b + t), pow(da, Rational(2)) * db * cos(a), rate(sin(a)) * rate(x * x)})
    CHECK(of(e) == e);
  Expr large = m;
  for (int i = 0; i < 12; ++i) large = large * (c.symbol("p" + std::to_string(i), Role::Parameter) + x);
  CHECK(of(large * da * db * cos(a - b)) == large * da * db * cos(a - b));
}

#include <maupertuis/transform.hpp>
#include <maupertuis/variation.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace maupertuis;

namespace {
struct Pendulum {
  Context c;
  Expr m = c.symbol("m", Role::Parameter), l = c.symbol("l", Role::Parameter), g = c.symbol("g", Role::Parameter);
  Expr q = c.symbol("θ", Role::Coordinate), v = c.symbol("θ", Role::Coordinate, 1),
       a = c.symbol("θ", Role::Coordinate, 2);
};
Expr square(Expr e) { return pow(e, Rational(2)); }
}  // namespace

TEST_CASE_FIXTURE(Pendulum, "derivatives of elementary functions") {
  CHECK(differentiate(sin(q), q) == cos(q));
  CHECK(differentiate(square(q) * m, q) == Rational(2) * m * q);
  CHECK(differentiate(sin(q), v).is_zero());
  CHECK(differentiate(apply(Kind::Log, q), q) == pow(q, Rational(-1)));
  const std::array symbols{q, m};
  const auto both = gradient(m * square(sin(q)), symbols);
  CHECK(both[0] == Rational(2) * m * sin(q) * cos(q));
  CHECK(both[1] == square(sin(q)));
}

TEST_CASE_FIXTURE(Pendulum, "the chain rule in time") {
  CHECK(total_time_derivative(sin(q)) == cos(q) * v);
  CHECK(total_time_derivative(sin(q) * v) == cos(q) * square(v) + sin(q) * a);
  CHECK(total_time_derivative(c.time() * m) == m);
  const Expr nested = c.time_derivative(c.time_derivative(sin(q)));
  CHECK(expand_time_derivatives(nested) == cos(q) * a - sin(q) * square(v));
}

TEST_CASE_FIXTURE(Pendulum, "the variational residual of the pendulum, from T and V and from its point") {
  const std::array coordinates{q};
  const Expr by_hand = m * square(l) * square(v) / Rational(2) + m * g * l * cos(q);
  const Expr expected = m * square(l) * a + m * g * l * sin(q);
  CHECK(expand(expand_time_derivatives(variational_residual(by_hand, coordinates)[0])) == expand(expected));

  const Expr x = l * sin(q), y = -l * cos(q);
  const Expr from_point = m * (square(c.time_derivative(x)) + square(c.time_derivative(y))) / Rational(2) - m * g * y;
  const Expr residual = variational_residual(from_point, coordinates)[0];
  const Expr plain = expand_time_derivatives(residual);
  CHECK_FALSE(c.has_time_derivative(plain.id()));
  const Expr difference = expand(plain - expected);
  const Expr pythagoras = expand(substitute(difference, {{square(sin(q)), c.number(1) - square(cos(q))}}));
  CHECK(pythagoras.is_zero());
}

TEST_CASE_FIXTURE(Pendulum, "the residual of a long chain has a number of nodes linear in the links") {
  const auto nodes_of_chain = [](int n) {
    Context context;
    std::vector<Expr> coordinates;
    Expr x = context.number(0), y = context.number(0), lagrangian = context.number(0);
    for (int i = 0; i < n; ++i) {
      coordinates.push_back(context.symbol("q" + std::to_string(i), Role::Coordinate));
      x = x + sin(coordinates.back());
      y = y - cos(coordinates.back());
      lagrangian = lagrangian + square(context.time_derivative(x)) + square(context.time_derivative(y)) - y;
    }
    return topological_order(variational_residual(lagrangian, coordinates)).size();
  };
  const auto small = nodes_of_chain(50), large = nodes_of_chain(100);
  CHECK(large < 2.2 * static_cast<double>(small));
}

TEST_CASE_FIXTURE(Pendulum, "a variation commutes with d/dt and carries the orders of a symbol") {
  const Expr x = c.symbol("x", Role::Coordinate);
  const ExprMap directions{{q, x}};
  const auto D = [&](Expr e) { return c.time_derivative(e); };
  const std::array roots{m * square(v), D(sin(q) * v), c.time() * cos(q), m * l};
  const auto varied = variation(roots, directions);
  CHECK(varied[0] == Rational(2) * m * v * D(x));
  CHECK(varied[1] == D(cos(q) * x * v + sin(q) * D(x)));
  CHECK(varied[2] == -(c.time() * sin(q) * x));
  CHECK(varied[3].is_zero());
}

#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/function_kernel.hpp>
#include <maupertuis/functions.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace {

using namespace maupertuis;

struct Symbols {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate);
  Expr v = context.symbol("x", Role::Coordinate, 1), t = context.time(), k = context.symbol("k", Role::Parameter);

  Expr f(Kind kind, std::initializer_list<Expr> arguments) {
    return context.function(kind, std::span<const Expr>(arguments.begin(), arguments.size()));
  }
  /// One of every kind of node.
  std::vector<Expr> zoo() {
    std::vector<Expr> all;
    // Every function has a value either below 1 or above.
    std::apply(
        [&](const auto&... row) {
          (all.push_back(apply(
               row.kind, row.kind == Kind::Acosh ? context.number(1) + x * x : (sin(x) + Rational(3)) / Rational(5))),
           ...);
        },
        functions::rows);
    for (const Kind kind : {Kind::Sin, Kind::Tanh, Kind::Exp, Kind::Erf, Kind::Abs, Kind::Sign, Kind::Step})
      all.push_back(apply(kind, x * y - k));
    for (const Kind kind : {Kind::Atan2, Kind::Min, Kind::Max}) all.push_back(f(kind, {x, y * v}));
    const Expr less = f(Kind::Less, {x, y}), at_most = f(Kind::LessEqual, {v, t});
    all.push_back(f(Kind::Piecewise, {f(Kind::And, {less, at_most}), x, f(Kind::Or, {less, at_most}), y, k}));
    all.push_back(x - y - k * v + Rational(2) * t - context.pi());
    all.push_back(-(x * y));
    all.push_back(x / (y * y * k));
    all.push_back(pow(x * x + 1, Rational(-3, 2)) * pow(k, 7) / pow(x * x + y * y, Rational(1, 2)));
    all.push_back(pow(x * x + 1, Rational(2, 7)) + pow(y, -3));
    all.push_back(context.power(x * x + 1, y));
    return all;
  }
};

std::vector<double> at_point(const FunctionKernel& kernel, std::vector<double> inputs, std::vector<double> parameters) {
  FunctionWorkspace work(kernel);
  work.set_parameters(parameters);
  std::vector<double> out(kernel.outputs());
  work.evaluate(inputs, out);
  return out;
}

}  // namespace

TEST_CASE("values agree with the evaluation of the expressions, for every kind of node and on both sides of switches") {
  Symbols s;
  const auto all = s.zoo();
  const FunctionKernel kernel = build_function({{s.x, s.y, s.v, s.t}, {s.k}, all});
  for (const double x : {-1.3, -0.2, 0.7, 2.1})
    for (const double y : {-0.9, 0.4, 1.7}) {
      const double v = 0.3 - x * y, t = 0.8 * y, k = 1.25;
      const auto expected = evaluate(all, {{s.x, x}, {s.y, y}, {s.v, v}, {s.t, t}, {s.k, k}});
      const auto got = at_point(kernel, {x, y, v, t}, {k});
      for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        CHECK(got[i] == doctest::Approx(expected[i]).epsilon(1e-14));
      }
    }
}

TEST_CASE("at the switch itself: sign(0) = 0, step(0) = 1, and what has no value stays so") {
  Symbols s;
  const FunctionKernel kernel = build_function({{s.x},
                                                {},
                                                {apply(Kind::Sign, s.x), apply(Kind::Step, s.x), apply(Kind::Log, s.x),
                                                 s.f(Kind::Min, {s.x, s.context.number(1)})}});
  const auto zero = at_point(kernel, {0}, {});
  CHECK(zero[0] == 0);
  CHECK(zero[1] == 1);
  CHECK(std::isnan(at_point(kernel, {-1}, {})[2]));
  for (const double value : at_point(kernel, {std::numeric_limits<double>::quiet_NaN()}, {})) CHECK(std::isnan(value));
}

TEST_CASE("derivatives are exact, and only those that do not vanish are outputs") {
  Symbols s;
  const std::vector<Expr> inputs{s.x, s.y, s.v};
  const std::vector<Expr> functions{s.k * s.x * s.x, sin(s.x * s.y), s.k};
  const DifferentiableKernel kernel = build_differentiable({inputs, {s.k}, functions});
  REQUIRE(kernel.entries.size() == 3);  // one, two and no inputs
  const auto got = at_point(kernel.values_and_entries, {0.7, -1.1, 3}, {2});
  CHECK(got[0] == doctest::Approx(0.98));
  for (std::size_t i = 0; i < kernel.entries.size(); ++i) {
    const auto [row, column] = kernel.entries[i];
    const double expected =
        evaluate(differentiate(functions[row], inputs[column]), {{s.x, 0.7}, {s.y, -1.1}, {s.v, 3}, {s.k, 2}});
    CHECK(got[3 + i] == doctest::Approx(expected).epsilon(1e-15));
  }
  CHECK(kernel.values.uses(0));
  CHECK_FALSE(kernel.values.uses(2));
}

TEST_CASE("shared sub-expressions are computed once, those of parameters outside of the call") {
  Symbols s;
  Expr e = s.x;
  for (int i = 0; i < 200; ++i) e = sin(e) * e + e;
  CHECK(build_function({{s.x}, {}, {e}}).size() == 400);  // a sine, and a sum with a product in it
  CHECK(build_function({{s.x}, {s.k}, {s.x * sin(s.k) * apply(Kind::Exp, s.k)}}).size() <= 2);
}

TEST_CASE("an unlisted symbol and an operator d/dt are internal errors") {
  Symbols s;
  CHECK_THROWS_AS(build_function({{s.x}, {}, {s.k}}), std::logic_error);
  CHECK_THROWS_AS(build_function({{s.x}, {}, {s.context.time_derivative(sin(s.x))}}), std::logic_error);
}

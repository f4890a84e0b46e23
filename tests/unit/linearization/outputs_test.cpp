#include "support.hpp"

#include <maupertuis/regulator.hpp>
#include <maupertuis/symbolic_linearization.hpp>

using namespace maupertuis;

// What is measured: y = y₀ + C x + D u, against closed forms and against differences along the motion.

TEST_CASE("an accelerometer on a driven oscillator passes the force on") {
  const ModelText m(R"(system driven
param m = 2 kg, k = 8 N/m
input u : [N] = 0
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
force x = u
)");
  const Expr outputs[] = {m.q(0), m.a(0), m.p("m") * m.a(0) + m.p("k") * m.q(0), m.system->inputs[0].symbol * m.v(0)};
  const PointEquations at(m.equations, outputs);
  OperatingPoint point{0, {0.5}, {3.0}, {-2.0}, {}, {0.0}};
  const MeasuredOutputs y = linearize(at, point).linearization.measured;
  CHECK(y.values == std::vector<double>{0.5, -2, 0, 0});
  CHECK(y.c.entries == std::vector<double>{1, 0, -4, 0, 0, 0, 0, 0});  // x'' = (u - k x)/m
  CHECK(y.d.entries == std::vector<double>{0, 0.5, 1, 3});
}

TEST_CASE("the tension of a rod, against its closed form and differences on the circle") {
  const ModelText m(R"(system cartesian
param m = 2 kg, l = 70 cm, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
)");
  const Expr outputs[] = {m.system->constraints[0].reaction};
  const PointEquations at(m.equations, outputs);
  const auto state = [](double x, double rate) {
    const double y = -std::sqrt(0.49 - x * x);
    return MotionState{0, {x, y}, {rate, -x * rate / y}};
  };
  const auto measured = [&](double x, double rate) {
    const auto point = operating_point(at, state(x, rate));
    REQUIRE(point);
    return linearize(at, *point).linearization;
  };
  const auto tension = [&](double x, double rate) {
    const MotionState s = state(x, rate);
    return 2 * (s.v[0] * s.v[0] + s.v[1] * s.v[1]) / 0.7 - 2 * 9.81 * s.q[1] / 0.7;
  };
  const Linearization l = measured(0.3, 1.7);
  REQUIRE(l.independent.size() == 1);
  const bool by_x = l.independent[0] == 0;
  REQUIRE(by_x);
  CHECK(near(l.measured.values[0], tension(0.3, 1.7), 1e-14));
  constexpr double h = 1e-5;
  CHECK(near(l.measured.c.at(0, 0), (tension(0.3 + h, 1.7) - tension(0.3 - h, 1.7)) / (2 * h), 1e-8));
  CHECK(near(l.measured.c.at(0, 1), (tension(0.3, 1.7 + h) - tension(0.3, 1.7 - h)) / (2 * h), 1e-8));
}

TEST_CASE("an output has a row of numbers only where it has a derivative") {
  const ModelText m(R"(system free
param m = 2 kg, l = 3 m
coord x, y : length
T = 1/2 m (x'^2 + y'^2)
V = 0
)");
  Context& c = *m.system->context;
  const auto f = [&](Kind kind, const std::vector<Expr>& arguments) { return c.function(kind, arguments); };
  const Expr x = m.q(0), y = m.q(1), v = m.v(0), l = m.p("l");
  const Expr outputs[] = {f(Kind::Abs, {x}),  x * f(Kind::Abs, {x}), f(Kind::Max, {y - l, x}),
                          f(Kind::Sign, {v}), f(Kind::Abs, {y}) + v, c.number(1) / x};
  const PointEquations at(m.equations, outputs);
  const MeasuredOutputs found = linearize(at, {0, {0, 3}, {0, 0}, {0, 0}, {}, {}}).linearization.measured;
  const auto row = [&](std::size_t i) {
    return std::vector<double>(found.c.entries.begin() + 4 * static_cast<long>(i),
                               found.c.entries.begin() + 4 * static_cast<long>(i + 1));
  };
  for (const std::size_t i : {0, 2, 3, 5}) {
    CAPTURE(i);
    CHECK(std::isnan(row(i)[0]));
  }
  CHECK(std::isinf(found.values[5]));
  CHECK(row(1) == std::vector<double>{0, 0, 0, 0});  // x |x| is flat at 0
  CHECK(row(4) == std::vector<double>{0, 1, 1, 0});
}

TEST_CASE("inputs that act by their rates have matrices of their own") {
  const ModelText m(R"(dimensionless
param A = 0.1, w = 3
input s : [1] = A cos(w t)
coord θ : number
point P mass 2 at (s + sin θ, -cos θ)
gravity (0, -9.81)
D = 1/2*0.4*(θ' - s')^2
)");
  const Expr s = m.system->inputs[0].symbol, rate = m.system->context->time_derivative(s);
  const Expr outputs[] = {m.v(0) - rate, m.a(0), m.system->context->function(Kind::Abs, std::vector{rate})};
  const PointEquations at(m.equations, outputs);

  SUBCASE("at rest: 2 θ'' + 2 s'' + 0.4 (θ' - s') + 19.62 θ = 0") {
    const Linearization l = linearize(at, {0, {0}, {0}, {0}, {}, {0.1}}).linearization;
    CHECK(l.input.entries == std::vector<double>{0});
    CHECK(l.input_rate.entries == std::vector<double>{0.4});
    CHECK(l.input_acceleration.entries == std::vector<double>{-2});
    CHECK(l.b_rate.entries == std::vector<double>{0, 0.2});
    CHECK(l.b_acceleration.entries == std::vector<double>{0, -1});
    CHECK(l.measured.d.at(0, 0) == 0);
    CHECK(l.measured.d_rate.at(0, 0) == -1);
    CHECK(l.measured.d_rate.at(1, 0) == doctest::Approx(0.2));
    CHECK(l.measured.d_acceleration.at(1, 0) == doctest::Approx(-1));
    CHECK(std::isnan(l.measured.d_rate.at(2, 0)));  // |s'| has no slope at 0

    const auto formulas = symbolic_linearization(m.equations, l, {});
    REQUIRE(formulas);
    CHECK(evaluate(formulas->input_acceleration.at(0, 0), parameter_bindings(*m.system)) == -2);

    Diagnostics refused;
    CHECK_FALSE(linear_quadratic_regulator(l, {2, 2, {1, 0, 0, 1}}, {1, 1, {1}}, refused));
    CHECK(refused.items().front().code == "E1316");
  }

  SUBCASE("along a motion the inputs have the rates of their formula") {
    const auto point = operating_point(at, {0.2, {0.3}, {0.7}});
    REQUIRE(point);
    const double first = -0.3 * std::sin(0.6), second = -0.9 * std::cos(0.6);
    CHECK(near(point->a[0], -9.81 * std::sin(0.3) - second * std::cos(0.3) - 0.2 * (0.7 - first), 1e-13));
    CHECK(near(linearize(at, *point).linearization.measured.values[0], 0.7 - first, 1e-14));
  }
}

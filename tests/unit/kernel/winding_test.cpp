#include <maupertuis/transform.hpp>
#include <maupertuis/winding.hpp>

#include <doctest/doctest.h>

#include <optional>

using namespace maupertuis;

namespace {

struct TwoAngles {
  Context context;
  KernelSource source;
  Expr a, b, k;

  TwoAngles() {
    a = context.symbol("a", Role::Coordinate), b = context.symbol("b", Role::Coordinate);
    k = context.symbol("k", Role::Parameter);
    source.coordinates = {a, b};
    source.parameters = {k};
  }
  Expr dot(Expr e) { return context.time_derivative(e); }
  const Winding& with(Expr potential) {
    source.residual = variational_residual(
        (pow(dot(a), 2) + pow(dot(b), 2) + dot(a) * dot(b) * cos(a - b)) / Rational(2) - potential, source.coordinates);
    kernel = build_kernel(source);
    return winding(*kernel);
  }
  std::optional<Kernel> kernel;
};

}  // namespace

TEST_CASE("angles wind where they enter through sines and cosines of whole multiples alone") {
  TwoAngles m;
  CHECK(m.with(cos(m.a) + sin(Rational(3) * m.b - Rational(2) * m.a)).coordinates == std::vector<bool>{true, true});
  CHECK(m.with(cos(m.a) + m.k * pow(m.b, 2)).coordinates == std::vector<bool>{true, false});
  CHECK(m.with(cos(m.a / Rational(2))).coordinates == std::vector<bool>{false, true});
  CHECK(m.with(cos(m.k * m.b)).coordinates == std::vector<bool>{true, false});
  CHECK(m.with(apply(Kind::Exp, m.a - m.b)).coordinates == std::vector<bool>{false, false});
  CHECK(m.with(m.k * apply(Kind::Tanh, sin(m.a)) + m.k * m.b).coordinates ==
        std::vector<bool>{true, true});  // a force k has no angle in it
}

TEST_CASE("observables say what a turn adds to them, events forbid it") {
  TwoAngles m;
  m.source.observables = {m.a, m.a - Rational(2) * m.b, sin(m.a), m.dot(m.b)};
  const Winding& found = m.with(cos(m.a));
  REQUIRE(found.observables.size() == 4);
  REQUIRE(found.observables[0].size() == 1);
  CHECK(found.observables[0][0].turns == 1);
  REQUIRE(found.observables[1].size() == 2);
  CHECK(found.observables[1][0].turns + found.observables[1][1].turns == -1);
  CHECK(found.observables[2].empty());
  CHECK(found.observables[3].empty());
  m.source.events = {m.a - m.context.number(Rational(20))};
  CHECK(m.with(cos(m.a)).coordinates == std::vector<bool>{false, true});
}

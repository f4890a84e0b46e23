// Nothing goes on with a kind that a pass has no rule for: what it would take the value or the derivative for could be
// certified.
#include "../forgotten_kind.hpp"

#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/jet_numbers.hpp"

#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/functions.hpp>
#include <maupertuis/transform.hpp>

#include <array>
#include <stdexcept>
#include <vector>

using namespace maupertuis;

TEST_CASE("the tables and the constructors refuse a kind that is not there") {
  Context c;
  const std::array x{c.symbol("x", Role::Coordinate)};
  CHECK_THROWS_AS(family_of(forgotten_kind), std::logic_error);
  CHECK_THROWS_AS(name_of(forgotten_kind), std::logic_error);
  CHECK_THROWS_AS(functions::value(forgotten_kind, 0.5), std::logic_error);
  CHECK_THROWS_AS(functions::derivative(forgotten_kind, x[0], x[0]), std::logic_error);
  CHECK_THROWS_AS(c.function(forgotten_kind, x), std::logic_error);
  // What is no function has no row.
  for (const Kind kind : {Kind::Abs, Kind::Sum, Kind::Symbol, Kind::Less})
    CHECK_THROWS_AS(functions::value(kind, 0.5), std::logic_error);
}

TEST_CASE("derivatives, values and the zero test throw on a node of a kind that they do not know") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), strange = node_of_forgotten_kind(x);
  CHECK_THROWS_AS(differentiate(strange, x), std::logic_error);
  CHECK_THROWS_AS(total_time_derivative(strange), std::logic_error);
  CHECK_THROWS_AS(gradient(strange * x, std::array{x}), std::logic_error);
  CHECK_THROWS_AS(substitute(strange, {{x, x * x}}), std::logic_error);
  CHECK_THROWS_AS(evaluate(strange, {{x, 0.5}}), std::logic_error);
  CHECK_THROWS_AS(zero_test(strange - x), std::logic_error);
}

TEST_CASE("the numbers of the certificate throw on it, and on a series of erf without its Gaussian") {
  using namespace evaluation;
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), erf = apply(Kind::Erf, x);
  for (const Expr& e : {node_of_forgotten_kind(x), erf}) {
    const Tape tape({&e, 1});
    const FieldHints hints;
    FieldNumbers numbers(random_prime_triple(hints.m, 1), hints, 1);
    std::vector<FieldNumbers::Value> values;
    JetNumbers<FieldNumbers> jets(numbers, 3, [&](Expr s) { return jets.constant(numbers.symbol(s)); });
    std::vector<Jet<FieldNumbers::Value>> series;
    if (e != erf) CHECK_THROWS_AS(run(tape, numbers, values), std::logic_error);
    CHECK_THROWS_AS(run(tape, jets, series), std::logic_error);
  }
}

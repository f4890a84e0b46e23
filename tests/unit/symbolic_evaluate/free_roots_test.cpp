// Formulas with more roots than a random point has squares for: the distances of many bodies.
#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/degree.hpp"
#include "symbolic/evaluate/evaluator.hpp"
#include "symbolic/evaluate/field_numbers.hpp"

#include <string>
#include <vector>

using namespace maupertuis;
using namespace maupertuis::evaluation;

namespace {

constexpr std::size_t bodies = 14;  // 91 distances: no random point serves all of them

struct Bodies {
  Context c;
  std::vector<Expr> x, y, z;

  Bodies() {
    for (std::size_t i = 0; i < bodies; ++i) {
      x.push_back(c.symbol("x" + std::to_string(i), Role::Coordinate));
      y.push_back(c.symbol("y" + std::to_string(i), Role::Coordinate));
      z.push_back(c.symbol("z" + std::to_string(i), Role::Coordinate));
    }
  }
  Expr square(std::size_t i, std::size_t j) const {
    return pow(x[i] - x[j], Rational(2)) + pow(y[i] - y[j], Rational(2)) + pow(z[i] - z[j], Rational(2));
  }
  Expr potential() {
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < bodies; ++i)
      for (std::size_t j = 0; j < i; ++j) terms.push_back(pow(square(i, j), Rational(-1, 2)));
    return c.sum(terms);
  }
  /// Σ (x_i ∂V/∂y_i − y_i ∂V/∂x_i): the torque of the forces between them.
  Expr torque() {
    const Expr v = potential();
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < bodies; ++i)
      terms.push_back(x[i] * differentiate(v, y[i]) - y[i] * differentiate(v, x[i]));
    return c.sum(terms);
  }
};

}  // namespace

TEST_CASE("identities over the distances of many bodies are proved, with a bound") {
  Bodies b;
  const ZeroTest torque = zero_test(b.torque());
  CHECK(torque.verdict == Verdict::Zero);
  CHECK(torque.error_bound < 1e-6);
  CHECK(zero_test(b.torque() + b.x[0] * Rational(1, 1000)).verdict == Verdict::Nonzero);

  // Euler's theorem needs that d^2 · d^-3 = d^-1.
  std::vector<Expr> terms{b.potential()};
  for (const auto* axis : {&b.x, &b.y, &b.z})
    for (const Expr& q : *axis) terms.push_back(q * differentiate(b.potential(), q));
  CHECK(zero_test(b.c.sum(terms)).verdict == Verdict::Zero);
}

TEST_CASE("what needs that a root squared is its radicand is left open there, and never called false") {
  Bodies b;
  const Expr root = pow(b.square(0, 1), Rational(1, 2));
  const Expr hidden = (root + 1) * (root + 2) - (b.square(0, 1) + root * Rational(3) + 2);
  CHECK(zero_test(hidden).verdict == Verdict::Zero);  // alone, where points are found
  CHECK(zero_test(hidden + b.torque()).verdict == Verdict::Undecided);
}

TEST_CASE("a root of what is negative everywhere is no symbol: nothing is said of it") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
  const Expr nowhere = pow(c.number(Rational(-1)) - x * x, Rational(1, 2));
  CHECK(zero_test((x + y) * nowhere - (x * nowhere + y * nowhere)).verdict == Verdict::Undecided);
}

TEST_CASE("powers with free roots: what stays of the laws of powers") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate);
  const std::vector<Expr> roots{pow(x, Rational(1, 2)),
                                pow(x, Rational(-3, 2)),
                                pow(x, Rational(5, 2)),
                                pow(x, Rational(1, 3)),
                                pow(x + Rational(1), Rational(1, 2)),
                                c.power(c.number(Rational(2)), c.number(Rational(1, 2)))};
  const Tape tape(roots);
  const FieldHints hints = field_hints(tape);
  const FieldHints no_hints;  // x is not drawn positive
  FieldNumbers numbers(random_prime_triple(hints.m, 5), no_hints, 6);
  numbers.let_roots_be_free();
  int negative = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    numbers.set_seed(seed);
    std::vector<FieldNumbers::Value> values;
    run(tape, numbers, values);
    const auto value = [&](std::size_t i) { return values[tape.roots()[i]]; };
    const PrimeField& field = numbers.field();
    const auto at_x = numbers.symbol(x);
    negative += field.character(at_x) < 0;
    CHECK(field.multiply(value(1), field.multiply(at_x, at_x)) == value(0));
    CHECK(field.multiply(value(0), field.multiply(at_x, at_x)) == value(2));
    CHECK(value(3) != value(0));
    CHECK(value(4) != value(0));
    CHECK(field.multiply(value(0), value(0)) != at_x);
    CHECK(field.multiply(value(5), value(5)) == numbers.number(2));  // numbers keep their roots
  }
  CHECK(negative > 0);
}

TEST_CASE("the degree of formulas with free roots counts whole powers and one for each root, and no sheets") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate);
  const Expr root = pow(x * x + y, Rational(-3, 2));
  const Complexity known = complexity(Tape({&root, 1})), free = complexity(Tape({&root, 1}), true);
  CHECK(known.radicals == 1);
  CHECK(free.radicals == 0);
  CHECK(known.degree == 3);
  CHECK(free.degree == 4);
}

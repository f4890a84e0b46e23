// Points over a prime field at which many roots exist: what is evaluated again, and that it is enough.
#include <doctest/doctest.h>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/evaluator.hpp"
#include "symbolic/evaluate/stale_nodes.hpp"

#include <functional>
#include <string>
#include <vector>

using namespace maupertuis;
using namespace maupertuis::evaluation;

namespace {

/// Σ sin(x_i y_j)/|P_i − P_j| of points of a plane.
Expr distances(Context& c, int points) {
  std::vector<Expr> x, y, terms;
  for (int i = 0; i < points; ++i) {
    x.push_back(c.symbol("x" + std::to_string(i), Role::Coordinate));
    y.push_back(c.symbol("y" + std::to_string(i), Role::Coordinate));
    for (int j = 0; j < i; ++j) {
      const Expr square = pow(x[i] - x[j], Rational(2)) + pow(y[i] - y[j], Rational(2));
      terms.push_back(apply(Kind::Sin, x[i] * y[j]) * pow(square, Rational(-1, 2)));
    }
  }
  return c.sum(terms);
}

}  // namespace

TEST_CASE("after a symbol was drawn again the values are those of a walk over the whole tape") {
  Context c;
  const Expr sum = distances(c, 5);
  const Tape tape({&sum, 1});
  const FieldHints hints = field_hints(tape);
  const PrimeTriple primes = random_prime_triple(hints.m, 11);
  FieldNumbers numbers(primes, hints, 12);
  StaleNodes stale(tape);
  std::vector<FieldNumbers::Value> values, again;
  std::size_t evaluated = 0, walks = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    numbers.set_seed(seed);
    stale.all();
    for (bool complete = false; !complete;) {
      ++walks;
      try {
        run(tape, numbers, values, [&](Position at) {
          const bool is_stale = stale(at);
          evaluated += is_stale;
          return is_stale;
        });
        complete = true;
      } catch (const Redraw& redraw) {
        REQUIRE(stale.mend(numbers, redraw));
      }
    }
    run(tape, numbers, again);
    CHECK(values == again);
  }
  CHECK(walks > 20);
  CHECK(evaluated < walks * tape.size() / 4);
}

TEST_CASE("a symbol on which a radicand does not depend is not drawn again and again") {
  Context c;
  const Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate),
             a = c.symbol("a", Role::Coordinate), cosine = apply(Kind::Cos, a), sine = apply(Kind::Sin, a);
  // The root u comes first; then that of the length of (u, y) turned by a, the only symbol that u does not see.
  const Expr u = pow(x + y, Rational(1, 3));
  const Expr square = expand(pow(u * cosine - y * sine, Rational(2)) + pow(u * sine + y * cosine, Rational(2)));
  const Expr sum = pow(square, Rational(1, 2));
  const Tape tape({&sum, 1});
  const FieldHints hints = field_hints(tape);
  REQUIRE(hints.asking.size() == 2);
  FieldNumbers numbers(random_prime_triple(hints.m, 21), hints, 22);
  StaleNodes stale(tape);
  std::vector<FieldNumbers::Value> values;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    numbers.set_seed(seed);
    stale.all();
    bool complete = false;
    for (int walk = 0; !complete && walk < 40; ++walk) {
      try {
        run(tape, numbers, values, std::ref(stale));
        complete = true;
      } catch (const Redraw& redraw) {
        REQUIRE(stale.mend(numbers, redraw));
      }
    }
    CHECK(complete);
  }
}

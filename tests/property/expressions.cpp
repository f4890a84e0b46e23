// Passes over expressions against independent ways to the same value.
#include <doctest/doctest.h>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "generators.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/jet_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"

#include <cmath>
#include <optional>
#include <set>

using namespace maupertuis;
using namespace maupertuis::property;
using evaluation::FieldNumbers;
using FieldJet = evaluation::Jet<FieldNumbers::Value>;

namespace {

struct World {
  Context c;
  Expr x = c.symbol("x", Role::Coordinate), y = c.symbol("y", Role::Coordinate), a = c.symbol("a", Role::Parameter);
  Expr vx = c.symbol("x", Role::Coordinate, 1), vy = c.symbol("y", Role::Coordinate, 1), t = c.time();
  std::vector<Expr> leaves{x, y, a, vx, t};
  Bindings point{{x, 0.37}, {y, -0.81}, {a, 1.3}, {vx, 0.59}, {vy, -0.44}, {t, 0.71}};

  World() {
    point.emplace(c.symbol("x", Role::Coordinate, 2), 0.23);
    point.emplace(c.symbol("y", Role::Coordinate, 2), -0.67);
  }
};

/// Jets of the roots modulo a random prime, `lookup` filling in the symbols; again until everything is defined.
template <class Lookup>
std::optional<std::vector<FieldJet>> field_jets(std::vector<Expr> roots, Lookup lookup) {
  roots = evaluation::flatten_arguments(roots);
  const auto tape = evaluation::Tape::with_gaussians(roots);
  const auto hints = evaluation::field_hints(tape);
  for (std::uint64_t attempt = 1; attempt < 400; ++attempt) {
    try {
      const auto primes = evaluation::random_prime_triple(hints.m, attempt / 50);
      FieldNumbers numbers(primes, hints, evaluation::mix(attempt));
      evaluation::JetNumbers<FieldNumbers> jets(numbers, 3, [&](Expr e) { return lookup(numbers, e); });
      std::vector<FieldJet> values, out;
      evaluation::run(tape, jets, values);
      for (const auto root : tape.roots()) out.push_back(values[root]);
      return out;
    } catch (const evaluation::Redraw&) {
    }
  }
  return std::nullopt;
}

FieldJet plain(const FieldNumbers& numbers, Expr e) {
  FieldJet out;
  out(0, 0) = numbers.symbol(e);
  return out;
}

}  // namespace

TEST_CASE("a property that is false is falsified, and most random expressions have a point modulo a prime") {
  const auto result = rc::detail::checkTestable([](const Recipe& recipe) { RC_ASSERT(recipe.steps.size() < 3); });
  CHECK(result.is<rc::detail::FailureResult>());
  int tried = 0, found = 0;
  rc::holds("field points", [&](const Recipe& recipe) {
    World w;
    ++tried;
    found += field_jets({build(recipe, w.leaves, Functions::WithSwitches)}, plain).has_value();
  });
  CHECK(tried >= 100);
  CHECK(found > tried * 9 / 10);
}

TEST_CASE("random expressions hold every kind of the table, and every function of theirs is defined at a point") {
  World w;
  std::set<Kind> seen;
  for (std::uint32_t choice = 0; choice < 64; ++choice) {
    const Expr e = made_by(choice + (2u << 6) + (1u << 12), w.leaves, Functions::WithSwitches);
    CHECK(std::isfinite(evaluate(e, w.point)));
    for (const Expr& node : topological_order({&e, 1})) seen.insert(node.kind());
  }
  for (auto kind = static_cast<std::size_t>(Kind::Number); kind <= static_cast<std::size_t>(Kind::Or); ++kind) {
    if (static_cast<Kind>(kind) == Kind::TimeDerivative) continue;  // the Lagrangians have it, by a factor of their own
    CAPTURE(std::string(name_of(static_cast<Kind>(kind))));
    CHECK(seen.count(static_cast<Kind>(kind)) == 1);
  }
}

TEST_CASE("a derivative is the first-order part of a variation") {
  rc::holds("differentiate", [](const Recipe& recipe) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::WithSwitches);
    const auto jets = field_jets({e, differentiate(e, w.x)}, [&](const FieldNumbers& numbers, Expr s) {
      FieldJet out = plain(numbers, s);
      if (s == w.x) out(1, 0) = numbers.number(1);
      return out;
    });
    if (jets) RC_ASSERT((*jets)[0](1, 0) == (*jets)[1](0, 0));
  });
}

TEST_CASE("a derivative is the limit of difference quotients") {
  rc::holds("difference quotient", [](const Recipe& recipe) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::Smooth);
    const auto at = [&](double dx) {
      Bindings moved = w.point;
      moved[w.x] += dx;
      return evaluate(e, moved);
    };
    const double h = 1e-3, d = evaluate(differentiate(e, w.x), w.point);
    // Richardson's extrapolation; the change between two steps estimates what is left.
    const auto quotient = [&](double s) { return (at(s) - at(-s)) / (2 * s); };
    const double fine = (4 * quotient(h / 2) - quotient(h)) / 3, finer = (4 * quotient(h / 4) - quotient(h / 2)) / 3;
    const double error = 10 * std::abs(finer - fine) + 1e-9 * (1 + std::abs(at(0)) + std::abs(d));
    if (std::isfinite(error) && error < 1e-3 * (1 + std::abs(d))) RC_ASSERT(std::abs(d - finer) <= error);
  });
}

TEST_CASE("the gradient is the list of derivatives") {
  rc::holds("gradient", [](const Recipe& recipe) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::WithSwitches);
    const std::vector<Expr> symbols{w.x, w.y, w.a};
    const auto g = gradient(e, symbols);
    std::vector<Expr> all = g;
    for (const Expr& s : symbols) all.push_back(differentiate(e, s));
    const auto jets = field_jets(all, plain);
    if (jets)
      for (std::size_t i = 0; i < symbols.size(); ++i) RC_ASSERT((*jets)[i](0, 0) == (*jets)[i + symbols.size()](0, 0));
  });
}

TEST_CASE("the total time derivative is the derivative of the series along a path") {
  rc::holds("total_time_derivative", [](const Recipe& recipe) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::WithSwitches);
    const auto jets =
        field_jets({e, total_time_derivative(e), w.c.time_derivative(e)}, [&](const FieldNumbers& n, Expr s) {
          FieldJet out = plain(n, s);
          if (s == w.t) out(0, 1) = n.number(1);
          if (s.role() != Role::Coordinate) return out;
          const auto next = [&](int order) {
            return n.symbol(s.context().symbol(s.name(), Role::Coordinate, s.order() + order));
          };
          out(0, 1) = next(1);
          out(0, 2) = n.multiply(next(2), n.number(Rational(1, 2)));
          return out;
        });
    if (!jets) return;
    RC_ASSERT((*jets)[0](0, 1) == (*jets)[1](0, 0));
    RC_ASSERT((*jets)[2](0, 0) == (*jets)[1](0, 0));
  });
}

TEST_CASE("substitution commutes with evaluation") {
  rc::holds("substitute", [](const Recipe& recipe, const Recipe& other) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::WithSwitches), f = build(other, w.leaves, Functions::Smooth);
    Bindings inner = w.point;
    inner[w.x] = evaluate(f, w.point);
    const double direct = evaluate(substitute(e, {{w.x, f}}), w.point), composed = evaluate(e, inner);
    if (std::isfinite(direct) && std::isfinite(composed) && std::abs(direct) < 1e6)
      RC_ASSERT(std::abs(direct - composed) <= 1e-7 * (1 + std::abs(direct)));
  });
}

TEST_CASE("an expression minus its expansion is zero, and the zero test agrees with evaluation") {
  rc::holds("zero_test", [](const Recipe& recipe) {
    World w;
    const Expr e = build(recipe, w.leaves, Functions::Smooth);
    const Expr expanded = expand(e, 500);
    if (expanded) RC_ASSERT(zero_test(e - expanded).verdict == Verdict::Zero);
    const ZeroTest test = zero_test(e);
    if (test.verdict == Verdict::Zero) RC_ASSERT(std::abs(evaluate(e, w.point)) < 1e-6);
    if (test.verdict == Verdict::Nonzero) RC_ASSERT(test.witness_value != 0);
  });
}

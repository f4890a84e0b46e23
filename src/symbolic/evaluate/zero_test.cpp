#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/degree.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"
#include "symbolic/evaluate/stale_nodes.hpp"
#include "symbolic/evaluate/witness.hpp"

#include <functional>
#include <optional>

namespace maupertuis {
namespace {

using namespace evaluation;

struct FieldResult {
  enum class Outcome { AllZero, SomeNonzero, NoPoint } outcome = Outcome::AllZero;
  int points = 0;
  double smallest_group = 1;
};

enum class Roots { Known, Free };

FieldResult test_over_primes(const Tape& tape, const FieldHints& hints, Roots roots, int points_per_prime,
                             std::uint64_t seed, const Interrupt& interrupt) {
  FieldResult result;
  std::vector<FieldNumbers::Value> values;
  for (int prime = 0; prime < 2; ++prime) {
    int found = 0, mends_left = mends_allowed(tape);
    for (int try_prime = 0; try_prime < 40 && found < points_per_prime; ++try_prime) {
      seed = mix(seed);
      const PrimeTriple primes = random_prime_triple(hints.m, seed);
      result.smallest_group = static_cast<double>(std::min(primes.r, primes.q));
      std::optional<FieldNumbers> numbers;
      StaleNodes stale(tape);
      bool mended = false;
      for (int attempt = 0; attempt < 60 + 8 * points_per_prime && found < points_per_prime; attempt += !mended) {
        interrupt.throw_if_asked();
        try {
          if (!mended) {
            seed = mix(seed);
            stale.all();
            numbers ? numbers->set_seed(seed) : static_cast<void>(numbers.emplace(primes, hints, seed));
            if (roots == Roots::Free) numbers->let_roots_be_free();
          }
          mended = false;
          run(tape, *numbers, values, std::ref(stale));
        } catch (const Redraw& redraw) {
          if (redraw.another_prime || (attempt >= 60 && found == 0)) break;
          mended = numbers && mends_left-- > 0 && stale.mend(*numbers, redraw);
          continue;
        }
        ++found;
        ++result.points;
        for (const Position root : tape.roots())
          if (values[root] != 0) {
            result.outcome = FieldResult::Outcome::SomeNonzero;
            return result;
          }
      }
    }
    if (found < points_per_prime) {
      result.outcome = FieldResult::Outcome::NoPoint;
      return result;
    }
  }
  return result;
}

ZeroTest nonzero(const Witness& witness) {
  ZeroTest test;
  test.verdict = Verdict::Nonzero;
  test.witness = witness.point;
  test.witness_value = witness.value;
  test.error_bound = 0;
  return test;
}

}  // namespace

ZeroTest zero_test(std::span<const Expr> differences, const ZeroTestOptions& options) {
  ZeroTest test;
  std::vector<Expr> roots;
  for (const Expr& d : expand_time_derivatives(differences))
    if (!d.is_zero()) roots.push_back(d);
  if (roots.empty()) {
    test.verdict = Verdict::Zero;
    test.error_bound = 0;
    return test;
  }
  if (options.points < 1) {
    test.reason = "no point was asked for";
    return test;
  }
  // One real point first: it settles most of what is not zero, for the price of one walk.
  if (const auto witness = find_witness(Tape(roots), 2, options.seed)) return nonzero(*witness);

  const Tape tape(flatten_arguments(roots));
  const FieldHints hints = field_hints(tape);
  Complexity size = complexity(tape);
  const int points = points_needed(size, options.points);
  const Interrupt interrupt = interrupt_of(roots.front().context());
  FieldResult field = test_over_primes(tape, hints, Roots::Known, points, options.seed, interrupt);
  if (field.outcome == FieldResult::Outcome::NoPoint && size.radicals > 0) {
    const FieldResult free = test_over_primes(tape, hints, Roots::Free, points, options.seed, interrupt);
    if (free.outcome == FieldResult::Outcome::AllZero) field = free, size = complexity(tape, true);
  }
  if (field.outcome == FieldResult::Outcome::AllZero) {
    test.verdict = Verdict::Zero;
    test.points = field.points;
    test.error_bound = error_bound(size, points, field.smallest_group);
    return test;
  }
  if (const auto witness = find_witness(tape, 24, options.seed + 1)) return nonzero(*witness);
  if (const auto witness = find_witness_in_branches(roots, options.seed + 3)) return nonzero(*witness);
  if (const auto witness = find_precise_witness(tape, 8, options.seed + 2)) return nonzero(*witness);
  test.reason =
      field.outcome == FieldResult::Outcome::NoPoint
          ? "no point was found at which every root and logarithm is defined"
          : "it does not vanish as a formula, but at every real point that was tried it is 0 to 80 digits or undefined";
  return test;
}

ZeroTest zero_test(Expr e, const ZeroTestOptions& options) { return zero_test({&e, 1}, options); }

bool vanishes_identically(Expr e) { return e.is_zero() || zero_test(e).verdict == Verdict::Zero; }

}  // namespace maupertuis

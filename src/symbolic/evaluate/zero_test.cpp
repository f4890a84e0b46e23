#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/degree.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/leaves.hpp"
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

constexpr double certain = 1e-6;  // of signs that come up by chance: the probability that some never did

struct Judgement {
  FieldResult::Outcome outcome = FieldResult::Outcome::AllZero;
  int points = 0;
  double error_bound = 0;
};

Judgement judge_over_primes(std::span<const Expr> roots, const ZeroTestOptions& options) {
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
  return {field.outcome, field.points, error_bound(size, points, field.smallest_group)};
}

/// The leaves of a formula with switches, some at a time. `failing` is the first that does not vanish as a formula.
struct LeafJudgement {
  Judgement all;
  std::optional<Leaf> failing;
};

constexpr std::size_t leaves_together = 64;

LeafJudgement judge_leaves(const std::vector<Leaf>& leaves, const ZeroTestOptions& options) {
  LeafJudgement out;
  const auto take = [&](std::size_t from, std::size_t to) {
    std::vector<Expr> formulas;
    for (std::size_t k = from; k < to; ++k) formulas.push_back(leaves[k].formulas.front());
    const Judgement here = judge_over_primes(formulas, options);
    if (here.outcome != FieldResult::Outcome::AllZero) return false;
    out.all.points += here.points;
    out.all.error_bound = std::max(out.all.error_bound, here.error_bound);
    return true;
  };
  for (std::size_t from = 0; from < leaves.size() && !out.failing; from += leaves_together) {
    const std::size_t to = std::min(leaves.size(), from + leaves_together);
    if (take(from, to)) continue;
    for (std::size_t k = from; k < to && !out.failing; ++k)
      if (to - from == 1 || !take(k, k + 1)) out.failing = leaves[k];
  }
  return out;
}

ZeroTest nonzero(const Witness& witness) {
  ZeroTest test;
  test.verdict = Verdict::Nonzero;
  test.witness = witness.point;
  test.witness_value = witness.value;
  test.error_bound = 0;
  return test;
}

ZeroTest zero(const Judgement& judgement) {
  ZeroTest test;
  test.verdict = Verdict::Zero;
  test.points = judgement.points;
  test.error_bound = judgement.error_bound;
  return test;
}

ZeroTest undecided(std::string reason) {
  ZeroTest test;
  test.reason = std::move(reason);
  return test;
}

/// By real points, where the images say that the roots do not vanish or say nothing.
ZeroTest by_witnesses(std::span<const Expr> roots, const Judgement& field, const ZeroTestOptions& options) {
  const Tape tape(flatten_arguments(roots));
  if (const auto witness = find_witness(tape, 24, options.seed + 1)) return nonzero(*witness);
  if (const auto witness = find_witness_in_branches(roots, options.seed + 3)) return nonzero(*witness);
  if (const auto witness = find_precise_witness(tape, 8, options.seed + 2)) return nonzero(*witness);
  return undecided(field.outcome == FieldResult::Outcome::NoPoint
                       ? "no point was found at which every root and logarithm is defined"
                       : "it does not vanish as a formula, but at every real point that was tried it is 0 to 80 digits "
                         "or undefined");
}

/// First each side for itself, as a formula without conditions; where one does not vanish so, as √(x²) − x where x > 0,
/// together with the signs that random points have.
ZeroTest with_switches(const std::vector<Expr>& roots, const ZeroTestOptions& options) {
  const auto leaves = leaves_of(roots);
  if (leaves) {
    const LeafJudgement judged = judge_leaves(leaves->all, options);
    if (!judged.failing) return zero(judged.all);
    const Leaf& leaf = *judged.failing;
    if (const auto witness = find_witness_on_sides(leaf.formulas.front(), leaves->sides_of(leaf), options.seed + 4))
      return nonzero(*witness);
  }
  const Judgement field = judge_over_primes(roots, options);
  if (field.outcome != FieldResult::Outcome::AllZero) return by_witnesses(roots, field, options);
  if (field.error_bound <= certain) return zero(field);
  if (const auto witness = find_witness_in_branches(roots, options.seed + 3)) return nonzero(*witness);
  return undecided("it vanishes where it was tried, but it has more sides of switches than were met");
}

}  // namespace

ZeroTest zero_test(std::span<const Expr> differences, const ZeroTestOptions& options) {
  std::vector<Expr> roots;
  for (const Expr& d : expand_time_derivatives(differences))
    if (!d.is_zero()) roots.push_back(d);
  if (roots.empty()) return zero({});
  if (options.points < 1) return undecided("no point was asked for");
  // One real point first: it settles most of what is not zero, for the price of one walk.
  const Tape tape(roots);
  if (const auto witness = find_witness(tape, 2, options.seed)) return nonzero(*witness);
  if (complexity(tape).switches > 0) return with_switches(roots, options);
  const Judgement field = judge_over_primes(roots, options);
  return field.outcome == FieldResult::Outcome::AllZero ? zero(field) : by_witnesses(roots, field, options);
}

ZeroTest zero_test(Expr e, const ZeroTestOptions& options) { return zero_test({&e, 1}, options); }

bool vanishes_identically(Expr e) { return e.is_zero() || zero_test(e).verdict == Verdict::Zero; }

}  // namespace maupertuis

#include "certificate/compare.hpp"

#include <maupertuis/interrupt_scope.hpp>

#include "symbolic/evaluate/degree.hpp"
#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/normalize.hpp"
#include "symbolic/evaluate/stale_nodes.hpp"

#include <functional>
#include <optional>

namespace maupertuis::certification {
namespace {

using evaluation::FieldNumbers;
using evaluation::mix;
using Values = std::vector<Jet<FieldNumbers::Value>>;

constexpr int points_per_prime = 3;
constexpr double certain = 1e-6;     // of signs that come up by chance: the probability that some never did
constexpr double node_budget = 1e6;  // bounds the extra points that switches ask for

std::vector<FieldNumbers::Value> random_direction(const FieldNumbers& numbers, std::size_t n) {
  std::vector<FieldNumbers::Value> direction;
  for (std::size_t i = 0; i < n; ++i) direction.push_back(numbers.random(0x646972, i));
  return direction;
}

bool any_nonzero(const std::vector<FieldNumbers::Value>& differences) {
  return std::any_of(differences.begin(), differences.end(), [](FieldNumbers::Value v) { return v != 0; });
}

/// One direction at a time at the same point, to name the equation. Of the differences about constraints only the first
/// depends on the direction.
void find_rows(const Questions& questions, const evaluation::Tape& tape, FieldNumbers& numbers, RoutesResult& result) {
  const std::size_t n = questions.system.coordinates.size(), orders = orders_needed(tape);
  std::array<bool, RouteCount> found{};
  result.routes[ConstraintRows].row = n;
  Values values;
  for (std::size_t row = 0; row < n; ++row) {
    auto difference =
        differences(questions, tape, numbers, orders, unit_direction(numbers, n, row), values, every_position);
    difference[ConstraintRows].resize(questions.constraints.empty() ? 0 : 1);
    for (std::size_t route = 0; route < RouteCount; ++route) {
      if (found[route] || !result.routes[route].fails || !any_nonzero(difference[route])) continue;
      found[route] = true;
      result.routes[route].row = row;
    }
  }
}

/// False: no point was found modulo this prime within the attempts.
bool compare_at_points(const Questions& questions, const evaluation::Tape& tape, const evaluation::FieldHints& hints,
                       bool free_roots, int wanted, std::uint64_t& seed, RoutesResult& result, double& smallest_group) {
  const std::size_t n = questions.system.coordinates.size(), orders = orders_needed(tape);
  const bool walked_twice = !questions.unit_quaternions.empty();  // no value is left of the first path
  Values values;
  int found = 0, mends_left = evaluation::mends_allowed(tape);
  for (int prime = 0; prime < 20 && found < wanted; ++prime) {
    seed = mix(seed);
    const evaluation::PrimeTriple primes = evaluation::random_prime_triple(hints.m, seed);
    smallest_group = static_cast<double>(std::min(primes.q, primes.r));
    std::optional<FieldNumbers> numbers;
    evaluation::StaleNodes stale(tape);
    bool mended = false;
    for (int attempt = 0; attempt < 60 + 8 * wanted && found < wanted; attempt += !mended) {
      interrupt_of(*questions.system.context).throw_if_asked();
      try {
        if (!mended) {
          seed = mix(seed);
          stale.all();
          if (numbers)
            numbers->set_seed(seed);
          else
            numbers.emplace(primes, hints, seed);
          if (free_roots) numbers->let_roots_be_free();
        }
        mended = false;
        const auto difference = walked_twice ? differences(questions, tape, *numbers, orders,
                                                           random_direction(*numbers, n), values, every_position)
                                             : differences(questions, tape, *numbers, orders,
                                                           random_direction(*numbers, n), values, std::ref(stale));
        bool fails = false;
        for (std::size_t route = 0; route < RouteCount; ++route) {
          RouteResult& r = result.routes[route];
          if (any_nonzero(difference[route]))
            fails = r.fails = true;
          else if (!r.fails)
            ++r.points;
        }
        ++found;
        if (fails) {
          find_rows(questions, tape, *numbers, result);
          return true;
        }
      } catch (const evaluation::Redraw& redraw) {
        if (redraw.another_prime || (attempt >= 60 && found == 0)) break;
        mended = numbers && mends_left-- > 0 && stale.mend(*numbers, redraw);
      }
    }
  }
  return found >= wanted;
}

/// `free_roots`: each root is a number of its own, so that only what agrees says something.
RoutesResult compare(const Questions& questions, const evaluation::Tape& tape, const evaluation::FieldHints& hints,
                     bool free_roots, std::uint64_t seed) {
  RoutesResult result;
  evaluation::Complexity size = evaluation::complexity(tape, free_roots);
  const int affordable =
      static_cast<int>(std::max<double>(points_per_prime, node_budget / static_cast<double>(tape.size())));
  const int wanted = std::min(evaluation::points_needed(size, points_per_prime), affordable);
  double smallest_group = 1;
  for (int prime = 0; prime < 2 && result.complete; ++prime) {
    result.complete = compare_at_points(questions, tape, hints, free_roots, wanted, seed, result, smallest_group);
    for (const RouteResult& r : result.routes)
      if (r.fails) return result;
  }
  // Two derivatives of L multiply its degree by at most 8; one more factor is c or q̇.
  size.degree = 8 * size.degree + 1;
  size.height = 8 * size.height + 8;
  if (result.complete) result.error_bound = evaluation::error_bound(size, wanted, smallest_group);
  return result;
}

}  // namespace

RoutesResult compare_over_primes(const Questions& questions, std::uint64_t seed) {
  const auto by_sides = compare_by_sides(questions, seed);
  if (by_sides && (by_sides->complete || by_sides->is_real)) return *by_sides;
  RoutesResult result = compare_formulas(questions, seed);
  if (by_sides && result.error_bound > certain)  // else each side was met, and formulas agree there: √(x²) and x
    for (std::size_t route = 0; route < RouteCount; ++route)
      result.routes[route].is_doubtful = by_sides->routes[route].is_doubtful;
  return result;
}

RoutesResult compare_formulas(const Questions& questions, std::uint64_t seed) {
  RoutesResult result;
  const auto tape = evaluation::Tape::with_gaussians(evaluation::flatten_arguments(questions.roots));
  if (orders_needed(tape) > Jet<FieldNumbers::Value>::max_orders) {
    result.complete = false;
    return result;
  }
  const evaluation::FieldHints hints = evaluation::field_hints(tape);
  result = compare(questions, tape, hints, false, seed);
  const auto fails = [](const RoutesResult& r) {
    return std::any_of(r.routes.begin(), r.routes.end(), [](const RouteResult& route) { return route.fails; });
  };
  if (result.complete || fails(result)) return result;
  const RoutesResult free = compare(questions, tape, hints, true, seed);
  return free.complete && !fails(free) ? free : result;
}

}  // namespace maupertuis::certification

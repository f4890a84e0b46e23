#pragma once
#include "certificate/questions.hpp"

#include <maupertuis/evaluate.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace maupertuis::certification {

enum Route : std::size_t { Action, Dalembert, Power, ConstraintRows, RouteCount };

struct RouteResult {
  bool fails = false;
  bool is_doubtful = false;  // the formulas of a side differ, but no real point was found on it at which they do
  std::size_t row = 0;       // the first equation that fails; n: a constraint's own row
  int points = 0;            // at which all differences vanished
  double difference = 0;     // over the reals: of the failing row
};

struct RoutesResult {
  std::array<RouteResult, RouteCount> routes;
  bool complete = true;  // false: not enough points at which everything is defined
  bool is_real = false;  // what fails does so at real points
  double error_bound = 1;
};

/// Exactly, at random points of homomorphic images of the reals modulo two random primes. Where something switches, on
/// each side of each switch; where that proves nothing, on the sides that random signs meet.
RoutesResult compare_over_primes(const Questions& questions, std::uint64_t seed);

/// The same of formulas without switches, or on the sides that random signs meet.
RoutesResult compare_formulas(const Questions& questions, std::uint64_t seed);

/// On each side of each switch: complete where all sides are proved; or up to a side that is wrong at a real point.
/// Nothing where nothing switches or there are too many sides.
std::optional<RoutesResult> compare_by_sides(const Questions& questions, std::uint64_t seed);

/// To 60 digits, at random real points: where a prime field cannot follow, or to confirm a difference.
RoutesResult compare_over_reals(const Questions& questions, std::uint64_t seed, int points);

/// The same at one point, of which some symbols are given.
RoutesResult compare_at_real_point(const Questions& questions, const Bindings& point, std::uint64_t seed);

}  // namespace maupertuis::certification

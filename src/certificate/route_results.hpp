#pragma once
#include "certificate/questions.hpp"

#include <array>
#include <cstdint>

namespace maupertuis::certification {

enum Route : std::size_t { Action, Dalembert, Power, ConstraintRows, RouteCount };

struct RouteResult {
  bool fails = false;
  std::size_t row = 0;    // the first equation that fails; n: a constraint's own row
  int points = 0;         // at which all differences vanished
  double difference = 0;  // over the reals: of the failing row
};

struct RoutesResult {
  std::array<RouteResult, RouteCount> routes;
  bool complete = true;  // false: not enough points at which everything is defined
  double error_bound = 1;
};

/// Exactly, at random points of homomorphic images of the reals modulo two random primes.
RoutesResult compare_over_primes(const Questions& questions, std::uint64_t seed);

/// To 60 digits, at random real points: where a prime field cannot follow, or to confirm a difference.
RoutesResult compare_over_reals(const Questions& questions, std::uint64_t seed, int points);

}  // namespace maupertuis::certification

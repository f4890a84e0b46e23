#pragma once
#include "symbolic/evaluate/tape.hpp"

namespace maupertuis::evaluation {

/// A bound of the degree of a tape's roots as rational functions of their atoms, and of the bits of their coefficients.
struct Complexity {
  double degree = 0;      // of numerator and denominator over a common denominator
  double height = 0;      // bits
  int radicals = 0;       // distinct roots: the image is a cover of 2^radicals sheets
  int switches = 0;       // distinct signs asked for
  bool claimable = true;  // false: symbolic exponents of several bases, whose images are not proved independent
};
/// `free_roots`: of the image in which roots are numbers of their own (FieldNumbers::let_roots_be_free).
Complexity complexity(const Tape& tape, bool free_roots = false);

/// Points per prime so that each combination of the signs that switches ask for is likely to come up.
int points_needed(const Complexity& c, int wanted);

/// The probability that a nonzero expression vanishes at `points` points modulo each of two random primes; the exponent
/// groups of the image have at least `smallest_group` elements. 1 where none is claimed.
double error_bound(const Complexity& c, int points, double smallest_group);

}  // namespace maupertuis::evaluation

#pragma once
#include "symbolic/transform/term_algebra.hpp"

namespace maupertuis::terms {

/// Brings terms that differ by whole powers of one sum over their common denominator and cancels it where it divides:
///
///     v'/(1 − v²)^(1/2) + v² v'/(1 − v²)^(3/2)  =  v'/(1 − v²)^(3/2),     x²/(x² + y²) + y²/(x² + y²)  =  1
///
/// Returns p itself where there is nothing to combine.
Polynomial over_common_denominators(TermAlgebra& algebra, const Polynomial& p);

}  // namespace maupertuis::terms

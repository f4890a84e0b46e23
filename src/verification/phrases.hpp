#pragma once
#include <maupertuis/rational.hpp>

#include <string>

namespace maupertuis::phrases {

/// What a number before a term that should be 1 says of it: "is missing", "has the wrong sign", "has a factor 2 too
/// many", "lacks a factor 2", "is 5/7 of what it should be".
std::string of_factor(const Rational& number);

/// The same of all terms beside the inertia, or of the inertia alone, which a claim does not tell apart.
std::string of_ratio_to_inertia(const Rational& number);

}  // namespace maupertuis::phrases

#pragma once
#include "verification/row_terms.hpp"

#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

/// The derived equation that a false claim resembles, and by what the claim differs from it, with the accelerations
/// left in.
struct Resemblance {
  std::string text;                 // "It is the equation for θ1, times 1/(m l^2), but for this: missing: c x'"
  std::string sentence;             // the mistake in words of physics; empty: unknown
  std::vector<TermOrigin> origins;  // of the terms that differ; empty: unknown
  bool signs_alone = false;         // they differ by their sign
  bool in_several_ways = false;     // one is missing and another has the wrong sign
  bool explained() const { return !sentence.empty(); }
};

/// `difference`: left side − right side of a claim that does not follow from the equations. Nothing where it resembles
/// none of them: a claim with all accelerations eliminated, a sum of equations, something else.
std::optional<Resemblance> resembled_equation(Expr difference, const EquationsOfMotion& equations);

}  // namespace maupertuis

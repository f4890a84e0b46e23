#pragma once
#include "verification/resemblance.hpp"

namespace maupertuis {

/// The same among the equations in rates that the model names (`derive --form rates`): a claim such as Euler's equation
/// with a wrong sign. Only terms without σ' are looked for: one that is missing, or has a wrong sign or number.
/// Nothing where the model names no rates. Cost: the derivation in rates, and a zero test a term.
std::optional<Resemblance> resembled_equation_in_rates(Expr difference, const EquationsOfMotion& equations);

}  // namespace maupertuis

#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/invariants.hpp>

#include <optional>

namespace maupertuis::invariants {

/// A system in which constants that are no fractions of parameters and their square roots, as sin α, π, √(1 − β²) and
/// exp(0.3), are parameters of their own. Coefficients of integrals are found as fractions of parameters; so they are
/// fractions of these as well. What is conserved for any value of such a parameter is so for its own; what holds by a
/// relation between two of them, as sin² α + cos² α = 1, is not seen.
struct NamedConstants {
  EquationsOfMotion equations;
  ExprMap meaning;       // what each new parameter stands for
  bool related = false;  // some of them are functions of each other
};

/// Nothing where there is no such constant, or the equations are not those of the system alone (degenerate Lagrangians,
/// modes of contacts).
std::optional<NamedConstants> with_named_constants(const EquationsOfMotion& equations);

/// The constants in the place of their parameters, in all that a reader sees.
void put_back(const ExprMap& meaning, Invariants& found);

}  // namespace maupertuis::invariants

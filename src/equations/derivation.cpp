#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/print.hpp>

#include "equations/derivation_steps.hpp"

namespace maupertuis {

Derivation readable_derivation(const EquationsOfMotion& equations, bool with_steps) {
  Derivation derivation;
  derivation.equations = readable_equations(equations.residual, equations.order);
  for (const ReadableForm& row : derivation.equations)
    for (const Intermediate& intermediate : row.intermediates) {
      const auto known = [&](const Intermediate& other) { return other.symbol == intermediate.symbol; };
      bool found = false;
      for (const Intermediate& other : derivation.intermediates) found |= known(other);
      if (!found) derivation.intermediates.push_back(intermediate);
    }
  if (with_steps) derivation.steps = derivation_steps(equations, derivation);
  return derivation;
}

}  // namespace maupertuis

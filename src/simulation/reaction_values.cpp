#include <maupertuis/reactions.hpp>
#include <maupertuis/simulation.hpp>

#include <algorithm>

namespace maupertuis {

std::vector<Expr> with_reactions(const EquationsOfMotion& equations, std::span<const Expr> expressions) {
  const MechanicalSystem& system = *equations.system;
  const std::vector<Expr> symbols = symbols_of(expressions);
  const auto stands = [&](Expr symbol) { return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end(); };
  const bool any =
      std::any_of(system.constraints.begin(), system.constraints.end(),
                  [&](const Constraint& c) { return stands(c.reaction); }) ||
      std::any_of(system.contacts.begin(), system.contacts.end(),
                  [&](const Contact& c) { return stands(c.reaction); }) ||
      std::any_of(system.releases.begin(), system.releases.end(), [&](const Release& r) { return stands(r.reaction); });
  if (!any) return {expressions.begin(), expressions.end()};
  ExprMap values;
  for (const Reaction& r : reactions(equations))
    if (r.value) values.emplace(r.symbol, r.value);
  return substitute(expressions, values);
}

}  // namespace maupertuis

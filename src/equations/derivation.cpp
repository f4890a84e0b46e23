#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/print.hpp>

#include "equations/constraint_forms.hpp"
#include "equations/derivation_steps.hpp"

#include <algorithm>

namespace maupertuis {

std::vector<Intermediate> definitions_used(const MechanicalSystem& system, std::span<const Expr> roots) {
  std::vector<Expr> symbols = symbols_of(roots);
  std::vector<Intermediate> used;
  const auto stands = [&](Expr symbol) { return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end(); };
  // A definition may use earlier ones: going backwards, what its formula names counts as used.
  for (auto d = system.definitions.rbegin(); d != system.definitions.rend(); ++d) {
    if (!d->symbol || !d->formula || !stands(d->symbol)) continue;
    for (const Expr& s : symbols_of({&d->formula, 1})) symbols.push_back(s);
    used.insert(used.begin(), {d->symbol, d->formula});
  }
  return used;
}

namespace {

/// Definitions of the model first, then the named sub-expressions of the rows.
std::vector<Intermediate> legend_of(const EquationsOfMotion& equations, const Derivation& derivation) {
  std::vector<const ReadableForm*> rows;
  for (const ReadableForm& row : derivation.equations) rows.push_back(&row);
  for (const ReadableForm& row : derivation.constraint_forces) rows.push_back(&row);
  std::vector<Expr> roots;
  for (const ReadableForm* row : rows) {
    roots.push_back(row->value);
    for (const Intermediate& i : row->intermediates) roots.push_back(i.value);
  }
  for (const ConstraintEquation& c : derivation.constraints) roots.insert(roots.end(), {c.left, c.right});
  roots.push_back(equations.lagrangian_expanded);  // momenta and energies are shown beside the equations
  roots.insert(roots.end(), equations.generalized_forces.begin(), equations.generalized_forces.end());
  roots.insert(roots.end(), equations.dissipative_terms.begin(), equations.dissipative_terms.end());
  std::vector<Intermediate> legend = definitions_used(*equations.system, roots);
  for (const ReadableForm* row : rows)
    for (const Intermediate& i : row->intermediates) {
      const bool known = std::any_of(legend.begin(), legend.end(), [&](const Intermediate& other) { return other.symbol == i.symbol; });
      if (!known) legend.push_back(i);
    }
  return legend;
}

}  // namespace

Derivation readable_derivation(const EquationsOfMotion& derived, bool with_steps) {
  const EquationsOfMotion& equations = derived.shown();
  Derivation derivation;
  derivation.equations = readable_equations(equations.residual, equations.order);
  derivation.constraint_forces = readable_constraint_forces(equations);
  for (std::size_t k = 0; k < equations.system->constraints.size(); ++k)
    derivation.constraints.push_back(constraint_equation(equations, k));
  derivation.intermediates = legend_of(equations, derivation);
  if (with_steps) derivation.steps = derivation_steps(equations, derivation, reactions(derived));
  return derivation;
}

}  // namespace maupertuis

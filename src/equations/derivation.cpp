#include <maupertuis/couplings.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/jacobian.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/shared_form.hpp>

#include "equations/constraint_forms.hpp"
#include "equations/derivation_steps.hpp"

#include <algorithm>
#include <unordered_set>

namespace maupertuis {
namespace {

/// Entries of M beyond which nobody reads them: those of 100 coordinates that are all coupled.
constexpr std::size_t most_couplings_read = 10000;

}  // namespace

std::vector<Intermediate> definitions_used(const MechanicalSystem& system, std::span<const Expr> roots) {
  const std::vector<Expr> symbols = symbols_of(roots);
  std::unordered_set<Expr, ExprHash> standing(symbols.begin(), symbols.end());
  std::vector<Intermediate> used;
  // A definition may use earlier ones: going backwards, what its formula names counts as used.
  for (auto d = system.definitions.rbegin(); d != system.definitions.rend(); ++d) {
    if (!d->symbol || !d->formula || standing.count(d->symbol) == 0) continue;
    for (const Expr& s : symbols_of({&d->formula, 1})) standing.insert(s);
    used.push_back({d->symbol, d->formula});
  }
  std::reverse(used.begin(), used.end());
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
  std::unordered_set<Expr, ExprHash> known;
  for (const Intermediate& i : legend) known.insert(i.symbol);
  for (const ReadableForm* row : rows)
    for (const Intermediate& i : row->intermediates)
      if (known.insert(i.symbol).second) legend.push_back(i);
  return legend;
}

/// Rows with so many accelerations that they are written by shared parts: the intermediates stand with the first.
std::vector<ReadableForm> rows_by_shared_parts(const EquationsOfMotion& equations) {
  SharedForm shared = shared_form(equations.residual, equations.order);
  std::vector<ReadableForm> rows;
  for (std::size_t i = 0; i < shared.rows.size(); ++i)
    rows.push_back({shared.rows[i], {}, equations.system->coordinates[i].q});
  rows.front().intermediates = std::move(shared.intermediates);
  return rows;
}

}  // namespace

bool couples_too_much_to_read(const EquationsOfMotion& equations) {
  const std::size_t n = equations.residual.size();
  if (n * n <= most_couplings_read) return false;
  ExprVector velocities;
  for (const Coordinate& c : equations.system->coordinates) velocities.push_back(c.velocity);
  return !sparse_jacobian(equations.shown().momenta, velocities, std::max(most_couplings_read, 10 * n));
}

Derivation readable_derivation(const EquationsOfMotion& derived, bool with_steps) {
  const ExpressionLock lock(*derived.system->context);
  const EquationsOfMotion& equations = derived.shown();
  Derivation derivation;
  derivation.equations = couples_too_much_to_read(derived) ? rows_by_shared_parts(equations)
                                                           : readable_equations(equations.residual, equations.order);
  derivation.constraint_forces = readable_constraint_forces(equations);
  for (std::size_t k = 0; k < equations.system->constraints.size(); ++k)
    derivation.constraints.push_back(constraint_equation(equations, k));
  derivation.intermediates = legend_of(equations, derivation);
  if (with_steps) derivation.steps = derivation_steps(equations, derivation, reactions(derived));
  return derivation;
}

}  // namespace maupertuis

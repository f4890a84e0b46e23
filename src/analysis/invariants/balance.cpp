#include "analysis/invariants/balance.hpp"

#include "analysis/invariants/naming.hpp"
#include "analysis/invariants/search.hpp"
#include "analysis/invariants/symmetry.hpp"

#include <algorithm>

namespace maupertuis::invariants {
namespace {

bool is_acted_upon(const EquationsOfMotion& equations) {
  const auto acts = [](const ExprVector& v) {
    return std::any_of(v.begin(), v.end(), [](const Expr& e) { return !e.is_zero(); });
  };
  return equations.system->constrained() || acts(equations.generalized_forces) || acts(equations.dissipative_terms);
}

}  // namespace

void add_balance_laws(Invariants& result, Ansatz& ansatz, const EquationsOfMotion& equations,
                      const InvariantsOptions& options) {
  if (!is_acted_upon(equations)) return;
  const MechanicalSystem& system = *equations.system;
  const MotionRows rows = conservative_rows(equations);
  if (!accelerations(conservative_residual(equations), system)) return;  // L alone does not determine a motion
  const Basis basis = noether_basis(ansatz, rows, options.largest_basis, options.seed + 11);
  const SearchResult found =
      conserved_combinations(rows, ansatz.generators, basis, {}, options.largest_basis * 100'000, options.seed + 12);
  const Namer namer(equations, rows, ansatz, options.seed + 13);
  for (const Combination& c : found.found) {
    const Naming naming = namer.name(c.value);
    if (naming.name.empty() || depends_on_time_itself(naming.scaled)) continue;
    if (naming.rank == 0) {  // energy: its power
      if (zero_test(equations.power).verdict == Verdict::Zero) continue;
      result.balance_laws.push_back({naming.name, readable(equations.shown().energy_function, equations.order),
                                     readable(expand_time_derivatives(equations.shown().power), equations.order)});
      continue;
    }
    const auto displacement = symmetry_of(naming.scaled, rows);
    if (!displacement) continue;
    Expr rate = system.context->number(0);
    for (std::size_t i = 0; i < displacement->size(); ++i) {
      Expr force = equations.generalized_forces[i] - equations.dissipative_terms[i];
      if (system.constrained()) force = force + equations.constraint_forces[i];
      rate = rate + force * (*displacement)[i];
    }
    rate = in_state_variables(system, {rate}).front();
    if (zero_test(rate).verdict == Verdict::Zero) continue;
    result.balance_laws.push_back(
        {naming.name, readable(naming.scaled, equations.order), readable(rate, equations.order)});
  }
}

}  // namespace maupertuis::invariants

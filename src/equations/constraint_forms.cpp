#include <maupertuis/equations_of_motion.hpp>

#include "equations/constraint_forms.hpp"
#include "equations/simplified.hpp"

namespace maupertuis {

ConstraintEquation constraint_equation(const EquationsOfMotion& equations, std::size_t index) {
  const Constraint& c = equations.system->constraints[index];
  Context& context = c.value.context();
  ExprVector left, right;
  const auto place = [&](Expr term) {
    const ScaledTerm scaled = split_coefficient(term);
    if (scaled.coefficient.sign() >= 0)
      left.push_back(term);
    else
      right.push_back(-term);
  };
  const auto place_terms = [&](Expr sum) {
    if (!sum.is(Kind::Sum)) return place(sum);
    for (std::size_t i = 0; i < sum.size(); ++i) place(sum[i]);
  };
  // Both sides of the text are sums of their own within left − right.
  if (c.value.is(Kind::Sum))
    for (std::size_t i = 0; i < c.value.size(); ++i) place_terms(with_flat_sums(c.value[i]));
  else
    place(with_flat_sums(c.value));
  return {equations.system->constraint_label(index), context.sum(left), context.sum(right)};
}

std::vector<ReadableForm> readable_constraint_forces(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  if (!system.constrained()) return {};
  const ExprMatrix a = constraint_matrix(equations);
  std::vector<ReadableForm> rows(a.columns);
  for (std::size_t i = 0; i < a.columns; ++i) {
    ExprVector terms;
    for (std::size_t k = 0; k < a.rows; ++k) {
      if (a.at(k, i).is_zero()) continue;
      // Never by intermediates: their names would mean something else in the next row.
      terms.push_back(simplified(a.at(k, i), equations.order) * equations.multipliers[k]);
    }
    rows[i].value = system.context->sum(terms);
    rows[i].own = system.coordinates[i].q;
  }
  return rows;
}

}  // namespace maupertuis

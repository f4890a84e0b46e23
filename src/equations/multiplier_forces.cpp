#include "equations/multiplier_forces.hpp"

#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

bool has_multiplier(Expr e, const ExprVector& multipliers) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [&](Expr s) { return std::find(multipliers.begin(), multipliers.end(), s) != multipliers.end(); });
}

}  // namespace

std::optional<MultiplierForces> multiplier_forces(const EquationsOfMotion& equations) {
  const ExprVector& multipliers = equations.multipliers;
  MultiplierForces out{expand_time_derivatives(equations.residual), constraint_matrix(equations), false};
  ExprMap without;
  for (const Expr& multiplier : multipliers) without.emplace(multiplier, multiplier.context().number(0));
  for (std::size_t i = 0; i < out.residual.size(); ++i) {
    if (!has_multiplier(out.residual[i], multipliers)) continue;
    out.of_friction = true;
    for (std::size_t k = 0; k < multipliers.size(); ++k) {
      const Expr slope = expand_time_derivatives(differentiate(out.residual[i], multipliers[k]));
      if (has_multiplier(slope, multipliers)) return std::nullopt;
      out.rows.at(k, i) = out.rows.at(k, i) - slope;
    }
    out.residual[i] = substitute(ExprVector{out.residual[i]}, without).front();
  }
  return out;
}

}  // namespace maupertuis

#include "simulation/motion_balance.hpp"

#include <maupertuis/rate_products.hpp>
#include <maupertuis/transform.hpp>

#include <array>

namespace maupertuis {
namespace {

/// d/dt ∂L/∂q̇ − ∂L/∂q + ∂D/∂q̇ − Q.
ExprVector rows_of(Expr lagrangian, const EquationsOfMotion& equations, const ExprVector& q) {
  ExprVector rows = variational_residual(lagrangian, q);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::array terms{rows[i], equations.dissipative_terms[i], -equations.generalized_forces[i]};
    rows[i] = lagrangian.context().sum(terms);
  }
  return rows;
}

}  // namespace

/// Rows that are not those of the Lagrangian alone, as of degenerate systems, stay as they are.
ExprVector motion_balance(const EquationsOfMotion& equations) {
  ExprVector q;
  for (const Coordinate& c : equations.system->coordinates) q.push_back(c.q);
  const Expr lagrangian = equations.lagrangian, by_rates = with_rate_products(lagrangian, q);
  if (by_rates == lagrangian || rows_of(lagrangian, equations, q) != equations.residual) return equations.balance();
  ExprVector rows = rows_of(by_rates, equations, q);
  for (std::size_t i = 0; i < equations.constraint_forces.size(); ++i)
    rows[i] = rows[i] - equations.constraint_forces[i];
  return rows;
}

}  // namespace maupertuis

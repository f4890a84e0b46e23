#include "analysis/hamiltonian/proofs.hpp"

#include <fmt/format.h>

namespace maupertuis {

using namespace phase_space;

namespace {

ExprMap map_of(const ExprVector& from, const ExprVector& to) {
  ExprMap map;
  for (std::size_t i = 0; i < from.size(); ++i) map.emplace(from[i], to[i]);
  return map;
}

struct Symbols {
  ExprVector q, v, inputs;
  explicit Symbols(const MechanicalSystem& system) {
    for (const Coordinate& c : system.coordinates) q.push_back(c.q), v.push_back(c.velocity);
    for (const Input& u : system.inputs) inputs.push_back(u.symbol);
  }
};

/// q̇ = ∂H/∂p put into p = ∂L/∂q̇, H = p·q̇ − L, ∂H/∂q = −∂L/∂q, ∂H/∂t = −∂L/∂t.
void check_transform(const Hamiltonian& h, const EquationsOfMotion& shown, Proofs& proofs) {
  const Symbols symbols(*h.system);
  Context& context = *h.system->context;
  const std::size_t n = h.momenta.size();
  const ExprMap velocities = map_of(symbols.v, {h.flow.begin(), h.flow.begin() + static_cast<std::ptrdiff_t>(n)});
  const Expr lagrangian = substitute(shown.lagrangian_expanded, velocities);
  ExprVector inverse = substitute(h.momentum_values, velocities);
  ExprVector products;
  for (std::size_t i = 0; i < n; ++i) {
    inverse[i] = inverse[i] - h.momenta[i];
    products.push_back(h.momenta[i] * h.flow[i]);
  }
  proofs.add("legendre", "∂L/∂q' at q' = ∂H/∂p is p", inverse);
  proofs.add("hamiltonian", "H is p·q' − L", {h.value - (context.sum(products) - lagrangian)});

  ExprVector variables = symbols.q;
  variables.insert(variables.end(), symbols.inputs.begin(), symbols.inputs.end());
  variables.push_back(context.time());
  const ExprVector of_h = gradient(h.value, variables);
  const ExprVector of_l = substitute(gradient(shown.lagrangian_expanded, variables), velocities);
  ExprVector sums;
  for (std::size_t i = 0; i < variables.size(); ++i) sums.push_back(of_h[i] + of_l[i]);
  proofs.add("partials", "∂H/∂q is −∂L/∂q, and ∂H/∂t is −∂L/∂t", sums);
}

/// d/dt ∂L/∂q̇ − p'(q, ∂L/∂q̇, t) − Aᵀλ is the residual of Lagrange's equations.
void check_against_lagrange(const Hamiltonian& h, const EquationsOfMotion& shown, Proofs& proofs) {
  const std::size_t n = h.momenta.size();
  const ExprVector put_in = substitute(h.flow, map_of(h.momenta, h.momentum_values));
  const ExprVector residual = expand_time_derivatives(shown.residual);
  ExprVector differences;
  for (std::size_t i = 0; i < n; ++i) {
    differences.push_back(put_in[i] - h.system->coordinates[i].velocity);
    differences.push_back(total_time_derivative(h.momentum_values[i]) - put_in[n + i] - residual[i]);
  }
  proofs.add("lagrange", "with p = ∂L/∂q' the canonical equations are Lagrange's", differences);
}

void check_what_is_shown(const Hamiltonian& h, const EquationsOfMotion& shown, Proofs& proofs) {
  const Symbols symbols(*h.system);
  const std::size_t n = h.momenta.size();
  const ExprMap velocities = map_of(symbols.v, {h.flow.begin(), h.flow.begin() + static_cast<std::ptrdiff_t>(n)});
  ExprVector differences;
  for (std::size_t i = 0; i < n; ++i) {
    if (h.velocities[i].right.value) differences.push_back(h.velocities[i].right.value - h.flow[i]);
    Expr flow = h.flow[n + i];
    if (!shown.constraint_forces.empty()) flow = flow + expand_time_derivatives(shown.constraint_forces[i]);
    differences.push_back(substitute(h.forces[i].right.value - flow, velocities));
  }
  if (h.legendre.readable.value) differences.push_back(h.legendre.readable.value - h.value);
  proofs.add("forms_agree", "what is printed is what was derived", differences);
}

/// Not every velocity follows from the momenta: what is left to say is said at p = ∂L/∂q̇.
void check_singular(const Hamiltonian& h, const EquationsOfMotion& shown, Proofs& proofs) {
  const ExprMap momenta = map_of(h.momenta, h.momentum_values);
  ExprVector constraints;
  for (const LegendreBlock& block : h.legendre.blocks)
    for (const Expr& c : block.primary_constraints) constraints.push_back(substitute(c, momenta));
  proofs.add("primary_constraints", "the primary constraints vanish at p = ∂L/∂q'", constraints);
  proofs.add("hamiltonian", "H at p = ∂L/∂q' is the energy function",
             {substitute(h.value, momenta) - shown.energy_function});
}

}  // namespace

Certificate certify(const Hamiltonian& h, const EquationsOfMotion& equations) {
  Proofs proofs(h, equations);
  if (!h.value) return proofs.take();
  if (!h.regular()) {
    check_singular(h, equations.shown(), proofs);
    return proofs.take();
  }
  check_transform(h, equations.shown(), proofs);
  check_against_lagrange(h, equations.shown(), proofs);
  check_what_is_shown(h, equations.shown(), proofs);
  return proofs.take();
}

}  // namespace maupertuis

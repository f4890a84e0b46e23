#include "analysis/hamiltonian/legendre.hpp"
#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/linear_system.hpp>

#include <algorithm>

namespace maupertuis::phase_space {
namespace {

bool holds_any(Expr e, const ExprVector& symbols) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (std::find(symbols.begin(), symbols.end(), s) != symbols.end()) return true;
  return false;
}

ExprVector velocities_of(const LegendreProblem& problem, const std::vector<std::size_t>& coordinates) {
  ExprVector out;
  for (const std::size_t i : coordinates) out.push_back(problem.system.coordinates[i].velocity);
  return out;
}

/// The one square root of velocities that stands in L; an empty handle where there is none, or several.
Expr only_root(Expr lagrangian, const ExprVector& velocities) {
  Expr found;
  for (const Expr& node : topological_order({&lagrangian, 1})) {
    const bool is_root = node.is(Kind::Power) && node[1].is_number() && node[1].number() == Rational(1, 2);
    if (!is_root || !holds_any(node, velocities)) continue;
    if (found) return {};
    found = node;
  }
  return found;
}

/// −2Π/c² = Σ κ_ij π_i π_j with the products that share a coefficient in one bracket: (π_x² + π_y²)/(m c)².
Expr kinetic_part(const RootLagrangian& root, const ExprVector& pi, const ReadingOrder& order) {
  Context& context = pi.front().context();
  std::vector<std::pair<Expr, ExprVector>> groups;
  for (std::size_t j = 0; j < pi.size(); ++j) {
    ExprVector unit(pi.size(), context.number(0));
    unit[j] = context.number(1);
    const auto column = solve_linear(augmented(root.metric, unit));
    for (std::size_t i = 0; i <= j; ++i) {
      const Expr weight = tidy(Rational(i == j ? -2 : -4) * (*column)[i] / pow(root.coefficient, 2), order);
      if (weight.is_zero()) continue;
      auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == weight; });
      if (group == groups.end()) group = groups.insert(groups.end(), {weight, {}});
      group->second.push_back(pi[i] * pi[j]);
    }
  }
  ExprVector terms;
  for (const auto& [weight, products] : groups) terms.push_back(weight * context.sum(products));
  return context.sum(terms);
}

}  // namespace

std::optional<RootLagrangian> root_lagrangian(const LegendreProblem& problem,
                                              const std::vector<std::size_t>& coordinates) {
  Context& context = *problem.system.context;
  const ExprVector velocities = velocities_of(problem, coordinates);
  RootLagrangian out;
  out.root = only_root(problem.lagrangian, velocities);
  if (!out.root) return std::nullopt;
  ExprMap rest;
  for (const Expr& v : velocities) rest.emplace(v, context.number(0));

  // L is linear in the root, and what is left of it linear in the velocities.
  const Expr root = context.symbol("root of velocities", Role::Auxiliary);
  const Expr linear = substitute(problem.lagrangian, {{out.root, root}});
  out.coefficient = differentiate(linear, root);
  const Expr remaining = substitute(linear, {{root, context.number(0)}});
  out.shift = gradient(remaining, velocities);
  ExprVector to_be_free = out.shift;
  to_be_free.push_back(out.coefficient);
  ExprVector forbidden = velocities;
  forbidden.push_back(root);
  for (const Expr& e : to_be_free)
    if (holds_any(e, forbidden)) return std::nullopt;

  const Expr w = out.root[0];
  out.at_rest = substitute(w, rest);
  out.metric = {velocities.size(), velocities.size(), {}};
  for (const Expr& slope : gradient(w, velocities)) {
    if (!may_vanish(substitute(slope, rest))) return std::nullopt;
    for (const Expr& entry : gradient(slope, velocities)) {
      if (holds_any(entry, velocities)) return std::nullopt;
      out.metric.entries.push_back(entry);
    }
  }
  return out;
}

void transform_root(LegendreBlock& block, const RootLagrangian& root, const LegendreProblem& problem) {
  Context& context = *problem.system.context;
  const ReadingOrder& order = problem.order;
  for (const Expr& b : root.shift) block.shift.push_back(tidy(b, order));
  const ExprVector pi = reduced_momenta(block, problem);
  const auto raised = solve_linear(augmented(root.metric, pi));
  if (!raised) {
    block.kind = LegendreKind::Unsolved;
    return;
  }
  ExprVector terms;
  for (std::size_t i = 0; i < pi.size(); ++i) terms.push_back(pi[i] * (*raised)[i]);
  const Expr square = tidy(context.sum(terms), order), c = tidy(root.coefficient, order);
  if (may_vanish(root.at_rest)) {
    block.kind = LegendreKind::Singular;
    block.energy = context.number(0);
    block.energy_is_readable = true;
    block.primary_constraints = {cleared(2 * square - pow(c, 2), order).numerator};
    return;
  }
  block.kind = LegendreKind::Root;
  const Expr candidates[] = {context.number(1) + kinetic_part(root, pi, order),
                             tidy(context.number(1) - 2 * square / pow(c, 2), order)};
  const Expr inside = shortest(candidates, order);
  block.energy = -c * sqrt(root.at_rest) * sqrt(inside);
  block.energy_is_readable = true;
  for (std::size_t i = 0; i < pi.size(); ++i)
    block.velocities[i] = tidy(2 * (*raised)[i] / c, order) * sqrt(root.at_rest) / sqrt(inside);
}

}  // namespace maupertuis::phase_space

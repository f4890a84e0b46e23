#include "symbolic/transform/reverse_sweep.hpp"

#include "symbolic/transform/derivative_rules.hpp"

#include <algorithm>
#include <unordered_set>

namespace maupertuis {
namespace {

/// The nodes of `order` from which a wanted symbol can be reached.
std::unordered_set<NodeId> active_nodes(const std::vector<Expr>& order,
                                        const std::unordered_map<NodeId, std::size_t>& wanted) {
  std::unordered_set<NodeId> active;
  for (const Expr& node : order) {
    const auto arguments = node.argument_ids();
    if (wanted.count(node.id()) != 0 ||
        std::any_of(arguments.begin(), arguments.end(), [&](NodeId id) { return active.count(id) != 0; }))
      active.insert(node.id());
  }
  return active;
}

Expr passed_to_argument(Expr node, std::size_t index, Expr adjoint) {
  if (node.is(Kind::TimeDerivative)) return -node.context().time_derivative(adjoint);
  return adjoint * partial_derivative(node, index);
}

}  // namespace

std::unordered_map<NodeId, std::size_t> places_of(std::span<const Expr> symbols) {
  std::unordered_map<NodeId, std::size_t> places;
  places.reserve(symbols.size());
  for (std::size_t i = 0; i < symbols.size(); ++i) places.emplace(symbols[i].id(), i);
  return places;
}

std::unordered_map<NodeId, Expr> reverse_sweep(Expr e, const std::unordered_map<NodeId, std::size_t>& wanted) {
  Context& context = e.context();
  const auto order = topological_order({&e, 1});
  const auto active = active_nodes(order, wanted);
  std::unordered_map<NodeId, std::vector<Expr>> contributions;
  std::unordered_map<NodeId, Expr> adjoints;
  if (!active.count(e.id())) return adjoints;
  contributions[e.id()].push_back(context.number(1));
  for (auto node = order.rbegin(); node != order.rend(); ++node) {
    const auto found = contributions.find(node->id());
    if (found == contributions.end()) continue;
    const Expr adjoint = context.sum(found->second);
    contributions.erase(found);
    if (adjoint.is_zero()) continue;
    adjoints.emplace(node->id(), adjoint);
    for (std::size_t i = 0; i < node->size(); ++i) {
      const NodeId argument = node->argument_ids()[i];
      if (active.count(argument)) contributions[argument].push_back(passed_to_argument(*node, i, adjoint));
    }
  }
  return adjoints;
}

}  // namespace maupertuis

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

using Places = std::unordered_map<NodeId, std::size_t>;
using Contributions = std::unordered_map<NodeId, std::vector<Expr>>;

/// From so many arguments on a piecewise node is differentiated branch by branch: what one branch alone contributes is
/// as long as the node, so that n of them would be n² in size.
constexpr std::size_t many_arguments = 16;

bool by_branches(Expr node) {
  return node.is(Kind::Piecewise) && node.size() >= many_arguments && !node.context().has_time_derivative(node.id());
}

/// piecewise(c: u, …) contributes piecewise(c: ∂u/∂s, …) to each wanted symbol s.
void pass_by_branches(Expr node, Expr adjoint, const Places& wanted, Contributions& contributions) {
  Context& context = node.context();
  std::unordered_map<NodeId, std::vector<Expr>> derivatives;  // [wanted] arguments of a piecewise node
  std::vector<Expr> arguments;                                // the same of one that is 0 everywhere
  for (std::size_t i = 0; i < node.size(); ++i)
    arguments.push_back(i % 2 == 0 && i + 1 < node.size() ? node[i] : context.number(0));
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (i % 2 == 0 && i + 1 < node.size()) continue;
    for (const auto& [id, derivative] : reverse_sweep(node[i], wanted))
      if (wanted.count(id) != 0) derivatives.try_emplace(id, arguments).first->second[i] = derivative;
  }
  for (const auto& [id, branches] : derivatives)
    contributions[id].push_back(adjoint * context.function(Kind::Piecewise, branches));
}

}  // namespace

std::unordered_map<NodeId, std::size_t> places_of(std::span<const Expr> symbols) {
  std::unordered_map<NodeId, std::size_t> places;
  places.reserve(symbols.size());
  for (std::size_t i = 0; i < symbols.size(); ++i) places.emplace(symbols[i].id(), i);
  return places;
}

std::unordered_map<NodeId, Expr> reverse_sweep(Expr e, const Places& wanted) {
  Context& context = e.context();
  const auto order = topological_order({&e, 1});
  const auto active = active_nodes(order, wanted);
  Contributions contributions;
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
    if (by_branches(*node)) {
      pass_by_branches(*node, adjoint, wanted, contributions);
      continue;
    }
    for (std::size_t i = 0; i < node->size(); ++i) {
      const NodeId argument = node->argument_ids()[i];
      if (active.count(argument)) contributions[argument].push_back(passed_to_argument(*node, i, adjoint));
    }
  }
  return adjoints;
}

}  // namespace maupertuis

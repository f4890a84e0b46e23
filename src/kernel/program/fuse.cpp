#include "kernel/program/graph.hpp"

#include <algorithm>

namespace maupertuis::lowering {
namespace {

bool is_sum(const Node& node) { return node.op == Op::Linear || node.op == Op::Products; }

std::vector<std::uint32_t> count_uses(const Graph& graph, std::span<const NodeIndex> roots) {
  std::vector<std::uint32_t> uses(graph.nodes.size(), 0);
  std::vector<NodeIndex> open;
  const auto use = [&](NodeIndex node) {
    if (node != no_node && uses[node]++ == 0) open.push_back(node);
  };
  for (const NodeIndex root : roots) use(root);
  while (!open.empty()) {
    const Node& node = graph.nodes[open.back()];
    open.pop_back();
    use(node.a);
    use(node.b);
    // The condition of a Select and the coefficients are constants, no nodes.
    for (const Term& term : node.terms) use(term.a), use(term.b);
  }
  return uses;
}

}  // namespace

void fuse(Graph& graph, std::span<const NodeIndex> roots) {
  const auto uses = count_uses(graph, roots);
  for (Node& node : graph.nodes) {
    if (!is_sum(node)) continue;
    std::vector<Term> merged;
    for (const Term& term : node.terms) {
      const bool alone = term.b == no_node && uses[term.a] == 1 && is_sum(graph.nodes[term.a]);
      if (!alone) { merged.push_back(term); continue; }
      for (Term inner : graph.nodes[term.a].terms) {
        inner.coefficient = graph.constants.multiply(term.coefficient, inner.coefficient);
        merged.push_back(inner);
      }
    }
    std::stable_partition(merged.begin(), merged.end(), [](const Term& term) { return term.b == no_node; });
    const bool has_products = !merged.empty() && merged.back().b != no_node;
    node.op = has_products ? Op::Products : Op::Linear;
    node.terms = std::move(merged);
  }
}

}  // namespace maupertuis::lowering

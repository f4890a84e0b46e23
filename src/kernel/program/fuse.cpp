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

class Fusion {
 public:
  Fusion(Graph& graph, std::span<const NodeIndex> roots) : graph_(graph), uses_(count_uses(graph, roots)) {}

  void run() {
    for (Node& node : graph_.nodes) {
      if (!is_sum(node)) continue;
      merged_.clear();
      for (const Term& term : node.terms) {
        if (term.b == no_node)
          add_linear(term, true);
        else
          merged_.push_back(term);
      }
      std::stable_partition(merged_.begin(), merged_.end(), [](const Term& term) { return term.b == no_node; });
      const bool has_products = !merged_.empty() && merged_.back().b != no_node;
      node.op = has_products ? Op::Products : Op::Linear;
      node.terms = merged_;
    }
  }

 private:
  /// `alone`: nothing else uses what stands between the sum and this operand.
  void add_linear(Term term, bool alone) {
    alone = alone && uses_[term.a] == 1;
    const Node& operand = graph_.nodes[term.a];
    if (operand.op == Op::Derivative && term.shift < Term::most_shift)
      return add_linear({term.coefficient, operand.a, no_node, term.shift + 1}, alone);
    if (!alone || !can_enter(operand, term.shift)) {
      merged_.push_back(term);
      return;
    }
    for (Term inner : operand.terms) {
      const bool vanishes = term.shift > 0 && graph_.nodes[inner.a].op == Op::One;
      inner.coefficient = graph_.constants.multiply(term.coefficient, inner.coefficient);
      inner.shift += term.shift;
      if (!vanishes) merged_.push_back(inner);
    }
  }

  /// Products are not shifted: d/dt of one is no product of the same operands.
  static bool can_enter(const Node& operand, std::uint32_t shift) {
    if (shift == 0) return is_sum(operand);
    if (operand.op != Op::Linear) return false;
    return std::all_of(operand.terms.begin(), operand.terms.end(),
                       [&](const Term& term) { return term.shift + shift <= Term::most_shift; });
  }

  Graph& graph_;
  std::vector<std::uint32_t> uses_;
  std::vector<Term> merged_;
};

}  // namespace

void fuse(Graph& graph, std::span<const NodeIndex> roots) { Fusion(graph, roots).run(); }

}  // namespace maupertuis::lowering

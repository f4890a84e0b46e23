#include <maupertuis/variation.hpp>

#include "symbolic/transform/derivative_rules.hpp"

#include <unordered_map>

namespace maupertuis {
namespace {

using Memo = std::unordered_map<NodeId, Expr>;

/// The variation of a symbol of any order; an empty handle where it does not vary.
Expr variation_of_symbol(Expr symbol, const ExprMap& variations) {
  Context& context = symbol.context();
  const Expr base = symbol.order() == 0 ? symbol : context.symbol(symbol.name(), symbol.role(), 0);
  const auto found = variations.find(base);
  if (found == variations.end()) return {};
  Expr result = found->second;
  for (int i = 0; i < symbol.order(); ++i) result = context.time_derivative(result);
  return result;
}

/// Σ ∂f/∂a_i · δa_i from the variations already known of the arguments.
Expr variation_of_node(Expr node, const Memo& known) {
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto inner = known.find(node.argument_ids()[i]);
    if (inner == known.end()) continue;
    terms.push_back(node.is(Kind::TimeDerivative) ? node.context().time_derivative(inner->second)
                                                  : partial_derivative(node, i) * inner->second);
  }
  return node.context().sum(terms);
}

}  // namespace

std::vector<Expr> variation(std::span<const Expr> roots, const ExprMap& variations) {
  Memo known;  // of nodes that vary; others are absent
  for (const Expr& node : topological_order(roots)) {
    const Expr varied = node.is_symbol() ? variation_of_symbol(node, variations) : variation_of_node(node, known);
    if (varied && !varied.is_zero()) known.emplace(node.id(), varied);
  }
  std::vector<Expr> out;
  for (const Expr& root : roots) {
    const auto found = known.find(root.id());
    out.push_back(found == known.end() ? root.context().number(0) : found->second);
  }
  return out;
}

}  // namespace maupertuis

#include <maupertuis/require.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/transform/derivative_rules.hpp"

#include <unordered_map>

namespace maupertuis {
namespace {

using Memo = std::unordered_map<NodeId, Expr>;

/// Chain rule at one node: Σ ∂f/∂a_i · (derivative of a_i), from the derivatives already known of its arguments.
Expr chain(Expr node, const Memo& derivatives) {
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto inner = derivatives.find(node.argument_ids()[i]);
    if (inner != derivatives.end()) terms.push_back(partial_derivative(node, i) * inner->second);
  }
  return node.context().sum(terms);
}

}  // namespace

Expr differentiate(Expr e, Expr symbol) {
  Context& context = e.context();
  MAUP_REQUIRE(symbol.is_symbol());
  MAUP_REQUIRE(!context.has_time_derivative(e.id()));
  Memo derivatives;  // of nodes that depend on the symbol; others are absent
  const auto order = topological_order({&e, 1});
  for (const Expr& node : order) {
    if (node == symbol)
      derivatives.emplace(node.id(), context.number(1));
    else if (node.size() > 0) {
      const Expr d = chain(node, derivatives);
      if (!d.is_zero()) derivatives.emplace(node.id(), d);
    }
  }
  const auto result = derivatives.find(e.id());
  return result == derivatives.end() ? context.number(0) : result->second;
}

}  // namespace maupertuis

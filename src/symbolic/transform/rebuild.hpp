#pragma once
#include <maupertuis/expression.hpp>

#include <vector>

namespace maupertuis {

/// The node with its arguments replaced by `replaced(argument)`, through the constructors and their rewrites.
/// The node itself if no argument changes; leaves are returned as they are.
template <class Replace>
Expr rebuild(Expr node, Replace replaced) {
  std::vector<Expr> arguments;
  arguments.reserve(node.size());
  bool changed = false;
  for (std::size_t i = 0; i < node.size(); ++i) {
    arguments.push_back(replaced(node[i]));
    changed |= arguments.back() != node[i];
  }
  if (!changed) return node;
  Context& context = node.context();
  switch (node.kind()) {
    case Kind::Sum: return context.sum(arguments);
    case Kind::Product: return context.product(arguments);
    case Kind::Power: return context.power(arguments[0], arguments[1]);
    case Kind::TimeDerivative: return context.time_derivative(arguments[0]);
    default: return context.function(node.kind(), arguments);
  }
}

}  // namespace maupertuis

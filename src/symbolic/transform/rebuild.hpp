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
  return node.context().make(node.kind(), arguments);
}

}  // namespace maupertuis

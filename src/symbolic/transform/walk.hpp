#pragma once
#include <maupertuis/expression.hpp>

#include <utility>
#include <vector>

namespace maupertuis {

/// Visits the nodes below `root`, children first, leaving out every node (with what is only below it) for which
/// `done` answers true at that moment. For passes that keep their memo between calls: the cost is that of the nodes
/// that are new. The walk has a stack of its own, so that depth is bounded by memory alone.
template <class Done, class Visit>
void walk_new(Expr root, Done done, Visit visit) {
  if (done(root)) return;
  struct Frame {
    Expr node;
    std::size_t next;
  };
  std::vector<Frame> stack{{root, 0}};
  while (!stack.empty()) {
    Frame& top = stack.back();
    if (top.next < top.node.size()) {
      const Expr child = top.node[top.next++];
      if (!done(child)) stack.push_back({child, 0});
      continue;
    }
    const Expr node = top.node;
    stack.pop_back();
    if (!done(node)) visit(node);
  }
}

}  // namespace maupertuis

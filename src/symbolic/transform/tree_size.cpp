#include <maupertuis/tree_size.hpp>

#include <algorithm>
#include <unordered_map>

namespace maupertuis {

std::size_t tree_size(Expr e, std::size_t most) {
  std::unordered_map<NodeId, std::size_t> sizes;
  for (const Expr& node : topological_order({&e, 1})) {
    std::size_t size = 1;
    for (const NodeId argument : node.argument_ids()) size = std::min(most, size + sizes.at(argument));
    sizes.emplace(node.id(), size);
  }
  return sizes.at(e.id());
}

}  // namespace maupertuis

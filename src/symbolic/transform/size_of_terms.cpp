#include <maupertuis/size_of_terms.hpp>

#include <unordered_map>

namespace maupertuis {

Expr size_of_terms(Expr e) {
  std::unordered_map<NodeId, Expr> sizes;
  for (const Expr& node : topological_order({&e, 1})) {
    std::vector<Expr> parts;
    for (std::size_t i = 0; i < node.size(); ++i) parts.push_back(sizes.at(node[i].id()));
    const bool power = node.is(Kind::Power) && node[1].is_number() && node[1].number().sign() > 0;
    sizes.emplace(node.id(), node.is(Kind::Sum)       ? e.context().sum(parts)
                             : node.is(Kind::Product) ? e.context().product(parts)
                             : power                  ? pow(parts[0], node[1].number())
                                                      : apply(Kind::Abs, node));
  }
  return sizes.at(e.id());
}

}  // namespace maupertuis

#include <maupertuis/transform.hpp>

#include "symbolic/transform/rebuild.hpp"

namespace maupertuis {

std::vector<Expr> substitute(std::span<const Expr> roots, const ExprMap& replacements) {
  ExprMap done;
  const auto replaced = [&](Expr e) {
    const auto found = done.find(e);
    return found == done.end() ? e : found->second;
  };
  for (const Expr& node : topological_order(roots)) {
    const auto wanted = replacements.find(node);
    const Expr value = wanted != replacements.end() ? wanted->second : rebuild(node, replaced);
    if (value != node) done.emplace(node, value);
  }
  std::vector<Expr> out;
  out.reserve(roots.size());
  for (const Expr& root : roots) out.push_back(replaced(root));
  return out;
}

Expr substitute(Expr e, const ExprMap& replacements) { return substitute({&e, 1}, replacements).front(); }

}  // namespace maupertuis

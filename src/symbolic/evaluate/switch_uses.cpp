#include <maupertuis/switches.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/switch_nodes.hpp"

#include <algorithm>
#include <unordered_set>

namespace maupertuis {
namespace {

using Nodes = std::unordered_set<NodeId>;

/// The terms of a sum that hold what `above` is above; of c·(a + b) those of the factor.
Expr terms_of(Expr e, const Nodes& above) {
  if (above.count(e.id()) == 0) return e.context().number(0);
  if (!e.is(Kind::Sum) && !e.is(Kind::Product)) return e;
  std::vector<Expr> with, without;
  for (std::size_t i = 0; i < e.size(); ++i) (above.count(e[i].id()) != 0 ? with : without).push_back(e[i]);
  if (e.is(Kind::Product) && with.size() > 1) return e;
  for (Expr& x : with) x = terms_of(x, above);
  if (e.is(Kind::Sum)) return e.context().sum(with);
  without.push_back(with.front());
  return e.context().product(without);
}

/// Takes out of both what they share. Lists are sorted by that.
void take_out_common(std::vector<Expr>& a, std::vector<Expr>& b, std::vector<Expr>& common) {
  const auto earlier = [](Expr x, Expr y) { return x.id() < y.id(); };
  std::sort(a.begin(), a.end(), earlier);
  std::sort(b.begin(), b.end(), earlier);
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common), earlier);
  std::vector<Expr> only_a, only_b;
  std::set_difference(a.begin(), a.end(), common.begin(), common.end(), std::back_inserter(only_a), earlier);
  std::set_difference(b.begin(), b.end(), common.begin(), common.end(), std::back_inserter(only_b), earlier);
  a = std::move(only_a), b = std::move(only_b);
}

std::vector<Expr> arguments_of(Expr e) {
  std::vector<Expr> out;
  for (std::size_t i = 0; i < e.size(); ++i) out.push_back(e[i]);
  return out;
}

/// a − b without what both have as terms or factors.
Expr difference(Expr a, Expr b) {
  Context& context = a.context();
  if (a == b) return context.number(0);
  if (a.kind() != b.kind() || (!a.is(Kind::Sum) && !a.is(Kind::Product))) return a - b;
  std::vector<Expr> left = arguments_of(a), right = arguments_of(b), common;
  take_out_common(left, right, common);
  if (a.is(Kind::Sum))
    return left.size() == 1 && right.size() == 1 ? difference(left.front(), right.front())
                                                 : context.sum(left) - context.sum(right);
  common.push_back(left.size() == 1 && right.size() == 1 ? difference(left.front(), right.front())
                                                         : context.product(left) - context.product(right));
  return context.product(common);
}

}  // namespace

std::vector<Expr> jump_across(std::span<const Expr> roots, Expr g) {
  std::vector<Expr> out = on_side(roots, g, true);
  const std::vector<Expr> below = on_side(roots, g, false);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = difference(out[i], below[i]);
  return out;
}

SwitchUses::SwitchUses(std::span<const Expr> roots) : roots_(roots.begin(), roots.end()) {
  Nodes above;
  for (const Expr& node : topological_order(roots)) {
    const Expr g = evaluation::difference_of(node);
    if (g && !g.is_number()) deciding_[g.id()].push_back(node.id()), above.insert(node.id());
    for (const NodeId argument : node.argument_ids()) {
      if (above.count(argument) == 0) continue;
      above.insert(node.id());
      parents_[argument].push_back(node.id());
    }
  }
}

std::vector<Expr> SwitchUses::terms_with(Expr g) const {
  std::vector<NodeId> open;
  for (const Expr& side : {g, evaluation::opposite(g)})
    if (const auto nodes = deciding_.find(side.id()); nodes != deciding_.end())
      open.insert(open.end(), nodes->second.begin(), nodes->second.end());
  Nodes above(open.begin(), open.end());
  while (!open.empty()) {
    const NodeId node = open.back();
    open.pop_back();
    const auto parents = parents_.find(node);
    if (parents == parents_.end()) continue;
    for (const NodeId parent : parents->second)
      if (above.insert(parent).second) open.push_back(parent);
  }
  std::vector<Expr> out;
  for (const Expr& root : roots_) out.push_back(terms_of(root, above));
  return out;
}

}  // namespace maupertuis

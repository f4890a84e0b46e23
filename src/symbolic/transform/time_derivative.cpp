#include <maupertuis/require.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/transform/derivative_rules.hpp"
#include "symbolic/transform/rebuild.hpp"
#include "symbolic/transform/walk.hpp"

#include <unordered_map>

namespace maupertuis {
namespace {

/// Two memo tables over one context: `plain` holds nodes with every d/dt carried out, `rate` their time derivatives.
class ChainRule {
 public:
  explicit ChainRule(Context& context) : context_(context) {}

  /// e without d/dt.
  Expr plain(Expr e) {
    const auto is_done = [&](Expr node) { return !context_.has_time_derivative(node.id()) || plain_.count(node.id()); };
    walk_new(e, is_done, [&](Expr node) {
      const Expr value = node.is(Kind::TimeDerivative) ? rate(done(node[0]))
                                                       : rebuild(node, [&](Expr argument) { return done(argument); });
      plain_.emplace(node.id(), value);
    });
    return done(e);
  }

  /// d/dt of an expression without d/dt.
  Expr rate(Expr e) {
    if (!context_.depends_on_time(e.id())) return context_.number(0);
    const auto is_done = [&](Expr node) { return !context_.depends_on_time(node.id()) || rate_.count(node.id()); };
    walk_new(e, is_done, [&](Expr node) {
      rate_.emplace(node.id(), node.is_symbol() ? context_.time_derivative(node) : chain(node));
    });
    return rate_.at(e.id());
  }

 private:
  Expr done(Expr e) const {
    const auto found = plain_.find(e.id());
    return found == plain_.end() ? e : found->second;
  }

  Expr chain(Expr node) {
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < node.size(); ++i) {
      const NodeId argument = node.argument_ids()[i];
      if (!context_.depends_on_time(argument)) continue;
      const Expr inner = rate_.at(argument);
      if (!inner.is_zero()) terms.push_back(partial_derivative(node, i) * inner);
    }
    return context_.sum(terms);
  }

  Context& context_;
  std::unordered_map<NodeId, Expr> plain_, rate_;
};

}  // namespace

std::vector<Expr> expand_time_derivatives(std::span<const Expr> roots) {
  std::vector<Expr> expanded;
  if (roots.empty()) return expanded;
  ChainRule rule(roots.front().context());
  expanded.reserve(roots.size());
  for (const Expr& root : roots) expanded.push_back(rule.plain(root));
  return expanded;
}

Expr expand_time_derivatives(Expr e) { return ChainRule(e.context()).plain(e); }

Expr total_time_derivative(Expr e) {
  ChainRule rule(e.context());
  return rule.rate(rule.plain(e));
}

}  // namespace maupertuis

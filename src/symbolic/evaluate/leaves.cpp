#include "symbolic/evaluate/leaves.hpp"

#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/switch_nodes.hpp"
#include "symbolic/transform/rebuild.hpp"

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace maupertuis::evaluation {
namespace {

constexpr std::size_t most_leaves = 16384;
constexpr std::size_t most_visits = 2'000'000;      // of nodes above switches and of conditions, over all leaves
constexpr std::size_t most_joint_visits = 500'000;  // their formulas are evaluated with all variations of a path

/// What a switch asks, up to a positive factor: `turned` where the question is the sign of −g.
struct Question {
  Expr g;
  bool turned = false;
};

/// x − 1, 1 − x and 2 x − 2 ask the same: the coefficient of one term, which does not depend on their order, is 1.
Question question_of(Expr g) {
  Context& context = g.context();
  std::vector<Expr> terms;
  for (std::size_t i = 0; g.is(Kind::Sum) && i < g.size(); ++i) terms.push_back(g[i]);
  if (terms.empty()) terms.push_back(g);
  Expr first;
  Rational leading = 1;
  for (const Expr& term : terms)
    if (const ScaledTerm t = split_coefficient(term); !term.is_number() && (!first || t.rest.id() < first.id()))
      first = t.rest, leading = t.coefficient;
  for (Expr& term : terms) term = (Rational(1) / leading) * term;
  Question out;
  out.g = context.sum(terms);
  out.turned = leading.sign() < 0;
  return out;
}

/// The switches of products, and which of them stand together in a term.
class Terms {
 public:
  explicit Terms(const Products& products) {
    std::vector<Expr> all;
    for (const std::vector<Expr>& factors : products) all.insert(all.end(), factors.begin(), factors.end());
    for (const Expr& node : topological_order(all)) {
      bool above = has_switch(node.kind());
      for (std::size_t i = 0; i < node.size() && !above; ++i) above = holds_switch(node[i]);
      if (above) above_switches_.insert(node.id());
    }
    for (const std::vector<Expr>& factors : products) take(factors);
  }

  bool holds_switch(Expr e) const { return above_switches_.count(e.id()) > 0; }
  /// The group of a node that decides; groups are numbered from 0.
  std::size_t group_of(Expr node) const { return representative(groups_.at(node.id())); }
  std::vector<std::size_t> groups() const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < merged_.size(); ++k)
      if (merged_[k] == k) out.push_back(k);
    return out;
  }

 private:
  void take(const std::vector<Expr>& factors) {
    std::vector<Expr> switching;
    for (const Expr& factor : factors)
      if (holds_switch(factor)) switching.push_back(factor);
    if (switching.size() == 1) return split(switching.front());
    if (!switching.empty()) gather(std::move(switching));
  }

  /// Down through sums and what multiplies them to the terms that do not come apart.
  void split(Expr e) {
    std::vector<Expr> below;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (holds_switch(e[i])) below.push_back(e[i]);
    const bool comes_apart = e.is(Kind::Sum) || (e.is(Kind::Product) && below.size() == 1);
    if (!comes_apart) return gather({e});
    for (const Expr& part : below) split(part);
  }

  /// All that decides in this product is one group, with the groups that it is a part of already.
  void gather(std::vector<Expr> open) {
    const std::size_t group = merged_.size();
    merged_.push_back(group);
    std::unordered_set<NodeId> seen;
    while (!open.empty()) {
      const Expr node = open.back();
      open.pop_back();
      if (!seen.insert(node.id()).second) continue;
      if (const Expr g = difference_of(node); g && !g.is_number()) join(node, question_of(g).g, group);
      for (std::size_t i = 0; i < node.size(); ++i)
        if (holds_switch(node[i]) || is_condition(node[i])) open.push_back(node[i]);
    }
  }

  static bool is_condition(Expr e) {
    const Family family = family_of(e.kind());
    return family == Family::Comparison || family == Family::Logic;
  }

  void join(Expr node, Expr g, std::size_t group) {
    const std::size_t known = asked_.emplace(g.id(), group).first->second;
    merged_[representative(known)] = representative(group);
    groups_[node.id()] = group;
  }

  std::size_t representative(std::size_t group) const {
    while (merged_[group] != group) group = merged_[group];
    return group;
  }

  std::unordered_set<NodeId> above_switches_;
  std::unordered_map<NodeId, std::size_t> groups_, asked_;  // [node], [g]
  std::vector<std::size_t> merged_;                         // [group] the group that it is a part of, or itself
};

/// Walks through the sides of the switches of one group, in the order in which they are asked for.
class Walk {
 public:
  Walk(std::span<const Expr> roots, const Terms& terms, std::size_t group, std::size_t& visits)
      : roots_(roots), terms_(terms), group_(group), visits_(visits) {}

  /// Its choices are added to those of `to`.
  Leaf leaf(Leaves& to) {
    built_.clear();
    others_.clear();
    Leaf out;
    for (const Expr& root : roots_) out.formulas.push_back(in_force(root));
    for (; numbers_.size() < path_.size(); numbers_.push_back(to.choices.size() - 1))
      to.choices.push_back({path_[numbers_.size()], numbers_.empty() ? 0 : numbers_.back()});
    out.last_choice = numbers_.empty() ? 0 : numbers_.back();
    out.not_varied = others_;
    return out;
  }

  /// False after the last.
  bool next() {
    while (!path_.empty() && !path_.back().above) {
      chosen_.erase(path_.back().g.id());
      path_.pop_back();
    }
    if (path_.empty()) return false;
    path_.back().above = false;
    chosen_[path_.back().g.id()].above = false;
    numbers_.resize(std::min(numbers_.size(), path_.size() - 1));
    for (auto& [node, depths] : failed_)
      while (!depths.empty() && depths.back() >= path_.size()) depths.pop_back();
    return true;
  }

 private:
  struct Chosen {
    bool above = true;
    std::size_t depth = 0;  // its place in the path, from 1
  };
  struct Built {
    Expr formula;
    std::size_t depth = 0;  // of the deepest choice that it depends on
  };
  Expr in_force(Expr e) {
    if (!terms_.holds_switch(e)) return e;
    if (const auto known = built_.find(e.id()); known != built_.end()) {
      depth_ = std::max(depth_, known->second.depth);
      return known->second.formula;
    }
    ++visits_;
    const std::size_t outside = std::exchange(depth_, 0);
    const Expr out = build(e);
    built_.emplace(e.id(), Built{out, depth_});
    depth_ = std::max(depth_, outside);
    return out;
  }

  Expr build(Expr e) {
    switch (family_of(e.kind())) {
      case Family::Switch: {
        const Expr x = in_force(e[0]);
        if (x.is_number()) break;
        const bool above = is_above(e, x);
        if (e.is(Kind::Abs)) return above ? x : -x;
        return e.context().number(above ? 1 : e.is(Kind::Sign) ? -1 : 0);
      }
      case Family::Extremum:
        return in_force(e[is_above(e, in_force(e[1]) - in_force(e[0])) == e.is(Kind::Max) ? 1 : 0]);
      case Family::Piecewise:
        return in_force(e[piece_of(e)]);
      case Family::Algebra:
        if (e.is(Kind::Product)) return product(e);
        break;
      case Family::Leaf:
      case Family::Function:
      case Family::Angle:
      case Family::Comparison:
      case Family::Logic:
      case Family::TimeDerivative:
        break;
    }
    return rebuild(e, [&](Expr argument) { return in_force(argument); });
  }

  /// The argument that is in force. A table is not gone through again from its first piece: conditions that did not
  /// hold still do not, as long as the choices that they depend on stay.
  std::size_t piece_of(Expr e) {
    std::vector<std::size_t>& failed = failed_[e.id()];
    const std::size_t others = others_.size(), outside = depth_;
    std::size_t i = 2 * failed.size();
    for (depth_ = failed.empty() ? 0 : failed.back(); i + 1 < e.size() && !holds(e[i]); i += 2)
      if (others_.size() == others) failed.push_back(depth_);
    depth_ = std::max(depth_, outside);
    return std::min(i + 1, e.size() - 1);
  }

  /// Where a factor is 0 nothing is asked of the others.
  Expr product(Expr e) {
    std::vector<Expr> factors;
    for (std::size_t i = 0; i < e.size(); ++i) {
      factors.push_back(in_force(e[i]));
      if (factors.back().is_zero()) return factors.back();
    }
    return e.context().product(factors);
  }

  bool holds(Expr condition) {
    ++visits_;
    if (condition.is(Kind::And)) return holds(condition[0]) && holds(condition[1]);
    if (condition.is(Kind::Or)) return holds(condition[0]) || holds(condition[1]);
    if (family_of(condition.kind()) != Family::Comparison)
      throw unknown_kind(condition.kind(), "a condition of a leaf");
    return is_above(condition, in_force(condition[1]) - in_force(condition[0]));
  }

  /// Whether g > 0 on this leaf.
  bool is_above(Expr node, Expr g) {
    if (const Rational* number = g.number_or_null())
      return number->sign() > 0 || (number->is_zero() && node.is(Kind::LessEqual));
    const auto [known, fresh] = questions_.try_emplace(g.id());
    if (fresh) known->second = question_of(g);
    const Question& q = known->second;
    return side_of(node, q.g) != q.turned;
  }

  bool side_of(Expr node, Expr g) {
    const auto [sign, unknown] = signs_.try_emplace(g.id(), 0);
    if (unknown) sign->second = definite_sign(g);
    if (sign->second != 0) return sign->second > 0;
    if (terms_.group_of(node) != group_) {
      others_.push_back({g, true});
      return true;
    }
    const auto [known, fresh] = chosen_.try_emplace(g.id());
    if (fresh) {
      path_.push_back({g, true});
      known->second.depth = path_.size();
    }
    depth_ = std::max(depth_, known->second.depth);
    return known->second.above;
  }

  std::span<const Expr> roots_;
  const Terms& terms_;
  std::size_t group_;
  std::size_t& visits_;
  std::vector<Side> path_;
  std::vector<std::size_t> numbers_;  // [path] among the choices of all leaves, as far as they are there
  std::unordered_map<NodeId, Chosen> chosen_;
  std::vector<Side> others_;
  std::unordered_map<NodeId, Built> built_;
  /// Of a piecewise, the first conditions, which do not hold: how deep the choices are that these depend on.
  std::unordered_map<NodeId, std::vector<std::size_t>> failed_;
  std::size_t depth_ = 0;  // of the deepest choice that was asked for since the node that is being built was begun
  std::unordered_map<NodeId, Question> questions_;
  std::unordered_map<NodeId, int> signs_;  // that a g has at all real points; 0: either
};

}  // namespace

std::vector<Side> Leaves::sides_of(const Leaf& leaf) const {
  std::vector<Side> out;
  for (std::size_t at = leaf.last_choice; at != 0; at = choices[at].before) out.push_back(choices[at].side);
  out.insert(out.end(), leaf.not_varied.begin(), leaf.not_varied.end());
  return out;
}

namespace {

/// What the leaves of all roots may cost.
struct Budget {
  std::size_t visits_left, leaves_left = most_leaves, visits = 0;

  bool is_spent() { return leaves_left-- == 0 || visits > visits_left; }
};

/// False where there are more than the budget allows.
template <class Take>
bool go_through(std::span<const Expr> roots, const Terms& terms, Budget& budget, Leaves& to, Take&& take) {
  for (const std::size_t group : terms.groups()) {
    Walk walk(roots, terms, group, budget.visits);
    do {
      interrupt_of(roots.front().context()).throw_if_asked();
      if (budget.is_spent()) return false;
      take(walk.leaf(to));
    } while (walk.next());
  }
  return true;
}

}  // namespace

std::optional<Leaves> leaves_of(std::span<const Expr> roots) {
  Leaves out;
  std::unordered_set<NodeId> known;
  const auto take = [&](Leaf leaf) {
    const Expr formula = leaf.formulas.front();
    if (!formula.is_zero() && known.insert(formula.id()).second) out.all.push_back(std::move(leaf));
  };
  Budget budget{most_visits};
  for (const Expr& root : roots) {
    const Terms terms({{root}});
    if (!terms.holds_switch(root)) take({{root}, 0, {}});
    if (!go_through({&root, 1}, terms, budget, out, take)) return std::nullopt;
  }
  return out;
}

std::optional<Leaves> joint_leaves(std::span<const Expr> roots, const Products& products) {
  Leaves out;
  const Terms terms(products);
  Budget budget{most_joint_visits};
  std::set<std::vector<NodeId>> known;
  const auto take = [&](Leaf leaf) {
    std::vector<NodeId> nodes;
    for (const Expr& formula : leaf.formulas) nodes.push_back(formula.id());
    if (known.insert(std::move(nodes)).second) out.all.push_back(std::move(leaf));
  };
  if (!go_through(roots, terms, budget, out, take)) return std::nullopt;
  return out;
}

}  // namespace maupertuis::evaluation

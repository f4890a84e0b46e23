#include "symbolic/evaluate/leaves.hpp"

#include "symbolic/evaluate/field_numbers.hpp"
#include "symbolic/evaluate/switch_nodes.hpp"
#include "symbolic/transform/rebuild.hpp"

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace maupertuis::evaluation {
namespace {

constexpr std::size_t most_leaves = 4096;
constexpr std::size_t most_visits = 2'000'000;  // of nodes above switches and of conditions, over all leaves

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

/// The switches of one root, and which of them stand together in a term.
class Terms {
 public:
  explicit Terms(Expr root) {
    for (const Expr& node : topological_order({&root, 1})) {
      bool above = has_switch(node.kind());
      for (std::size_t i = 0; i < node.size() && !above; ++i) above = holds_switch(node[i]);
      if (above) above_switches_.insert(node.id());
    }
    if (holds_switch(root)) split(root);
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
  /// Down through sums and what multiplies them to the terms that do not come apart.
  void split(Expr e) {
    std::vector<Expr> below;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (holds_switch(e[i])) below.push_back(e[i]);
    const bool comes_apart = e.is(Kind::Sum) || (e.is(Kind::Product) && below.size() == 1);
    if (!comes_apart) return gather(e);
    for (const Expr& part : below) split(part);
  }

  /// All that decides in this term is one group, with the groups that it is a part of already.
  void gather(Expr term) {
    const std::size_t group = merged_.size();
    merged_.push_back(group);
    std::unordered_set<NodeId> seen;
    std::vector<Expr> open{term};
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
  Walk(Expr root, const Terms& terms, std::size_t group, std::size_t& visits)
      : root_(root), terms_(terms), group_(group), visits_(visits) {}

  Leaf leaf() {
    built_.clear();
    others_.clear();
    Leaf out{in_force(root_), {}};
    out.sides = path_;
    out.sides.insert(out.sides.end(), others_.begin(), others_.end());
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
    chosen_[path_.back().g.id()] = false;
    return true;
  }

 private:
  Expr in_force(Expr e) {
    if (!terms_.holds_switch(e)) return e;
    if (const auto known = built_.find(e.id()); known != built_.end()) return known->second;
    ++visits_;
    const Expr out = build(e);
    built_.emplace(e.id(), out);
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
        for (std::size_t i = 0; i + 1 < e.size(); i += 2)
          if (holds(e[i])) return in_force(e[i + 1]);
        return in_force(e[e.size() - 1]);
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
    const auto [known, fresh] = chosen_.try_emplace(g.id(), true);
    if (fresh) path_.push_back({g, true});
    return known->second;
  }

  Expr root_;
  const Terms& terms_;
  std::size_t group_;
  std::size_t& visits_;
  std::vector<Side> path_;
  std::unordered_map<NodeId, bool> chosen_;
  std::vector<Side> others_;
  std::unordered_map<NodeId, Expr> built_;
  std::unordered_map<NodeId, Question> questions_;
  std::unordered_map<NodeId, int> signs_;  // that a g has at all real points; 0: either
};

}  // namespace

std::optional<std::vector<Leaf>> leaves_of(std::span<const Expr> roots) {
  std::vector<Leaf> out;
  std::unordered_set<NodeId> known;
  std::size_t count = 0, visits = 0;
  const auto take = [&](Leaf leaf) {
    if (!leaf.formula.is_zero() && known.insert(leaf.formula.id()).second) out.push_back(std::move(leaf));
  };
  for (const Expr& root : roots) {
    const Terms terms(root);
    if (!terms.holds_switch(root)) take({root, {}});
    for (const std::size_t group : terms.groups()) {
      Walk walk(root, terms, group, visits);
      do {
        interrupt_of(root.context()).throw_if_asked();
        if (++count > most_leaves || visits > most_visits) return std::nullopt;
        take(walk.leaf());
      } while (walk.next());
    }
  }
  return out;
}

}  // namespace maupertuis::evaluation

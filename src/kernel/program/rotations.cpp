#include "kernel/program/rotations.hpp"

#include <algorithm>

namespace maupertuis::lowering {
namespace {

constexpr std::size_t most_parts = 3;  // of a factor: longer sums stay shared

/// function · factor, where the function is `sine` or its cosine.
struct Product {
  std::size_t term;
  NodeIndex sine, function;
  Scaled factor;
};

class Collection {
 public:
  Collection(Graph& graph, std::vector<Term> terms) : graph_(graph), terms_(std::move(terms)) {}

  std::vector<Term> run() {
    for (std::size_t i = 0; i < terms_.size(); ++i) find_products(i);
    std::vector<bool> gone(terms_.size(), false);
    std::vector<Term> added;
    for (const Product& cosine : cosines_) {
      const auto [first, last] = sines_.equal_range(cosine.sine);
      for (auto found = first; found != last; ++found) {
        const Product& sine = found->second;
        if (gone[cosine.term] || gone[sine.term] || !join(cosine, sine, added)) continue;
        gone[cosine.term] = gone[sine.term] = true;
      }
    }
    std::vector<Term> result;
    for (std::size_t i = 0; i < terms_.size(); ++i)
      if (!gone[i]) result.push_back(terms_[i]);
    result.insert(result.end(), added.begin(), added.end());
    return result;
  }

 private:
  void find_products(std::size_t i) {
    const Node& node = graph_.nodes[terms_[i].a];
    if (node.op != Op::Products || node.terms.size() != 1) return;
    const Term& product = node.terms[0];
    const ConstantId coefficient = graph_.constants.multiply(terms_[i].coefficient, product.coefficient);
    for (const auto& [function, other] : {std::pair{product.a, product.b}, std::pair{product.b, product.a}}) {
      const Node& f = graph_.nodes[function];
      if (f.op == Op::SinCos) sines_.emplace(function, Product{i, function, function, {coefficient, other}});
      if (f.op == Op::Companion && graph_.nodes[f.a].op == Op::SinCos)
        cosines_.push_back({i, f.a, function, {coefficient, other}});
    }
  }

  /// As a sum of derivatives of other nodes; false: it has too many parts.
  bool expand(Scaled value, std::uint32_t shift, std::vector<Term>& parts) {
    const Node& node = graph_.nodes[value.node];
    if (node.op == Op::Derivative && shift < Term::most_shift)
      return expand({value.coefficient, node.a}, shift + 1, parts);
    if (node.op != Op::Linear) {
      const auto same = part(parts, value.node, shift);
      if (same != parts.end())
        same->coefficient = graph_.constants.add(same->coefficient, value.coefficient);
      else if (node.op != Op::One || shift == 0)
        parts.push_back({value.coefficient, value.node, no_node, shift});
      return parts.size() <= most_parts;
    }
    const std::vector<Term> terms = node.terms;
    return terms.size() <= most_parts && std::all_of(terms.begin(), terms.end(), [&](const Term& t) {
             return expand({graph_.constants.multiply(value.coefficient, t.coefficient), t.a}, shift, parts);
           });
  }

  bool join(const Product& cosine, const Product& sine, std::vector<Term>& added) {
    std::vector<Term> by_cosine, by_sine;
    if (!expand(cosine.factor, 0, by_cosine) || !expand(sine.factor, 0, by_sine)) return false;
    for (std::uint32_t shift = 1; shift <= Term::most_shift; ++shift) {
      const auto of_sine = part(by_cosine, sine.function, shift), of_cosine = part(by_sine, cosine.function, shift);
      if (of_sine == by_cosine.end() || of_cosine == by_sine.end()) continue;
      if (!graph_.constants.are_opposite(of_sine->coefficient, of_cosine->coefficient)) continue;
      const ConstantId coefficient = of_sine->coefficient;
      by_cosine.erase(of_sine), by_sine.erase(of_cosine);
      if (products(by_cosine) + products(by_sine) > 2) return false;
      NodeIndex turned = graph_.nodes[sine.sine].a;
      for (std::uint32_t i = 0; i < shift; ++i) turned = graph_.unary(Op::Derivative, turned);
      added.push_back({coefficient, turned});
      add_products(cosine.function, by_cosine, added);
      add_products(sine.function, by_sine, added);
      return true;
    }
    return false;
  }

  static std::vector<Term>::iterator part(std::vector<Term>& parts, NodeIndex node, std::uint32_t shift) {
    return std::find_if(parts.begin(), parts.end(), [&](const Term& t) { return t.a == node && t.shift == shift; });
  }

  std::ptrdiff_t products(const std::vector<Term>& parts) const {
    return std::count_if(parts.begin(), parts.end(), [&](const Term& t) { return graph_.nodes[t.a].op != Op::One; });
  }

  void add_products(NodeIndex function, const std::vector<Term>& parts, std::vector<Term>& added) {
    for (const Term& t : parts) {
      NodeIndex factor = t.a;
      for (std::uint32_t i = 0; i < t.shift; ++i) factor = graph_.unary(Op::Derivative, factor);
      added.push_back({t.coefficient, graph_.multiply(function, factor)});
    }
  }

  Graph& graph_;
  std::vector<Term> terms_;
  std::unordered_multimap<NodeIndex, Product> sines_;
  std::vector<Product> cosines_;
};

}  // namespace

std::vector<Term> collect_rotations(Graph& graph, std::vector<Term> terms) {
  return Collection(graph, std::move(terms)).run();
}

}  // namespace maupertuis::lowering

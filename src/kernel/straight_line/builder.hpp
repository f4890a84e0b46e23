#pragma once
#include "kernel/straight_line/straight_line.hpp"

#include <map>
#include <tuple>
#include <vector>

namespace maupertuis::straight {

/// Builder::finish: lines of any length are sorted.
inline constexpr std::size_t everything = ~std::size_t{0};

/// Writes a StraightLine. Literals are folded, equal nodes given once where that is cheap to see.
class Builder {
 public:
  Value literal(double value);
  Value given(std::uint32_t array, std::uint32_t index);
  /// Σ terms, times `times`, over `over`. What is known last is added last.
  Value sum(std::vector<Term> terms, Value times = none, Value over = none);
  Value product(double factor, Value a, Value b = none) { return sum({{factor, a, b}}); }
  Value reciprocal(Value a) { return sum({{1}}, none, a); }
  Value magnitudes(const std::vector<Term>& terms);
  Value larger(Value a, Value b);
  Value choose(Value condition, Value then, Value otherwise);
  Value root(Value a);
  Value call(Kind function, Value a, Value b = none);
  /// At most 8 at a time: (sine, cosine) each.
  std::vector<std::pair<Value, Value>> sines(const std::vector<Value>& angles);

  Value unit(std::uint32_t lane);
  Value wide(const std::vector<Term>& terms);
  /// Of a number: itself.
  Value lane(Value wide, std::uint32_t index);
  /// One number where all lanes are the same.
  Value gather(const std::vector<Value>& lanes);
  Value wide_given(std::uint32_t array, std::uint32_t first, std::uint32_t width);
  /// A node of another line, with operands and terms of this one.
  Value copy(Node node, std::vector<Term> terms, const std::vector<Value>& operands);

  /// Of the sums and sizes that follow. Terms keep their order in a part, so that equal parts stay equal.
  void set_part(std::uint32_t part) { part_ = static_cast<std::uint8_t>(part); }

  void check(PivotCheck check) { line_.checks.push_back(check); }
  void require_finite(Value value) { line_.finite.push_back(value); }
  void guard() { line_.guarded = true; }
  void store(Value value, std::uint32_t array, std::uint32_t index) { line_.stores.push_back({value, array, index}); }

  bool is_literal(Value v) const { return v != none && line_.nodes[v].what == Node::Literal; }
  bool is_zero(Value v) const { return is_literal(v) && line_.nodes[v].literal == 0; }
  double literal_of(Value v) const { return line_.nodes[v].literal; }
  /// Sums and roots of wide values are as wide as the widest of these.
  std::uint32_t width(Value v) const { return line_.width(v); }

  /// In the order in which nodes after `anchor` were added, each preceded by what it needs and is not there yet; nodes
  /// before it are made when first needed, and those that no store, check or finiteness needs are not there. Lines of
  /// at most `most_sorted` nodes are in the order of their urgency instead: in longer ones too many numbers would wait
  /// in memory.
  StraightLine finish(std::uint32_t arrays, std::uint32_t wide, Value anchor, std::size_t most_sorted = 0);
  Value next() const { return static_cast<Value>(line_.nodes.size()); }

 private:
  Value add(Node node);
  Value add(Node::What what, std::vector<Term> terms, Node node = {});
  Node as_wide_as_operands(Node node) const;
  std::vector<Term> folded(const std::vector<Term>& terms) const;
  std::vector<bool> needed() const;
  void sort_by_urgency(std::vector<Value>& order) const;

  StraightLine line_;
  std::uint8_t part_ = 0;
  std::vector<std::uint32_t> depth_;  // [nodes] of operations that it waits for
  std::map<std::tuple<std::uint8_t, std::uint64_t, std::uint64_t>, Value> once_;
  std::map<std::vector<Value>, Value> gathered_;
};

}  // namespace maupertuis::straight

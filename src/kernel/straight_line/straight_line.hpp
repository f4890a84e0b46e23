#pragma once
#include <maupertuis/expression.hpp>

#include <cstdint>
#include <limits>
#include <vector>

/// A calculation without loops and branches: *nodes* in an order in which each refers to earlier ones alone. What is
/// given and what comes out stands in arrays of doubles.
namespace maupertuis::straight {

/// A node, by its place in the list.
using Value = std::uint32_t;
inline constexpr Value none = ~Value{0};

/// factor · a · b · c; `none` counts as 1.
struct Term {
  double factor = 1;
  Value a = none, b = none, c = none;
};

struct Node {
  enum What : std::uint8_t {
    Literal,     // `literal`
    Given,       // arrays[array][index]
    Sum,         // Σ terms, times a, over b
    Magnitudes,  // Σ |terms|
    Larger,      // max(|a|, |b|)
    Chosen,      // a ≠ 0 ? b : c
    Angles,      // sines and cosines of `operands` together (no number by itself)
    Sine,        // of operand `index` of the node a
    Cosine,
    Root,    // √a
    Call,    // function(a) or function(a, b): elementary functions, Power, Atan2
    Unit,    // wide: 1 in lane `index`, else 0
    Wide,    // wide: Σ terms; in each the last factor is wide, the others are not
    Lane,    // number `index` of the wide node a
    Gather,  // wide: `operands`, a lane each
  } what = Literal;
  bool wide = false;       // Given: numbers that follow each other; Sum, Magnitudes, Larger, Root: lane by lane
  std::uint8_t width = 0;  // numbers of a wide node; 0: as many as StraightLine::wide
  std::uint8_t part = 0;   // 0: of none, see widen()
  Kind function = Kind::Exp;
  Value a = none, b = none, c = none;
  std::uint32_t array = 0, index = 0;
  std::uint32_t first = 0, last = 0;  // terms or operands
  double literal = 0;
};

struct Store {
  Value value;  // wide: to places that follow each other
  std::uint32_t array, index;
};

/// `pivot` is to be above share · size, in all lanes if they are wide.
struct PivotCheck {
  Value pivot, size;
  double share;
};

/// Whether it refers to `operands` instead of terms.
inline bool lists_operands(const Node& node) { return node.what == Node::Angles || node.what == Node::Gather; }
inline bool is_wide(const Node& node) {
  return node.wide || node.what == Node::Wide || node.what == Node::Unit || node.what == Node::Gather;
}

struct StraightLine {
  /// Numbers of a value.
  std::uint32_t width(Value v) const {
    const Node& node = nodes[v];
    return !is_wide(node) ? 1 : node.width > 0 ? node.width : wide;
  }

  std::vector<Node> nodes;
  std::vector<Term> terms;
  std::vector<Value> operands;
  std::vector<Store> stores;
  std::vector<PivotCheck> checks;
  std::vector<Value> finite;  // what must be neither infinite nor undefined
  std::uint32_t arrays = 0;   // that `Given` and `stores` refer to
  std::uint32_t wide = 1;     // numbers of a wide value that has no width of its own
  /// stores come last, and only where all went well: results may go where arguments stood
  bool guarded = false;

  /// How long the code will be, about.
  std::size_t size() const { return nodes.size() + terms.size(); }
};

/// Calls f(value) for each operand of a node of the line.
template <class F>
void for_operands(const StraightLine& line, const Node& node, F&& f) {
  for (const Value v : {node.a, node.b, node.c})
    if (v != none) f(v);
  for (std::uint32_t i = node.first; i < node.last; ++i) {
    if (lists_operands(node)) {
      f(line.operands[i]);
      continue;
    }
    for (const Value v : {line.terms[i].a, line.terms[i].b, line.terms[i].c})
      if (v != none) f(v);
  }
}

/// Doubles of the array that code takes after those of its program: first whether all went well, see `sound`, then
/// numbers on their way from one function to the next.
inline std::size_t scratch_size(const StraightLine& line) {
  std::size_t out = 8;
  for (Value v = 0; v < line.nodes.size(); ++v) out += line.width(v);
  return out;
}

/// What code leaves in its scratch, unless it is guarded: min (pivot − share · size), and 0 · Σ finite.
inline bool sound(const double* scratch) { return scratch[0] > 0 && scratch[1] == 0; }

}  // namespace maupertuis::straight

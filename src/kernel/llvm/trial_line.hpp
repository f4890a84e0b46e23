#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

/// Trial: a straight line whose numbers stand in groups of 1, 2, 4 or 8.
namespace maupertuis::grouped {

using Node = std::uint32_t;
inline constexpr Node none = ~Node{0};

/// One number of a group.
struct Number {
  Node node = none;
  std::uint32_t lane = 0;
  auto operator<=>(const Number&) const = default;
};
using Numbers = std::vector<Number>;

/// ± a · b; none: 1
struct Term {
  Node a, b = none;
  bool negative = false;
};

enum Array : std::uint8_t { Rows, Coefficients, Positions, Velocities };

struct Entry {
  enum What : std::uint8_t { Literal, Given, Sum, Quotient, Root, Magnitude, Gather, Sines, Cosines } what = Sum;
  std::uint32_t width = 1;
  std::uint32_t first = 0, last = 0;  // literals, terms, numbers
  Node a = none, b = none;
  Array array = Rows;
  std::size_t index = 0;
  int stage = 0;
};

struct Store {
  Node value;
  std::size_t index;  // in the rows
};
struct Check {
  Node value;
  double least;
};

class Line {
 public:
  std::vector<Entry> entries;
  std::vector<double> literals;
  std::vector<Term> terms;
  Numbers numbers;
  std::vector<std::vector<Store>> stores;  // [entries]
  std::vector<Check> checks;
  Node finite = none;
  int stage = 0;

  std::uint32_t width(Node v) const { return entries[v].width; }
  Node literal(const std::vector<double>& values);
  Node literal(double x, std::uint32_t w) { return literal(std::vector<double>(w, x)); }
  Node given(Array array, std::size_t index, std::uint32_t w);
  Node sum(std::vector<Term> all);
  Node product(Node a, Node b) { return sum({{a, b}}); }
  Node add(Node a, Node b) { return a == none ? b : b == none ? a : sum({{a}, {b}}); }
  Node quotient(Node a, Node b);
  Node one_of(Entry::What what, Node a);
  Node gather(Numbers all, std::uint32_t w);
  Node spread(Number x, std::uint32_t w) { return gather(Numbers(w, x), w); }
  void store(Node v, std::size_t index);

  bool is_literal(Node v) const { return entries[v].what == Entry::Literal; }
  bool is_all(Node v, double x) const;
  double literal_of(Number x) const { return literals[entries[x.node].first + x.lane]; }

 private:
  Node add(Entry e) {
    e.stage = stage;
    entries.push_back(e);
    stores.emplace_back();
    return static_cast<Node>(entries.size() - 1);
  }
  std::map<std::vector<double>, Node> literals_;
  std::map<std::pair<Numbers, std::uint32_t>, Node> gathers_;
  std::map<std::pair<Node, Node>, Node> constant_products_;
};

}  // namespace maupertuis::grouped

#include "kernel/llvm/trial_line.hpp"

#include <algorithm>

namespace maupertuis::grouped {

Node Line::literal(const std::vector<double>& values) {
  const auto [found, fresh] = literals_.try_emplace(values, static_cast<Node>(entries.size()));
  if (!fresh) return found->second;
  Entry e{.what = Entry::Literal, .width = static_cast<std::uint32_t>(values.size())};
  e.first = static_cast<std::uint32_t>(literals.size());
  literals.insert(literals.end(), values.begin(), values.end());
  e.last = static_cast<std::uint32_t>(literals.size());
  return add(e);
}

bool Line::is_all(Node v, double x) const {
  const Entry& e = entries[v];
  return e.what == Entry::Literal &&
         std::all_of(literals.begin() + e.first, literals.begin() + e.last, [x](double y) { return y == x; });
}

Node Line::given(Array array, std::size_t index, std::uint32_t w) {
  return add(Entry{.what = Entry::Given, .width = w, .array = array, .index = index});
}

Node Line::sum(std::vector<Term> all) {
  const std::uint32_t w = width(all[0].a);
  std::vector<Term> kept;
  for (Term t : all) {
    if (is_all(t.a, 0) || (t.b != none && is_all(t.b, 0))) continue;
    if (t.b != none && is_all(t.a, 1)) std::swap(t.a, t.b);
    if (t.b != none && is_all(t.b, 1)) t.b = none;
    if (t.b != none && is_literal(t.a) && is_literal(t.b)) {
      std::vector<double> product;
      for (std::uint32_t i = 0; i < w; ++i) product.push_back(literal_of({t.a, i}) * literal_of({t.b, i}));
      t = {literal(product), none, t.negative};
    }
    kept.push_back(t);
  }
  if (kept.empty()) return literal(0.0, w);
  if (kept.size() == 1 && kept[0].b == none && !kept[0].negative) return kept[0].a;
  Entry e{.what = Entry::Sum, .width = w};
  e.first = static_cast<std::uint32_t>(terms.size());
  terms.insert(terms.end(), kept.begin(), kept.end());
  e.last = static_cast<std::uint32_t>(terms.size());
  return add(e);
}

Node Line::quotient(Node a, Node b) {
  return add(Entry{.what = Entry::Quotient, .width = width(a), .a = a, .b = b});
}
Node Line::one_of(Entry::What what, Node a) { return add(Entry{.what = what, .width = width(a), .a = a}); }

Node Line::gather(Numbers all, std::uint32_t w) {
  while (all.size() < w) all.push_back(all.back());
  bool literal_all = true;
  for (Number& x : all) {
    if (entries[x.node].what == Entry::Gather) x = numbers[entries[x.node].first + x.lane];
    literal_all = literal_all && is_literal(x.node);
  }
  if (literal_all) {
    std::vector<double> values;
    for (const Number x : all) values.push_back(literal_of(x));
    return literal(values);
  }
  bool same = width(all[0].node) == w;
  for (std::uint32_t i = 0; i < w; ++i) same = same && all[i] == Number{all[0].node, i};
  if (same) return all[0].node;
  const auto [found, fresh] = gathers_.try_emplace({all, w}, static_cast<Node>(entries.size()));
  if (!fresh) return found->second;
  Entry e{.what = Entry::Gather, .width = w};
  e.first = static_cast<std::uint32_t>(numbers.size());
  numbers.insert(numbers.end(), all.begin(), all.end());
  e.last = static_cast<std::uint32_t>(numbers.size());
  return add(e);
}

void Line::store(Node v, std::size_t index) { stores[v].push_back({v, index}); }

}  // namespace maupertuis::grouped

#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace maupertuis::straight {
namespace {

/// The latency of a division is that of several additions.
constexpr std::uint32_t depth_of_operation = 1, depth_of_division = 4, depth_of_function = 15;
/// About the cycles that a result waits for its operands.
constexpr std::uint32_t cycles_of_operation = 3, cycles_of_fused = 4, cycles_of_division = 13, cycles_of_function = 45;

std::uint64_t bits_of(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

}  // namespace

Value Builder::add(Node node) {
  std::uint32_t depth = 0;
  for_operands(line_, node, [&](Value operand) { depth = std::max(depth, depth_[operand]); });
  const bool is_function = node.what == Node::Angles || node.what == Node::Call;
  depth_.push_back(depth + (is_function                                ? depth_of_function
                            : node.b != none && node.what == Node::Sum ? depth_of_division
                                                                       : depth_of_operation));
  line_.nodes.push_back(node);
  return next() - 1;
}

Value Builder::add(Node::What what, std::vector<Term> terms, Node node) {
  const auto depth = [&](const Term& t) {
    std::uint32_t most = 0;
    for (const Value v : {t.a, t.b, t.c})
      if (v != none) most = std::max(most, depth_[v]);
    return most;
  };
  if (part_ == 0)
    std::stable_sort(terms.begin(), terms.end(), [&](const Term& x, const Term& y) { return depth(x) < depth(y); });
  node.what = what;
  node.part = part_;
  node.first = static_cast<std::uint32_t>(line_.terms.size());
  line_.terms.insert(line_.terms.end(), terms.begin(), terms.end());
  node.last = static_cast<std::uint32_t>(line_.terms.size());
  return add(as_wide_as_operands(node));
}

/// Where they have widths of their own.
Node Builder::as_wide_as_operands(Node node) const {
  std::uint32_t width = node.width;
  for_operands(line_, node, [&](Value v) { width = std::max<std::uint32_t>(width, line_.nodes[v].width); });
  node.width = static_cast<std::uint8_t>(width);
  node.wide = node.wide || width > 1;
  return node;
}

Value Builder::literal(double value) {
  const auto [found, fresh] = once_.try_emplace({Node::Literal, bits_of(value), 0}, next());
  return fresh ? add({.what = Node::Literal, .literal = value}) : found->second;
}

Value Builder::given(std::uint32_t array, std::uint32_t index) {
  const auto [found, fresh] = once_.try_emplace({Node::Given, array, index}, next());
  return fresh ? add({.what = Node::Given, .array = array, .index = index}) : found->second;
}

/// Literals go into the factors; terms that vanish are gone, and literals are added up.
std::vector<Term> Builder::folded(const std::vector<Term>& terms) const {
  std::vector<Term> out;
  double constant = 0;
  for (const Term& term : terms) {
    Term t{term.factor};
    std::vector<Value> rest;
    for (const Value v : {term.a, term.b, term.c}) {
      if (v == none) continue;
      if (is_literal(v))
        t.factor *= literal_of(v);
      else
        rest.push_back(v);
    }
    // What is known last is multiplied last.
    std::stable_sort(rest.begin(), rest.end(), [&](Value x, Value y) { return depth_[x] < depth_[y]; });
    rest.resize(3, none);
    t.a = rest[0], t.b = rest[1], t.c = rest[2];
    if (t.a == none)
      constant += t.factor;
    else if (t.factor != 0)
      out.push_back(t);
  }
  if (constant != 0) out.push_back({constant});
  return out;
}

Value Builder::sum(std::vector<Term> terms, Value times, Value over) {
  double factor = 1;
  if (times != none && is_literal(times)) factor *= literal_of(times), times = none;
  if (over != none && is_literal(over)) factor /= literal_of(over), over = none;
  for (Term& t : terms) t.factor *= factor;
  terms = folded(terms);
  if (terms.empty()) return literal(0);
  const bool alone = terms.size() == 1 && times == none && over == none;
  if (alone && terms[0].a == none) return literal(terms[0].factor);
  if (alone && terms[0].factor == 1 && terms[0].b == none) return terms[0].a;
  if (terms.size() == 1 && times == none && over != none && terms[0].a == none && terms[0].factor == 1) {
    const auto [found, fresh] = once_.try_emplace({Node::Sum, over, 1}, next());
    return fresh ? add(Node::Sum, std::move(terms), {.b = over}) : found->second;
  }
  return add(Node::Sum, std::move(terms), {.a = times, .b = over});
}

Value Builder::magnitudes(const std::vector<Term>& terms) { return add(Node::Magnitudes, folded(terms)); }
Value Builder::larger(Value a, Value b) { return add({.what = Node::Larger, .part = part_, .a = a, .b = b}); }

Value Builder::choose(Value condition, Value then, Value otherwise) {
  if (is_literal(condition)) return literal_of(condition) != 0 ? then : otherwise;
  return then == otherwise ? then : add({.what = Node::Chosen, .a = condition, .b = then, .c = otherwise});
}

Value Builder::root(Value a) { return add(as_wide_as_operands({.what = Node::Root, .a = a})); }
Value Builder::call(Kind function, Value a, Value b) {
  return add({.what = Node::Call, .function = function, .a = a, .b = b});
}

std::vector<std::pair<Value, Value>> Builder::sines(const std::vector<Value>& angles) {
  const auto first = static_cast<std::uint32_t>(line_.operands.size());
  line_.operands.insert(line_.operands.end(), angles.begin(), angles.end());
  const Value all =
      add({.what = Node::Angles, .first = first, .last = static_cast<std::uint32_t>(line_.operands.size())});
  std::vector<std::pair<Value, Value>> out;
  for (std::uint32_t i = 0; i < angles.size(); ++i) {
    const Value sine = add({.what = Node::Sine, .a = all, .index = i});
    out.emplace_back(sine, add({.what = Node::Cosine, .a = all, .index = i}));
  }
  return out;
}

Value Builder::unit(std::uint32_t lane) { return add({.what = Node::Unit, .index = lane}); }

/// The wide factor is the last one of each term.
Value Builder::wide(const std::vector<Term>& terms) {
  std::vector<Term> kept;
  for (Term t : terms) {
    if (t.a != none && is_literal(t.a)) t.factor *= literal_of(t.a), t.a = none;
    if (t.factor != 0) kept.push_back(t);
  }
  if (kept.size() == 1 && kept[0].factor == 1 && kept[0].a == none) return kept[0].c;
  return add(Node::Wide, std::move(kept));
}

Value Builder::lane(Value wide, std::uint32_t index) {
  const Node& node = line_.nodes[wide];
  if (!is_wide(node)) return wide;
  if (node.what == Node::Gather) return line_.operands[node.first + index];
  const auto [found, fresh] = once_.try_emplace({Node::Lane, wide, index}, next());
  return fresh ? add({.what = Node::Lane, .a = wide, .index = index}) : found->second;
}

Value Builder::gather(const std::vector<Value>& lanes) {
  const Node& first = line_.nodes[lanes[0]];
  bool same = true, in_order = first.what == Node::Lane && line_.width(first.a) == lanes.size();
  for (std::uint32_t i = 0; i < lanes.size(); ++i) {
    const Node& node = line_.nodes[lanes[i]];
    same = same && lanes[i] == lanes[0];
    in_order = in_order && node.what == Node::Lane && node.a == first.a && node.index == i;
  }
  if (same || in_order) return same ? lanes[0] : first.a;
  const auto [found, fresh] = gathered_.try_emplace(lanes, next());
  return fresh ? copy({.what = Node::Gather, .width = static_cast<std::uint8_t>(lanes.size())}, {}, lanes)
               : found->second;
}

Value Builder::wide_given(std::uint32_t array, std::uint32_t first, std::uint32_t width) {
  const auto [found, fresh] = once_.try_emplace({Node::Given, array, std::uint64_t{width} << 32 | first}, next());
  if (!fresh) return found->second;
  return add(
      {.what = Node::Given, .wide = true, .width = static_cast<std::uint8_t>(width), .array = array, .index = first});
}

Value Builder::copy(Node node, std::vector<Term> terms, const std::vector<Value>& operands) {
  if (!terms.empty()) return add(node.what, std::move(terms), node);
  node.first = static_cast<std::uint32_t>(line_.operands.size());
  line_.operands.insert(line_.operands.end(), operands.begin(), operands.end());
  node.last = static_cast<std::uint32_t>(line_.operands.size());
  if (!lists_operands(node)) node.first = node.last = 0;
  return add(node);
}

std::vector<bool> Builder::needed() const {
  std::vector<bool> out(line_.nodes.size(), false);
  for (const Store& store : line_.stores) out[store.value] = true;
  for (const PivotCheck& check : line_.checks) out[check.pivot] = out[check.size] = true;
  for (const Value v : line_.finite) out[v] = true;
  for (std::size_t i = out.size(); i-- > 0;)
    if (out[i]) for_operands(line_, line_.nodes[i], [&](Value operand) { out[operand] = true; });
  return out;
}

/// What has to be there first for the end of the line to be reached in time comes first. `order`: each preceded by what
/// it needs.
void Builder::sort_by_urgency(std::vector<Value>& order) const {
  // in cycles before the end, at the latest
  std::vector<std::uint32_t> wanted(line_.nodes.size(), 0), begins(line_.nodes.size(), 0);
  for (std::size_t i = order.size(); i-- > 0;) {
    const Node& node = line_.nodes[order[i]];
    const bool divides = node.what == Node::Sum && node.b != none,
               is_function = node.what == Node::Angles || node.what == Node::Call;
    std::uint32_t last = wanted[order[i]] + (is_function ? cycles_of_function
                                             : divides   ? cycles_of_division
                                                         : cycles_of_operation);
    begins[order[i]] = last;  // its last operation
    for_operands(line_, node, [&](Value v) { wanted[v] = std::max(wanted[v], last); });
    if (lists_operands(node)) continue;
    for (std::uint32_t t = node.last; t-- > node.first; last += cycles_of_fused)
      for (const Value v : {line_.terms[t].a, line_.terms[t].b, line_.terms[t].c})
        if (v != none) wanted[v] = std::max(wanted[v], last);
  }
  std::stable_sort(order.begin(), order.end(), [&](Value x, Value y) { return begins[x] > begins[y]; });
}

StraightLine Builder::finish(std::uint32_t arrays, std::uint32_t wide, Value anchor, std::size_t most_sorted) {
  const std::vector<bool> keep = needed();
  std::vector<Value> number(line_.nodes.size(), none), order, open;
  const auto visit = [&](Value root) {
    for (open.push_back(root); !open.empty();) {
      const Value v = open.back();
      if (number[v] != none) {
        open.pop_back();
        continue;
      }
      const std::size_t before = open.size();
      for_operands(line_, line_.nodes[v], [&](Value operand) {
        if (number[operand] == none) open.push_back(operand);
      });
      if (open.size() > before) continue;
      number[v] = static_cast<Value>(order.size());
      order.push_back(v);
      open.pop_back();
    }
  };
  for (Value v = anchor; v < line_.nodes.size(); ++v)
    if (keep[v]) visit(v);
  for (Value v = 0; v < line_.nodes.size(); ++v)
    if (keep[v]) visit(v);
  if (order.size() <= most_sorted) {
    sort_by_urgency(order);
    for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<Value>(i);
  }

  StraightLine out;
  out.checks = line_.checks, out.arrays = arrays, out.wide = wide, out.guarded = line_.guarded;
  const auto renumber = [&](Value v) { return v == none ? none : number[v]; };
  for (const Value v : order) {
    Node node = line_.nodes[v];
    node.a = renumber(node.a), node.b = renumber(node.b), node.c = renumber(node.c);
    const std::uint32_t first = node.first, last = node.last;
    const bool listed = lists_operands(node);
    node.first = static_cast<std::uint32_t>(listed ? out.operands.size() : out.terms.size());
    for (std::uint32_t i = first; i < last; ++i) {
      if (listed) {
        out.operands.push_back(renumber(line_.operands[i]));
        continue;
      }
      const Term& t = line_.terms[i];
      out.terms.push_back({t.factor, renumber(t.a), renumber(t.b), renumber(t.c)});
    }
    node.last = static_cast<std::uint32_t>(listed ? out.operands.size() : out.terms.size());
    out.nodes.push_back(node);
  }
  for (PivotCheck& check : out.checks) check.pivot = number[check.pivot], check.size = number[check.size];
  for (const Value v : line_.finite) out.finite.push_back(number[v]);
  for (const Store& store : line_.stores) out.stores.push_back({number[store.value], store.array, store.index});
  return out;
}

}  // namespace maupertuis::straight

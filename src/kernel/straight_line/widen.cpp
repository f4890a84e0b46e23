#include "kernel/straight_line/widen.hpp"

#include "kernel/straight_line/builder.hpp"

#include <algorithm>

namespace maupertuis::straight {

void Places::place_together(const std::vector<std::uint32_t>& indices) {
  for (const std::uint32_t index : indices)
    if (place_[index] != none) return;
  for (const std::uint32_t index : indices) place_[index] = bottom_++;
}

namespace {

/// One number of each lane.
using Lanes = std::vector<Value>;

class Widening {
 public:
  Widening(const StraightLine& line, const Rearranged& read, const Rearranged& written)
      : line_(line),
        read_(read),
        written_(written),
        place_in_part_(line.nodes.size(), 0),
        made_(line.nodes.size(), none),
        open_(line.nodes.size(), false) {}

  std::optional<StraightLine> run() {
    find_parts();
    if (!are_alike()) return std::nullopt;
    place_lanes();
    for (Value v = 0; v < line_.nodes.size(); ++v)
      if (!make(v)) return std::nullopt;
    store();
    check();
    return to_.finish(line_.arrays, width(), 0);
  }

 private:
  std::uint32_t width() const { return static_cast<std::uint32_t>(parts_.size()); }
  const Node& node(Value v) const { return line_.nodes[v]; }

  // ------------------------------------------------------------------------------------------------------------- parts

  void find_parts() {
    for (Value v = 0; v < line_.nodes.size(); ++v) {
      const std::uint8_t part = node(v).part;
      if (part == 0) continue;
      if (parts_.size() < part) parts_.resize(part);
      place_in_part_[v] = static_cast<std::uint32_t>(parts_[part - 1u].size());
      parts_[part - 1u].push_back(v);
    }
  }

  bool are_alike() const {
    if (parts_.size() < 2) return false;
    for (const auto& part : parts_)
      if (part.size() != parts_[0].size()) return false;
    for (std::uint32_t i = 0; i < parts_[0].size(); ++i)
      for (const auto& part : parts_)
        if (!are_alike(parts_[0][i], part[i])) return false;
    return true;
  }

  bool are_alike(Value v, Value w) const {
    const Node &x = node(v), &y = node(w);
    if (x.what != y.what || x.last - x.first != y.last - y.first) return false;
    bool alike = correspond(v, x.a, w, y.a) && correspond(v, x.b, w, y.b);
    for (std::uint32_t i = 0; i < x.last - x.first; ++i) {
      const Term &s = line_.terms[x.first + i], &t = line_.terms[y.first + i];
      alike = alike && s.factor == t.factor && correspond(v, s.a, w, t.a) && correspond(v, s.b, w, t.b) &&
              correspond(v, s.c, w, t.c);
    }
    return alike;
  }

  /// Operands a of v and b of w: the same place in both parts, or of no part.
  bool correspond(Value v, Value a, Value w, Value b) const {
    if (a == none || b == none) return a == b;
    const bool is_own = node(a).part == node(v).part;
    if (is_own != (node(b).part == node(w).part)) return false;
    return is_own ? place_in_part_[a] == place_in_part_[b] : node(a).part == 0 && node(b).part == 0;
  }

  // ------------------------------------------------------------------------------------------------------------- nodes

  /// The nodes that stand for v: itself, or the same of each part.
  Lanes members(Value v) const {
    if (node(v).part == 0) return {v};
    Lanes out;
    for (const auto& part : parts_) out.push_back(part[place_in_part_[v]]);
    return out;
  }

  /// Whatever it needs first; false where that needs it itself.
  bool make(Value root) {
    for (Lanes stack{root}; !stack.empty();) {
      const Value v = members(stack.back()).front();
      if (made_[v] != none) {
        stack.pop_back();
        continue;
      }
      const std::size_t before = stack.size();
      for (const Value member : members(v))
        for_operands(line_, node(member), [&](Value w) {
          if (made_[members(w).front()] == none) stack.push_back(w);
        });
      if (stack.size() == before) {
        made_[v] = node(v).part == 0 ? copy(v) : wide(v);
      } else if (open_[v]) {
        return false;
      } else {
        open_[v] = true;
      }
    }
    return true;
  }

  /// In the new line, a number.
  Value single(Value v) {
    if (v == none) return none;
    const Value made = made_[members(v).front()];
    if (node(v).part == 0) return made;
    const auto [found, fresh] = lanes_.try_emplace(v, none);
    if (fresh) found->second = to_.lane(made, node(v).part - 1u);
    return found->second;
  }

  Value copy(Value v) {
    const Node& n = node(v);
    if (n.what == Node::Literal) return to_.literal(n.literal);
    if (n.what == Node::Given) return to_.given(n.array, place_of(read_, n.array, n.index));
    std::vector<Term> terms;
    Lanes operands;
    for (std::uint32_t i = n.first; i < n.last; ++i) {
      if (lists_operands(n)) {
        operands.push_back(single(line_.operands[i]));
        continue;
      }
      const Term& t = line_.terms[i];
      terms.push_back({t.factor, single(t.a), single(t.b), single(t.c)});
    }
    Node out = n;
    out.a = single(n.a), out.b = single(n.b), out.c = single(n.c);
    return to_.copy(out, std::move(terms), operands);
  }

  Value wide(Value v) {
    const Node& n = node(v);
    std::vector<Term> terms;
    for (std::uint32_t i = 0; i < n.last - n.first; ++i) {
      const auto operand = [&](Value Term::*which) { return together(operands(v, i, which)); };
      terms.push_back({line_.terms[n.first + i].factor, operand(&Term::a), operand(&Term::b), operand(&Term::c)});
    }
    Node out = n;
    out.wide = true;
    out.part = 0;
    out.a = together(operands(v, &Node::a)), out.b = together(operands(v, &Node::b));
    return to_.copy(out, std::move(terms), {});
  }

  Lanes operands(Value v, std::uint32_t term, Value Term::*which) const {
    Lanes out;
    for (const Value w : members(v)) out.push_back(line_.terms[node(w).first + term].*which);
    return out;
  }
  Lanes operands(Value v, Value Node::*which) const {
    Lanes out;
    for (const Value w : members(v)) out.push_back(node(w).*which);
    return out;
  }

  /// One operand for all lanes: a number, where it is the same for all of them.
  Value together(const Lanes& lanes) {
    const Value first = lanes[0];
    if (first == none) return none;
    if (node(first).part != 0) return made_[first];
    if (std::all_of(lanes.begin(), lanes.end(), [&](Value v) { return v == first; })) return single(first);
    const auto [found, fresh] = gathered_.try_emplace(lanes, none);
    if (fresh) found->second = gather(lanes);
    return found->second;
  }

  /// Places of what the lanes read in one array; empty where it is anything else.
  std::vector<std::uint32_t> indices_of(const Lanes& lanes) const {
    std::vector<std::uint32_t> out;
    for (const Value v : lanes)
      if (v == none || node(v).what != Node::Given || node(v).array != node(lanes[0]).array)
        return {};
      else
        out.push_back(node(v).index);
    return out;
  }

  void place_lanes() {
    const auto place = [&](const Lanes& lanes) {
      const std::vector<std::uint32_t> indices = indices_of(lanes);
      if (indices.empty() || indices[0] == indices[1]) return;
      if (const auto free = read_.find(node(lanes[0]).array); free != read_.end())
        free->second->place_together(indices);
    };
    for (const Value v : parts_[0]) {
      for (std::uint32_t i = 0; i < node(v).last - node(v).first; ++i)
        for (const auto which : {&Term::a, &Term::b, &Term::c}) place(operands(v, i, which));
      place(operands(v, &Node::a)), place(operands(v, &Node::b));
    }
  }

  Value gather(const Lanes& lanes) {
    std::vector<std::uint32_t> places = indices_of(lanes);
    for (std::uint32_t& place : places) place = place_of(read_, node(lanes[0]).array, place);
    if (!places.empty() && follow_each_other(places)) return to_.wide_given(node(lanes[0]).array, places[0], width());
    Lanes out;
    for (const Value v : lanes) out.push_back(single(v));
    return to_.gather(out);
  }

  static bool follow_each_other(const std::vector<std::uint32_t>& indices) {
    for (std::size_t i = 1; i < indices.size(); ++i)
      if (indices[i] != indices[0] + i) return false;
    return true;
  }

  // ----------------------------------------------------------------------------------------------------------- results

  void store() {
    std::map<Value, std::vector<const Store*>> of_lanes;  // by the first member
    for (const Store& store : line_.stores) {
      const auto free = written_.find(store.array);
      if (free != written_.end() && !free->second->is_placed(store.index)) continue;
      if (node(store.value).part != 0)
        of_lanes[members(store.value).front()].push_back(&store);
      else
        to_.store(single(store.value), store.array, place_of(written_, store.array, store.index));
    }
    for (const auto& [first, stores] : of_lanes) store_lanes(first, stores);
  }

  static std::uint32_t place_of(const Rearranged& arrays, std::uint32_t array, std::uint32_t index) {
    const auto free = arrays.find(array);
    return free == arrays.end() ? index : free->second->place(index);
  }

  void store_lanes(Value first, const std::vector<const Store*>& stores) {
    std::vector<std::uint32_t> places;
    bool in_order = stores.size() == width();
    for (std::uint32_t i = 0; i < stores.size(); ++i) {
      places.push_back(place_of(written_, stores[i]->array, stores[i]->index));
      in_order = in_order && node(stores[i]->value).part == i + 1 && stores[i]->array == stores[0]->array;
    }
    if (in_order && follow_each_other(places)) return to_.store(made_[first], stores[0]->array, places[0]);
    for (std::uint32_t i = 0; i < stores.size(); ++i) to_.store(single(stores[i]->value), stores[i]->array, places[i]);
  }

  /// Those of a part once for all.
  void check() {
    for (const PivotCheck& check : line_.checks) {
      const bool is_wide = node(check.pivot).part != 0 && node(check.size).part == node(check.pivot).part;
      if (!is_wide)
        to_.check({single(check.pivot), single(check.size), check.share});
      else if (node(check.pivot).part == 1)
        to_.check({made_[check.pivot], made_[check.size], check.share});
    }
    for (const Value v : line_.finite) to_.require_finite(single(v));
  }

  const StraightLine& line_;
  const Rearranged &read_, &written_;
  Builder to_;
  std::vector<Lanes> parts_;                  // [parts] nodes
  std::vector<std::uint32_t> place_in_part_;  // [nodes]
  std::vector<Value> made_;                   // [nodes] in the new line; of a part: at the first part's node
  std::vector<bool> open_;
  std::map<Value, Value> lanes_;
  std::map<Lanes, Value> gathered_;
};

}  // namespace

std::optional<StraightLine> widen(const StraightLine& line, const Rearranged& read, const Rearranged& written) {
  return Widening(line, read, written).run();
}

StraightLine in_columns(StraightLine line, std::uint32_t read, std::uint32_t written, std::uint32_t lanes) {
  const auto is_wide = [&](Value v) { return v != none && line.nodes[v].wide; };
  for (Node& node : line.nodes) {
    if (node.what == Node::Given) {
      node.wide = node.array == read;
      if (node.wide) node.index *= lanes;
      continue;
    }
    node.wide = is_wide(node.a) || is_wide(node.b);
    for (std::uint32_t i = node.first; i < node.last; ++i)
      node.wide = node.wide || is_wide(line.terms[i].a) || is_wide(line.terms[i].b) || is_wide(line.terms[i].c);
  }
  std::erase_if(line.stores, [&](const Store& store) { return !is_wide(store.value); });
  for (Store& store : line.stores)
    if (store.array == written) store.index *= lanes;
  line.wide = lanes;
  return line;
}

}  // namespace maupertuis::straight

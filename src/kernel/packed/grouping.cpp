#include "kernel/packed/grouping.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <tuple>

namespace maupertuis::packed {
namespace {

class Grouping {
 public:
  Grouping(const Program& program, std::vector<Step>& steps, const LaneOrder& order)
      : in_(program), steps_(steps), piece_(steps.size(), Before), order_(order) {}

  std::vector<Group> run() {
    find_producers();
    find_levels();
    find_stored();
    align_products();
    cut_chains();
    find_groups();
    order_groups();
    if (has_no_choices(in_)) set_fronts();
    return std::move(groups_);
  }

 private:
  const Step& step(std::size_t index) const { return steps_[index]; }
  int lag(Slot slot) const { return in_.lags[slot]; }

  // ------------------------------------------------------------------------------------------------- facts of slots

  void find_producers() {
    producer_.assign(in_.slots, none);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      producer_[steps_[i].head.out] = i;
      if (steps_[i].head.second != no_slot) producer_[steps_[i].head.second] = i;
    }
  }

  /// The level of a step is one above the highest of those that it waits for. The members of a running sum share one,
  /// since they are found together. Steps that no other reads, such as the rows of the residual, share the last.
  void find_levels() {
    constexpr int patience = 200;
    int turn = 0;
    while (raise_levels() && turn < patience) ++turn;
    if (turn == patience) {  // two running sums wait for each other: their members become single steps
      for (Step& s : steps_) s.chain = -1;
      while (raise_levels()) {
      }
    }
    std::vector<bool> read(in_.slots, false);
    for (const Step& s : steps_) for_operands(s, [&](Slot slot, int) { read[slot] = true; });
    const int last = level_.empty() ? 0 : *std::max_element(level_.begin(), level_.end());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const Instruction& head = steps_[i].head;
      if (steps_[i].chain < 0 && !read[head.out] && (head.second == no_slot || !read[head.second])) level_[i] = last;
    }
  }

  bool raise_levels() {
    bool changed = level_.size() != steps_.size();
    level_.resize(steps_.size(), 0);
    std::map<int, int> of_chain;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      int level = 0;
      for_operands(steps_[i], [&](Slot slot, int) {
        const std::size_t producer = producer_[slot];
        if (producer == none || (steps_[i].chain >= 0 && steps_[producer].chain == steps_[i].chain)) return;
        level = std::max(level, level_[producer] + 1);
      });
      if (steps_[i].chain >= 0) {
        int& whole = of_chain[steps_[i].chain];
        level = whole = std::max({whole, level, level_[i]});
      }
      changed = changed || level > level_[i];
      level_[i] = std::max(level_[i], level);
    }
    return changed;
  }

  void store(Slot slot) {
    if (slot != no_slot) stored_[slot] = true;
  }

  /// As in the schedule of the program, for what is left after sums were written out.
  void find_stored() {
    stored_.assign(in_.slots, false);
    for (const Step& s : steps_) {
      for_operands(s, [&](Slot slot, int shift) {
        if (lag(slot) + shift != s.head.lag) store(slot);
      });
      for (const Term& term : s.products) store(term.a), store(term.b);
      if (s.head.op == Op::Linear || s.head.op == Op::Select) continue;
      if (s.head.op != Op::Products) store(s.head.a), store(s.head.b), store(s.head.out), store(s.head.second);
    }
    for (const Section section : {Along, AtPoint})
      for (const Run& run : in_.runs[section])
        for (std::uint32_t i = run.first; i < run.last; ++i) {
          const Instruction& instruction = in_.instructions[i];
          store(instruction.a), store(instruction.b);
          for (std::uint32_t t = instruction.first_term; t < instruction.last_term; ++t)
            store(in_.terms[t].a), store(in_.terms[t].b);
        }
    for (const auto* slots : {&in_.switch_slots, &in_.events, &in_.observables, &in_.integrands, &in_.constraint_values,
                              &in_.constraint_rates})
      for (const Slot slot : *slots) store(slot);
    std::map<int, bool> of_chain;  // a running sum is stored as a whole
    for (const Step& s : steps_)
      if (s.chain >= 0 && stored_[s.head.out]) of_chain[s.chain] = true;
    for (const Step& s : steps_)
      if (s.chain >= 0 && of_chain[s.chain]) store(s.head.out);
  }

  // --------------------------------------------------------------------------------------------------------- groups

  /// Level and operation of the step that a slot comes from: slots of one class may come to lie side by side.
  std::size_t class_of(Slot slot) const {
    const std::size_t producer = producer_[slot];
    if (producer == none) return 0;
    const bool is_second = steps_[producer].head.second == slot;
    return 2 +
           2 * (static_cast<std::size_t>(level_[producer]) * 32 + static_cast<std::size_t>(steps_[producer].head.op)) +
           is_second;
  }

  /// Factors in the order of lag, class and number, and products likewise: so the third product of one sum is like the
  /// third of another, and both can be lanes of one convolution.
  void align_products() {
    for (Step& s : steps_) {
      if (s.head.op != Op::Products && s.head.op != Op::Linear) continue;
      for (Term& term : s.products)
        if (std::tuple(lag(term.b), class_of(term.b), term.b) < std::tuple(lag(term.a), class_of(term.a), term.a))
          std::swap(term.a, term.b);
      std::stable_sort(s.products.begin(), s.products.end(), [&](const Term& x, const Term& y) {
        return std::tuple(lag(x.a), lag(x.b), class_of(x.a), class_of(x.b)) <
               std::tuple(lag(y.a), lag(y.b), class_of(y.a), class_of(y.b));
      });
    }
  }

  // --------------------------------------------------------------------------------------- running sums in eight parts

  /// Running sums whose members stand in the eights of order_, but for some at the ends. Where members wait for
  /// something that those before do not, they are of a higher level, and a group of their own.
  void cut_chains() {
    find_homes();
    std::map<std::pair<int, int>, std::vector<std::size_t>> chains;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (steps_[i].chain >= 0) chains[{steps_[i].chain, level_[i]}].push_back(i);
    for (const auto& [chain, members] : chains) cut_chain(members);
  }

  /// [slots] the place in order_ of the coordinate that a slot belongs to: that of what it adds to a running sum, or
  /// else of its first operand.
  void find_homes() {
    home_.assign(in_.slots, none);
    for (std::size_t place = 0; place < order_.coordinates.size(); ++place) home_[order_.coordinates[place]] = place;
    for (const Step& s : steps_) {
      std::size_t home = none;
      if (s.chain >= 0) {
        for (std::size_t t = 1; t < s.linear.size(); ++t)
          if (home == none) home = home_[s.linear[t].a];
      } else {
        for_operands(s, [&](Slot slot, int) {
          if (home == none) home = home_[slot];
        });
      }
      home_[s.head.out] = home;
      if (s.head.second != no_slot) home_[s.head.second] = home;
    }
  }
  std::size_t home(std::size_t index) const { return home_[step(index).head.out]; }

  void cut_chain(const std::vector<std::size_t>& members) {
    const auto is_whole = [&](std::size_t i) { return home(i) < order_.whole; };
    const auto begin = std::find_if(members.begin(), members.end(), is_whole),
               end = std::find_if_not(begin, members.end(), is_whole);
    if (!are_strands({members.data() + (begin - members.begin()), static_cast<std::size_t>(end - begin)})) return;
    for (auto i = begin; i != end; ++i) piece_[*i] = Strands;
    for (auto i = end; i != members.end(); ++i) piece_[*i] = After;
  }

  /// Lane by lane, up or down, with the same eights in each, one after the other.
  bool are_strands(std::span<const std::size_t> members) const {
    if (members.size() < 2 * lanes || members.size() % lanes != 0) return false;
    const std::size_t length = members.size() / lanes;
    const auto lane = [&](std::size_t m) { return home(members[m]) % lanes; };
    const auto eight = [&](std::size_t m) { return home(members[m]) / lanes; };
    const bool up = lane(0) == 0, onwards = eight(0) < eight(1);
    for (std::size_t m = 0; m < members.size(); ++m)
      if (lane(m) != (up ? m / length : lanes - 1 - m / length) || eight(m) != eight(m % length)) return false;
    for (std::size_t m = 1; m < length; ++m)
      if (onwards ? eight(m) <= eight(m - 1) : eight(m) >= eight(m - 1)) return false;
    return true;
  }

  /// Instructions of one key may share a pack.
  std::vector<int> shape(std::size_t index) const {
    const Step& s = step(index);
    if (s.chain >= 0) return {level_[index], -1, s.chain, piece_[index]};
    std::vector<int> key{level_[index], static_cast<int>(s.head.op), s.head.lag, stored_[s.head.out],
                         in_.tangent_lags[s.head.out] == Program::unmoved};
    if (s.head.a != no_slot) key.push_back(lag(s.head.a));
    if (s.head.b != no_slot) key.push_back(lag(s.head.b));
    for (const Term& term : s.products) key.insert(key.end(), {lag(term.a), lag(term.b)});
    if (s.head.op == Op::Function) key.push_back(static_cast<int>(s.products.size()));
    return key;
  }

  bool can_pack(const Step& s) const {
    switch (s.head.op) {
      case Op::Linear:
      case Op::Products:
      case Op::Square:
      case Op::SinCos:
      case Op::SinhCosh:
      case Op::Quotient:
      case Op::SquareRoot:
        return true;
      case Op::Function:
        return s.products.size() == 1 && s.head.b == no_slot;
      case Op::Power:
      case Op::Derivative:
      case Op::Select:
        return false;
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
        return false;
    }
    throw unknown_op(s.head.op, "the grouping of packs");
  }

  void find_groups() {
    std::map<std::vector<int>, std::size_t> index;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const auto [place, fresh] = index.try_emplace(shape(i), groups_.size());
      if (fresh) groups_.push_back({{}, level_[i], stored_[steps_[i].head.out], false, false});
      groups_[place->second].steps.push_back(i);
    }
    std::stable_sort(groups_.begin(), groups_.end(), [](const Group& x, const Group& y) { return x.level < y.level; });
    for (Group& group : groups_) {
      const bool pair = step(group.steps[0]).head.second != no_slot;
      const std::size_t terms = std::max<std::size_t>(pair ? 2 : 1, step(group.steps[0]).products.size());
      // Rolled code calls back for what stands alone; straight-line code, of few unknowns without constraints, writes
      // it out.
      const bool written_out = in_.unknowns <= lanes && in_.unknowns == in_.freedoms;
      group.packs = can_pack(step(group.steps[0])) && (group.steps.size() * terms >= 2 || !written_out);
    }
  }

  /// Non-linear groups follow their first operands; sums follow their consumers.
  void order_groups() {
    place_.assign(in_.slots, 0);
    for (Slot slot = 0; slot < in_.unknowns; ++slot) place_[slot] = home_[slot] != none ? home_[slot] : slot;
    std::size_t next = in_.unknowns;
    for (Group& group : groups_) {
      if (step(group.steps[0]).chain < 0)
        std::stable_sort(group.steps.begin(), group.steps.end(),
                         [&](std::size_t x, std::size_t y) { return first_operand(x) < first_operand(y); });
      for (const std::size_t i : group.steps) place_[steps_[i].head.out] = next++;
      for (const std::size_t i : group.steps)
        if (steps_[i].head.second != no_slot) place_[steps_[i].head.second] = next++;
    }
    rank_consumers();
    for (Group& group : groups_) {
      if (piece_[group.steps[0]] == Strands) {
        group.in_strands = true;
        group.down = home(group.steps.front()) % lanes != 0;
        std::sort(group.steps.begin(), group.steps.end(),
                  [&](std::size_t x, std::size_t y) { return home(x) < home(y); });
      } else if (step(group.steps[0]).chain >= 0) {
        group.down = rank_[step(group.steps.front()).head.out] > rank_[step(group.steps.back()).head.out];
        if (group.down) std::reverse(group.steps.begin(), group.steps.end());
      } else if (is_linear(step(group.steps[0]))) {
        std::stable_sort(group.steps.begin(), group.steps.end(), [&](std::size_t x, std::size_t y) {
          return rank_[steps_[x].head.out] < rank_[steps_[y].head.out];
        });
      }
    }
  }

  /// A running sum begins in the lane in which what its first step adds stands, as far as its steps agree. Vectors are
  /// then read as they were written: one that lies across two would have to wait until both are in the cache.
  void set_fronts() {
    std::vector<std::size_t> lane_of(in_.slots, none);
    for (Slot slot = 0; slot < in_.unknowns; ++slot) lane_of[slot] = slot % lanes;
    for (Group& group : groups_) {
      if (step(group.steps[0]).chain >= 0 && !group.in_strands) {
        std::array<std::size_t, lanes> votes{};
        for (std::size_t place = 0; place < group.steps.size(); ++place) {
          const std::vector<Term>& terms = step(group.steps[place]).linear;
          for (std::size_t t = 1; t < terms.size(); ++t)
            if (const std::size_t lane = lane_of[terms[t].a]; lane != none)
              ++votes[(lane + lanes - place % lanes) % lanes];
        }
        group.front = static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
      }
      for (std::size_t place = 0; place < group.steps.size() && group.packs; ++place) {
        const Instruction& head = step(group.steps[place]).head;
        lane_of[head.out] = (group.front + place) % lanes;
        if (head.second != no_slot && 2 * group.steps.size() > lanes) lane_of[head.second] = lane_of[head.out];
      }
    }
  }

  static bool is_linear(const Step& s) { return s.head.op == Op::Linear && s.products.empty(); }

  std::size_t first_operand(std::size_t index) const {
    const Step& s = step(index);
    if (is_linear(s)) return s.head.out;
    if (s.head.op == Op::Function) return place_[s.products[0].b];
    return place_[s.products.empty() ? s.head.a != no_slot ? s.head.a : s.head.out : s.products[0].a];
  }

  void rank_consumers() {
    rank_.assign(in_.slots, none);
    std::size_t next = 0;
    const auto rank = [&](Slot slot) {
      if (slot != no_slot && rank_[slot] == none) rank_[slot] = next;
      ++next;
    };
    for (const Group& group : groups_) {
      const Step& shape = step(group.steps[0]);
      for (std::size_t t = 0; t < shape.products.size(); ++t)
        for (const std::size_t i : group.steps) rank(step(i).products[t].b);
      for (std::size_t t = 0; t < shape.products.size(); ++t)
        for (const std::size_t i : group.steps) rank(step(i).products[t].a);
      for (const std::size_t i : group.steps) rank(step(i).head.a);
      for (const std::size_t i : group.steps) rank(step(i).head.b);
    }
    for (const Slot slot : in_.residual) rank(slot);
    for (const Step& s : steps_) rank(s.head.out);
  }

  static constexpr std::size_t none = ~std::size_t{0};
  enum Piece : int { Before, Strands, After };

  const Program& in_;
  std::vector<Step>& steps_;
  std::vector<std::size_t> producer_;  // [slots]
  std::vector<int> level_;             // [steps]
  std::vector<bool> stored_;           // [slots]
  std::vector<Group> groups_;
  std::vector<Piece> piece_;  // [steps] of running sums
  const LaneOrder& order_;
  std::vector<std::size_t> home_;          // [slots]
  std::vector<std::size_t> place_, rank_;  // [slots]
};

}  // namespace

std::vector<Group> group_steps(const Program& program, std::vector<Step>& steps, const LaneOrder& order) {
  return Grouping(program, steps, order).run();
}

}  // namespace maupertuis::packed

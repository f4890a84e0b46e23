#include "kernel/packed/layout.hpp"

#include "kernel/packed/collapse.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

/// Groups of instructions of one shape and level are found first; then the order within each group, so that operands of
/// one group come from neighbouring results of another; then the slots are numbered, group by group, and packs of up to
/// eight lanes are cut from the groups.
namespace maupertuis::packed {
namespace {

constexpr std::size_t longest_sum_of_small = 64, longest_sum_of_large = 10;
constexpr std::size_t most_without_chains = 16, shortest_chain = 8;

std::size_t padded(std::size_t count) { return (count + lanes - 1) / lanes * lanes; }

class Layout {
 public:
  explicit Layout(const Program& program) : in_(program), program_(program) {}

  PackedProgram run() {
    steps_ = dynamics_of(program_);
    const bool large = in_.unknowns > most_without_chains;
    write_derivatives(program_, steps_);
    if (large) find_chains(program_, steps_, shortest_chain);
    collapse_sums(program_, steps_, large ? longest_sum_of_large : longest_sum_of_small);
    find_producers();
    find_levels();
    find_stored();
    align_products();
    find_groups();
    order_groups();
    number_slots();
    write_program();
    write_packs();
    return std::move(out_);
  }

 private:
  struct Group {
    std::vector<std::size_t> steps;     // in the order of lanes
    int level = 0;
    bool stored = false;
    bool packs = false;                 // worth vectors
    bool down = false;                  // a running sum from the last lane to the first
  };

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

  /// A running sum is one member of the order; what nothing in Dynamics waits for comes last, all at once.
  void find_levels() {
    constexpr int patience = 200;
    int turn = 0;
    while (raise_levels() && turn < patience) ++turn;
    if (turn == patience) {  // running sums that wait for each other
      for (Step& s : steps_) s.chain = -1;
      while (raise_levels()) {}
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

  void store(Slot slot) { if (slot != no_slot) stored_[slot] = true; }

  /// As in the schedule of the program, for what is left after sums were written out.
  void find_stored() {
    stored_.assign(in_.slots, false);
    for (const Step& s : steps_) {
      for_operands(s, [&](Slot slot, int shift) { if (lag(slot) + shift != s.head.lag) store(slot); });
      for (const Term& term : s.products) store(term.a), store(term.b);
      if (s.head.op == Op::Linear || s.head.op == Op::Select) continue;
      if (s.head.op != Op::Products) store(s.head.a), store(s.head.b), store(s.head.out), store(s.head.second);
    }
    for (const Section section : {Along, AtPoint})
      for (const Run& run : in_.runs[section])
        for (std::uint32_t i = run.first; i < run.last; ++i) {
          const Instruction& instruction = in_.instructions[i];
          store(instruction.a), store(instruction.b);
          for (std::uint32_t t = instruction.first_term; t < instruction.last_term; ++t) store(in_.terms[t].a), store(in_.terms[t].b);
        }
    for (const auto* slots : {&in_.switch_slots, &in_.events, &in_.observables, &in_.integrands, &in_.constraint_values,
                              &in_.constraint_rates})
      for (const Slot slot : *slots) store(slot);
    std::map<int, bool> of_chain;  // all members or none
    for (const Step& s : steps_) if (s.chain >= 0 && stored_[s.head.out]) of_chain[s.chain] = true;
    for (const Step& s : steps_) if (s.chain >= 0 && of_chain[s.chain]) store(s.head.out);
  }

  // --------------------------------------------------------------------------------------------------------- groups

  /// Where a slot comes from, coarsely: operands of one class may become neighbours.
  std::size_t class_of(Slot slot) const {
    const std::size_t producer = producer_[slot];
    if (producer == none) return 0;
    const bool is_second = steps_[producer].head.second == slot;
    return 2 + 2 * (static_cast<std::size_t>(level_[producer]) * 32 + static_cast<std::size_t>(steps_[producer].head.op)) + is_second;
  }

  /// The factor of lower lag first; like terms of several sums in like places.
  void align_products() {
    for (Step& s : steps_) {
      if (s.head.op != Op::Products && s.head.op != Op::Linear) continue;
      for (Term& term : s.products)
        if (std::tuple(lag(term.b), class_of(term.b), term.b) < std::tuple(lag(term.a), class_of(term.a), term.a)) std::swap(term.a, term.b);
      std::stable_sort(s.products.begin(), s.products.end(), [&](const Term& x, const Term& y) {
        return std::tuple(lag(x.a), lag(x.b), class_of(x.a), class_of(x.b)) < std::tuple(lag(y.a), lag(y.b), class_of(y.a), class_of(y.b));
      });
    }
  }

  /// Instructions of one key may share a pack.
  std::vector<int> shape(std::size_t index) const {
    const Step& s = step(index);
    if (s.chain >= 0) return {level_[index], -1, s.chain};
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
      case Op::Linear: case Op::Products: case Op::Square: case Op::SinCos: case Op::SinhCosh:
      case Op::Quotient: case Op::SquareRoot: return true;
      case Op::Function: return s.products.size() == 1 && s.head.b == no_slot;
      default: return false;
    }
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
      group.packs = can_pack(step(group.steps[0])) && group.steps.size() * terms >= 2;
    }
  }

  /// Non-linear groups follow their first operands; sums follow their consumers.
  void order_groups() {
    place_.assign(in_.slots, 0);
    for (Slot slot = 0; slot < in_.unknowns; ++slot) place_[slot] = slot;
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
      if (step(group.steps[0]).chain >= 0) {
        group.down = rank_[step(group.steps.front()).head.out] > rank_[step(group.steps.back()).head.out];
        if (group.down) std::reverse(group.steps.begin(), group.steps.end());
      } else if (is_linear(step(group.steps[0]))) {
        std::stable_sort(group.steps.begin(), group.steps.end(), [&](std::size_t x, std::size_t y) {
          return rank_[steps_[x].head.out] < rank_[steps_[y].head.out];
        });
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
    const auto rank = [&](Slot slot) { if (slot != no_slot && rank_[slot] == none) rank_[slot] = next; ++next; };
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

  // ------------------------------------------------------------------------------------------------------ numbering

  /// Coordinates; corrected slots by lag; the other slots of Dynamics; everything else. Packs begin at multiples of 8.
  void number_slots() {
    number_.assign(in_.slots, no_slot);
    std::size_t next = 0;
    for (Slot slot = 0; slot < in_.unknowns; ++slot) number_[slot] = static_cast<Slot>(next++);
    const auto is_corrected = [&](const Group& group, int l) {
      const Slot out = step(group.steps[0]).head.out;
      return group.stored && in_.tangent_lags[out] != Program::unmoved && lag(out) == l;
    };
    for (int l = 0; l <= 2; ++l) {
      next = padded(next);
      for (const Group& group : groups_) if (is_corrected(group, l)) number(group, next);
      program_.stored_end[static_cast<std::size_t>(l)] = static_cast<Slot>(next);
    }
    for (const Group& group : groups_) number(group, next);
    for (Slot slot = 0; slot < in_.slots; ++slot)
      if (number_[slot] == no_slot && is_read(slot)) number_[slot] = static_cast<Slot>(next++);
    program_.slots = padded(next);
  }

  /// A slot that sums were written over has no number.
  bool is_read(Slot slot) const {
    if (slot == in_.one || slot == in_.time) return true;
    return !in_dynamics_before(slot) || producer_[slot] != none;
  }
  bool in_dynamics_before(Slot slot) const {
    if (made_in_dynamics_.empty()) {
      made_in_dynamics_.assign(in_.slots, false);
      for (const Run& run : in_.runs[Dynamics])
        for (std::uint32_t i = run.first; i < run.last; ++i) {
          made_in_dynamics_[in_.instructions[i].out] = true;
          if (in_.instructions[i].second != no_slot) made_in_dynamics_[in_.instructions[i].second] = true;
        }
    }
    return made_in_dynamics_[slot];
  }

  void number(const Group& group, std::size_t& next) {
    if (number_[step(group.steps[0]).head.out] != no_slot) return;
    if (group.packs) next = padded(next);
    const auto outs = [&](Slot Instruction::* result) {
      for (const std::size_t i : group.steps)
        if (const Slot slot = steps_[i].head.*result; slot != no_slot) number_[slot] = static_cast<Slot>(next++);
    };
    outs(&Instruction::out);
    // Few sines and their cosines share a vector.
    if (group.packs && 2 * group.steps.size() > lanes) next = padded(next);
    outs(&Instruction::second);
    if (group.packs) next = padded(next);
  }

  Slot renumbered(Slot slot) const { return slot == no_slot ? no_slot : number_[slot]; }

  // --------------------------------------------------------------------------------------------------------- output

  void write_program() {
    std::vector<Instruction> rest;
    std::vector<Term> terms;
    std::array<std::vector<Run>, SectionCount> runs;
    program_.instructions.clear();
    const auto append = [&](Instruction instruction, std::span<const Term> linear, std::span<const Term> products) {
      for (Slot* slot : {&instruction.out, &instruction.second, &instruction.a, &instruction.b}) *slot = renumbered(*slot);
      instruction.first_term = static_cast<std::uint32_t>(terms.size());
      for (const Term& term : linear) terms.push_back({term.coefficient, renumbered(term.a), no_slot, term.shift});
      instruction.first_product = static_cast<std::uint32_t>(terms.size());
      for (const Term& term : products) terms.push_back({term.coefficient, renumbered(term.a), renumbered(term.b), term.shift});
      instruction.last_term = static_cast<std::uint32_t>(terms.size());
      program_.instructions.push_back(instruction);
    };
    for (const Group& group : groups_) {
      std::vector<std::size_t> in_order = group.steps;
      if (group.down) std::reverse(in_order.begin(), in_order.end());
      for (const std::size_t i : in_order) {
        const auto index = static_cast<std::uint32_t>(program_.instructions.size());
        index_.emplace(i, index);
        append(steps_[i].head, steps_[i].linear, steps_[i].products);
        runs[Dynamics].push_back({steps_[i].head.op, steps_[i].head.lag, index, index + 1});
      }
    }
    for (const Section section : {Along, AtPoint})
      for (const Run& run : in_.runs[section]) {
        const auto first = static_cast<std::uint32_t>(program_.instructions.size());
        for (std::uint32_t i = run.first; i < run.last; ++i) {
          const Instruction& x = in_.instructions[i];
          const Term* const all = in_.terms.data();
          append(x, {all + x.first_term, all + x.first_product}, {all + x.first_product, all + x.last_term});
        }
        runs[section].push_back({run.op, run.lag, first, static_cast<std::uint32_t>(program_.instructions.size())});
      }
    program_.terms = std::move(terms);
    program_.runs = std::move(runs);
    renumber_outputs();
  }

  void renumber_outputs() {
    std::vector<std::int8_t> lags(program_.slots, 0), tangent_lags(program_.slots, Program::unmoved);
    for (Slot slot = 0; slot < in_.slots; ++slot) {
      if (number_[slot] == no_slot) continue;
      lags[number_[slot]] = in_.lags[slot];
      tangent_lags[number_[slot]] = in_.tangent_lags[slot];
    }
    program_.lags = std::move(lags);
    program_.tangent_lags = std::move(tangent_lags);
    program_.one = renumbered(in_.one);
    program_.time = renumbered(in_.time);
    for (auto* slots : {&program_.residual, &program_.constraint_values, &program_.constraint_rates, &program_.switch_slots,
                        &program_.events, &program_.observables, &program_.integrands})
      for (Slot& slot : *slots) slot = renumbered(slot);
  }

  void write_packs() {
    program_.constants.push_back({.kind = Kind::Number, .value = 0});
    zero_ = static_cast<ConstantId>(program_.constants.size() - 1);
    out_.program = std::move(program_);
    out_.number = number_;
    next_cell_ = padded(out_.program.slots);
    for (const Group& group : groups_) {
      if (!group.packs) {
        for (const std::size_t i : group.steps) scalar(i, group.level);
        continue;
      }
      const std::size_t chunks = padded(group.steps.size()) / lanes;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        const std::size_t first = lanes * (group.down ? chunks - 1 - chunk : chunk);
        const std::size_t last = std::min<std::size_t>(first + lanes, group.steps.size());
        write_pack({group.steps.begin() + static_cast<std::ptrdiff_t>(first), group.steps.begin() + static_cast<std::ptrdiff_t>(last)},
                   group);
      }
    }
    out_.cells = next_cell_;
  }

  void scalar(std::size_t i, int level) {
    out_.packs.push_back({.kind = Pack::Scalar, .lag = step(i).head.lag, .level = static_cast<std::int8_t>(std::min(level, 127)),
                          .width = 1, .out = number_[step(i).head.out], .instruction = index_.at(i)});
  }

  using Members = std::span<const std::size_t>;

  void write_pack(Members members, const Group& group) {
    const Step& shape = step(members[0]);
    Pack pack{.lag = shape.head.lag, .level = static_cast<std::int8_t>(std::min(group.level, 127)),
              .width = static_cast<std::uint32_t>(members.size()), .out = number_[shape.head.out],
              .instruction = index_.at(members[0])};
    if (shape.chain >= 0) return scan(pack, members, group);
    switch (shape.head.op) {
      case Op::SinCos: return pairs(pack, members, group, -1);
      case Op::SinhCosh: return pairs(pack, members, group, 1);
      case Op::Function: function(pack, members); break;
      case Op::Quotient:
        pack.kind = Pack::Quotient;
        pack.a = heads(members, &Instruction::a), pack.b = heads(members, &Instruction::b), pack.y = heads(members, &Instruction::out);
        break;
      case Op::SquareRoot:
        pack.kind = Pack::SquareRoot;
        pack.a = heads(members, &Instruction::a), pack.y = heads(members, &Instruction::out);
        break;
      default: sum(pack, members); break;
    }
    out_.packs.push_back(pack);
  }

  std::uint32_t heads(Members members, Slot Instruction::* operand) {
    std::vector<Slot> slots;
    for (const std::size_t i : members) slots.push_back(number_[step(i).head.*operand]);
    return block(slots, false);
  }

  void function(Pack& pack, Members members) {
    pack.kind = Pack::Integral;
    std::vector<Slot> u, w;
    std::vector<ConstantId> c;
    functions(pack, members);
    for (const std::size_t i : members) {
      const Term& term = step(i).products[0];
      u.push_back(number_[term.b]), w.push_back(number_[term.a]), c.push_back(term.coefficient);
    }
    pack.a = block(u, true), pack.b = block(w, false), pack.coefficients = coefficients(c);
  }

  void functions(Pack& pack, Members members) {
    pack.first_function = static_cast<std::uint32_t>(out_.functions.size());
    for (const std::size_t i : members) out_.functions.push_back(index_.at(i));
    pack.last_function = static_cast<std::uint32_t>(out_.functions.size());
  }

  /// d sin u = cos u du, d cos u = −sin u du: one pack if both fit, else two.
  void pairs(Pack pack, Members members, const Group& group, int sign) {
    pack.kind = Pack::Integral;
    const ConstantId plus = literal(1), other = literal(sign);
    std::vector<Slot> u, out, second;
    for (const std::size_t i : members)
      u.push_back(number_[step(i).head.a]), out.push_back(number_[step(i).head.out]), second.push_back(number_[step(i).head.second]);
    functions(pack, members);
    if (sign < 0) pack.pairs = second[0];
    const std::size_t count = members.size();
    if (2 * group.steps.size() <= lanes) {
      pack.width = static_cast<std::uint32_t>(2 * count);
      u.insert(u.end(), u.begin(), u.begin() + static_cast<std::ptrdiff_t>(count));
      std::vector<Slot> w = second;
      w.insert(w.end(), out.begin(), out.end());
      std::vector<ConstantId> c(count, plus);
      c.insert(c.end(), count, other);
      pack.a = block(u, true), pack.b = block(w, false), pack.coefficients = coefficients(c);
      out_.packs.push_back(pack);
      return;
    }
    pack.a = block(u, true), pack.b = block(second, false);
    pack.coefficients = coefficients(std::vector<ConstantId>(count, plus));
    out_.packs.push_back(pack);
    pack.out = second[0];
    pack.b = block(out, false);
    pack.coefficients = coefficients(std::vector<ConstantId>(count, other));
    pack.first_function = pack.last_function;
    out_.packs.push_back(pack);
  }

  void scan(Pack pack, Members members, const Group& group) {
    pack.kind = group.down ? Pack::ScanDown : Pack::Scan;
    pack.carry = number_[step(group.down ? members.back() : members.front()).linear.front().a];
    columns(pack, members);
    out_.packs.push_back(pack);
  }

  /// What the engine reads, run by run.
  void columns(Pack& pack, Members members) {
    pack.first_column = static_cast<std::uint32_t>(out_.columns.size());
    pack.first_run = static_cast<std::uint32_t>(out_.runs.size());
    auto found = columns_of(members);
    const auto key = [&](const auto& entry) {
      const Column& column = entry.first;
      return std::tuple(column.shift, column.kind, passes_tangent(column, pack.lag));
    };
    std::stable_sort(found.begin(), found.end(), [&](const auto& x, const auto& y) { return key(x) < key(y); });
    for (auto& entry : found) {
      const auto [shift, kind, passes] = key(entry);
      const auto at = static_cast<std::uint32_t>(out_.columns.size());
      const bool fresh = out_.runs.size() == pack.first_run || key(entry) != std::tuple(out_.runs.back().shift, out_.runs.back().kind, out_.runs.back().passes_tangent);
      if (fresh) out_.runs.push_back({kind, shift, passes, at, at});
      ++out_.runs.back().last;
      add_column(entry.first, std::move(entry.second), pack.lag);
    }
    pack.last_column = static_cast<std::uint32_t>(out_.columns.size());
    pack.last_run = static_cast<std::uint32_t>(out_.runs.size());
  }

  /// Of a running sum: what is added.
  std::vector<Term> terms_of(std::size_t index) const {
    std::vector<Term> terms(step(index).linear.begin() + (step(index).chain >= 0 ? 1 : 0), step(index).linear.end());
    for (Term& term : terms) term.a = number_[term.a];
    return terms;
  }

  void sum(Pack& pack, Members members) {
    pack.kind = Pack::Sum;
    columns(pack, members);
    pack.first_aligned = static_cast<std::uint32_t>(out_.columns.size());
    aligned_columns(members, pack.lag);
    pack.last_aligned = static_cast<std::uint32_t>(out_.columns.size());
    pack.first_product = static_cast<std::uint32_t>(out_.products.size());
    const Step& shape = step(members[0]);
    if (shape.head.op == Op::Square) {
      const std::uint32_t a = heads(members, &Instruction::a);
      out_.products.push_back({a, a, coefficients(std::vector<ConstantId>(members.size(), literal(1)))});
    }
    for (std::size_t t = 0; t < shape.products.size(); ++t) {
      std::vector<Slot> a, b;
      std::vector<ConstantId> c;
      for (const std::size_t i : members) {
        const Term& term = step(i).products[t];
        a.push_back(number_[term.a]), b.push_back(number_[term.b]), c.push_back(term.coefficient);
      }
      out_.products.push_back({block(a, false), block(b, false), coefficients(c)});
    }
    pack.last_product = static_cast<std::uint32_t>(out_.products.size());
  }

  /// By operand (one load serves all lanes) or by place in the sums (one gather each): what takes fewer loads.
  std::vector<std::pair<Column, std::vector<ConstantId>>> columns_of(Members members) const {
    using Key = std::pair<std::uint32_t, Slot>;
    std::map<Key, std::vector<ConstantId>> by_operand;
    std::vector<std::vector<Term>> sums;
    std::size_t longest = 0;
    for (std::size_t lane = 0; lane < members.size(); ++lane) {
      std::vector<Term> terms = terms_of(members[lane]);
      for (const Term& term : terms) {
        auto& column = by_operand[{term.shift, term.a}];
        column.resize(lanes, zero_);
        column[lane] = term.coefficient;
      }
      std::stable_sort(terms.begin(), terms.end(), [](const Term& x, const Term& y) { return std::tuple(x.shift, x.a) < std::tuple(y.shift, y.a); });
      longest = std::max(longest, terms.size());
      sums.push_back(std::move(terms));
    }
    const auto same_shifts = [&](std::size_t t) {
      const auto lag_of = [&](const Term& term) { return out_.program.tangent_lags[term.a]; };
      return std::all_of(sums.begin(), sums.end(), [&](const auto& s) {
        return t < s.size() && t < sums[0].size() && s[t].shift == sums[0][t].shift && lag_of(s[t]) == lag_of(sums[0][t]);
      });
    };
    bool aligned = true;
    for (std::size_t t = 0; t < longest; ++t) aligned = aligned && same_shifts(t);
    std::size_t loads = 0;
    for (std::size_t t = 0; aligned && t < longest; ++t) loads += is_range(sums, t) || is_reversed(sums, t) ? 1 : 5;
    const bool by_place = aligned && loads < by_operand.size();
    std::vector<std::pair<Column, std::vector<ConstantId>>> found;
    if (!by_place) {
      for (const auto& [key, column] : by_operand)
        found.push_back({{.kind = Column::Broadcast, .shift = static_cast<std::uint8_t>(key.first), .source = key.second}, column});
      return found;
    }
    for (std::size_t t = 0; t < longest; ++t) {
      Column column{.kind = is_range(sums, t) ? Column::Contiguous : is_reversed(sums, t) ? Column::Reversed : Column::Gather, .shift = static_cast<std::uint8_t>(sums[0][t].shift),
                    .source = sums[0][t].a};
      std::vector<ConstantId> c;
      column.sources.fill(sums[0][t].a);
      for (std::size_t lane = 0; lane < sums.size(); ++lane) column.sources[lane] = sums[lane][t].a, c.push_back(sums[lane][t].coefficient);
      found.push_back({column, std::move(c)});
    }
    return found;
  }

  /// One column a place, whatever the sums hold there: a lane whose sum is shorter reads its own operand times 0. Terms of the
  /// leaf 1 stand apart, since they vanish beyond order 0.
  void aligned_columns(Members members, int lag) {
    using Order = std::tuple<std::uint32_t, int, bool, Slot>;
    std::vector<std::vector<Term>> sums;
    std::map<std::pair<std::uint32_t, int>, std::size_t> longest;  // by shift and lag
    std::vector<ConstantId> of_one(lanes, zero_);
    bool has_one = false;
    const auto lag_of = [&](const Term& term) { return static_cast<int>(out_.program.lags[term.a]); };
    for (std::size_t lane = 0; lane < members.size(); ++lane) {
      std::vector<Term> terms;
      for (const Term& term : terms_of(members[lane])) {
        if (term.a == out_.program.one) has_one = true, of_one[lane] = term.coefficient;
        else terms.push_back(term);
      }
      const auto key = [&](const Term& x) { return Order{x.shift, lag_of(x), false, x.a}; };
      std::stable_sort(terms.begin(), terms.end(), [&](const Term& x, const Term& y) { return key(x) < key(y); });
      std::map<std::pair<std::uint32_t, int>, std::size_t> count;
      for (const Term& term : terms) {
        const std::pair kind{term.shift, lag_of(term)};
        longest[kind] = std::max(longest[kind], ++count[kind]);
      }
      sums.push_back(std::move(terms));
    }
    for (const auto& [kind, count] : longest)
      for (std::size_t t = 0; t < count; ++t) {
        Column column{.kind = Column::Gather, .shift = static_cast<std::uint8_t>(kind.first)};
        std::vector<ConstantId> c;
        Slot any = no_slot;
        std::vector<Slot> sources;
        for (const auto& terms : sums) {
          std::size_t seen = 0;
          Slot slot = no_slot;
          ConstantId coefficient = zero_;
          for (const Term& term : terms)
            if (std::pair{term.shift, lag_of(term)} == kind && seen++ == t) slot = term.a, coefficient = term.coefficient;
          sources.push_back(slot), c.push_back(coefficient);
          if (slot != no_slot) any = slot;
        }
        column.sources.fill(any);
        for (std::size_t lane = 0; lane < sources.size(); ++lane) column.sources[lane] = sources[lane] == no_slot ? any : sources[lane];
        column.source = any;
        add_column(column, c, lag);
      }
    if (has_one) add_column({.kind = Column::Broadcast, .source = out_.program.one}, of_one, lag);
  }

  /// Whether 8 lanes can be read at once. Lanes beyond the sums are multiplied by 0, so that they must hold numbers: they do if
  /// they belong to the same pack.
  static bool is_range(const std::vector<std::vector<Term>>& sums, std::size_t t) {
    const Slot first = sums[0][t].a;
    for (std::size_t lane = 0; lane < sums.size(); ++lane)
      if (sums[lane][t].a != first + lane) return false;
    return sums.size() == lanes || first % lanes == 0;
  }

  static bool is_reversed(const std::vector<std::vector<Term>>& sums, std::size_t t) {
    for (std::size_t lane = 0; lane < sums.size(); ++lane)
      if (sums[lane][t].a + lane != sums[0][t].a) return false;
    return sums.size() == lanes;
  }

  bool passes_tangent(const Column& column, int lag) const { return out_.program.tangent_lags[column.source] + column.shift == lag; }

  void add_column(Column column, std::vector<ConstantId> c, int lag) {
    column.passes_tangent = passes_tangent(column, lag);
    column.coefficients = coefficients(std::move(c));
    out_.columns.push_back(column);
  }

  std::uint32_t coefficients(std::vector<ConstantId> c) {
    const auto first = static_cast<std::uint32_t>(out_.coefficients.size());
    c.resize(lanes, zero_);
    out_.coefficients.insert(out_.coefficients.end(), c.begin(), c.end());
    return first;
  }

  std::uint32_t block(const std::vector<Slot>& slots, bool weighted) {
    bool range = !weighted && (slots.size() == lanes || slots[0] % lanes == 0);
    for (std::size_t lane = 0; lane < slots.size(); ++lane) range = range && slots[lane] == slots[0] + lane;
    const auto [place, fresh] = blocks_.try_emplace({slots, weighted}, static_cast<std::uint32_t>(out_.blocks.size()));
    if (!fresh) return place->second;
    Block result{.first = slots[0], .direct = range, .weighted = weighted, .lag = out_.program.lags[slots[0]],
                 .width = static_cast<std::uint32_t>(slots.size())};
    result.slots.fill(slots[0]);
    std::copy(slots.begin(), slots.end(), result.slots.begin());
    result.is_range = slots.size() == lanes || slots[0] % lanes == 0;
    for (std::size_t lane = 0; lane < slots.size(); ++lane) result.is_range = result.is_range && slots[lane] == slots[0] + lane;
    if (!range) {
      result.first = static_cast<Slot>(next_cell_);
      next_cell_ += lanes;
    }
    out_.blocks.push_back(result);
    return place->second;
  }

  ConstantId literal(int value) {
    const auto [place, fresh] = literals_.try_emplace(value, 0);
    if (fresh) {
      out_.program.constants.push_back({.kind = Kind::Number, .value = static_cast<double>(value)});
      place->second = static_cast<ConstantId>(out_.program.constants.size() - 1);
    }
    return place->second;
  }

  static constexpr std::size_t none = ~std::size_t{0};

  const Program& in_;
  Program program_;
  PackedProgram out_;
  std::vector<Step> steps_;
  std::vector<std::size_t> producer_;   // [slots]
  std::vector<int> level_;              // [steps]
  std::vector<bool> stored_;            // [slots]
  std::vector<Group> groups_;
  std::vector<std::size_t> place_, rank_;
  std::vector<Slot> number_;            // [slots] old to new
  mutable std::vector<bool> made_in_dynamics_;
  std::map<std::size_t, std::uint32_t> index_;
  std::map<std::pair<std::vector<Slot>, bool>, std::uint32_t> blocks_;
  std::map<int, ConstantId> literals_;
  ConstantId zero_ = 0;
  std::size_t next_cell_ = 0;
};

}  // namespace

PackedProgram pack(const Program& program) { return Layout(program).run(); }

}  // namespace maupertuis::packed

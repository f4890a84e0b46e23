#include "kernel/packed/numbering.hpp"

#include <algorithm>
#include <span>

namespace maupertuis::packed {
namespace {

class SlotNumbers {
 public:
  SlotNumbers(const Program& program, const std::vector<Step>& steps, const std::vector<Group>& groups)
      : in_(program), steps_(steps), groups_(groups) {}

  Numbering run() {
    find_made();
    out_.number.assign(in_.slots, no_slot);
    std::size_t next = 0;
    for (Slot slot = 0; slot < in_.unknowns; ++slot) out_.number[slot] = static_cast<Slot>(next++);
    const auto is_corrected = [&](const Group& group, int l) {
      const Slot out = step(group.steps[0]).head.out;
      return group.stored && in_.tangent_lags[out] != Program::unmoved && lag(out) == l;
    };
    for (int l = 0; l <= 2; ++l) {
      next = padded(next);
      for (const Group& group : groups_)
        if (is_corrected(group, l)) number(group, next);
      out_.stored_end[static_cast<std::size_t>(l)] = static_cast<Slot>(next);
    }
    for (const Group& group : groups_) number(group, next);
    next = padded(next);  // vectors of Dynamics are read whole, and what follows need not be finite
    for (Slot slot = 0; slot < in_.slots; ++slot)
      if (out_.number[slot] == no_slot && is_read(slot)) out_.number[slot] = static_cast<Slot>(next++);
    out_.slots = padded(next);
    return std::move(out_);
  }

 private:
  /// A slot that sums were written over has no number.
  bool is_read(Slot slot) const {
    if (slot == in_.one || slot == in_.time) return true;
    return !made_before_[slot] || made_[slot];
  }
  void find_made() {
    made_before_.assign(in_.slots, false);
    made_.assign(in_.slots, false);
    const auto mark = [](std::vector<bool>& made, const Instruction& instruction) {
      made[instruction.out] = true;
      if (instruction.second != no_slot) made[instruction.second] = true;
    };
    for (const Run& run : in_.runs[Dynamics])
      for (std::uint32_t i = run.first; i < run.last; ++i) mark(made_before_, in_.instructions[i]);
    for (const Step& s : steps_) mark(made_, s.head);
  }

  void number(const Group& group, std::size_t& next) {
    if (out_.number[step(group.steps[0]).head.out] != no_slot) return;
    if (group.packs) next = padded(next) + group.front;
    const auto outs = [&](Slot Instruction::*result) {
      for (const std::size_t i : group.steps)
        if (const Slot slot = steps_[i].head.*result; slot != no_slot) out_.number[slot] = static_cast<Slot>(next++);
    };
    outs(&Instruction::out);
    // Few sines and their cosines share a vector.
    if (group.packs && 2 * group.steps.size() > lanes) next = padded(next);
    outs(&Instruction::second);
    if (group.packs) next = padded(next);
  }

  const Step& step(std::size_t index) const { return steps_[index]; }
  int lag(Slot slot) const { return in_.lags[slot]; }

  const Program& in_;
  const std::vector<Step>& steps_;
  const std::vector<Group>& groups_;
  std::vector<bool> made_before_, made_;  // [slots] in Dynamics: before sums were written out, and now
  Numbering out_;
};

class Renumbering {
 public:
  Renumbering(const Program& program, Program constants, const std::vector<Step>& steps,
              const std::vector<Group>& groups, const Numbering& numbering)
      : in_(program),
        program_(std::move(constants)),
        steps_(steps),
        groups_(groups),
        number_(numbering.number),
        index_(steps.size()) {
    program_.slots = numbering.slots;
    program_.stored_end = numbering.stored_end;
  }

  Renumbered run() {
    std::vector<Term> terms;
    std::array<std::vector<Run>, SectionCount> runs;
    program_.instructions.clear();
    const auto append = [&](Instruction instruction, std::span<const Term> linear, std::span<const Term> products) {
      for (Slot* slot : {&instruction.out, &instruction.second, &instruction.a, &instruction.b})
        *slot = renumbered(*slot);
      instruction.first_term = static_cast<std::uint32_t>(terms.size());
      for (const Term& term : linear) terms.push_back({term.coefficient, renumbered(term.a), no_slot, term.shift});
      instruction.first_product = static_cast<std::uint32_t>(terms.size());
      for (const Term& term : products)
        terms.push_back({term.coefficient, renumbered(term.a), renumbered(term.b), term.shift});
      instruction.last_term = static_cast<std::uint32_t>(terms.size());
      program_.instructions.push_back(instruction);
    };
    for (const Group& group : groups_) {
      std::vector<std::size_t> in_order = group.steps;
      if (group.in_strands)
        std::sort(in_order.begin(), in_order.end());
      else if (group.down)
        std::reverse(in_order.begin(), in_order.end());
      for (const std::size_t i : in_order) {
        const auto index = static_cast<std::uint32_t>(program_.instructions.size());
        index_[i] = index;
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
    return {std::move(program_), std::move(index_)};
  }

 private:
  void renumber_outputs() {
    std::vector<std::int8_t> lags(program_.slots, 0), tangent_lags(program_.slots, Program::unmoved);
    for (Slot slot = 0; slot < in_.slots; ++slot) {
      if (number_[slot] == no_slot) continue;
      lags[number_[slot]] = in_.lags[slot];
      tangent_lags[number_[slot]] = in_.tangent_lags[slot];
    }
    for (const Group& group : groups_) {  // empty lanes are read with the others
      const Slot first = number_[steps_[group.steps[0]].head.out];
      std::fill_n(lags.begin() + static_cast<std::ptrdiff_t>(first - group.front), group.front, lags[first]);
      std::fill_n(tangent_lags.begin() + static_cast<std::ptrdiff_t>(first - group.front), group.front,
                  tangent_lags[first]);
    }
    program_.lags = std::move(lags);
    program_.tangent_lags = std::move(tangent_lags);
    program_.one = renumbered(in_.one);
    program_.time = renumbered(in_.time);
    for (auto* slots : {&program_.residual, &program_.constraint_values, &program_.constraint_rates,
                        &program_.switch_slots, &program_.events, &program_.observables, &program_.integrands})
      for (Slot& slot : *slots) slot = renumbered(slot);
  }

  Slot renumbered(Slot slot) const { return slot == no_slot ? no_slot : number_[slot]; }

  const Program& in_;
  Program program_;
  const std::vector<Step>& steps_;
  const std::vector<Group>& groups_;
  const std::vector<Slot>& number_;
  std::vector<std::uint32_t> index_;
};

}  // namespace

Numbering number_slots(const Program& program, const std::vector<Step>& steps, const std::vector<Group>& groups) {
  return SlotNumbers(program, steps, groups).run();
}

Renumbered renumber(const Program& program, Program constants, const std::vector<Step>& steps,
                    const std::vector<Group>& groups, const Numbering& numbering) {
  return Renumbering(program, std::move(constants), steps, groups, numbering).run();
}

}  // namespace maupertuis::packed

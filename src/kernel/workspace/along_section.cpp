#include "kernel/workspace/along_section.hpp"

#include <algorithm>

namespace maupertuis::workspace {
namespace {

constexpr std::uint32_t none = static_cast<std::uint32_t>(-1);

}  // namespace

AlongSection::AlongSection(const Program& program)
    : program_(program),
      maker_(program.slots, none),
      is_later_(program.instructions.size(), false),
      seen_(program.instructions.size(), false),
      of_event_(program.events.size()),
      has_makers_(program.events.size(), false),
      known_(program.events.size(), 0) {
  for (const Run& run : program.runs[Along])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      maker_[program.instructions[i].out] = i;
      if (program.instructions[i].second != no_slot) maker_[program.instructions[i].second] = i;
    }
  for (const auto* slots : {&program.switch_slots, &program.integrands})
    for (const Slot slot : *slots)
      for (const std::uint32_t i : makers_of(slot)) is_later_[i] = true;
  later_ = runs_of(is_later_);
  std::vector<bool> without_events = is_later_;
  const auto keep = [&](Slot slot) {
    for (const std::uint32_t i : makers_of(slot)) without_events[i] = true;
  };
  for (const Slot slot : program.observables) keep(slot);
  for (const Run& run : program.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      const Instruction& instruction = program.instructions[i];
      keep(instruction.a), keep(instruction.b);
      for (std::uint32_t t = instruction.first_term; t < instruction.last_term; ++t)
        keep(program.terms[t].a), keep(program.terms[t].b);
    }
  without_events_ = runs_of(without_events);
}

/// Those of the section that are chosen, in order.
std::vector<Run> AlongSection::runs_of(const std::vector<bool>& chosen) const {
  std::vector<Run> out;
  for (const Run& run : program_.runs[Along])
    for (std::uint32_t i = run.first; i < run.last; ++i) {
      if (!chosen[i]) continue;
      if (!out.empty() && out.back().last == i && out.back().op == run.op && out.back().lag == run.lag)
        ++out.back().last;
      else
        out.push_back({run.op, run.lag, i, i + 1});
    }
  return out;
}

/// Those of the section without which a slot has no value, in order.
std::vector<std::uint32_t> AlongSection::makers_of(Slot slot) {
  std::vector<std::uint32_t> out;
  const auto reach = [&](Slot s) {
    if (s == no_slot || maker_[s] == none || is_later_[maker_[s]] || seen_[maker_[s]]) return;
    seen_[maker_[s]] = true;
    out.push_back(maker_[s]);
  };
  reach(slot);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Instruction& i = program_.instructions[out[k]];
    reach(i.a);
    reach(i.b);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) reach(program_.terms[t].a), reach(program_.terms[t].b);
  }
  for (const std::uint32_t i : out) seen_[i] = false;
  std::sort(out.begin(), out.end());
  return out;
}

void AlongSection::begin(bool is_point) {
  is_point_ = is_point;
  has_events_ = !is_point;
  if (++expansion_ != 0) return;
  std::fill(known_.begin(), known_.end(), 0);
  expansion_ = 1;
}

void AlongSection::run(reference::Memory& memory, int stage) const {
  if (stage <= 0 && !is_point_) {
    if (!empty()) reference::run_section(memory, Along, stage);
    return;
  }
  for (const Run& run : is_point_ ? without_events_ : later_)
    if (const int order = stage + 2 - run.lag; order >= 0) reference::run_instructions(memory, run, order);
}

void AlongSection::need_point(reference::Memory& memory) {
  if (has_events_) return;
  has_events_ = true;
  for (int stage = program_.first_stage; stage <= 0; ++stage) reference::run_section(memory, Along, stage);
}

void AlongSection::need_event(reference::Memory& memory, std::size_t event, int last_stage) {
  if (known_[event] == expansion_) return;
  known_[event] = expansion_;
  if (!has_makers_[event]) {
    of_event_[event] = makers_of(program_.events[event]);
    has_makers_[event] = true;
  }
  for (int stage = 1; stage <= last_stage; ++stage)
    for (const std::uint32_t i : of_event_[event])
      if (const int order = stage + 2 - program_.instructions[i].lag; order >= 0)
        reference::run_instruction(memory, i, order);
}

}  // namespace maupertuis::workspace

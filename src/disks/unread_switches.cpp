#include "disks/unread_switches.hpp"

namespace maupertuis {
namespace {

/// Constants that the slots are made of, with all that these are made of. [constants]
std::vector<bool> constants_of(const Program& program, const std::vector<const std::vector<Slot>*>& roots) {
  std::vector<const Instruction*> maker(program.slots, nullptr);
  for (const Instruction& i : program.instructions) {
    maker[i.out] = &i;
    if (i.second != no_slot) maker[i.second] = &i;
  }
  std::vector<bool> reached(program.slots, false), out(program.constants.size(), false);
  std::vector<Slot> open;
  const auto reach = [&](Slot slot) {
    if (slot == no_slot || reached[slot]) return;
    reached[slot] = true;
    open.push_back(slot);
  };
  for (const std::vector<Slot>* slots : roots)
    for (const Slot slot : *slots) reach(slot);
  while (!open.empty()) {
    const Instruction* const i = maker[open.back()];
    open.pop_back();
    if (!i) continue;
    if (i->op == Op::Power) out[i->constant] = true;
    reach(i->a);
    reach(i->b);
    for (std::uint32_t t = i->first_term; t < i->last_term; ++t) {
      out[program.terms[t].coefficient] = true;
      reach(program.terms[t].a);
      reach(program.terms[t].b);
    }
  }
  for (std::size_t c = out.size(); c-- > 0;)  // arguments come before what is made of them
    for (std::uint32_t a = 0; out[c] && a < program.constants[c].arguments; ++a)
      out[program.constant_arguments[program.constants[c].first_argument + a]] = true;
  return out;
}

/// Switches whose sides are among these constants. [switches]
std::vector<bool> switches_in(const Program& program, const std::vector<const std::vector<Slot>*>& roots) {
  std::vector<bool> out(program.switch_slots.size(), false);
  const std::vector<bool> read = constants_of(program, roots);
  for (std::size_t c = 0; c < read.size(); ++c) {
    const Constant& constant = program.constants[c];
    if (read[c] && constant.kind == Kind::Sign && constant.arguments == 0) out[constant.index] = true;
  }
  return out;
}

}  // namespace

std::vector<bool> switches_of_events_alone(const Program& program) {
  std::vector<bool> out = switches_in(program, {&program.residual, &program.constraint_values,
                                                &program.constraint_rates, &program.observables, &program.integrands});
  out.flip();
  return out;
}

std::vector<bool> switches_read_by(const Program& program, Slot slot) {
  const std::vector<Slot> slots{slot};
  const bool reads_unknowns = program.lags[slot] >= 2;
  return reads_unknowns ? switches_in(program, {&slots, &program.residual}) : switches_in(program, {&slots});
}

}  // namespace maupertuis

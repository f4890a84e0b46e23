#include "kernel/program/code.hpp"

namespace maupertuis {
namespace {

using machine_code::Digester;

template <class List>
void add_list(Digester& digester, const List& list) {
  digester.add(list.size());
  for (const auto x : list) digester.add(static_cast<std::uint64_t>(x));
}

void add_constants(Digester& d, const Program& program) {
  d.add(program.constants.size());
  for (const Constant& c : program.constants) {
    d.add(static_cast<std::uint64_t>(c.kind));
    d.add_double(c.value);
    d.add(c.index);
    d.add(c.first_argument);
    d.add(c.arguments);
  }
  add_list(d, program.constant_arguments);
}

void add_instructions(Digester& d, const Program& program) {
  d.add(program.instructions.size());
  for (const Instruction& i : program.instructions) {
    for (const std::uint64_t part : {std::uint64_t(i.op), std::uint64_t(i.function), std::uint64_t(i.lag)}) d.add(part);
    for (const std::uint32_t part : {i.out, i.second, i.a, i.b, i.constant, i.first_term, i.first_product, i.last_term})
      d.add(part);
  }
  d.add(program.terms.size());
  for (const Term& t : program.terms)
    for (const std::uint32_t part : {t.coefficient, t.a, t.b, t.shift}) d.add(part);
  for (const auto& runs : program.runs) {
    d.add(runs.size());
    for (const Run& run : runs) d.add(run.first), d.add(run.last);
  }
}

}  // namespace

machine_code::Digest digest_of(const Program& program) {
  Digester d;
  add_constants(d, program);
  add_instructions(d, program);
  d.add(program.slots);
  add_list(d, program.stored_end);
  add_list(d, program.lags);
  add_list(d, program.tangent_lags);
  for (const std::uint64_t part :
       {std::uint64_t(program.one), std::uint64_t(program.time), std::uint64_t(program.first_stage),
        std::uint64_t(program.freedoms), std::uint64_t(program.unknowns)})
    d.add(part);
  for (const auto* list : {&program.residual, &program.constraint_values, &program.constraint_rates,
                           &program.switch_slots, &program.events, &program.observables, &program.integrands})
    add_list(d, *list);
  return d.digest();
}

CompileReport report_of(const machine_code::Compiled& made) {
  return {.compiled = made.code != nullptr,
          .trouble = made.trouble,
          .cache_trouble = made.cache_trouble,
          .from_cache = made.from_cache,
          .is_final = made.is_final,
          .seconds = made.seconds};
}

}  // namespace maupertuis

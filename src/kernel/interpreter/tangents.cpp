#include "kernel/interpreter/tangents_code.hpp"

#include <algorithm>

namespace maupertuis::interpreter {

template void tangents<1>(const Memory&, double*, std::span<const std::uint32_t>);
template void tangents<8>(const Memory&, double*, std::span<const std::uint32_t>);

std::vector<std::uint32_t> moved_instructions(const Program& program) {
  std::vector<std::uint32_t> out;
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (program.tangent_lags[program.instructions[i].out] != Program::unmoved) out.push_back(i);
  return out;
}

/// Backwards from the residual along the operands that pass the highest derivative on.
std::vector<std::uint32_t> instructions_of_mass(const Program& program) {
  std::vector<bool> needed(program.slots, false);
  for (const Slot slot : program.residual) needed[slot] = program.tangent_lags[slot] == 2;
  const std::vector<std::uint32_t> all = moved_instructions(program);
  std::vector<std::uint32_t> out;
  for (auto index = all.rbegin(); index != all.rend(); ++index) {
    const Instruction& i = program.instructions[*index];
    if (!needed[i.out] && !(i.second != no_slot && needed[i.second])) continue;
    out.push_back(*index);
    const auto reach = [&](Slot operand, std::uint32_t shift) {
      if (operand != no_slot && program.tangent_lags[operand] + static_cast<int>(shift) == i.lag) needed[operand] = true;
    };
    reach(i.a, i.op == Op::Derivative ? 1 : 0);
    reach(i.b, 0);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      reach(program.terms[t].a, program.terms[t].shift);
      reach(program.terms[t].b, 0);
    }
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace maupertuis::interpreter

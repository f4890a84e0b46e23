#include "kernel/interpreter/elementary.hpp"
#include "kernel/interpreter/interpreter.hpp"

#include <cmath>

namespace maupertuis::interpreter {
namespace {

/// Whole cache lines, and an odd number of them, so that the orders of a slot do not fall into one cache set.
std::size_t padded(std::size_t slots) {
  const std::size_t lines = (slots + 7) / 8;
  return 8 * (lines | 1);
}

}  // namespace

Memory::Memory(const Program& p, int orders, std::size_t cells)
    : program(p), stride(padded(cells)), constants(p.constants.size()), coefficients(p.terms.size()),
      linear(p.terms.size()), rows(static_cast<std::size_t>(orders) * stride, 0.0) {
  for (int k = 0; k < orders; ++k) shift_factors.insert(shift_factors.end(), {1.0, k + 1.0, (k + 1.0) * (k + 2.0)});
}

void compute_constants(Memory& memory, std::span<const double> parameters, std::span<const std::int8_t> sides) {
  const Program& program = memory.program;
  std::vector<double> operands;
  for (std::size_t i = 0; i < program.constants.size(); ++i) {
    const Constant& constant = program.constants[i];
    double& value = memory.constants[i];
    if (constant.kind == Kind::Number) { value = constant.value; continue; }
    if (constant.kind == Kind::Symbol) { value = parameters[constant.index]; continue; }
    if (constant.kind == Kind::Sign && constant.arguments == 0) { value = sides[constant.index]; continue; }
    operands.clear();
    for (std::uint32_t k = 0; k < constant.arguments; ++k)
      operands.push_back(memory.constants[program.constant_arguments[constant.first_argument + k]]);
    value = constant_operation(constant.kind, operands);
  }
  for (std::size_t i = 0; i < program.terms.size(); ++i) {
    const Term& term = program.terms[i];
    memory.coefficients[i] = memory.constants[term.coefficient];
    memory.linear[i] = {memory.coefficients[i], static_cast<std::uint32_t>(term.a + term.shift * memory.stride),
                        term.shift};
  }
}

void set_leaves(Memory& memory, double t, int orders) {
  const Program& program = memory.program;
  for (int k = 0; k < orders; ++k) {
    if (program.one != no_slot) memory.row(k)[program.one] = k == 0 ? 1 : 0;
    if (program.time != no_slot) memory.row(k)[program.time] = k == 0 ? t : k == 1 ? 1 : 0;
  }
}

double term_size(const Memory& memory, const Instruction* producer, Slot slot) {
  const double* now = memory.row(0);
  if (!producer || (producer->op != Op::Linear && producer->op != Op::Products)) return std::abs(now[slot]);
  double size = 0;
  for (std::uint32_t i = producer->first_term; i < producer->last_term; ++i) {
    const Term& term = memory.program.terms[i];
    const double factor = term.shift == 2 ? 2 : 1;
    const double a = factor * memory.row(static_cast<int>(term.shift))[term.a];
    size += std::abs(memory.coefficients[i] * a * (term.b == no_slot ? 1 : now[term.b]));
  }
  return size;
}

}  // namespace maupertuis::interpreter

#pragma once
#include "kernel/reference/elementary.hpp"
#include "kernel/reference/reference.hpp"

#include <cmath>

namespace maupertuis::reference {
/// Whole cache lines, and an odd number of them, so that the orders of a slot do not fall into one cache set.
inline std::size_t padded(std::size_t slots) {
  const std::size_t lines = (slots + 7) / 8;
  return 8 * (lines | 1);
}

template <class T>
MemoryOf<T>::MemoryOf(const Program& p, int orders, std::size_t cells)
    : program(p),
      stride(padded(cells)),
      constants(p.constants.size()),
      coefficients(p.terms.size()),
      linear(p.terms.size()),
      rows(static_cast<std::size_t>(orders) * stride, T(0)) {
  for (int k = 0; k < orders; ++k)
    shift_factors.insert(shift_factors.end(), {T(1), T(k + 1.0), T((k + 1.0) * (k + 2.0))});
}

template <class T>
T literal(const Program& program, const Constant& constant) {
  if constexpr (std::is_same_v<T, double>)
    return constant.value;
  else
    return Exactly<T>::from(program.literals[constant.index]);
}

template <class T>
void prepare_terms(MemoryOf<T>& memory) {
  const Program& program = memory.program;
  for (std::size_t i = 0; i < program.terms.size(); ++i) {
    const Term& term = program.terms[i];
    memory.coefficients[i] = memory.constants[term.coefficient];
    memory.linear[i] = {memory.coefficients[i], static_cast<std::uint32_t>(term.a + term.shift * memory.stride),
                        term.shift};
  }
}

template <class T>
void compute_constants(MemoryOf<T>& memory, std::span<const std::type_identity_t<T>> parameters,
                       std::span<const std::int8_t> sides) {
  const Program& program = memory.program;
  std::vector<T> operands;
  for (std::size_t i = 0; i < program.constants.size(); ++i) {
    const Constant& constant = program.constants[i];
    T& value = memory.constants[i];
    if (constant.kind == Kind::Number) {
      value = literal<T>(program, constant);
      continue;
    }
    if (constant.kind == Kind::Symbol) {
      value = parameters[constant.index];
      continue;
    }
    if (constant.kind == Kind::Sign && constant.arguments == 0) {
      value = T(sides[constant.index]);
      continue;
    }
    operands.clear();
    for (std::uint32_t k = 0; k < constant.arguments; ++k)
      operands.push_back(memory.constants[program.constant_arguments[constant.first_argument + k]]);
    value = constant_operation<T>(constant.kind, operands);
  }
  prepare_terms(memory);
}

template <class T>
void set_leaves(MemoryOf<T>& memory, const std::type_identity_t<T>& t, int orders) {
  const Program& program = memory.program;
  for (int k = 0; k < orders; ++k) {
    if (program.one != no_slot) memory.row(k)[program.one] = T(k == 0 ? 1 : 0);
    if (program.time != no_slot) memory.row(k)[program.time] = k == 0 ? t : T(k == 1 ? 1 : 0);
  }
}

template <class T>
T term_size(const MemoryOf<T>& memory, const Instruction* producer, Slot slot) {
  using std::abs;
  const T* now = memory.row(0);
  if (!producer || (producer->op != Op::Linear && producer->op != Op::Products)) return abs(now[slot]);
  T size = T(0);
  for (std::uint32_t i = producer->first_term; i < producer->last_term; ++i) {
    const Term& term = memory.program.terms[i];
    const int factor = term.shift == 2 ? 2 : 1;
    const T a = factor * memory.row(static_cast<int>(term.shift))[term.a];
    size += abs(memory.coefficients[i] * a * (term.b == no_slot ? T(1) : now[term.b]));
  }
  return size;
}

}  // namespace maupertuis::reference

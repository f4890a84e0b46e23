#pragma once
#include "kernel/reference/reference.hpp"
#include "kernel/series/elementary.hpp"

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
      rows(static_cast<std::size_t>(orders) * stride, T(0)) {}

template <class T>
T literal(const Program& program, const Constant& constant) {
  if constexpr (std::is_same_v<T, double>)
    return constant.value;
  else
    return series::Exactly<T>::from(program.literals[constant.index]);
}

template <class T>
T compute_constant(const Program& program, std::size_t index, std::span<const std::type_identity_t<T>> parameters,
                   std::span<const std::int8_t> sides, std::span<const T> constants, std::vector<T>& operands) {
  const Constant& constant = program.constants[index];
  if (constant.kind == Kind::Number) return literal<T>(program, constant);
  if (constant.kind == Kind::Symbol) return parameters[constant.index];
  if (constant.kind == Kind::Sign && constant.arguments == 0) return T(sides[constant.index]);
  operands.clear();
  for (std::uint32_t k = 0; k < constant.arguments; ++k)
    operands.push_back(constants[program.constant_arguments[constant.first_argument + k]]);
  return series::operation<T>(constant.kind, operands);
}

template <class T>
void compute_constants(const Program& program, std::span<const std::type_identity_t<T>> parameters,
                       std::span<const std::int8_t> sides, std::span<T> constants) {
  std::vector<T> operands;
  for (std::size_t i = 0; i < constants.size(); ++i)
    constants[i] = compute_constant<T>(program, i, parameters, sides, constants, operands);
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
    size += abs(memory.constants[term.coefficient] * a * (term.b == no_slot ? T(1) : now[term.b]));
  }
  return size;
}

}  // namespace maupertuis::reference

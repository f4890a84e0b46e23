#pragma once
#include "kernel/interpreter/interpreter.hpp"

namespace maupertuis::interpreter {

/// At order 0 the highest derivative of q in a slot of lag ℓ enters linearly through those operands alone that have
/// lag ℓ themselves; the others hold lower derivatives and are constants here.
template <int Width, class T>
class Tangents {
 public:
  Tangents(const MemoryOf<T>& memory, T* tangent)
      : memory_(memory), now_(memory.row(0)), lags_(memory.program.tangent_lags.data()), tangent_(tangent) {}

  void operator()(const Instruction& i) {
    if (lags_[i.out] == Program::unmoved) return;
    lag_ = i.lag;
    T out[Width] = {};
    switch (i.op) {
      case Op::Linear:
      case Op::Products: terms(i, out); break;
      case Op::Square: add(out, 2 * now_[i.a], i.a); break;
      case Op::Quotient:
        add(out, 1 / now_[i.b], i.a);
        add(out, -now_[i.out] / now_[i.b], i.b);
        break;
      case Op::SquareRoot: add(out, T(0.5) / now_[i.out], i.a); break;
      case Op::Power: add(out, memory_.constants[i.constant] * now_[i.out] / now_[i.a], i.a); break;
      case Op::SinCos: pair(i, out, -1); break;
      case Op::SinhCosh: pair(i, out, 1); break;
      case Op::Function: differential(i, out); break;
      case Op::Derivative: add(out, T(1), i.a, 1); break;
      case Op::Select: select(i, out); break;
      case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: return;
    }
    store(i.out, out);
  }

 private:
  void add(T* out, const T& factor, Slot operand, std::uint32_t shift = 0) const {
    if (lags_[operand] + static_cast<int>(shift) != lag_) return;
    const T* const from = tangent_ + static_cast<std::size_t>(operand) * Width;
    for (int d = 0; d < Width; ++d) out[d] += factor * from[d];
  }
  void store(Slot slot, const T* values) {
    T* const to = tangent_ + static_cast<std::size_t>(slot) * Width;
    for (int d = 0; d < Width; ++d) to[d] = values[d];
  }

  void terms(const Instruction& i, T* out) const {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = memory_.program.terms[t];
      const T& c = memory_.coefficients[t];
      if (term.b == no_slot) { add(out, c, term.a, term.shift); continue; }
      add(out, c * now_[term.b], term.a);
      add(out, c * now_[term.a], term.b);
    }
  }

  void pair(const Instruction& i, T* out, int sign) {
    T second[Width] = {};
    add(out, now_[i.second], i.a);
    add(second, sign * now_[i.out], i.a);
    store(i.second, second);
  }

  void differential(const Instruction& i, T* out) const {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = memory_.program.terms[t];
      add(out, memory_.coefficients[t] * now_[term.a], term.b);
    }
  }

  void select(const Instruction& i, T* out) const {
    std::uint32_t t = i.first_term;
    while (t + 1 < i.last_term && memory_.coefficients[t] == 0) ++t;
    add(out, T(1), memory_.program.terms[t].a);
  }

  const MemoryOf<T>& memory_;
  const T* now_;
  const std::int8_t* lags_;
  T* tangent_;
  int lag_ = 0;
};

template <int Width, class T>
void tangents(const MemoryOf<T>& memory, T* tangent, std::span<const std::uint32_t> instructions) {
  Tangents<Width, T> sweep(memory, tangent);
  for (const std::uint32_t i : instructions) sweep(memory.program.instructions[i]);
}

}  // namespace maupertuis::interpreter

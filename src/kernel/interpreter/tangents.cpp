#include "kernel/interpreter/interpreter.hpp"

#include <algorithm>

namespace maupertuis::interpreter {
namespace {

/// At order 0 the highest derivative of q in a slot of lag ℓ enters linearly through those operands alone that have
/// lag ℓ themselves; the others hold lower derivatives and are constants here.
template <int Width>
class Tangents {
 public:
  Tangents(const Memory& memory, double* tangent)
      : memory_(memory), now_(memory.row(0)), lags_(memory.program.tangent_lags.data()), tangent_(tangent) {}

  void operator()(const Instruction& i) {
    if (lags_[i.out] == Program::unmoved) return;
    lag_ = i.lag;
    double out[Width] = {};
    switch (i.op) {
      case Op::Linear:
      case Op::Products: terms(i, out); break;
      case Op::Square: add(out, 2 * now_[i.a], i.a); break;
      case Op::Quotient:
        add(out, 1 / now_[i.b], i.a);
        add(out, -now_[i.out] / now_[i.b], i.b);
        break;
      case Op::SquareRoot: add(out, 0.5 / now_[i.out], i.a); break;
      case Op::Power: add(out, memory_.constants[i.constant] * now_[i.out] / now_[i.a], i.a); break;
      case Op::SinCos: pair(i, out, -1); break;
      case Op::SinhCosh: pair(i, out, 1); break;
      case Op::Function: differential(i, out); break;
      case Op::Derivative: add(out, 1, i.a, 1); break;
      case Op::Select: select(i, out); break;
      default: return;
    }
    store(i.out, out);
  }

 private:
  void add(double* out, double factor, Slot operand, std::uint32_t shift = 0) const {
    if (lags_[operand] + static_cast<int>(shift) != lag_) return;
    const double* const from = tangent_ + static_cast<std::size_t>(operand) * Width;
    for (int d = 0; d < Width; ++d) out[d] += factor * from[d];
  }
  void store(Slot slot, const double* values) {
    double* const to = tangent_ + static_cast<std::size_t>(slot) * Width;
    for (int d = 0; d < Width; ++d) to[d] = values[d];
  }

  void terms(const Instruction& i, double* out) const {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = memory_.program.terms[t];
      const double c = memory_.coefficients[t];
      if (term.b == no_slot) { add(out, c, term.a, term.shift); continue; }
      add(out, c * now_[term.b], term.a);
      add(out, c * now_[term.a], term.b);
    }
  }

  void pair(const Instruction& i, double* out, double sign) {
    double second[Width] = {};
    add(out, now_[i.second], i.a);
    add(second, sign * now_[i.out], i.a);
    store(i.second, second);
  }

  void differential(const Instruction& i, double* out) const {
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = memory_.program.terms[t];
      add(out, memory_.coefficients[t] * now_[term.a], term.b);
    }
  }

  void select(const Instruction& i, double* out) const {
    std::uint32_t t = i.first_term;
    while (t + 1 < i.last_term && memory_.coefficients[t] == 0) ++t;
    add(out, 1, memory_.program.terms[t].a);
  }

  const Memory& memory_;
  const double* now_;
  const std::int8_t* lags_;
  double* tangent_;
  int lag_ = 0;
};

}  // namespace

template <int Width>
void tangents(const Memory& memory, double* tangent, std::span<const std::uint32_t> instructions) {
  Tangents<Width> sweep(memory, tangent);
  for (const std::uint32_t i : instructions) sweep(memory.program.instructions[i]);
}

template void tangents<1>(const Memory&, double*, std::span<const std::uint32_t>);
template void tangents<2>(const Memory&, double*, std::span<const std::uint32_t>);
template void tangents<4>(const Memory&, double*, std::span<const std::uint32_t>);
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

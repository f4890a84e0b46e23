#include "disks/roundings.hpp"

#include <cmath>

namespace maupertuis {

double FormulaRoundings::of(Slot slot, const SlotCoefficients& coefficients, double length) {
  now_ = coefficients;
  if (length_ != length) find(length);
  // Where the bound overflows nothing is known, and nothing may be forgiven: all of a force could be called rounding.
  return std::isfinite(of_[slot]) ? of_[slot] : 0;
}

double FormulaRoundings::size(Slot slot, std::uint32_t shift) const {
  const double c = std::abs(now_.rows[shift * now_.stride + slot * now_.step]);
  return shift == 0 ? c : shift == 1 ? c / now_.unit : 2 * c / now_.unit / now_.unit;
}

void FormulaRoundings::find(double length) {
  length_ = length;
  const Program& program = plan_.program;
  for (Slot i = 0; i < program.unknowns; ++i) of_[i] = size(i);
  if (program.one != no_slot) of_[program.one] = 0;
  if (program.time != no_slot) of_[program.time] = size(program.time);
  for (const DiskPlan::Node& node : plan_.nodes) {
    const Instruction& i = node.instruction;
    const double handed_on = of_node(node);
    of_[i.out] = size(i.out) + handed_on;
    if (i.second == no_slot) continue;
    // The derivative of each of the pair is the other.
    of_[i.out] = size(i.out) + size(i.second) * of_[i.a];
    of_[i.second] = size(i.second) + size(i.out) * of_[i.a];
  }
}

/// The coefficients of a coordinate are exact; those of a function are known to what its values are over `length`.
double FormulaRoundings::of_derivative(Slot slot, std::uint32_t shift) const {
  const double own = size(slot, shift);
  if (slot < plan_.program.unknowns || slot == plan_.program.time) return own;
  return own + of_[slot] / length_ * (shift == 1 ? 1 : 2 / length_);
}

/// Σ |∂f/∂u| of what the operands hand on.
double FormulaRoundings::of_node(const DiskPlan::Node& node) const {
  const Instruction& i = node.instruction;
  const auto of_product = [&](Slot a, Slot b) { return size(a) * of_[b] + size(b) * of_[a]; };
  double sum = 0;
  switch (i.op) {
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      return 0;
    case Op::Linear:
    case Op::Products:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const DiskPlan::Term& term = plan_.terms[t];
        const double c = term.size;
        sum += c * (DiskPlan::is_product(i, t) ? of_product(term.a, term.b) + size(term.a) * size(term.b)
                    : term.shift == 0          ? of_[term.a]
                                               : of_derivative(term.a, term.shift));
      }
      return sum;
    case Op::Square:
      return 2 * size(i.a) * of_[i.a];
    case Op::Quotient:
      return (of_[i.a] + size(i.out) * of_[i.b]) / size(i.b);
    case Op::SquareRoot:
      return size(i.a) > 0 ? 0.5 * of_[i.a] / size(i.out) : 0;
    case Op::Power:
      return size(i.a) > 0 ? std::abs(node.exponent) * size(i.out) / size(i.a) * of_[i.a] : 0;
    case Op::SinCos:
    case Op::SinhCosh:
      return 0;  // by the caller
    case Op::Function:
      // dy = Σ c w du
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        sum += plan_.terms[t].size * size(plan_.terms[t].a) * of_[plan_.terms[t].b];
      return sum;
    case Op::Derivative:
      return of_derivative(i.a, 1);
    case Op::Select:
      return of_[plan_.chosen(i)];
  }
  return 0;
}

}  // namespace maupertuis

#include "kernel/disks/node.hpp"

#include <cmath>

/// A running error analysis at the centre (N. J. Higham, Accuracy and Stability of Numerical Algorithms, §3.3).
namespace maupertuis {

void Disks::find_roundings(double length) {
  rounding_length_ = length;
  for (Slot i = 0; i < program_.unknowns; ++i) rounding_[i] = std::abs(centre(i));
  if (program_.one != no_slot) rounding_[program_.one] = 0;
  if (program_.time != no_slot) rounding_[program_.time] = std::abs(centre(program_.time));
  for (const Node& node : nodes_) {
    const Instruction& i = node.instruction;
    const double handed_on = rounding_of(node);
    rounding_[i.out] = std::abs(centre(i.out)) + handed_on;
    if (i.second == no_slot) continue;
    // The derivative of each of the pair is the other.
    rounding_[i.out] = std::abs(centre(i.out)) + std::abs(centre(i.second)) * rounding_[i.a];
    rounding_[i.second] = std::abs(centre(i.second)) + std::abs(centre(i.out)) * rounding_[i.a];
  }
}

/// The coefficients of a coordinate are exact; those of a function are known to what its values are over `length`.
double Disks::rounding_of_derivative(std::uint32_t slot, std::uint32_t shift) const {
  const double own = std::abs(centre(slot, shift));
  if (slot < program_.unknowns || slot == program_.time) return own;
  return own + rounding_[slot] / rounding_length_ * (shift == 1 ? 1 : 2 / rounding_length_);
}

/// Σ |∂f/∂u| of what the operands hand on.
double Disks::rounding_of(const Node& node) const {
  const Instruction& i = node.instruction;
  const auto size = [this](Slot slot) { return std::abs(centre(slot)); };
  const auto of_product = [&](Slot a, Slot b) { return size(a) * rounding_[b] + size(b) * rounding_[a]; };
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
        const Term& term = terms_[t];
        const bool is_product = i.op == Op::Products && t >= i.first_product;
        const double c = term.size;
        sum += c * (is_product        ? of_product(term.a, term.b) + size(term.a) * size(term.b)
                    : term.shift == 0 ? rounding_[term.a]
                                      : rounding_of_derivative(term.a, term.shift));
      }
      return sum;
    case Op::Square:
      return 2 * size(i.a) * rounding_[i.a];
    case Op::Quotient:
      return (rounding_[i.a] + size(i.out) * rounding_[i.b]) / size(i.b);
    case Op::SquareRoot:
      return size(i.a) > 0 ? 0.5 * rounding_[i.a] / size(i.out) : 0;
    case Op::Power:
      return size(i.a) > 0 ? std::abs(node.exponent) * size(i.out) / size(i.a) * rounding_[i.a] : 0;
    case Op::SinCos:
    case Op::SinhCosh:
      return 0;  // by the caller
    case Op::Function:
      // dy = Σ c w du
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        sum += terms_[t].size * size(terms_[t].a) * rounding_[terms_[t].b];
      return sum;
    case Op::Derivative:
      return rounding_of_derivative(i.a, 1);
    case Op::Select: {
      std::uint32_t t = i.first_term;
      while (t + 1 < i.last_term && constants_[terms_[t].coefficient] == 0) ++t;
      return rounding_[terms_[t].a];
    }
  }
  return 0;
}

}  // namespace maupertuis

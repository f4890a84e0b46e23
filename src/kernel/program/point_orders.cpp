#include "kernel/program/point_orders.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

class PointOrders {
 public:
  explicit PointOrders(const Program& program) : program_(program), of_slot_(program.slots, -1) {
    for (const Slot slot : program.observables) need(slot, 0);
    for (auto run = program.runs[AtPoint].rbegin(); run != program.runs[AtPoint].rend(); ++run)
      for (std::uint32_t i = run->last; i-- > run->first;) pass(program.instructions[i]);
  }

  int of(const Instruction& i) const {
    return std::max(of_slot_[i.out], i.second == no_slot ? -1 : of_slot_[i.second]);
  }

 private:
  void need(Slot slot, int order) {
    if (slot != no_slot) of_slot_[slot] = std::max(of_slot_[slot], order);
  }

  void pass(const Instruction& i) {
    const int order = of(i);
    if (order < 0) return;
    need(i.a, order + (i.op == Op::Derivative ? 1 : 0));
    need(i.b, order);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = program_.terms[t];
      // y_k = Σ j w_{k−j} u_j/k of a function: its differential is not read at order 0.
      need(term.a, i.op == Op::Function ? order - 1 : order + static_cast<int>(term.shift));
      need(term.b, order);
    }
  }

  const Program& program_;
  std::vector<int> of_slot_;
};

bool is_unrolled_at_points(const Instruction& i, int highest) {
  switch (i.op) {
    case Op::Linear:
    case Op::Products:
    case Op::Square:
    case Op::Derivative:
    case Op::Quotient:
    case Op::SquareRoot:
    case Op::Power:
    case Op::Function:
      return true;
    case Op::SinCos:  // beyond order 0 they are written as packs alone
    case Op::SinhCosh:
      return highest <= 0;
    case Op::Select:
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      break;
  }
  return false;
}

}  // namespace

std::vector<int> point_orders(const Program& program) {
  std::vector<int> out(program.instructions.size(), -1);
  const PointOrders needed(program);
  for (const Run& run : program.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i) out[i] = needed.of(program.instructions[i]);
  return out;
}

bool are_points_unrolled(const Program& program) {
  if (!program.runs[Along].empty()) return false;
  const std::vector<int> orders = point_orders(program);
  for (const Run& run : program.runs[AtPoint])
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (orders[i] >= 0 && !is_unrolled_at_points(program.instructions[i], orders[i])) return false;
  return true;
}

}  // namespace maupertuis

#pragma once
#include "kernel/reference/elementary.hpp"
#include "kernel/reference/reference.hpp"

#include <cmath>

namespace maupertuis::reference {

/// One run of instructions at one order: `row` is that order's row. Each case decides once for the whole run.
template <class T>
class RunAtOrder {
 public:
  RunAtOrder(MemoryOf<T>& memory, int order)
      : memory_(memory),
        k_(order),
        row_(memory.row(order)),
        instructions_(memory.program.instructions.data()),
        terms_(memory.program.terms.data()),
        linear_(memory.linear.data()),
        factors_(memory.shift_factors.data() + 3 * order),
        pairing_(order, memory.stride) {}

  void operator()(const Run& run) {
    switch (run.op) {
      case Op::Linear:
        return each(run, [this](const Instruction& i) { row_[i.out] = linear_part(i); });
      case Op::Products:
        return each(run, [this](const Instruction& i) { row_[i.out] = linear_part(i) + products(i); });
      case Op::Square:
        return each(run, [this](const Instruction& i) { row_[i.out] = series::square(column(i.a), k_); });
      case Op::Quotient:
        return each(run, [this](const Instruction& i) { quotient(i); });
      case Op::SquareRoot:
        return each(run, [this](const Instruction& i) { square_root(i); });
      case Op::Power:
        return each(run, [this](const Instruction& i) { power(i); });
      case Op::SinCos:
        return each(run, [this](const Instruction& i) { sincos(i); });
      case Op::SinhCosh:
        return each(run, [this](const Instruction& i) { sinhcosh(i); });
      case Op::Function:
        return each(run, [this](const Instruction& i) { function(i); });
      case Op::Derivative:
        return each(run, [this](const Instruction& i) { derivative(i); });
      case Op::Select:
        return each(run, [this](const Instruction& i) { select(i); });
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
        return;
    }
    throw unknown_op(run.op, "the interpreter");
  }

 private:
  template <class F>
  void each(const Run& run, F&& f) {
    const Instruction* const last = instructions_ + run.last;
    for (const Instruction* i = instructions_ + run.first; i != last; ++i) f(*i);
  }
  series::Column<T> column(Slot slot) const { return memory_.column(slot); }

  T linear_part(const Instruction& i) const {
    T sum = T(0);
    const LinearTermOf<T>* const last = linear_ + i.first_product;
    for (const LinearTermOf<T>* term = linear_ + i.first_term; term != last; ++term)
      sum += term->coefficient * (factors_[term->shift] * row_[term->offset]);
    return sum;
  }

  T products(const Instruction& i) const {
    T sum = T(0);
    const T* const rows = memory_.rows.data();
    for (std::uint32_t t = i.first_product; t < i.last_term; ++t)
      sum += linear_[t].coefficient * series::product(rows + terms_[t].a, rows + terms_[t].b, pairing_);
    return sum;
  }

  void quotient(const Instruction& i) {
    row_[i.out] = k_ == 0 ? row_[i.a] / row_[i.b] : series::quotient(row_[i.a], column(i.b), column(i.out), k_);
  }

  void square_root(const Instruction& i) {
    using std::sqrt;
    row_[i.out] = k_ == 0 ? sqrt(row_[i.a]) : series::square_root(column(i.a), column(i.out), k_);
  }

  void power(const Instruction& i) {
    using std::pow;
    const T& p = memory_.constants[i.constant];
    row_[i.out] = k_ == 0 ? pow(row_[i.a], p) : series::power(column(i.a), column(i.out), p, k_);
  }

  void sincos(const Instruction& i) {
    using std::sin, std::cos;
    if (k_ == 0) {
      row_[i.out] = sin(row_[i.a]);
      row_[i.second] = cos(row_[i.a]);
    } else {
      series::integral_pair(column(i.out), column(i.second), column(i.a), k_, T(-1), row_[i.out], row_[i.second]);
    }
  }

  void sinhcosh(const Instruction& i) {
    using std::sinh, std::cosh;
    if (k_ == 0) {
      row_[i.out] = sinh(row_[i.a]);
      row_[i.second] = cosh(row_[i.a]);
    } else {
      series::integral_pair(column(i.out), column(i.second), column(i.a), k_, T(1), row_[i.out], row_[i.second]);
    }
  }

  void function(const Instruction& i) {
    if (k_ == 0) {
      row_[i.out] = elementary(i.function, row_[i.a], i.b == no_slot ? T(0) : row_[i.b]);
      return;
    }
    T sum = T(0);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = memory_.program.terms[t];
      sum += memory_.coefficients[t] * series::integral(column(term.a), column(term.b), k_);
    }
    row_[i.out] = sum;
  }

  /// (du/dt)_k = (k + 1) u_{k+1}
  void derivative(const Instruction& i) { row_[i.out] = (k_ + 1) * row_[memory_.stride + i.a]; }

  void select(const Instruction& i) {
    std::uint32_t t = i.first_term;
    while (t + 1 < i.last_term && memory_.coefficients[t] == 0) ++t;
    row_[i.out] = row_[memory_.program.terms[t].a];
  }

  MemoryOf<T>& memory_;
  int k_;
  T* row_;
  const Instruction* instructions_;
  const Term* terms_;
  const LinearTermOf<T>* linear_;
  const T* factors_;
  series::Pairing pairing_;
};

template <class T>
void run_instruction(MemoryOf<T>& memory, std::uint32_t index, int order) {
  const Instruction& instruction = memory.program.instructions[index];
  RunAtOrder<T>(memory, order)({instruction.op, instruction.lag, index, index + 1});
}

template <class T>
void run_instructions(MemoryOf<T>& memory, const Run& run, int order) {
  RunAtOrder<T>(memory, order)(run);
}

template <class T>
void run_section(MemoryOf<T>& memory, Section section, int stage) {
  for (const Run& run : memory.program.runs[section]) {
    const int order = stage + 2 - run.lag;
    if (order >= 0) RunAtOrder<T>(memory, order)(run);
  }
}

}  // namespace maupertuis::reference

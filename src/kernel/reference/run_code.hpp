#pragma once
#include "kernel/reference/reference.hpp"
#include "kernel/series/elementary.hpp"

#include <cmath>

namespace maupertuis::reference {

/// One run of instructions at one order. Each case decides once for the whole run. T: a number, or several side by side
/// (kernel/lanes), of which nothing but pointers is asked then.
template <class T>
class RunAtOrder {
 public:
  RunAtOrder(const Rows<T>& rows, int order)
      : rows_(rows),
        k_(order),
        row_(rows.first + static_cast<std::size_t>(order) * rows.stride),
        pairing_(order, rows.stride) {}

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
    throw_unknown(run.op);
  }

 private:
  template <class F>
  void each(const Run& run, F&& f) {
    const Instruction* const last = rows_.instructions + run.last;
    for (const Instruction* i = rows_.instructions + run.first; i != last; ++i) f(*i);
  }
  series::Column<T> column(Slot slot) const { return {rows_.first + slot, rows_.stride}; }
  const T& coefficient(const Term& term) const { return rows_.constants[term.coefficient]; }

  T linear_part(const Instruction& i) const {
    const int factors[] = {1, k_ + 1, (k_ + 1) * (k_ + 2)};
    T sum = T(0);
    for (std::uint32_t t = i.first_term; t < i.first_product; ++t) {
      const Term& term = rows_.terms[t];
      add_product(sum, coefficient(term), row_[term.a + term.shift * rows_.stride] * factors[term.shift]);
    }
    return sum;
  }

  T products(const Instruction& i) const {
    T sum = T(0);
    for (std::uint32_t t = i.first_product; t < i.last_term; ++t) {
      const Term& term = rows_.terms[t];
      add_product(sum, coefficient(term), series::product(rows_.first + term.a, rows_.first + term.b, pairing_));
    }
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
    const T& p = rows_.constants[i.constant];
    row_[i.out] = k_ == 0 ? pow(row_[i.a], p) : series::power(column(i.a), column(i.out), p, k_);
  }

  void sincos(const Instruction& i) {
    if (k_ == 0)
      sine_cosine(row_[i.a], row_[i.out], row_[i.second]);
    else
      series::integral_pair(column(i.out), column(i.second), column(i.a), k_, T(-1), row_[i.out], row_[i.second]);
  }

  void sinhcosh(const Instruction& i) {
    if (k_ > 0)
      return series::integral_pair(column(i.out), column(i.second), column(i.a), k_, T(1), row_[i.out], row_[i.second]);
    row_[i.out] = elementary(Kind::Sinh, row_[i.a], T(0));
    row_[i.second] = elementary(Kind::Cosh, row_[i.a], T(0));
  }

  void function(const Instruction& i) {
    if (k_ == 0) {
      row_[i.out] = elementary(i.function, row_[i.a], i.b == no_slot ? T(0) : row_[i.b]);
      return;
    }
    T sum = T(0);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = rows_.terms[t];
      add_product(sum, coefficient(term), series::integral(column(term.a), column(term.b), k_));
    }
    row_[i.out] = sum;
  }

  /// (du/dt)_k = (k + 1) u_{k+1}
  void derivative(const Instruction& i) { row_[i.out] = row_[rows_.stride + i.a] * (k_ + 1); }

  /// The first term whose condition is not 0, else the last.
  void select(const Instruction& i) {
    std::uint32_t t = i.last_term - 1;
    T value = row_[rows_.terms[t].a];
    while (t-- > i.first_term) value = chosen(coefficient(rows_.terms[t]), row_[rows_.terms[t].a], value);
    row_[i.out] = value;
  }

  Rows<T> rows_;
  int k_;
  T* row_;
  series::Pairing<T> pairing_;
};

template <class T>
void run_instruction(MemoryOf<T>& memory, std::uint32_t index, int order) {
  const Instruction& instruction = memory.program.instructions[index];
  RunAtOrder<T>(memory.view(), order)({instruction.op, instruction.lag, index, index + 1});
}

template <class T>
void run_instructions(MemoryOf<T>& memory, const Run& run, int order) {
  RunAtOrder<T>(memory.view(), order)(run);
}

template <class T>
void run_section(MemoryOf<T>& memory, Section section, int stage) {
  for (const Run& run : memory.program.runs[section]) {
    const int order = stage + 2 - run.lag;
    if (order >= 0) RunAtOrder<T>(memory.view(), order)(run);
  }
}

}  // namespace maupertuis::reference

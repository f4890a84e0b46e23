#include "machine_code/llvm/lanes_emitter.hpp"

/// The operations of kernel/program at one order: what the interiors leave open (semantics:
/// kernel/reference/run_code.hpp).
namespace maupertuis::llvm_backend {

using llvm::Value;

void LanesEmitter::instruction(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  switch (i.op) {
    case Op::Linear:
      return define(i.out, linear_part(i));
    case Op::Products:
      return define(i.out, products(index, linear_part(i)));
    case Op::Square:
      return define(i.out, square(index));
    case Op::Quotient:
      return define(i.out, quotient(index));
    case Op::SquareRoot:
      return define(i.out, square_root(index));
    case Op::Power:
      return define(i.out, power(index));
    case Op::SinCos:
    case Op::SinhCosh:
      return pair(index);
    case Op::Function:
      return define(i.out, function(index));
    case Op::Derivative:
      return define(i.out, derivative(i));
    case Op::Select:
      return define(i.out, select(i));
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      return;
  }
  throw unknown_op(i.op, "the code of lanes");
}

/// (dʳa/dtʳ)_m = (m + 1) … (m + r) a_{m+r}
Value* LanesEmitter::linear_part(const Instruction& i) {
  const int m = ahead_of(i.out);
  Value* sum = nullptr;
  for (std::uint32_t t = i.first_term; t < i.first_product; ++t) {
    const Term& term = program_.terms[t];
    Value* x = read(term.a, m + static_cast<int>(term.shift));
    if (!x) continue;
    const Coefficient c = coefficient(term.coefficient);
    if (term.shift == 0) {
      sum = plus_scaled(sum, c, x);
      continue;
    }
    sum = plus_scaled(sum, c, derivative_of(term.a, m, term.shift));
  }
  return sum;
}

/// (m + 1) a_{m+1} or (m + 1)(m + 2) a_{m+2}; null: zero.
Value* LanesEmitter::derivative_of(Slot slot, int m, std::uint32_t times) {
  const int ahead = m + static_cast<int>(times);
  Value* const x = read(slot, ahead);
  if (!x) return nullptr;
  Value* const rate = ahead == ahead_of(slot) ? rates_[slot] : nullptr;
  if (times == 1) return rate ? rate : out_.multiply(x, order(m + 1));
  return rate ? out_.multiply(rate, order(m + 1)) : out_.multiply(x, order(m + 1, OrderColumn::Pair));
}

/// The products with coefficients of order 0 and m, all there is at order 0: those whose factor of order m was there
/// before this stage, or those for which it is `late`. Of a weighted sum it comes divided by m.
Value* LanesEmitter::ends(const Piece& piece, int m, Value* sum, bool late) {
  const auto is_late = [&](Slot slot) { return ahead_of(slot) <= m; };
  if (is_order_zero(m)) return late ? plus(sum, read(piece.a, m), read(piece.b, m), piece.negative) : sum;
  if (is_late(piece.a) == late)
    if (Value* const a = read(piece.a, m)) sum = plus(sum, a, first(piece.b), piece.negative);
  if (piece.shape == Shape::Product && is_late(piece.b) == late)
    if (Value* const b = read(piece.b, m)) sum = plus(sum, first(piece.a), b, piece.negative);
  return sum;
}

/// All of an accumulator's products, what is known first added first; a weighted sum is divided by m, and what it was
/// before is the derivative of the integral.
Value* LanesEmitter::sum_of(std::uint32_t index, Slot integral) {
  const Accumulator& accumulator = accumulators_[index];
  const int m = accumulator.ahead;
  Value* sum = accumulator.sum;
  const auto add_ends = [&](bool late) {
    for (const Piece& piece : accumulator.pieces) sum = ends(piece, m, sum, late);
  };
  const bool weighted = accumulator.pieces[0].shape == Shape::Weighted;
  if (!weighted) add_ends(false);
  Value* const rate = sum;
  if (weighted && sum) sum = over_order(sum, m);
  Value* const divided = sum;
  if (weighted) add_ends(false);
  add_ends(true);
  if (weighted && integral != no_slot && sum == divided) rates_[integral] = rate;
  return sum;
}

Value* LanesEmitter::products(std::uint32_t index, Value* sum) {
  for (const Group& group : groups_[index]) {
    const Coefficient c = group.coefficient.unit != 0 ? group.coefficient : coefficient(group.id);
    sum = plus_scaled(sum, c, sum_of(group.accumulator));
  }
  return sum;
}

Value* LanesEmitter::square(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  Value* const a = read(i.a, m);
  if (is_order_zero(m)) return a ? out_.multiply(a, a) : nullptr;
  Value* const sum = plus(self_sum(index), a ? first(i.a) : nullptr, a);
  return sum ? out_.add(sum, sum) : nullptr;
}

/// Half of Σ_{0<j<m} a_j a_{m−j}.
Value* LanesEmitter::self_sum(std::uint32_t index) {
  const Accumulator& accumulator = accumulators_[groups_[index][0].accumulator];
  return accumulator.sum;
}

// -------------------------------------------------------------------------------- divisions by coefficients of order 0

void LanesEmitter::keep_reciprocal(std::uint32_t index, Value* divisor) {
  out_.store(out_.divide(number(1), divisor), scratch(reciprocals_at_ + index));
}

Value* LanesEmitter::divide_by_first(Value* x, std::uint32_t index, Value* divisor) {
  return x ? out_.quotient(x, divisor, out_.load(real_, scratch(reciprocals_at_ + index))) : nullptr;
}

/// (a_m − Σ b_j y_{m−j}) / b_0
Value* LanesEmitter::quotient(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  Value* const a = read(i.a, m);
  if (is_order_zero(m)) {
    Value* const divisor = or_zero(read(i.b, m));
    keep_reciprocal(index, divisor);
    return out_.divide(or_zero(a), divisor);
  }
  const Accumulator& accumulator = accumulators_[groups_[index][0].accumulator];
  Value* sum = accumulator.sum;
  if (Value* const b = read(i.b, m)) sum = plus(sum, b, first(i.out));
  Value* const rest = !sum ? a : a ? out_.subtract(a, sum) : out_.negate(sum);
  return divide_by_first(rest, index, first(i.b));
}

/// (u_m − Σ_{0<j<m} y_j y_{m−j}) / (2 y_0)
Value* LanesEmitter::square_root(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  Value* const u = read(i.a, m);
  if (is_order_zero(m)) {
    Value* const y = out_.square_root(or_zero(u));
    keep_reciprocal(index, out_.add(y, y));
    return y;
  }
  Value* const half = self_sum(index);
  Value* const sum = half ? out_.add(half, half) : nullptr;
  Value* const rest = !sum ? u : u ? out_.subtract(u, sum) : out_.negate(sum);
  Value* const y = first(i.out);
  return divide_by_first(rest, index, out_.add(y, y));
}

/// Σ (p j − (m − j)) u_j y_{m−j} / (m u_0)
Value* LanesEmitter::power(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  if (is_order_zero(m)) {
    Value* const u = or_zero(read(i.a, m));
    keep_reciprocal(index, u);
    return out_.elementary(Kind::Power, u, constant(i.constant));
  }
  const Accumulator& accumulator = accumulators_[groups_[index][0].accumulator];
  Value* sum = accumulator.sum;
  if (Value* const u = read(i.a, m))
    sum = plus(sum, out_.multiply(u, out_.multiply(constant(i.constant), order(m))), first(i.out));
  return divide_by_first(sum ? over_order(sum, m) : nullptr, index, first(i.a));
}

// ------------------------------------------------------------------------------------------------------- differentials

/// dy = z du, dz = ± y du
void LanesEmitter::pair(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  if (is_order_zero(m)) {
    Value* const u = or_zero(read(i.a, m));
    const auto [y, z] =
        i.op == Op::SinCos ? out_.sincos(u) : std::pair{out_.elementary(Kind::Sinh, u), out_.elementary(Kind::Cosh, u)};
    define(i.out, y);
    define(i.second, z);
    return;
  }
  Value* const y = sum_of(groups_[index][0].accumulator, i.out);
  Value* const z = sum_of(groups_[index][1].accumulator, i.second);
  define(i.out, y);
  define(i.second, z);
}

Value* LanesEmitter::function(std::uint32_t index) {
  const Instruction& i = program_.instructions[index];
  const int m = ahead_of(i.out);
  if (is_order_zero(m)) {
    Value* const y = i.b == no_slot ? nullptr : or_zero(read(i.b, m));
    return out_.elementary(i.function, or_zero(read(i.a, m)), y);
  }
  return products(index, nullptr);
}

Value* LanesEmitter::derivative(const Instruction& i) { return derivative_of(i.a, ahead_of(i.out), 1); }

Value* LanesEmitter::select(const Instruction& i) {
  const int m = ahead_of(i.out);
  Value* result = or_zero(read(program_.terms[i.last_term - 1].a, m));
  for (std::uint32_t t = i.last_term - 1; t-- > i.first_term;) {
    Value* const condition = out_.b.CreateFCmpUNE(constant(program_.terms[t].coefficient), number(0));
    result = out_.b.CreateSelect(condition, or_zero(read(program_.terms[t].a, m)), result);
  }
  return result;
}

}  // namespace maupertuis::llvm_backend

#include "kernel/llvm/unrolled_emitter.hpp"

namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::Pack;

void UnrolledEmitter::scalar(const Pack& pack) {
  const Instruction& i = p_.program.instructions[pack.instruction];
  switch (i.op) {
    case Op::Linear: case Op::Products: keep(i.out, scalar_sum(pack.instruction)); break;
    case Op::Square: keep(i.out, scalar_self(i.a, 0)); break;
    case Op::Quotient: keep(i.out, scalar_quotient(i)); break;
    case Op::SquareRoot: keep(i.out, scalar_root(i)); break;
    case Op::Power: keep(i.out, scalar_power(i)); break;
    case Op::SinCos: case Op::SinhCosh: scalar_pair(i); break;
    case Op::Function: keep(i.out, scalar_function(i)); break;
    case Op::Select: keep(i.out, scalar_select(i)); break;
    case Op::Derivative: keep(i.out, mul(history(i.a, k_ + 1), vector_of(k_ + 1.0, 1))); break;
    case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: break;
  }
}

Value* UnrolledEmitter::scalar_product(Slot a, Slot b, int first, int last) {
  return convolution([&](int j) { return history(a, j); }, [&](int j) { return history(b, j); }, first, last, k_);
}

Value* UnrolledEmitter::scalar_sum(std::uint32_t index) {
  const Instruction& i = p_.program.instructions[index];
  Value* sum = nullptr;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = p_.program.terms[t];
    const int order = k_ + static_cast<int>(term.shift);
    if (term.b == no_slot && term.a == p_.program.one && order > 0) continue;
    const double factor = term.shift == 0 ? 1 : term.shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
    Value* const value =
        term.b != no_slot ? scalar_product(term.a, term.b, 0, k_) : mul(history(term.a, order), vector_of(factor, 1));
    sum = fma(value, term_coefficient(t), sum);
  }
  return sum ? sum : vector_of(0.0, 1);
}

Value* UnrolledEmitter::scalar_self(Slot a, int first) {
  Value* sum = nullptr;
  for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) sum = fma(history(a, j), history(a, k_ - j), sum);
  if (sum) sum = b_.CreateFAdd(sum, sum);
  if (k_ % 2 == 0 && k_ / 2 >= first) sum = fma(history(a, k_ / 2), history(a, k_ / 2), sum);
  return sum ? sum : vector_of(0.0, 1);
}

Value* UnrolledEmitter::scalar_quotient(const Instruction& i) {
  Value* const a = history(i.a, k_);
  Value* const sum = k_ == 0 ? vector_of(0.0, 1) : scalar_product(i.b, i.out, 1, k_);
  return b_.CreateFDiv(b_.CreateFSub(a, sum), history(i.b, 0));
}

Value* UnrolledEmitter::scalar_root(const Instruction& i) {
  if (k_ == 0) return b_.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, history(i.a, 0));
  Value* const y0 = history(i.out, 0);
  return b_.CreateFDiv(b_.CreateFSub(history(i.a, k_), scalar_self(i.out, 1)), b_.CreateFAdd(y0, y0));
}

Value* UnrolledEmitter::scalar_power(const Instruction& i) {
  Value* const p = constant(i.constant);
  if (k_ == 0) return call_elementary(Kind::Power, history(i.a, 0), p);
  Value* sum = nullptr;
  for (int j = 1; j <= k_; ++j) {
    Value* const weight = b_.CreateFSub(b_.CreateFMul(p, vector_of(j, 1)), vector_of(k_ - j, 1));
    sum = fma(b_.CreateFMul(history(i.a, j), weight), history(i.out, k_ - j), sum);
  }
  return b_.CreateFDiv(sum, b_.CreateFMul(vector_of(k_, 1), history(i.a, 0)));
}

Value* UnrolledEmitter::scalar_integral(Slot w, Slot u) {
  Value* sum = nullptr;
  for (int j = 1; j <= k_; ++j) sum = fma(mul(history(u, j), vector_of(j, 1)), history(w, k_ - j), sum);
  return over(sum, k_);
}

void UnrolledEmitter::scalar_pair(const Instruction& i) {
  if (k_ == 0) {
    const auto [first, second] = pair(i.op, history(i.a, 0));
    keep(i.out, first), keep(i.second, second);
    return;
  }
  Value *const first = scalar_integral(i.second, i.a), *const second = scalar_integral(i.out, i.a);
  keep(i.out, first);
  keep(i.second, i.op == Op::SinCos ? b_.CreateFNeg(second) : second);
}

Value* UnrolledEmitter::scalar_function(const Instruction& i) {
  if (k_ == 0) return call_elementary(i.function, history(i.a, 0), i.b == no_slot ? nullptr : history(i.b, 0));
  Value* sum = nullptr;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
    sum = fma(scalar_integral(p_.program.terms[t].a, p_.program.terms[t].b), term_coefficient(t), sum);
  return sum;
}

Value* UnrolledEmitter::scalar_select(const Instruction& i) {
  return choose(i, [&](Slot slot) { return history(slot, k_); });
}

void UnrolledEmitter::scalar_tangent(const Pack& pack) {
  const Instruction& i = p_.program.instructions[pack.instruction];
  std::vector<Source> sources;
  const auto source = [&](Slot slot, int shift, Value* factor) {
    if (slot != no_slot && passes(slot, shift, i.lag))
      sources.push_back({{slot}, [factor](unsigned) { return factor; }});
  };
  const auto now = [&](Slot slot) { return history(slot, 0); };
  Value* const one = vector_of(1.0, 1);
  switch (i.op) {
    case Op::Linear: case Op::Products:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const Term& term = p_.program.terms[t];
        if (term.b == no_slot) { source(term.a, static_cast<int>(term.shift), term_coefficient(t)); continue; }
        source(term.a, 0, mul(term_coefficient(t), now(term.b)));
        source(term.b, 0, mul(term_coefficient(t), now(term.a)));
      }
      break;
    case Op::Square: source(i.a, 0, mul(vector_of(2.0, 1), now(i.a))); break;
    case Op::Quotient:
      source(i.a, 0, b_.CreateFDiv(one, now(i.b)));
      source(i.b, 0, b_.CreateFNeg(b_.CreateFDiv(now(i.out), now(i.b))));
      break;
    case Op::SquareRoot: source(i.a, 0, b_.CreateFDiv(vector_of(0.5, 1), now(i.out))); break;
    case Op::Power: source(i.a, 0, b_.CreateFDiv(mul(constant(i.constant), now(i.out)), now(i.a))); break;
    case Op::SinCos: case Op::SinhCosh: {
      source(i.a, 0, i.op == Op::SinCos ? b_.CreateFNeg(now(i.out)) : now(i.out));
      second_tangents_[i.second] = combine(sources, 1);
      sources.clear();
      source(i.a, 0, now(i.second));
      break;
    }
    case Op::Function:
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        source(p_.program.terms[t].b, 0, mul(term_coefficient(t), now(p_.program.terms[t].a)));
      break;
    case Op::Derivative: source(i.a, 1, one); break;
    case Op::Select: break;  // declined
    case Op::One: case Op::Time: case Op::Coordinate: case Op::Companion: break;
  }
  tangents_[index_of(pack)] = combine(sources, 1);
}

}  // namespace maupertuis::llvm_backend

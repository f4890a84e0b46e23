#include "machine_code/llvm/lanes_emitter.hpp"

/// M₀, its factors, and what follows the accelerations: the sums of lanes::Plan written out.
namespace maupertuis::llvm_backend {
namespace {

/// Up to here a solution is a product with the inverse.
constexpr std::size_t most_by_inverse = 8;

}  // namespace

using llvm::Value;

/// What later orders, the tangents or the caller read.
void LanesEmitter::find_stored() {
  stored_.assign(program_.slots, false);
  corrected_.assign(program_.slots, false);
  for (std::size_t i = 0; i < view_.corrections_end[2]; ++i) corrected_[view_.corrections[i].slot] = true;
  for (Slot slot = 0; slot < program_.stored_end[2]; ++slot) stored_[slot] = true;
  const auto store = [&](Slot slot) {
    if (slot != no_slot) stored_[slot] = true;
  };
  for (const Run& run : program_.runs[Dynamics])
    for (std::uint32_t index = run.first; index < run.last; ++index) {
      const Instruction& i = program_.instructions[index];
      const bool sums = i.op == Op::Linear || i.op == Op::Derivative || i.op == Op::Select || i.op == Op::Products;
      if (!sums) store(i.out), store(i.second), store(i.a), store(i.b);
      if (i.op == Op::Derivative && ahead_of(i.a) != ahead_of(i.out) + 1) store(i.a);
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
        const Term& term = program_.terms[t];
        if (term.b != no_slot)
          store(term.a), store(term.b);
        else if (ahead_of(term.a) != ahead_of(i.out) + static_cast<int>(term.shift))
          store(term.a);
      }
    }
}

// ------------------------------------------------------------------------------------------------------------ tangents

Value* LanesEmitter::factor_value(const sparse::Edge& f) {
  using sparse::Rule;
  switch (f.rule) {
    case Rule::Coefficient:
      return constant(f.index);
    case Rule::Scaled:
      return scaled(coefficient(f.index), first(f.x));
    case Rule::Double:
      return out_.add(first(f.x), first(f.x));
    case Rule::Reciprocal:
      return out_.divide(number(1), first(f.x));
    case Rule::Ratio:
      return out_.divide(out_.negate(first(f.y)), first(f.x));
    case Rule::HalfReciprocal:
      return out_.divide(number(0.5), first(f.x));
    case Rule::PowerSlope:
      return out_.divide(out_.multiply(constant(f.index), first(f.y)), first(f.x));
    case Rule::Value:
      return first(f.x);
    case Rule::Negative:
      return out_.negate(first(f.x));
    case Rule::Choice:
      return in_force(f);
    case Rule::One:
      break;
  }
  return number(1);
}

/// Terms [x, y) of a Select: 1 where the condition of term `index` is the first that holds.
Value* LanesEmitter::in_force(const sparse::Edge& f) {
  const auto holds = [&](std::uint32_t t) {
    return out_.b.CreateFCmpUNE(constant(program_.terms[t].coefficient), number(0));
  };
  Value* result = number(1);
  if (f.index + 1 < f.y) result = out_.b.CreateSelect(holds(f.index), result, number(0));
  for (std::uint32_t t = f.x; t < f.index; ++t) result = out_.b.CreateSelect(holds(t), number(0), result);
  return result;
}

/// Tangent 0 is the number 1. Those that corrections need later go to scratch.
void LanesEmitter::find_tangents() {
  std::vector<Value*> factors;
  for (std::size_t i = 0; i < view_.factor_count; ++i) factors.push_back(factor_value(view_.factors[i]));
  tangents_.assign(view_.tangent_count, nullptr);
  tangents_[0] = number(1);
  const auto product = [&](Value* sum, const lanes::Pair& pair) {
    const bool is_one = pair.tangent == 0, factor_is_one = view_.factors[pair.factor].rule == sparse::Rule::One;
    if (is_one) return plus(sum, factors[pair.factor]);
    if (factor_is_one) return plus(sum, tangents_[pair.tangent]);
    return plus(sum, factors[pair.factor], tangents_[pair.tangent]);
  };
  for (std::size_t i = 0; i < view_.combination_count; ++i) {
    const lanes::Combination& c = view_.combinations[i];
    Value* sum = nullptr;
    for (std::uint32_t k = c.first; k < c.last; ++k) {
      const lanes::Pair& pair = view_.pairs[k];
      if (!c.chooses)
        sum = product(sum, pair);
      else
        sum = out_.b.CreateSelect(out_.b.CreateFCmpUNE(factors[pair.factor], number(0)), tangents_[pair.tangent],
                                  or_zero(sum));
    }
    tangents_[c.out] = or_zero(sum);
  }
  std::vector<bool> kept(view_.tangent_count, false);
  for (std::size_t i = 0; i < view_.corrections_end[2]; ++i)
    for (std::uint32_t t = view_.corrections[i].first; t < view_.corrections[i].last; ++t) {
      const std::uint32_t index = view_.correction_terms[t].tangent;
      if (index != 0 && !kept[index]) out_.store(tangents_[index], scratch(index));
      kept[index] = true;
    }
}

// ------------------------------------------------------------------------------------------------------------ solution

/// In a function of its own: it hands everything on through memory, and the time of a compiler grows faster than a
/// function's length.
void LanesEmitter::factor() {
  llvm::IRBuilder<>::InsertPointGuard guard(out_.b);
  const std::vector<Value*> outside{rows_, constants_, quality_, scratch_};
  llvm::Function* const f =
      out_.function("factor", {out_.pointer(), out_.pointer(), out_.pointer(), out_.pointer()}, false);
  rows_ = f->getArg(0), constants_ = f->getArg(1), quality_ = f->getArg(2), scratch_ = f->getArg(3);
  factor_mass();
  out_.end_function();
  rows_ = outside[0], constants_ = outside[1], quality_ = outside[2], scratch_ = outside[3];
  factor_ = f;
}

void LanesEmitter::factor_mass() {
  find_tangents();
  std::vector<Value*> m(n_ * n_, nullptr);
  for (std::size_t i = 0; i < view_.mass_count; ++i)
    m[view_.mass[i].row * n_ + view_.mass[i].column] = tangents_[view_.mass[i].tangent];
  for (Value*& entry : m) entry = or_zero(entry);
  Value* const symmetric = symmetry(m);
  decompose(std::move(m), symmetric);
}

/// 1 where M₀ is symmetric to rounding, as the reference asks, else 0.
Value* LanesEmitter::symmetry(const std::vector<Value*>& m) {
  constexpr double tolerance = 64 * 0x1p-52;
  Value* result = number(1);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Value *const below = m[i * n_ + j], *const above = m[j * n_ + i];
      if (below == above) continue;
      Value* const difference = out_.subtract(below, above);
      Value* const diagonal = out_.absolute(out_.multiply(m[i * n_ + i], m[j * n_ + j]));
      Value* const size = out_.multiply(out_.fma(below, below, diagonal), number(tolerance * tolerance));
      result =
          out_.b.CreateSelect(out_.b.CreateFCmpULT(size, out_.multiply(difference, difference)), number(0), result);
    }
  return result;
}

/// M₀ = L D Lᵀ: L below the diagonal, 1/D beside, in scratch; the quality is the smallest pivot over the largest, each
/// in units of its diagonal element.
void LanesEmitter::decompose(std::vector<Value*> m, Value* symmetric) {
  Value *least = number(1), *largest = number(0);
  for (std::size_t j = 0; j < n_; ++j) {
    Value* const diagonal = m[j * n_ + j];
    Value* pivot = diagonal;
    // Above the diagonal: D Lᵀ, row by row.
    for (std::size_t k = 0; k < j; ++k) pivot = out_.fma(out_.negate(m[j * n_ + k]), m[k * n_ + j], pivot);
    Value* const inverse = out_.divide(number(1), pivot);
    out_.store(inverse, scratch(pivots_at_ + j));
    for (std::size_t i = j + 1; i < n_; ++i) {
      Value* sum = m[i * n_ + j];
      for (std::size_t k = 0; k < j; ++k) sum = out_.fma(out_.negate(m[i * n_ + k]), m[k * n_ + j], sum);
      m[j * n_ + i] = sum;
      m[i * n_ + j] = out_.multiply(sum, inverse);
      out_.store(m[i * n_ + j], scratch(matrix_at_ + i * n_ + j));
    }
    Value* const ratio = out_.divide(pivot, diagonal);
    // A comparison with NaN is false: the smallest stays what it is not less than.
    least = out_.b.CreateSelect(out_.b.CreateFCmpOLT(least, ratio), least, ratio);
    largest = out_.b.CreateSelect(out_.b.CreateFCmpOLT(largest, ratio), ratio, largest);
  }
  if (n_ <= most_by_inverse) invert(m);
  Value* const quality = n_ == 0 ? number(1) : out_.multiply(out_.divide(least, largest), symmetric);
  out_.store(quality, quality_);
}

/// −M₀⁻¹ in place of the factors: a product with it is a shorter chain than two substitutions.
void LanesEmitter::invert(const std::vector<Value*>& m) {
  std::vector<Value*> inverse(n_ * n_, nullptr);  // of L, below its unit diagonal
  const auto lower = [&](std::size_t i, std::size_t j) -> Value*& { return inverse[i * n_ + j]; };
  for (std::size_t j = 0; j < n_; ++j)
    for (std::size_t i = j + 1; i < n_; ++i) {
      Value* sum = m[i * n_ + j];
      for (std::size_t k = j + 1; k < i; ++k) sum = out_.fma(m[i * n_ + k], lower(k, j), sum);
      lower(i, j) = out_.negate(sum);
    }
  std::vector<Value*> pivots;
  for (std::size_t k = 0; k < n_; ++k) pivots.push_back(out_.negate(out_.load(real_, scratch(pivots_at_ + k))));
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      Value* sum = i == j ? pivots[i] : out_.multiply(lower(i, j), pivots[i]);
      for (std::size_t k = i + 1; k < n_; ++k) sum = out_.fma(out_.multiply(lower(k, i), pivots[k]), lower(k, j), sum);
      out_.store(sum, scratch(matrix_at_ + i * n_ + j));
      if (i != j) out_.store(sum, scratch(matrix_at_ + j * n_ + i));
    }
}

/// q̈_k = −M₀⁻¹ R_k; the quality becomes NaN where it is not finite, since infinity and NaN times 0 are NaN.
void LanesEmitter::solve() {
  acceleration_.assign(n_, nullptr);
  if (n_ == 0) return;
  if (n_ > most_by_inverse)
    solve_by_factors();
  else
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j)
        acceleration_[i] = plus(acceleration_[i], read(program_.residual[j], 0), minus_inverse(i, j));
      acceleration_[i] = or_zero(acceleration_[i]);
    }
  Value* quality = out_.load(real_, quality_);
  for (Value* const a : acceleration_) quality = out_.fma(a, number(0), quality);
  out_.store(quality, quality_);
}

void LanesEmitter::solve_by_factors() {
  const auto below = [&](std::size_t i, std::size_t k) {
    return out_.negate(out_.load(real_, scratch(matrix_at_ + i * n_ + k)));
  };
  std::vector<Value*>& x = acceleration_;
  for (std::size_t i = 0; i < n_; ++i) {
    Value* const residual = read(program_.residual[i], 0);
    Value* sum = residual ? out_.negate(residual) : number(0);
    for (std::size_t k = 0; k < i; ++k) sum = out_.fma(below(i, k), x[k], sum);
    x[i] = sum;
  }
  for (std::size_t i = n_; i-- > 0;) {
    Value* sum = out_.multiply(x[i], out_.load(real_, scratch(pivots_at_ + i)));
    for (std::size_t k = i + 1; k < n_; ++k) sum = out_.fma(below(k, i), x[k], sum);
    x[i] = sum;
  }
}

/// Coefficient k + 2 − ℓ of a stored slot of lag ℓ follows q̈_k, divided by (k + 1)(k + 2), k + 1 or 1.
void LanesEmitter::correct() {
  std::vector<Value*> position, velocity;
  for (std::size_t i = 0; i < n_; ++i) {
    position.push_back(over_orders(acceleration_[i], 1));
    velocity.push_back(over_order(acceleration_[i], 1));
    now_[i] = position[i];
    out_.store(position[i], slot_at(row(2), static_cast<Slot>(i)));
  }
  correct_lag(0, view_.corrections_end[0], position);
  correct_lag(view_.corrections_end[0], view_.corrections_end[1], velocity);
  correct_lag(view_.corrections_end[1], view_.corrections_end[2], acceleration_);
}

void LanesEmitter::correct_lag(std::size_t begin, std::size_t end, const std::vector<Value*>& direction) {
  for (std::size_t i = begin; i < end; ++i) {
    const lanes::Correction& c = view_.corrections[i];
    Value* sum = read(c.slot, ahead_of(c.slot));
    for (std::uint32_t t = c.first; t < c.last; ++t) {
      const lanes::CorrectionTerm& term = view_.correction_terms[t];
      if (term.tangent == 0)
        sum = plus(sum, direction[term.direction]);
      else
        sum = plus(sum, out_.load(real_, scratch(term.tangent)), direction[term.direction]);
    }
    now_[c.slot] = or_zero(sum);
    out_.store(now_[c.slot], slot_at(row(ahead_of(c.slot)), c.slot));
  }
}

}  // namespace maupertuis::llvm_backend

#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;

void RolledEmitter::pack(std::size_t index) {
  const Pack& pack = p_.packs[index];
  ++time_;
  switch (pack.kind) {
    case Pack::Sum:
      return keep(pack, products(index, columns(pack)));
    case Pack::Scan:
      return keep(pack, carried(pack, running_sum(columns(pack), false), row(ahead_of(pack))));
    case Pack::ScanDown:
      return keep(pack, carried(pack, running_sum(columns(pack), true), row(ahead_of(pack))));
    case Pack::Strand:
      return strand(pack, columns(pack));
    case Pack::Join:
      return join(pack, false, row(ahead_of(pack)));
    case Pack::JoinDown:
      return join(pack, true, row(ahead_of(pack)));
    case Pack::Integral:
      return integral(index);
    case Pack::Quotient:
      return quotient(index);
    case Pack::SquareRoot:
      return square_root(index);
    case Pack::Scalar:
      return call_rule(pack.instruction, ahead_of(pack));
  }
}

void RolledEmitter::keep(const Pack& pack, Value* value) { keep(pack, value, row(ahead_of(pack))); }

void RolledEmitter::keep(const Pack& pack, Value* value, Value* row) {
  save(value, place(row, pack.out));
  recent_[pack.out] = {value, time_};
}

// ------------------------------------------------------------------------------------------------------------- passing

/// Vectors that are read in the stage that made them and never again: they need not stand in a row of their order, each
/// of which would have to be brought from the second cache to be written to. `residual_too`: the solution that follows
/// reads it there.
void RolledEmitter::find_passing(bool residual_too) {
  passing_.assign(p_.cells / lanes + 1, false);
  const auto is_scalar = [](const Pack& pack) { return pack.kind == Pack::Scalar; };
  if (program_.unknowns != program_.freedoms || std::any_of(p_.packs.begin(), p_.packs.end(), is_scalar)) return;
  const auto set = [this](const Pack& pack, bool value) {
    for (Slot out = pack.out; out < pack.out + std::max(pack.strands, 1u) * lanes; out += lanes)
      passing_[out / lanes] = value;
  };
  for (const Pack& pack : p_.packs) {
    const bool is_sum =
        pack.kind == Pack::Sum || pack.kind == Pack::Scan || pack.kind == Pack::ScanDown || pack.kind == Pack::Strand;
    if (is_sum && pack.out >= program_.stored_end[2] &&
        program_.tangent_lags[pack.out + pack.width - 1] != Program::unmoved)
      set(pack, true);
  }
  for (const Slot slot : program_.residual) passing_[slot / lanes] = passing_[slot / lanes] && residual_too;
  // What is read across two vectors stands beside each other.
  for (bool changed = true; std::exchange(changed, false);)
    for (const Column& column : p_.columns) {
      if (column.kind != Column::Contiguous && column.kind != Column::Reversed) continue;
      const Slot lowest = column.kind == Column::Reversed ? column.source - (lanes - 1) : column.source,
                 last = lowest + lanes - 1;
      if (passing_[lowest / lanes] == passing_[last / lanes]) continue;
      passing_[lowest / lanes] = passing_[last / lanes] = false;
      changed = true;
    }
}

// ---------------------------------------------------------------------------------------------------------------- sums

/// Terms of one shift first, so that its factor is one product. The leaf 1 has no coefficients beyond order 0.
Value* RolledEmitter::columns(const Pack& pack) {
  std::array<Value*, 3> sums{};
  for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
    const Column& column = p_.columns[c];
    const int ahead = ahead_of(pack) + column.shift;
    const bool is_first_order = written_ && *written_ + ahead == 0;
    const auto is_nothing = [&](Slot slot) {
      return (slot == program_.one && !is_first_order) || vanishes(slot, ahead);
    };
    const bool single = column.kind == Column::Broadcast;
    if (single ? is_nothing(column.source) : std::all_of(column.sources.begin(), column.sources.end(), is_nothing))
      continue;
    Value*& sum = sums[column.shift];
    sum = plus_scaled(sum, column.coefficients,
                      column_values(column, row(ahead), 2 - program_.lags[column.source] == ahead));
  }
  Value* const next = sums[1] || sums[2] ? real(stage_plus(ahead_of(pack) + 1)) : nullptr;
  if (sums[2]) sums[1] = plus(sums[1], real(stage_plus(ahead_of(pack) + 2)), sums[2]);
  if (sums[1]) return plus(sums[0], next, sums[1]);
  return sums[0];
}

/// sum + x times coefficients, which are multiplied by only where they are not all 1, or all −1, whatever the
/// parameters are. A null sum is zero.
Value* RolledEmitter::plus_scaled(Value* sum, std::uint32_t first, Value* x) {
  const auto are_all = [&](double value) {
    const auto begin = p_.coefficients.begin() + first;
    return std::all_of(begin, begin + lanes, [&](ConstantId id) {
      return program_.constants[id].kind == Kind::Number && program_.constants[id].value == value;
    });
  };
  if (are_all(1)) return sum ? out_.add(sum, x) : x;
  if (are_all(-1)) return sum ? out_.subtract(sum, x) : out_.negate(x);
  return plus(sum, coefficients(first), x);
}

/// `is_here`: the row is the one that the packs of now write to.
Value* RolledEmitter::column_values(const Column& column, Value* row, bool is_here) {
  if (column.kind == Column::Broadcast) return splat_of(column.source, row, is_here);
  if (column.kind == Column::Gather) return gather(row, column.sources, is_here);
  const bool reversed = column.kind == Column::Reversed;
  const Slot lowest = reversed ? column.source - (lanes - 1) : column.source;
  Value* const here = is_here ? in_register(lowest) : nullptr;
  Value* const values = here ? here : load(place(row, lowest));
  return reversed ? out_.b.CreateShuffleVector(values, {7, 6, 5, 4, 3, 2, 1, 0}) : values;
}

/// One number in all lanes. A shuffle is shorter than the way through memory.
Value* RolledEmitter::splat_of(Slot slot, Value* row, bool is_here) {
  const Slot lane = slot % lanes;
  Value* const here = is_here ? in_register(slot - lane) : nullptr;
  return here ? out_.b.CreateShuffleVector(here, std::vector<int>(lanes, static_cast<int>(lane)))
              : splat(load_one(place(row, slot)));
}

/// What the packs before have left, if it is still in a register.
Value* RolledEmitter::in_register(Slot first) const {
  const auto found = recent_.find(first);
  return found != recent_.end() && time_ - found->second.time <= longest_memory ? found->second.value : nullptr;
}

/// Of one or two vectors a row one shuffle, if they are not still being written in pieces.
Value* RolledEmitter::gather(Value* row, const std::array<Slot, lanes>& slots, bool is_here) {
  auto& b = out_.b;
  if (std::all_of(slots.begin(), slots.end(), [&](Slot s) { return s == slots[0]; }))
    return splat(load_one(place(row, slots[0])));
  const auto base = [](Slot slot) { return slot / lanes * lanes; };
  const Slot first = base(slots[0]);
  const auto other = std::find_if(slots.begin(), slots.end(), [&](Slot slot) { return base(slot) != first; });
  const Slot second = other == slots.end() ? first : base(*other);
  if (std::all_of(slots.begin(), slots.end(), [&](Slot slot) { return base(slot) == first || base(slot) == second; })) {
    const auto vector = [&](Slot slot) {
      Value* const here = is_here ? in_register(slot) : nullptr;
      return here ? here : load(place(row, slot));
    };
    std::vector<int> places;
    for (const Slot slot : slots) places.push_back(static_cast<int>(slot % lanes + (base(slot) == first ? 0 : lanes)));
    return b.CreateShuffleVector(vector(first), vector(second), places);
  }
  Value* result = llvm::PoisonValue::get(vector_);
  for (std::uint64_t lane = 0; lane < lanes; ++lane)
    result = b.CreateInsertElement(result, load_one(place(row, slots[lane])), lane);
  return result;
}

/// Each lane with all lanes before it, or after it: in pairs, fours and eights the second half adds the last sum of the
/// first.
Value* RolledEmitter::running_sum(Value* v, bool down) {
  if (!v) return llvm::Constant::getNullValue(vector_);
  constexpr int nothing = static_cast<int>(lanes);  // a lane of zeros
  for (int half = 1; half < static_cast<int>(lanes); half *= 2) {
    std::vector<int> places;
    for (int lane = 0; lane < static_cast<int>(lanes); ++lane) {
      const int begin = lane / (2 * half) * 2 * half;
      const bool adds = (lane - begin < half) == down;
      places.push_back(adds ? begin + (down ? half : half - 1) : nothing + lane);
    }
    v = out_.add(v, out_.b.CreateShuffleVector(v, llvm::Constant::getNullValue(vector_), places));
  }
  return v;
}

/// What the pack before has come to is known as its carry and its own sum, so that one addition a pack waits for the
/// other.
Value* RolledEmitter::carried(const Pack& pack, Value* sum, Value* row) {
  Value* carry = nullptr;
  if (pack.carry != no_slot) {
    const Slot base = pack.carry / lanes * lanes;
    if (scan_.out == base && scan_.time + 1 == time_) {
      carry = out_.b.CreateShuffleVector(scan_.sum, std::vector<int>(lanes, static_cast<int>(pack.carry - base)));
      if (scan_.carry) carry = out_.add(scan_.carry, carry);
    } else {
      carry = splat(load_one(place(row, pack.carry)));
    }
  }
  scan_ = {pack.out, time_, sum, carry};
  return carry ? out_.add(sum, carry) : sum;
}

/// What a vector of a running sum in eight parts adds; join() adds it up.
void RolledEmitter::strand(const Pack& pack, Value* columns) {
  if (pack.carry == no_slot) strands_.clear();
  strands_.push_back({pack.out, columns ? columns : llvm::Constant::getNullValue(vector_)});
}

/// In segments that do not wait for each other, then what each lacks of those before it and of the lanes before.
void RolledEmitter::join(const Pack& pack, bool down, Value* row) {
  constexpr std::size_t segment = 4;
  std::vector<Value*> before;  // [segments] all segments before it; null: nothing
  Value* total = nullptr;
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    if (i % segment != 0) strands_[i].sum = out_.add(strands_[i - 1].sum, strands_[i].sum);
    if (i % segment == 0) before.push_back(total);
    if (i % segment == segment - 1 || i + 1 == strands_.size())
      total = total ? out_.add(total, strands_[i].sum) : strands_[i].sum;
  }
  constexpr int last = static_cast<int>(lanes) - 1;
  std::vector<int> places;
  for (int lane = 0; lane <= last; ++lane) places.push_back(down ? lane + 1 : lane == 0 ? 2 * last + 1 : lane - 1);
  Value* missing = running_sum(out_.b.CreateShuffleVector(total, llvm::Constant::getNullValue(vector_), places), down);
  if (pack.carry != no_slot) missing = out_.add(missing, splat(load_one(place(row, pack.carry))));
  for (Value*& sum : before) sum = sum ? out_.add(sum, missing) : missing;
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    Value* const sum = out_.add(strands_[i].sum, before[i / segment]);
    save(sum, place(row, strands_[i].out));
    recent_[strands_[i].out] = {sum, time_};
  }
}

// ------------------------------------------------------------------------------------------------------------ products

Value* RolledEmitter::products(std::size_t index, Value* result) {
  const Pack& pack = p_.packs[index];
  for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
    Value* const sum = convolution(p_.packs[index].first_convolution + i - pack.first_product, true, true);
    result = plus_scaled(result, p_.products[i].coefficients, sum);
  }
  return result ? result : llvm::Constant::getNullValue(vector_);
}

/// Σ_j a_j b_{m−j}: what is known, and those ends that take part.
Value* RolledEmitter::convolution(std::size_t number, bool a_ends, bool b_ends) {
  const packed::Convolution& c = p_.convolutions[number];
  if (written_) {
    Value* const sum = short_convolution(c, a_ends, b_ends);
    return sum ? sum : llvm::Constant::getNullValue(vector_);
  }
  Value* sum = load(at(sums_of_stage_[phase_[number]],
                       static_cast<std::int64_t>(sums_of_[number] * packed::rolled_group * 8 * lanes)));
  sum = late_terms(c, sum);
  if (a_ends) sum = end(c.a, c.b, c.lag, sum);
  if (b_ends) sum = end(c.b, c.a, c.lag, sum);
  return sum;
}

/// + x_m y_0, where x_m is of this stage; else it is known already.
Value* RolledEmitter::end(std::uint32_t x, std::uint32_t y, int lag, Value* sum) {
  if (p_.blocks[x].lag != lag || vanishes(p_.blocks[x], 2 - lag)) return sum;
  return out_.fma(newest(x, 2 - lag), first(y), sum);
}

bool RolledEmitter::vanishes(const Block& block, int ahead) const {
  return std::all_of(block.slots.begin(), block.slots.end(), [&](Slot slot) { return vanishes(slot, ahead); });
}

/// Of the order of this stage, before it is solved: what the block copies is not there yet.
Value* RolledEmitter::newest(std::uint32_t index, int ahead) {
  const Block& block = p_.blocks[index];
  Value* values = block.direct || block.is_range ? in_register(block.slots[0]) : nullptr;
  if (!values)
    values = block.direct || block.is_range ? values_of(block, row(ahead)) : gather(row(ahead), block.slots, true);
  return block.weighted ? out_.multiply(values, real(stage_plus(ahead))) : values;
}

/// The slots of a block in a row, weighted or not.
Value* RolledEmitter::values_of(const Block& block, Value* row) {
  if (block.direct) return load(slot_at(row, block.first));
  return block.is_range ? load(slot_at(row, block.slots[0])) : gather(row, block.slots);
}

/// k y_k = c Σ_{j≥1} (j u_j) w_{k−j}; j u_j is 0 for j = 0. Divided by k without the rounding of 1/k, which would be
/// the same in every step.
void RolledEmitter::integral(std::size_t index) {
  const Pack& pack = p_.packs[index];
  if (written_ && *written_ + ahead_of(pack) == 0) return functions(pack);
  Value* const sum = plus_scaled(nullptr, pack.coefficients, convolution(pack.first_convolution, true, false));
  llvm::Type* const scalar = out_.b.getDoubleTy();
  Value* const k = out_.b.CreateSIToFP(stage_plus(ahead_of(pack)), scalar);
  if (!out_.features.fma) return keep(pack, out_.divide(sum, splat(k)));
  Value* const reciprocal = out_.divide(out_.number(1, scalar), k);
  Value* const lack = out_.multiply(out_.fma(out_.negate(reciprocal), k, out_.number(1, scalar)), reciprocal);
  keep(pack, out_.fma(sum, splat(reciprocal), out_.multiply(sum, splat(lack))));
}

/// y_k = (a_k − Σ_{j≥1} b_j y_{k−j}) / b_0
void RolledEmitter::quotient(std::size_t index) {
  const Pack& pack = p_.packs[index];
  Value* const sum = convolution(p_.packs[index].first_convolution, true, false);
  const int ahead = ahead_of(pack), before = p_.blocks[pack.a].lag;
  Value* const a = before == pack.lag ? newest(pack.a, ahead) : load(slot_at(row(ahead), p_.blocks[pack.a].first));
  // At order 0 what a block copies is not there yet; of a lower lag it is, and what is in a register may be of a higher
  // order.
  const bool is_of_stage = written_ && *written_ + ahead == 0 && p_.blocks[pack.b].lag == pack.lag;
  keep(pack, out_.divide(out_.subtract(a, sum), is_of_stage ? newest(pack.b, ahead) : first(pack.b)));
}

/// y_k = (u_k − Σ_{0<j<k} y_j y_{k−j}) / (2 y_0)
void RolledEmitter::square_root(std::size_t index) {
  const Pack& pack = p_.packs[index];
  Value* const sum = convolution(p_.packs[index].first_convolution, false, false);
  const int ahead = ahead_of(pack), before = p_.blocks[pack.a].lag;
  Value* const u = before == pack.lag ? newest(pack.a, ahead) : load(slot_at(row(ahead), p_.blocks[pack.a].first));
  if (written_ && *written_ + ahead == 0) return keep(pack, out_.square_root(u));
  Value* const y = first(pack.y);
  keep(pack, out_.divide(out_.subtract(u, sum), out_.add(y, y)));
}

/// One instruction by the reference rules.
void RolledEmitter::call_rule(std::uint32_t instruction, int ahead) {
  auto& b = out_.b;
  Value* const context = field(offsetof(packed::CompiledArguments, context));
  Value* const value = field(offsetof(packed::CompiledArguments, value));
  auto* const signature =
      llvm::FunctionType::get(b.getVoidTy(), {out_.pointer(), b.getInt32Ty(), b.getInt32Ty()}, false);
  b.CreateCall(signature, value, {context, b.getInt32(instruction), b.CreateTrunc(stage_plus(ahead), b.getInt32Ty())});
}

}  // namespace maupertuis::llvm_backend

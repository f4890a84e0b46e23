#include "kernel/llvm/unrolled_emitter.hpp"

namespace maupertuis::llvm_backend {

using llvm::ArrayRef;
using llvm::Value;
using packed::Block;
using packed::Column;
using packed::Pack;
using packed::lanes;

void UnrolledEmitter::dynamics(const Pack& pack) {
  k_ = stage_ + 2 - pack.lag;
  if (k_ < 0) return;
  const unsigned w = width_of(pack.width);
  switch (pack.kind) {
    case Pack::Sum: keep(pack, sum(pack, w)); break;
    case Pack::Integral: integral(pack, w); break;
    case Pack::Quotient: keep(pack, quotient(pack, w)); break;
    case Pack::SquareRoot: keep(pack, square_root(pack, w)); break;
    case Pack::Scalar: scalar(pack); break;
    // of large systems alone, which are declined
    case Pack::Scan: case Pack::ScanDown: case Pack::Strand: case Pack::Join: case Pack::JoinDown: break;
  }
}

void UnrolledEmitter::keep(Slot slot, Value* v) {
  open_[slot] = v;
  // What is corrected is written when it is final; order 0 of lag 2 is read by the tangents from registers.
  if (stage_ < 0 || !is_corrected(slot)) save(cell(current_order(slot), slot), v);
}

bool UnrolledEmitter::is_corrected(Slot slot) const {
  return !follows_ && slot < p_.program.stored_end[2] && p_.program.tangent_lags[slot] != Program::unmoved;
}

Value* UnrolledEmitter::sum(const Pack& pack, unsigned w) {
  Value* result = nullptr;
  for (std::uint8_t shift = 0; shift < 3; ++shift) result = shifted_sum(pack, shift, w, result);
  return products(pack, w, result ? result : vector_of(0.0, w));
}

/// The factor of the shift goes to the coefficients where they are few, since nothing waits for those, else to their
/// sum.
Value* UnrolledEmitter::shifted_sum(const Pack& pack, std::uint8_t shift, unsigned w, Value* result) {
  const double factor = shift == 0 ? 1 : shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
  std::vector<const Column*> columns;
  std::vector<Value*> derivatives, factors;
  for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c) {
    const Column& column = p_.columns[c];
    if (column.shift != shift || (column.source == p_.program.one && k_ + shift != 0)) continue;
    Value* const rate = rates(sources_of(column, pack.width), shift, w);
    if (!rate) columns.push_back(&column);
    else derivatives.push_back(rate), factors.push_back(coefficients(column.coefficients, w));
  }
  result = add(dot(derivatives, factors), result);
  const bool few = columns.size() <= 2;
  Value* sums[2] = {few ? result : nullptr, nullptr};
  std::size_t next = 0;
  for (const Column* const column : columns) {
    Value* const c = coefficients(column->coefficients, w);
    Value* const values = gather(sources_of(*column, pack.width), k_ + shift, w);
    Value*& sum = sums[few ? 0 : next++ % 2];
    sum = fma(values, few ? mul(c, splat(factor, c)) : c, sum);
  }
  if (few) return sums[0];
  Value* const whole = add(sums[0], sums[1]);
  return fma(whole, splat(factor, whole), result);
}

/// Derivatives of integrals of this stage: k y_k is there before y_k is. Null: not all of the slots are such.
Value* UnrolledEmitter::rates(const std::vector<Slot>& slots, std::uint8_t shift, unsigned w) {
  if (shift == 0 || stage_ < 1) return nullptr;
  std::vector<std::optional<Place>> places;
  for (const Slot slot : slots) {
    const auto integral = slot < n_ || !pack_of_[slot] || current_order(slot) != k_ + shift
                              ? rates_.end()
                              : rates_.find({pack_of_[slot]->out, shift});
    if (integral == rates_.end()) return nullptr;
    places.push_back(Place{integral->second, slot - pack_of_[slot]->out});
  }
  return assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); });
}

std::vector<Slot> UnrolledEmitter::sources_of(const Column& column, std::uint32_t width) {
  if (column.kind == Column::Broadcast) return std::vector<Slot>(width, column.source);
  return {column.sources.begin(), column.sources.begin() + width};
}

Value* UnrolledEmitter::products(const Pack& pack, unsigned w, Value* result) {
  const std::uint32_t count = pack.last_product - pack.first_product;
  if (const unsigned whole = merged_width(pack); whole > 0) return merged_products(pack, w, whole, result);
  for (std::uint32_t i = 0; i < count; ++i) {
    const packed::ProductTerm& term = p_.products[pack.first_product + i];
    Value* const value = term.a == term.b ? self(term.a, 0, w) : product(term.a, term.b, w);
    result = fma(value, coefficients(term.coefficients, w), result);
  }
  return result;
}

Value* UnrolledEmitter::product(std::uint32_t a, std::uint32_t b, unsigned w) {
  return convolution([&](int j) { return operand(a, j, w); }, [&](int j) { return operand(b, j, w); }, 0, k_, k_);
}

/// Products of several terms whose operands lie side by side are one convolution of wider vectors.
unsigned UnrolledEmitter::merged_width(const Pack& pack) const {
  const std::uint32_t count = pack.last_product - pack.first_product;
  const std::size_t whole = static_cast<std::size_t>(count) * pack.width;
  if (count < 2 || whole > lanes || !std::has_single_bit(whole)) return 0;
  const auto follows = [&](std::uint32_t block, std::uint32_t first, std::uint32_t t) {
    const Block &x = p_.blocks[block], &y = p_.blocks[first];
    return x.lag == y.lag && x.slots[0] == y.slots[0] + t * pack.width && is_range(x);
  };
  const packed::ProductTerm& first = p_.products[pack.first_product];
  for (std::uint32_t t = 0; t < count; ++t) {
    const packed::ProductTerm& term = p_.products[pack.first_product + t];
    if (term.a == term.b || !follows(term.a, first.a, t) || !follows(term.b, first.b, t)) return 0;
  }
  return static_cast<unsigned>(whole);
}

bool UnrolledEmitter::is_range(const Block& block) {
  for (std::uint32_t lane = 0; lane < block.width; ++lane)
    if (block.slots[lane] != block.slots[0] + lane) return false;
  return !block.weighted;
}

Value* UnrolledEmitter::merged_products(const Pack& pack, unsigned w, unsigned whole, Value* result) {
  const packed::ProductTerm& first = p_.products[pack.first_product];
  const auto wide = [&](std::uint32_t block) {
    return [this, block, whole](int j) { return range(p_.blocks[block].slots[0], j, whole); };
  };
  Value* const all = convolution(wide(first.a), wide(first.b), 0, k_, k_);
  for (unsigned t = 0; t * pack.width < whole; ++t) {
    Value* part = nullptr;
    if (pack.width == 1) {
      part = b_.CreateExtractElement(all, t);
    } else {
      std::vector<int> mask;
      for (unsigned lane = 0; lane < w; ++lane)
        mask.push_back(static_cast<int>(t * pack.width + std::min(lane, pack.width - 1)));
      part = b_.CreateShuffleVector(all, mask);
    }
    result = fma(part, coefficients(p_.products[pack.first_product + t].coefficients, w), result);
  }
  return result;
}

/// Neighbouring slots of one lag at an order.
Value* UnrolledEmitter::range(Slot first, int order, unsigned w) {
  const auto newest = newest_ranges_.find({first, order, w});
  if (newest != newest_ranges_.end()) return seen(newest->second);
  if (current_order(first) != order) return load(cell(order, first), w);
  std::vector<Slot> slots;
  for (unsigned lane = 0; lane < w; ++lane) slots.push_back(first + lane);
  ranges_.insert({first, w});
  return gather(slots, order, w);
}

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
Value* UnrolledEmitter::self(std::uint32_t a, int first, unsigned w) {
  Value* sum = nullptr;
  for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) sum = fma(operand(a, j, w), operand(a, k_ - j, w), sum);
  if (sum) sum = b_.CreateFAdd(sum, sum);
  if (k_ % 2 == 0 && k_ / 2 >= first) {
    Value* const middle = operand(a, k_ / 2, w);
    sum = fma(middle, middle, sum);
  }
  return sum ? sum : vector_of(0.0, w);
}

void UnrolledEmitter::integral(const Pack& pack, unsigned w) {
  if (k_ == 0) return functions(pack, w);
  Value* const sum = convolution([&](int j) { return operand(pack.a, j, w); },
                                 [&](int j) { return operand(pack.b, j, w); }, 1, k_, k_);
  Value* const c = coefficients(pack.coefficients, w);
  rates_[{pack.out, 1}] = mul(sum, c);
  rates_[{pack.out, 2}] = mul(sum, constant_product(c, k_ - 1.0));
  keep(pack, over(sum, k_, c));
}

Value* UnrolledEmitter::quotient(const Pack& pack, unsigned w) {
  Value* const a = operand(pack.a, k_, w);
  Value* const b0 = operand(pack.b, 0, w);
  if (k_ == 0) return b_.CreateFDiv(a, b0);
  Value* const sum = convolution([&](int j) { return operand(pack.b, j, w); },
                                 [&](int j) { return operand(pack.y, j, w); }, 1, k_, k_);
  return b_.CreateFDiv(b_.CreateFSub(a, sum), b0);
}

Value* UnrolledEmitter::square_root(const Pack& pack, unsigned w) {
  Value* const u = operand(pack.a, k_, w);
  if (k_ == 0) return b_.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, u);
  Value* const y0 = operand(pack.y, 0, w);
  return b_.CreateFDiv(b_.CreateFSub(u, self(pack.y, 1, w)), b_.CreateFAdd(y0, y0));
}

Value* UnrolledEmitter::call_elementary(Kind kind, Value* x, Value* y) {
  auto* const signature =
      llvm::FunctionType::get(b_.getDoubleTy(), {b_.getInt8Ty(), b_.getDoubleTy(), b_.getDoubleTy()}, false);
  return b_.CreateCall(signature, elementary_,
                       {b_.getInt8(static_cast<std::uint8_t>(kind)), x, y ? y : vector_of(0.0, 1)});
}

void UnrolledEmitter::functions(const Pack& pack, unsigned w) {
  std::vector<Value*> values(w, nullptr);
  bool second_pack = pack.first_function == pack.last_function;  // cosines of the sines before
  if (second_pack) {
    for (unsigned lane = 0; lane < pack.width; ++lane) values[lane] = seconds_.at(pack.out + lane);
  } else {
    if (pack.pairs != packed::no_block) return sines_cosines(pack, w);
    unsigned lane = 0;
    for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f, ++lane) {
      const Instruction& i = p_.program.instructions[p_.functions[f]];
      Value* const u = one_slot(i.a, current_order(i.a));
      if (i.second == no_slot) { values[lane] = call_elementary(i.function, u); continue; }
      const auto [first, second] = pair(i.op, u);
      values[lane] = first;
      const unsigned count = pack.last_function - pack.first_function;
      if (pack.width == 2 * count) values[lane + count] = second;
      else seconds_[i.second] = second;
    }
  }
  Value* result = w == 1 ? values[0] : llvm::PoisonValue::get(type(w));
  for (unsigned lane = 0; w > 1 && lane < w; ++lane)
    result = b_.CreateInsertElement(result, values[lane] ? values[lane] : vector_of(0.0, 1), lane);
  keep(pack, result);
}

void UnrolledEmitter::sines_cosines(const Pack& pack, unsigned w) {
  const unsigned count = pack.last_function - pack.first_function, size = width_of(count);
  const Block& block = p_.blocks[pack.a];
  const ArrayRef<Slot> slots(block.slots.data(), count);
  Value* const x = gather(slots, current_order(slots[0]), size);
  const auto call = [&] { return called_sines(x, count, size); };
  const auto [sines, cosines] = fuses_ ? sines_in_place(b_, x, call) : call();
  if (pack.width == 2 * count) return keep(pack, joined(sines, cosines, count, w));
  for (unsigned lane = 0; lane < count; ++lane) seconds_[pack.pairs + lane] = splat_lane(cosines, lane, 1);
  keep(pack, sines);
}

/// Through memory: the function takes and gives arrays.
SineAndCosine UnrolledEmitter::called_sines(Value* x, unsigned count, unsigned size) {
  llvm::IRBuilder<> entry(&function_->getEntryBlock(), function_->getEntryBlock().begin());
  llvm::AllocaInst* const in = entry.CreateAlloca(type(lanes));
  llvm::AllocaInst* const out = entry.CreateAlloca(type(lanes), b_.getInt32(2));
  in->setAlignment(llvm::Align(64)), out->setAlignment(llvm::Align(64));
  save(in, x);
  auto* const signature =
      llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt32Ty()}, false);
  b_.CreateCall(signature, sincos_, {in, out, b_.getInt32(count)});
  return {load_from(out, 0, size), load_from(out, lanes, size)};
}

/// The first `count` lanes of two vectors.
Value* UnrolledEmitter::joined(Value* first, Value* second, unsigned count, unsigned w) {
  if (width(first) == 1) {
    Value* const both = b_.CreateInsertElement(llvm::PoisonValue::get(type(2)), first, std::uint64_t{0});
    return b_.CreateInsertElement(both, second, std::uint64_t{1});
  }
  std::vector<int> mask;
  for (unsigned lane = 0; lane < w; ++lane)
    mask.push_back(static_cast<int>(lane < count ? lane : lane < 2 * count ? width(first) + lane - count : 0));
  return b_.CreateShuffleVector(first, second, mask);
}

std::pair<Value*, Value*> UnrolledEmitter::pair(Op op, Value* u) {
  if (op == Op::SinhCosh) return {call_elementary(Kind::Sinh, u), call_elementary(Kind::Cosh, u)};
  return {call_elementary(Kind::Sin, u), call_elementary(Kind::Cos, u)};
}

}  // namespace maupertuis::llvm_backend

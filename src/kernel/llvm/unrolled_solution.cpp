#include "kernel/llvm/unrolled_emitter.hpp"

namespace maupertuis::llvm_backend {

using llvm::ArrayRef;
using llvm::Value;
using packed::Pack;

static constexpr double least_pivot = 1e-10, least_determinant = 1e-280;

void UnrolledEmitter::factor() {
  for (const Pack& pack : p_.packs)
    if (p_.program.tangent_lags[pack.out] != Program::unmoved && (!follows_ || awaited_[index_of(pack)])) tangent(pack);
  // The tangents of all residuals in direction d are column d of M.
  std::vector<Value*> columns;
  for (std::size_t d = 0; d < n_; ++d) {
    std::vector<std::optional<Place>> places;
    for (const Slot slot : p_.program.residual) {
      auto place = passes(slot, 0, 2) ? tangent_place(slot, static_cast<int>(d)) : std::nullopt;
      places.push_back(place ? *place : Place{vector_of(0.0, wide_), 0});
    }
    columns.push_back(assemble(places, wide_, [&](std::size_t) { return vector_of(0.0, 1); }));
  }
  invert(std::move(columns));
}

/// The columns of −M₀⁻¹ from those of M₀ by Gauss and Jordan on the transposed matrix without pivoting: stable for a
/// symmetric, positive definite matrix. The pivots against their diagonal entries tell whether it is one.
void UnrolledEmitter::invert(std::vector<Value*> rows) {
  const std::vector<Value*> matrix = rows;
  std::vector<Value*> diagonal, sound;
  for (unsigned i = 0; i < n_; ++i) diagonal.push_back(splat_lane(rows[i], i, 1));
  unsigned pivot = 0;
  for (; pivot + 1 < n_; pivot += 2) eliminate_pair(rows, pivot, diagonal, sound);
  if (pivot < n_) eliminate_one(rows, pivot, diagonal, sound);
  for (Value* const row : refined(rows, matrix)) inverse_columns_.push_back(b_.CreateFNeg(row));
  trust(b_.CreateAnd(sound));
}

/// Newton's step X + X (1 − N X) for the inverse X of N: what rounding left in X would act on all orders of a step, and
/// the energy of a double pendulum drift.
std::vector<Value*> UnrolledEmitter::refined(ArrayRef<Value*> inverse, ArrayRef<Value*> matrix) {
  std::vector<Value*> rest, result;
  for (unsigned i = 0; i < n_; ++i) {
    rest.push_back(with_lane(vector_of(0.0, wide_), i, vector_of(1.0, 1)));
    for (unsigned j = 0; j < n_; ++j)
      rest[i] = fma(b_.CreateFNeg(splat_lane(matrix[i], j, wide_)), inverse[j], rest[i]);
  }
  for (unsigned i = 0; i < n_; ++i) {
    Value* change = nullptr;
    for (unsigned j = 0; j < n_; ++j) change = fma(splat_lane(inverse[i], j, wide_), rest[j], change);
    result.push_back(b_.CreateFAdd(inverse[i], change));
  }
  return result;
}

void UnrolledEmitter::eliminate_one(std::vector<Value*>& rows, unsigned pivot, ArrayRef<Value*> diagonal,
                                    std::vector<Value*>& sound) {
  Value* const p = splat_lane(rows[pivot], pivot, 1);
  sound.push_back(b_.CreateFCmpOGT(b_.CreateFDiv(p, diagonal[pivot]), vector_of(least_pivot, 1)));
  Value* const row = mul(with_lane(rows[pivot], pivot, vector_of(1.0, 1)), spread(b_.CreateFDiv(vector_of(1.0, 1), p)));
  for (unsigned i = 0; i < n_; ++i)
    if (i != pivot)
      rows[i] =
          fma(b_.CreateFNeg(splat_lane(rows[i], pivot, wide_)), row, with_lane(rows[i], pivot, vector_of(0.0, 1)));
  rows[pivot] = row;
}

/// Two pivots at once: their rows are combined while their determinant is divided by. One that is too small to have all
/// its digits is not sound.
void UnrolledEmitter::eliminate_pair(std::vector<Value*>& rows, unsigned pivot, ArrayRef<Value*> diagonal,
                                     std::vector<Value*>& sound) {
  const unsigned other = pivot + 1;
  const auto with_pair = [&](Value* row, double x, double y) {
    return with_lane(with_lane(row, pivot, vector_of(x, 1)), other, vector_of(y, 1));
  };
  Value *const a = splat_lane(rows[pivot], pivot, 1), *const b = splat_lane(rows[pivot], other, 1);
  Value *const c = splat_lane(rows[other], pivot, 1), *const d = splat_lane(rows[other], other, 1);
  Value* const determinant = fma(b_.CreateFNeg(b), c, b_.CreateFMul(a, d));
  sound.push_back(b_.CreateFCmpOGT(b_.CreateFDiv(a, diagonal[pivot]), vector_of(least_pivot, 1)));
  sound.push_back(
      b_.CreateFCmpOGT(b_.CreateFDiv(determinant, b_.CreateFMul(a, diagonal[other])), vector_of(least_pivot, 1)));
  sound.push_back(
      b_.CreateFCmpOGT(b_.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, determinant), vector_of(least_determinant, 1)));
  Value* const inverse = spread(b_.CreateFDiv(vector_of(1.0, 1), determinant));
  Value *const x = with_pair(rows[pivot], 1, 0), *const y = with_pair(rows[other], 0, 1);
  Value* const above = fma(b_.CreateFNeg(spread(b)), y, b_.CreateFMul(spread(d), x));
  Value* const below = fma(b_.CreateFNeg(spread(c)), x, b_.CreateFMul(spread(a), y));
  for (unsigned i = 0; i < n_; ++i) {
    if (i == pivot || i == other) continue;
    Value* const f = b_.CreateFMul(splat_lane(rows[i], pivot, wide_), inverse);
    Value* const g = b_.CreateFMul(splat_lane(rows[i], other, wide_), inverse);
    rows[i] = fma(b_.CreateFNeg(g), below, fma(b_.CreateFNeg(f), above, with_pair(rows[i], 0, 0)));
  }
  rows[pivot] = b_.CreateFMul(above, inverse), rows[other] = b_.CreateFMul(below, inverse);
}

/// Beyond this point only if the condition holds; else the slow path has to decide.
void UnrolledEmitter::trust(Value* condition) {
  auto* const good = llvm::BasicBlock::Create(context_, "", function_);
  auto* const bad = llvm::BasicBlock::Create(context_, "", function_);
  b_.CreateCondBr(condition, good, bad);
  b_.SetInsertPoint(bad);
  b_.CreateRet(b_.getInt32(2));
  b_.SetInsertPoint(good);
}

Value* UnrolledEmitter::splat_lane(Value* v, unsigned lane, unsigned w) {
  if (width(v) == 1) return w == 1 ? v : b_.CreateVectorSplat(w, v);
  if (w == 1) return b_.CreateExtractElement(v, lane);
  return b_.CreateShuffleVector(v, std::vector<int>(w, static_cast<int>(lane)));
}

/// q̈_k = −M₀⁻¹ R_k; looking ahead, R_k lacks its part by q̈_{k−1}.
void UnrolledEmitter::solve() {
  std::vector<Value*> residual, before, slopes;
  for (unsigned d = 0; d < n_; ++d) {
    const Slot slot = p_.program.residual[d];
    const auto r = current_order(slot) == stage_ ? place(slot) : std::nullopt;
    residual.push_back(r ? splat_lane(r->vector, r->lane, wide_) : spread(load(cell(stage_, slot), 1)));
    if (!looks_ahead(stage_)) continue;
    before.push_back(splat_lane(acceleration_, d, wide_));
    slopes.push_back(fma(ahead_b_[d], vector_of(1.0 / stage_, wide_), ahead_a_[d]));
  }
  Value* const found = add(dot(before, slopes), dot(residual, inverse_columns_));
  previous_ = std::exchange(acceleration_, found);
  check_ = check_ ? b_.CreateFAdd(check_, found) : found;
}

/// Σ x_i y_i in two chains; null without terms. Two products are added: an addition is shorter than a fused product.
Value* UnrolledEmitter::dot(ArrayRef<Value*> x, ArrayRef<Value*> y) {
  Value *even = nullptr, *odd = nullptr;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Value*& sum = i % 2 == 0 ? even : odd;
    sum = fma(x[i], y[i], sum);
  }
  return add(even, odd);
}

void UnrolledEmitter::correct() {
  coordinates_ = over(acceleration_, (stage_ + 1.0) * (stage_ + 2.0));
  previous_coordinates_ = std::exchange(final_coordinates_, coordinates_);
  save(cell(stage_ + 2, 0), coordinates_);  // the other lanes of the row's first vector belong to nobody
  for (const Pack& pack : p_.packs) {
    if (!is_corrected(pack.out)) continue;
    const SecondTangent* const second_order = looks_ahead(stage_) ? &second_order_[index_of(pack)] : nullptr;
    correct(pack.out, tangents_[index_of(pack)], pack.lag, second_order);
    if (pack.kind != Pack::Scalar) continue;
    const Slot second = p_.program.instructions[pack.instruction].second;
    if (second != no_slot) correct(second, second_tangents_[second], pack.lag, nullptr);
  }
}

void UnrolledEmitter::correct(Slot slot, const Tangent& t, int lag, const SecondTangent* second_order) {
  const auto found = open_.find(slot);
  if (found == open_.end()) return;
  Value* result = found->second;
  const unsigned w = width(result);
  const double k = stage_;
  if (second_order) {
    // (k+1)_ℓ A + (k+1)_{ℓ−1} B over (k+1) k, since q_{k+1} = q̈_{k−1} / ((k+1) k)
    for (const auto& [d, values] : joined(*second_order)) {
      Value* slope = values.second ? fma(values.second, vector_of(1 / (k + 2 - lag), w), values.first) : values.first;
      if (lag == 1) slope = mul(slope, vector_of(1 / k, w));
      result = fma(direction_of(lag == 0 ? previous_coordinates_ : previous_, t, d, w), slope, result);
    }
  }
  found->second = early_[slot] = result;
  const double factor = lag == 2 ? 1 : lag == 1 ? 1.0 / (k + 1) : 1.0 / ((k + 1) * (k + 2));
  // The next stage waits for this where nothing looks ahead: then the tangents are scaled, which are there before.
  const bool by_coordinates = lag == 0 && second_order;
  Value* const change = by_coordinates ? coordinates_ : acceleration_;
  const auto scaled = [&](Value* v) { return by_coordinates ? v : mul(v, splat(factor, v)); };
  if (t.diagonal) result = fma(direction_of(change, t, along_lanes, w), scaled(t.diagonal), result);
  for (const auto& [d, value] : t.dense)
    result = fma(splat_lane(change, static_cast<unsigned>(d), w), scaled(value), result);
  found->second = result;
  save(cell(stage_ + 2 - lag, slot), result);
}

/// Accelerations as the lanes of a diagonal tangent need them, or one for all lanes.
Value* UnrolledEmitter::direction_of(Value* acceleration, const Tangent& t, int d, unsigned w) {
  if (d != along_lanes) return splat_lane(acceleration, static_cast<unsigned>(d), w);
  std::vector<std::optional<Place>> places;
  for (const int x : t.direction) places.push_back(Place{acceleration, static_cast<unsigned>(std::max(0, x))});
  return assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); });
}

std::map<int, std::pair<Value*, Value*>> UnrolledEmitter::joined(const SecondTangent& s) {
  std::map<int, std::pair<Value*, Value*>> result;
  for (const auto& [d, value] : s.a) result[d].first = value;
  for (const auto& [d, value] : s.b) result[d].second = value;
  return result;
}

}  // namespace maupertuis::llvm_backend

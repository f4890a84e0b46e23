#include "kernel/llvm/unrolled_emitter.hpp"

#include <cmath>

namespace maupertuis::llvm_backend {

using llvm::ArrayRef;
using llvm::Value;
using packed::Block;
using packed::Pack;

Value* UnrolledEmitter::vector_of(double x, unsigned width) {
  llvm::Constant* const scalar = llvm::ConstantFP::get(b_.getDoubleTy(), x);
  return width == 1 ? scalar : llvm::ConstantVector::getSplat(llvm::ElementCount::getFixed(width), scalar);
}

unsigned UnrolledEmitter::width(const Value* v) {
  const auto* const t = llvm::dyn_cast<llvm::FixedVectorType>(v->getType());
  return t ? t->getNumElements() : 1;
}

bool UnrolledEmitter::is_zero(const Value* v) {
  const auto* const c = llvm::dyn_cast<llvm::Constant>(v);
  return c && c->isZeroValue();
}

Value* UnrolledEmitter::cell(int order, std::size_t slot) {
  return b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), rows_, static_cast<std::uint64_t>(order) * stride_ + slot);
}

Value* UnrolledEmitter::load_from(Value* table, std::size_t index, unsigned w) {
  return load(b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), table, index), w);
}

/// Numbers of the model's text are numbers of the code.
Value* UnrolledEmitter::coefficients(std::uint32_t first, unsigned w) {
  std::vector<llvm::Constant*> values;
  for (unsigned lane = 0; lane < w; ++lane) {
    const Constant& c = p_.program.constants[p_.coefficients[first + lane]];
    if (c.kind != Kind::Number) return load_from(coefficients_, first, w);
    values.push_back(llvm::ConstantFP::get(b_.getDoubleTy(), c.value));
  }
  return w == 1 ? values[0] : llvm::ConstantVector::get(values);
}

bool UnrolledEmitter::is_one(const Value* v) {
  const auto* const c = llvm::dyn_cast<llvm::Constant>(v);
  return c && (c->getType()->isVectorTy() ? c->getSplatValue() && is_one(c->getSplatValue())
                                          : llvm::cast<llvm::ConstantFP>(c)->isExactlyValue(1.0));
}

Value* UnrolledEmitter::mul(Value* x, Value* y) {
  return is_zero(x) || is_one(y) ? x : is_zero(y) || is_one(x) ? y : b_.CreateFMul(x, y);
}

/// Null stands for a sum without terms.
Value* UnrolledEmitter::add(Value* x, Value* y) {
  if (!x || !y) return x ? x : y;
  return is_zero(x) ? y : is_zero(y) ? x : b_.CreateFAdd(x, y);
}

/// x y + sum; a null sum is zero.
Value* UnrolledEmitter::fma(Value* x, Value* y, Value* sum) {
  if (is_zero(x) || is_zero(y)) return sum ? sum : is_zero(x) ? x : y;
  if (!sum || is_zero(sum)) return mul(x, y);
  if (is_one(x) || is_one(y)) return b_.CreateFAdd(is_one(x) ? y : x, sum);
  if (!fuses_) return b_.CreateFAdd(mul(x, y), sum);
  return b_.CreateIntrinsic(llvm::Intrinsic::fma, {x->getType()}, {x, y, sum});
}

/// c x / d
Value* UnrolledEmitter::over(Value* x, double d, Value* c) {
  if (is_zero(x)) return x;
  const double high = 1 / d, low = std::fma(-high, d, 1.0) / d;
  Value* const by_high = constant_product(c, high);
  return low == 0 ? mul(x, by_high) : fma(x, by_high, mul(x, constant_product(c, low)));
}

void UnrolledEmitter::begin_stage(int stage) {
  stage_ = stage;
  open_.clear();
  rates_.clear();
  early_.clear();
  if (stage < 0) {
    const int k = stage + 2;
    coordinates_ = k < 2 && k >= 0 ? given_coordinates(k) : nullptr;
  } else {
    coordinates_ = vector_of(0.0, wide_);
  }
}

/// q or q̇, number by number: a wider load would wait until all of it is in the cache. `volatile` keeps LLVM from
/// joining them.
Value* UnrolledEmitter::given_coordinates(int order) {
  constexpr std::size_t most_singly = 4;  // beyond, putting them together takes longer
  if (n_ > most_singly) return load(cell(order, 0), wide_);
  Value* const from = order == 0 ? given_q_ : given_v_;
  Value* result = vector_of(0.0, wide_);
  for (unsigned i = 0; i < n_; ++i) {
    auto* const number = llvm::cast<llvm::LoadInst>(load_from(from, i, 1));
    number->setVolatile(true);
    result = with_lane(result, i, number);
  }
  return result;
}

/// Where the coefficient of this stage stands; nothing: it was not computed in this stage's registers.
std::optional<UnrolledEmitter::Place> UnrolledEmitter::place(Slot slot) const {
  if (slot < n_) return coordinates_ ? std::optional<Place>({coordinates_, slot}) : std::nullopt;
  const Pack* const pack = pack_of_[slot];
  if (!pack) return std::nullopt;
  const auto found = open_.find(slot_base(*pack, slot));
  if (found == open_.end()) return std::nullopt;
  return Place{found->second, slot - found->first};
}

Value* UnrolledEmitter::element(const Place& place) {
  return width(place.vector) == 1 ? place.vector : b_.CreateExtractElement(place.vector, place.lane);
}

/// Lanes from up to two vectors by one shuffle, else one by one.
Value* UnrolledEmitter::assemble(const std::vector<std::optional<Place>>& places, unsigned w,
                                 const std::function<Value*(std::size_t)>& other) {
  std::vector<Value*> sources;
  bool shuffles = true;
  for (const auto& p : places) {
    if (!p || width(p->vector) == 1) { shuffles = false; break; }
    if (std::find(sources.begin(), sources.end(), p->vector) == sources.end()) sources.push_back(p->vector);
  }
  if (w == 1) return places[0] ? element(*places[0]) : other(0);
  if (shuffles && sources.size() <= 2 && width(sources[0]) == width(sources.back())) return shuffle(places, sources, w);
  Value* result = llvm::PoisonValue::get(type(w));
  for (unsigned lane = 0; lane < w; ++lane) {
    const std::size_t from = std::min<std::size_t>(lane, places.size() - 1);
    result = b_.CreateInsertElement(result, places[from] ? element(*places[from]) : other(from), lane);
  }
  return result;
}

Value* UnrolledEmitter::shuffle(const std::vector<std::optional<Place>>& places, const std::vector<Value*>& sources,
                                unsigned w) {
  const unsigned size = width(sources[0]);
  const bool one_lane =
      std::all_of(places.begin(), places.end(), [&](const auto& p) { return p->lane == places[0]->lane; });
  if (sources.size() == 1 && one_lane) return splat_lane(sources[0], places[0]->lane, w);
  std::vector<int> mask;
  bool identity = w == size && sources.size() == 1;
  for (unsigned lane = 0; lane < w; ++lane) {
    const Place& p = *places[std::min<std::size_t>(lane, places.size() - 1)];
    mask.push_back(static_cast<int>(p.lane + (p.vector == sources[0] ? 0 : size)));
    identity = identity && (lane >= places.size() || mask.back() == static_cast<int>(lane));
  }
  if (identity) return sources[0];
  return b_.CreateShuffleVector(sources[0],
                                sources.size() > 1 ? sources[1] : llvm::PoisonValue::get(sources[0]->getType()), mask);
}

/// Slots at given orders (one for each), from registers where they were computed in this stage, else from memory.
Value* UnrolledEmitter::gather(ArrayRef<Slot> slots, int order, unsigned w) {
  bool range = true, all_zero = true, any_open = false;
  std::vector<std::optional<Place>> places;
  for (std::size_t lane = 0; lane < slots.size(); ++lane) {
    range = range && slots[lane] == slots[0] + lane;
    places.push_back(current_order(slots[lane]) == order ? place(slots[lane]) : std::nullopt);
    any_open = any_open || places.back();
    all_zero = all_zero && places.back() && is_zero(places.back()->vector);
  }
  if (all_zero) return vector_of(0.0, w);
  if (!any_open && w == 1)
    if (Value* const known = recent(slots[0], order)) return known;
  if (!any_open && range) return load(cell(order, slots[0]), w);
  const bool same = std::all_of(slots.begin(), slots.end(), [&](Slot s) { return s == slots[0]; });
  if (!any_open && same && w > 1) return b_.CreateVectorSplat(w, load(cell(order, slots[0]), 1));
  return assemble(places, w, [&](std::size_t lane) { return load(cell(order, slots[lane]), 1); });
}

/// What the last two stages found, one number of it: a shuffle is shorter than the way through memory. Null: not known.
Value* UnrolledEmitter::recent(Slot slot, int order) {
  if (slot < n_ || !pack_of_[slot]) return nullptr;
  const Slot base = slot_base(*pack_of_[slot], slot);
  const auto found = recent_.find({base, order});
  return found == recent_.end() ? nullptr : element({found->second, slot - base});
}

void UnrolledEmitter::keep_recent() {
  std::erase_if(
      recent_, [&](const auto& entry) { return entry.first.second < stage_ + 1 - p_.program.lags[entry.first.first]; });
  for (const auto& [base, value] : open_) recent_[{base, current_order(base)}] = value;
}

/// A block's coefficients of some order, final or of this stage.
Value* UnrolledEmitter::operand(std::uint32_t index, int order, unsigned w) {
  const Block& block = p_.blocks[index];
  const auto newest = newest_.find({index, order});
  if (newest != newest_.end() && width(newest->second.final) == w) return seen(newest->second);
  const ArrayRef<Slot> slots(block.slots.data(), block.width);
  if (current_order(block.slots[0]) == order) {
    if (follows_ && stage_ >= 0 && block.weighted && is_of_coordinates(block)) return weighted_coordinates(block);
    Value* const values = gather(slots, order, w);
    return block.weighted ? mul(values, splat(order, values)) : values;
  }
  return load(cell(order, block.first), w);
}

/// Copies of what is final now; the newest two stages stay in registers.
void UnrolledEmitter::renew_blocks() {
  std::erase_if(newest_, [&](const auto& entry) { return entry.second.stage < stage_ - 1; });
  std::erase_if(newest_ranges_, [&](const auto& entry) { return entry.second.stage < stage_ - 1; });
  for (std::uint32_t index = 0; index < p_.blocks.size(); ++index) {
    const Block& block = p_.blocks[index];
    const int order = stage_ + 2 - block.lag;
    if (order < 0) continue;
    Newest entry = newest_of(ArrayRef<Slot>(block.slots.data(), block.width), order, width_of(block.width));
    if (block.weighted) weigh(block, entry, order);
    if (!block.direct) save(cell(order, block.first), entry.final);
    newest_[{index, order}] = entry;
  }
  for (const auto& [first, w] : ranges_) {
    const int order = stage_ + 2 - p_.program.lags[first];
    std::vector<Slot> slots;
    for (unsigned lane = 0; lane < w; ++lane) slots.push_back(first + lane);
    if (order >= 0) newest_ranges_[{first, order, w}] = newest_of(slots, order, w);
  }
}

UnrolledEmitter::Newest UnrolledEmitter::newest_of(ArrayRef<Slot> slots, int order, unsigned w) {
  Newest entry{.final = gather(slots, order, w), .stage = stage_};
  entry.early = entry.final;
  if (!looks_ahead(stage_ + 1)) return entry;
  std::vector<std::optional<Place>> places;
  for (const Slot slot : slots) {
    auto p = place(slot);
    if (slot < n_) p = Place{vector_of(0.0, width(coordinates_)), slot};
    else if (p)
      if (const auto early = early_.find(slot - p->lane); early != early_.end()) p->vector = early->second;
    places.push_back(p);
  }
  entry.early = assemble(places, w, [&](std::size_t lane) { return load(cell(order, slots[lane]), 1); });
  return entry;
}

bool UnrolledEmitter::is_of_coordinates(const Block& block) const {
  return std::all_of(block.slots.begin(), block.slots.begin() + block.width, [&](Slot s) { return s < n_; });
}

/// k q_k is q̈/(k−1): one operation fewer to wait for.
Value* UnrolledEmitter::weighted_coordinates(const Block& block) {
  std::vector<std::optional<Place>> places;
  for (std::uint32_t lane = 0; lane < block.width; ++lane) places.push_back(Place{acceleration_, block.slots[lane]});
  return over(assemble(places, width_of(block.width), [&](std::size_t) { return vector_of(0.0, 1); }), stage_ + 1.0);
}

void UnrolledEmitter::weigh(const Block& block, Newest& entry, int order) {
  const unsigned w = width_of(block.width);
  const bool same = entry.early == entry.final;
  entry.early = mul(entry.early, vector_of(order, w));
  entry.final =
      is_of_coordinates(block) && stage_ >= 0 ? weighted_coordinates(block) : mul(entry.final, vector_of(order, w));
  if (same) entry.early = entry.final;
}

}  // namespace maupertuis::llvm_backend

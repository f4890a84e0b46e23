#include "kernel/llvm/unrolled_emitter.hpp"

namespace maupertuis::llvm_backend {

using llvm::ArrayRef;
using llvm::Value;
using packed::Block;
using packed::Column;
using packed::Pack;

static constexpr std::size_t most_looking_ahead = 4;  // unknowns

/// Whether the second tangents of all packs are found by the rules below, and no sum reads what the stage before has
/// just found: that would hold the q̈ that is to come last.
bool UnrolledEmitter::has_second_tangents() const {
  return n_ <= most_looking_ahead && std::all_of(p_.packs.begin(), p_.packs.end(), [&](const Pack& pack) {
    if (p_.program.tangent_lags[pack.out] == Program::unmoved) return true;
    for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c)
      for (const Slot slot : sources_of(p_.columns[c], pack.width))
        if (passes(slot, p_.columns[c].shift, pack.lag - 1)) return false;
    return pack.kind == Pack::Sum || pack.kind == Pack::Integral;
  });
}

/// After stage 0, when all coefficients of order 1 that it takes are known.
void UnrolledEmitter::find_second_tangents() {
  for (const Pack& pack : p_.packs)
    if (p_.program.tangent_lags[pack.out] != Program::unmoved) second_order_[index_of(pack)] = second_tangent(pack);
  for (unsigned d = 0; d < n_; ++d) {
    Value *a = vector_of(0.0, wide_), *b = a;
    for (unsigned i = 0; i < n_; ++i) {
      const Slot slot = p_.program.residual[i];
      if (const auto found = second_place(slot, static_cast<int>(d), true))
        a = fma(spread(element(*found)), inverse_columns_[i], a);
      if (const auto found = second_place(slot, static_cast<int>(d), false))
        b = fma(spread(element(*found)), inverse_columns_[i], b);
    }
    ahead_a_.push_back(a), ahead_b_.push_back(b);
  }
}

std::optional<UnrolledEmitter::Place> UnrolledEmitter::second_place(Slot slot, int d, bool of_a) {
  if (slot < n_ || !pack_of_[slot]) return std::nullopt;
  const Pack& pack = *pack_of_[slot];
  const auto& map = of_a ? second_order_[index_of(pack)].a : second_order_[index_of(pack)].b;
  const unsigned lane = slot - pack.out;
  if (const auto found = map.find(d); found != map.end()) return Place{found->second, lane};
  const auto found = map.find(along_lanes);
  if (found == map.end() || tangents_[index_of(pack)].direction[lane] != d) return std::nullopt;
  return Place{found->second, lane};
}

/// Lanes of slots in the directions given.
Value* UnrolledEmitter::gather_part(Part part, ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w) {
  if (part == Part::Leading) return gather_tangents(slots, direction, w);
  std::vector<std::optional<Place>> places;
  bool any = false;
  for (std::size_t lane = 0; lane < slots.size(); ++lane) {
    places.push_back(direction[lane] < 0 ? std::nullopt : second_place(slots[lane], direction[lane], part == Part::A));
    any = any || places.back();
  }
  return any ? assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); }) : vector_of(0.0, w);
}

UnrolledEmitter::SecondTangent UnrolledEmitter::second_tangent(const Pack& pack) {
  const Tangent& t = tangents_[index_of(pack)];
  SecondTangent result;
  if (t.diagonal) add_second(pack, along_lanes, t.direction, result);
  else
    for (unsigned d = 0; d < n_; ++d)
      add_second(pack, static_cast<int>(d), std::vector<int>(pack.width, static_cast<int>(d)), result);
  return result;
}

void UnrolledEmitter::add_second(const Pack& pack, int name, ArrayRef<int> direction, SecondTangent& result) {
  Slopes slopes;
  if (pack.kind == Pack::Sum) {
    for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c)
      add_column(pack, p_.columns[c], direction, slopes);
    for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i)
      add_product(pack, p_.products[i], direction, slopes);
  }
  if (pack.kind == Pack::Integral) add_integral(pack, direction, slopes);
  if (slopes.a && !is_zero(slopes.a)) result.a[name] = slopes.a;
  if (slopes.b && !is_zero(slopes.b)) result.b[name] = slopes.b;
}

void UnrolledEmitter::add_column(const Pack& pack, const Column& column, ArrayRef<int> direction, Slopes& s) {
  const unsigned w = width_of(pack.width);
  const std::vector<Slot> slots = sources_of(column, pack.width);
  Value* const factor = coefficients(column.coefficients, w);
  if (p_.program.lags[column.source] + column.shift == pack.lag) {
    Value* const of_a = gather_part(Part::A, slots, direction, w);
    s.a = fma(of_a, factor, s.a);
    s.b = fma(gather_part(Part::B, slots, direction, w), factor, s.b);
    if (column.shift > 0) s.b = fma(of_a, mul(factor, vector_of(column.shift, w)), s.b);
  } else if (passes(column.source, column.shift, pack.lag - 1)) {
    s.b = fma(gather_part(Part::Leading, slots, direction, w), factor, s.b);
  }
}

void UnrolledEmitter::add_product(const Pack& pack, const packed::ProductTerm& term, ArrayRef<int> direction,
                                  Slopes& s) {
  const unsigned w = width_of(pack.width);
  Value* const factor = coefficients(term.coefficients, w);
  for (const auto& [x, y] : {std::pair{term.a, term.b}, std::pair{term.b, term.a}}) {
    const std::vector<Slot> slots = slots_of(p_.blocks[x]);
    Value* const y0 = mul(factor, value_at(y, 0, w));
    if (p_.blocks[x].lag == pack.lag) {
      s.a = fma(gather_part(Part::A, slots, direction, w), y0, s.a);
      s.a = fma(gather_part(Part::Leading, slots, direction, w), mul(factor, value_at(y, 1, w)), s.a);
      s.b = fma(gather_part(Part::B, slots, direction, w), y0, s.b);
    } else if (p_.blocks[x].lag == pack.lag - 1) {
      s.b = fma(gather_part(Part::Leading, slots, direction, w), y0, s.b);
    }
  }
}

/// y' = c w u': the factors (m)_ℓ (m − ℓ)/(m − ℓ + 1) of T_u w₁ are (m)_ℓ − (m)_{ℓ−1}.
void UnrolledEmitter::add_integral(const Pack& pack, ArrayRef<int> direction, Slopes& s) {
  const unsigned w = width_of(pack.width);
  const std::vector<Slot> u = slots_of(p_.blocks[pack.a]), x = slots_of(p_.blocks[pack.b]);
  Value* const c = coefficients(pack.coefficients, w);
  Value* const w0 = mul(c, value_at(pack.b, 0, w));
  if (p_.blocks[pack.a].lag == pack.lag) {
    Value* const by_w1 = mul(gather_part(Part::Leading, u, direction, w), mul(c, value_at(pack.b, 1, w)));
    s.a = add(fma(gather_part(Part::A, u, direction, w), w0, s.a), by_w1);
    s.b = fma(gather_part(Part::B, u, direction, w), w0, s.b);
    s.b = fma(by_w1, vector_of(-1.0, w), s.b);
  } else if (p_.blocks[pack.a].lag == pack.lag - 1) {
    s.b = fma(gather_part(Part::Leading, u, direction, w), w0, s.b);
  }
  if (p_.blocks[pack.b].lag == pack.lag)
    s.b = fma(gather_part(Part::Leading, x, direction, w), mul(c, value_at(pack.a, 1, w)), s.b);
}

/// Final coefficients of a block's slots, after their stage.
Value* UnrolledEmitter::value_at(std::uint32_t index, int order, unsigned w) {
  const Block& block = p_.blocks[index];
  const ArrayRef<Slot> slots(block.slots.data(), block.width);
  if (current_order(slots[0]) == order) return gather(slots, order, w);
  bool range = true;
  for (std::size_t lane = 0; lane < slots.size(); ++lane) range = range && slots[lane] == slots[0] + lane;
  if (range) return load(cell(order, slots[0]), w);
  Value* result = w == 1 ? load(cell(order, slots[0]), 1) : llvm::PoisonValue::get(type(w));
  for (unsigned lane = 0; w > 1 && lane < w; ++lane)
    result = b_.CreateInsertElement(result, load(cell(order, slots[std::min<std::size_t>(lane, slots.size() - 1)]), 1),
                                    lane);
  return result;
}

}  // namespace maupertuis::llvm_backend

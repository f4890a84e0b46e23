#include "kernel/llvm/unrolled_emitter.hpp"

namespace maupertuis::llvm_backend {

using llvm::ArrayRef;
using llvm::Value;
using packed::Block;
using packed::Column;
using packed::Pack;

/// The tangent of one slot in one direction: where it stands; nothing for zero.
std::optional<UnrolledEmitter::Place> UnrolledEmitter::tangent_place(Slot slot, int d) {
  if (slot < n_) return static_cast<int>(slot) == d ? std::optional<Place>({vector_of(1.0, 2), 0}) : std::nullopt;
  const Pack* const pack = pack_of_[slot];
  if (!pack) return std::nullopt;
  const Tangent& t =
      pack->kind == Pack::Scalar && slot != pack->out ? second_tangents_[slot] : tangents_[index_of(*pack)];
  const unsigned lane = pack->kind == Pack::Scalar ? 0 : slot - pack->out;
  if (t.diagonal) return t.direction[lane] == d ? std::optional<Place>({t.diagonal, lane}) : std::nullopt;
  const auto found = t.dense.find(d);
  return found == t.dense.end() ? std::nullopt : std::optional<Place>({found->second, lane});
}

std::set<int> UnrolledEmitter::directions(Slot slot) {
  std::set<int> result;
  if (slot < n_) return {static_cast<int>(slot)};
  const Pack* const pack = pack_of_[slot];
  if (!pack) return result;
  const Tangent& t =
      pack->kind == Pack::Scalar && slot != pack->out ? second_tangents_[slot] : tangents_[index_of(*pack)];
  const unsigned lane = pack->kind == Pack::Scalar ? 0 : slot - pack->out;
  if (t.diagonal && t.direction[lane] >= 0) result.insert(t.direction[lane]);
  for (const auto& [d, value] : t.dense) result.insert(d);
  return result;
}

/// Tangents of slots, lane by lane, in the direction given for each lane (−1: zero).
Value* UnrolledEmitter::gather_tangents(ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w) {
  std::vector<std::optional<Place>> places;
  bool any = false;
  for (std::size_t lane = 0; lane < slots.size(); ++lane) {
    places.push_back(direction[lane] < 0 ? std::nullopt : tangent_place(slots[lane], direction[lane]));
    any = any || places.back();
  }
  if (!any) return vector_of(0.0, w);
  return assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); });
}

void UnrolledEmitter::tangent(const Pack& pack) {
  if (pack.kind == Pack::Scalar) return scalar_tangent(pack);
  tangents_[index_of(pack)] = combine(sources(pack), pack.width);
}

UnrolledEmitter::Tangent UnrolledEmitter::combine(const std::vector<Source>& sources, std::size_t count) {
  const unsigned w = width_of(count);
  std::vector<std::set<int>> of_lane(count);
  std::set<int> all;
  for (const Source& source : sources)
    for (std::size_t lane = 0; lane < count; ++lane)
      for (const int d : directions(source.slots[lane])) of_lane[lane].insert(d), all.insert(d);
  Tangent result;
  const auto accumulate = [&](ArrayRef<int> direction) {
    Value* sum = nullptr;
    for (const Source& source : sources) {
      Value* const values = gather_tangents(source.slots, direction, w);
      if (!is_zero(values)) sum = fma(values, source.factor(w), sum);
    }
    return sum ? sum : vector_of(0.0, w);
  };
  if (all.empty()) return result;
  if (std::all_of(of_lane.begin(), of_lane.end(), [](const auto& s) { return s.size() <= 1; })) {
    for (const auto& s : of_lane) result.direction.push_back(s.empty() ? -1 : *s.begin());
    result.diagonal = accumulate(result.direction);
    return result;
  }
  for (const int d : all) result.dense[d] = accumulate(std::vector<int>(count, d));
  return result;
}

/// Order 0 stands in memory by now, or in registers.
Value* UnrolledEmitter::operand_unweighted(std::uint32_t index, int order, unsigned w) {
  const Block& block = p_.blocks[index];
  return gather(ArrayRef<Slot>(block.slots.data(), block.width), order, w);
}

std::vector<UnrolledEmitter::Source> UnrolledEmitter::sources(const Pack& pack) {
  std::vector<Source> result;
  const auto block_source = [&](std::uint32_t block, std::function<Value*(unsigned)> factor) {
    if (p_.blocks[block].lag == pack.lag) result.push_back({slots_of(p_.blocks[block]), std::move(factor)});
  };
  switch (pack.kind) {
    case Pack::Sum:
      for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c) {
        const Column& column = p_.columns[c];
        // lanes that q does not move have no directions
        if (p_.program.lags[column.source] + column.shift != pack.lag) continue;
        result.push_back({sources_of(column, pack.width),
                          [this, &column](unsigned w) { return coefficients(column.coefficients, w); }});
      }
      for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
        const packed::ProductTerm& term = p_.products[i];
        const auto times = [&](std::uint32_t other) {
          return [this, &term, other](unsigned w) {
            return mul(coefficients(term.coefficients, w), value_at_zero(other, w));
          };
        };
        block_source(term.a, times(term.b));
        block_source(term.b, times(term.a));
      }
      break;
    case Pack::Integral:
      block_source(pack.a, [this, &pack](unsigned w) {
        return mul(coefficients(pack.coefficients, w), value_at_zero(pack.b, w));
      });
      break;
    case Pack::Quotient:
      block_source(pack.a,
                   [this, &pack](unsigned w) { return b_.CreateFDiv(vector_of(1.0, w), value_at_zero(pack.b, w)); });
      block_source(pack.b, [this, &pack](unsigned w) {
        return b_.CreateFNeg(b_.CreateFDiv(value_at_zero(pack.y, w), value_at_zero(pack.b, w)));
      });
      break;
    case Pack::SquareRoot:
      block_source(pack.a,
                   [this, &pack](unsigned w) { return b_.CreateFDiv(vector_of(0.5, w), value_at_zero(pack.y, w)); });
      break;
    case Pack::Scan:
    case Pack::ScanDown:
    case Pack::Strand:
    case Pack::Join:
    case Pack::JoinDown:
    case Pack::Scalar:
      break;
  }
  return result;
}

}  // namespace maupertuis::llvm_backend

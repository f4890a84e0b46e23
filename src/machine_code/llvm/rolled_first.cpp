#include "machine_code/llvm/rolled_emitter.hpp"
#include "machine_code/llvm/sines.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <cstddef>

/// The stages up to 0, written out one after the other: they alone have values of functions, and sums over orders that
/// are so short that nothing is added up beforehand.
namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;

void RolledEmitter::first_stages() {
  open("first", {});
  passing_row_ = field(offsetof(packed::CompiledArguments, passing_row));
  for (int stage = program_.first_stage; stage <= 0; ++stage) {
    written_ = stage;
    stage_ = out_.b.getInt64(static_cast<std::uint64_t>(stage));
    rows_of_stage_.clear();
    for (int k = 0; k <= -program_.first_stage; ++k)
      rows_of_stage_.push_back(stage + k < 0 ? nullptr : row_of(stage_plus(k)));
    for (std::size_t i = 0; i < p_.packs.size(); ++i)
      if (stage + ahead_of(p_.packs[i]) >= 0) pack(i);
    for (const Block& block : p_.blocks)
      if (stage < 0 && !block.direct) renew(block);
    time_ += longest_memory + 1;  // what is in registers belongs to this stage
  }
  written_.reset();
  out_.end_function();
}

/// Σ_j a_j b_{m−j} of a stage that is written out, as convolution(); null: no terms.
Value* RolledEmitter::short_convolution(const packed::Convolution& c, bool a_ends, bool b_ends) {
  const int m = *written_ + 2 - c.lag;
  const auto value = [&](std::uint32_t index, int order) -> Value* {
    const Block& block = p_.blocks[index];
    const int ahead = 2 - block.lag;
    if (order != *written_ + ahead) return load(at(slot_at(rows_, block.first), order * row_bytes_));
    return vanishes(block, ahead) ? nullptr : newest(index, ahead);
  };
  Value* sum = nullptr;
  for (int j = b_ends ? 0 : 1; j <= (a_ends ? m : m - 1); ++j) {
    Value *const a = value(c.a, j), *const b = value(c.b, m - j);
    if (a && b) sum = plus(sum, a, b);
  }
  return sum;
}

/// Of order 0.
void RolledEmitter::functions(const Pack& pack) {
  if (pack.pairs != packed::no_block) return sines(pack);
  for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f) call_rule(p_.functions[f], ahead_of(pack));
}

void RolledEmitter::sines(const Pack& pack) {
  const std::uint32_t count = pack.last_function - pack.first_function;
  if (count == 0) return;  // the cosines of the pack before
  const Block& block = p_.blocks[pack.a];
  Value* const u =
      block.is_range ? load(slot_at(row(ahead_of(pack)), block.slots[0])) : gather(row(ahead_of(pack)), block.slots);
  const auto call = [&] { return out_.sincos(u); };
  auto [sine, cosine] = out_.features.fma ? sines_in_place(out_.b, u, call) : call();
  if (pack.width == 2 * count) {
    std::vector<int> places;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      places.push_back(static_cast<int>(lane < count ? lane : std::min(lane - count, count - 1) + lanes));
    return keep(pack, out_.b.CreateShuffleVector(sine, cosine, places));
  }
  keep(pack, sine);
  save(cosine, slot_at(row(ahead_of(pack)), pack.pairs));
  recent_[pack.pairs] = {cosine, time_};
}

}  // namespace maupertuis::llvm_backend

#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <cstddef>

/// q̈_k of a stage as a product with −M₀⁻¹, and what it changes in the coefficients of the stage: nothing in between
/// leaves the registers and is read again in another width.
namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;

void RolledEmitter::solution() {
  if (!packed::solves_by_inverse(program_.unknowns, program_.freedoms)) return;
  open_stage("solve");
  solve_by(field(offsetof(packed::CompiledArguments, inverse)),
           field(offsetof(packed::CompiledArguments, tangent_row)));
  out_.end_function();
}

void RolledEmitter::solve_by(Value* inverse, Value* tangent_row) {
  set_correction_factors(1);
  const std::vector<Value*> accelerations = product_with_inverse(inverse);
  recent_.clear(), final_.clear();
  passing_row_ = nullptr;
  ++time_;
  for (std::size_t v = 0; v < accelerations.size(); ++v) {
    const auto slot = static_cast<Slot>(v * lanes);
    final_[slot] = over_divisor(accelerations[v]);
    save(final_[slot], slot_at(row(2), slot));
    save(accelerations[v], slot_at(tangent_row, slot));
    recent_[slot] = {accelerations[v], time_};
  }
  gap();
  correct(tangent_row);
}

/// −M₀⁻¹ R_k, a vector in several sums, since products of one wait for each other.
std::vector<Value*> RolledEmitter::product_with_inverse(Value* inverse) {
  constexpr std::size_t most_sums = 16;  // in registers
  const std::size_t vectors = packed::padded(program_.unknowns) / lanes;
  const std::size_t chains = std::clamp<std::size_t>(most_sums / vectors, 2, 4);
  std::vector<std::vector<Value*>> sums(vectors, std::vector<Value*>(chains, nullptr));
  for (std::size_t d = 0; d < program_.unknowns; ++d) {
    Value* const residual = splat_of(program_.residual[d], row(0), true);
    for (std::size_t v = 0; v < vectors; ++v) {
      Value*& sum = sums[v][d % chains];
      sum = plus(sum, residual, load(slot_at(inverse, static_cast<Slot>((d * vectors + v) * lanes))));
    }
  }
  std::vector<Value*> out;
  for (auto& parts : sums) {
    parts.erase(std::remove(parts.begin(), parts.end(), nullptr), parts.end());
    for (; parts.size() > 1; parts.resize((parts.size() + 1) / 2))
      for (std::size_t i = 0; i < parts.size() / 2; ++i) parts[i] = out_.add(parts[i], parts[parts.size() - 1 - i]);
    out.push_back(parts[0]);
  }
  return out;
}

/// x / ((k + 1)(k + 2)) without the rounding of the reciprocal, which would be the same in every step.
Value* RolledEmitter::over_divisor(Value* x) {
  return out_.features.fma ? out_.fma(x, splat(reciprocal_), out_.multiply(x, splat(lack_)))
                           : out_.divide(x, splat(divisor_));
}

/// q̈_k = −x and all that follows from it, where x and the tangents in its direction are there.
void RolledEmitter::correction() {
  if (program_.unknowns != program_.freedoms) return;
  open_stage("correct");
  Value* const tangents = field(offsetof(packed::CompiledArguments, tangents));
  set_correction_factors(-1);
  for (Slot slot = 0; slot < program_.unknowns; slot += lanes)
    save(over_divisor(load(slot_at(tangents, slot))), slot_at(row(2), slot));
  const std::vector<int> lag = corrected_lags();
  for (std::size_t i = 0; i < lag.size(); ++i)
    if (const auto slot = static_cast<Slot>(i * lanes); lag[i] >= 0)
      correct(slot, lag[i], load(slot_at(tangents, slot)));
  correct_copies(tangents);
  out_.end_function();
}

/// (k + 2) q_{k+2}, as renewing them would make it; where there are no copies of x, it is made later.
void RolledEmitter::correct_copies(Value* tangents) {
  for (const Block& block : p_.blocks)
    if (p_.copies_coordinates(block))
      save(out_.multiply(over_divisor(load(slot_at(tangents, block.first))), real(stage_plus(2))),
           slot_at(row(2), block.first));
}

/// A change of q̈_k changes a coefficient of a slot of lag 2, 1, 0 by its tangent times 1, 1/(k + 1), 1/((k + 1)(k +
/// 2)). `sign`: that of the tangents.
void RolledEmitter::set_correction_factors(int sign) {
  auto& b = out_.b;
  llvm::Type* const scalar = b.getDoubleTy();
  const auto number = [&](int n) { return b.CreateSIToFP(stage_plus(n), scalar); };
  divisor_ = out_.multiply(out_.multiply(out_.number(sign, scalar), number(1)), number(2));
  reciprocal_ = out_.divide(out_.number(1, scalar), divisor_);
  lack_ = out_.multiply(out_.fma(out_.negate(reciprocal_), divisor_, out_.number(1, scalar)), reciprocal_);
  correction_factors_ = {splat(reciprocal_), splat(out_.divide(out_.number(sign, scalar), number(1))),
                         out_.number(sign, vector_)};
}

/// Tangents of what is corrected, pack by pack, each added to its coefficients as soon as it is there.
void RolledEmitter::correct(Value* tangent_row) {
  std::vector<int> lag = corrected_lags();
  const std::vector<bool> needed = needed_for_corrections(lag);
  for (std::size_t i = 0; i < p_.packs.size(); ++i) {
    if (!needed[i]) continue;
    const Pack& pack = p_.packs[i];
    ++time_;
    tangent(pack, tangent_row);
    if (pack.kind == Pack::Scalar || pack.kind == Pack::Strand) continue;
    for (Slot out = pack.out; out < pack.out + std::max(pack.strands, 1u) * lanes; out += lanes)
      if (int& own = lag[out / lanes]; own >= 0) correct(out, std::exchange(own, -1), in_register(out));
    gap();
  }
  for (std::size_t i = 0; i < lag.size(); ++i)  // what stands alone
    if (const auto slot = static_cast<Slot>(i * lanes); lag[i] >= 0)
      correct(slot, lag[i], load(slot_at(tangent_row, slot)));
}

void RolledEmitter::correct(Slot slot, int lag, Value* tangent) {
  Value* const place = slot_at(row(2 - lag), slot);
  final_[slot] = out_.fma(correction_factors_[static_cast<std::size_t>(lag)], tangent, load(place));
  save(final_[slot], place);
}

/// By eights of slots: the lag of those whose coefficients are corrected, else −1.
std::vector<int> RolledEmitter::corrected_lags() const {
  std::vector<int> lag(p_.cells / lanes + 1, -1);
  std::size_t first = packed::padded(program_.unknowns) / lanes;
  for (int l = 0; l <= 2; ++l) {
    const std::size_t end = packed::padded(program_.stored_end[static_cast<std::size_t>(l)]) / lanes;
    for (; first < end; ++first) lag[first] = l;
  }
  return lag;
}

/// Packs that a corrected slot's tangent comes from. What instructions that stand alone read is not looked up.
std::vector<bool> RolledEmitter::needed_for_corrections(const std::vector<int>& lag) const {
  std::vector<bool> needed(p_.packs.size(), false), slot_needed(p_.cells + lanes, false);
  const auto need = [&](Slot slot) { slot_needed[slot] = true; };
  const auto need_block = [&](const Pack& pack, std::uint32_t index) {
    if (index == packed::no_block || p_.blocks[index].lag != pack.lag) return;
    const Block& block = p_.blocks[index];
    for (Slot lane = 0; lane < lanes; ++lane) need(block.direct ? block.first + lane : block.slots[lane]);
  };
  bool all_before = false;
  for (std::size_t i = p_.packs.size(); i-- > 0;) {
    const Pack& pack = p_.packs[i];
    const Slot end = pack.out + std::max(pack.strands, 1u) * lanes;
    needed[i] = all_before || pack.kind == Pack::Scalar || lag[pack.out / lanes] >= 0;
    for (Slot slot = pack.out; slot < end && pack.kind != Pack::Scalar; ++slot)
      needed[i] = needed[i] || slot_needed[slot];
    if (!needed[i]) continue;
    all_before = all_before || pack.kind == Pack::Scalar;
    for (Slot slot = pack.out; slot < end && pack.strands > 0; ++slot) need(slot);
    if (pack.carry != no_slot) need(pack.carry);
    for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
      const Column& column = p_.columns[c];
      if (!column.passes_tangent) continue;
      for (Slot k = 0; k < lanes; ++k)
        need(column.kind == Column::Broadcast    ? column.source
             : column.kind == Column::Contiguous ? column.source + k
             : column.kind == Column::Reversed   ? column.source - k
                                                 : column.sources[k]);
    }
    for (std::uint32_t k = pack.first_product; k < pack.last_product; ++k)
      need_block(pack, p_.products[k].a), need_block(pack, p_.products[k].b);
    need_block(pack, pack.a);
    if (pack.kind == Pack::Quotient) need_block(pack, pack.b);
  }
  return needed;
}

}  // namespace maupertuis::llvm_backend

#include "kernel/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <cstddef>

/// All stages from 1 on in one loop, where −M₀⁻¹ solves them. So that little waits, and what waits leaves room for
/// others: sums for later stages stand between the packs of a stage (rolled_filling.cpp); so do corrections of the
/// stage before that its first packs can do without; and what these packs read of the stage before stays in registers.
namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::lanes;
using packed::rolled_group;

/// Not where a stage cannot add late terms itself, and not where instructions are called back, of which it is not known
/// what they read. (Strands belong to solutions in parts.)
bool RolledEmitter::has_later() const {
  const auto stands_apart = [](const Pack& pack) { return pack.kind == Pack::Scalar || pack.kind == Pack::Strand; };
  return packed::solves_by_inverse(program_.unknowns, program_.freedoms) &&
         std::none_of(p_.packs.begin(), p_.packs.end(), stands_apart) &&
         std::all_of(classes_.begin(), classes_.end(), [](const auto& c) { return adds_late(c.first); });
}

void RolledEmitter::later() {
  if (!has_later()) return;
  auto& b = out_.b;
  choose_slots();
  find_passing(true);
  open("later", {out_.integer()}, out_.integer());
  Value* const end = b.GetInsertBlock()->getParent()->getArg(1);
  choose_deferred();
  Value* const inverse = field(offsetof(packed::CompiledArguments, inverse));
  Deferred& d = *deferred_;
  d.tangent_row = field(offsetof(packed::CompiledArguments, tangent_row));
  begin_without_corrections();
  set_stage(b.getInt64(0));
  for (const Block& block : p_.blocks)
    if (!block.direct) renew(block);
  add_up_first();
  const std::vector<Slot> kept = kept_slots();
  std::vector<Value*> values;
  for (const Slot slot : kept) values.push_back(final_.count(slot) ? final_[slot] : load(slot_at(row(2), slot)));
  values.push_back(llvm::Constant::getNullValue(vector_));  // 0 as long as all is finite
  const std::vector<Value*> last =
      out_.loop(b.getInt64(1), end, values, [&](Value* stage, const std::vector<Value*>& now) {
        final_.clear(), kept_.clear();
        for (std::size_t i = 0; i < kept.size(); ++i) kept_[kept[i]] = now[i];
        set_stage_before(stage);
        later_stage(stage, end, inverse);
        std::vector<Value*> next;
        for (const Slot slot : kept) next.push_back(final_.at(slot));
        next.push_back(now.back());
        for (Slot slot = 0; slot < program_.unknowns; slot += lanes)
          next.back() = out_.fma(final_.at(slot), llvm::Constant::getNullValue(vector_), next.back());
        return next;
      });
  final_.clear(), kept_.clear();
  set_stage_before(end);
  correct_before(d.packs.size());
  deferred_.reset(), filling_.reset();
  std::fill(phase_.begin(), phase_.end(), 0);
  find_passing(false);
  Value* const is_finite = b.CreateAndReduce(b.CreateFCmpOEQ(last.back(), last.back()));
  b.CreateRet(b.CreateZExt(is_finite, out_.integer()));
}

/// One turn of the loop.
void RolledEmitter::later_stage(Value* stage, Value* end, Value* inverse) {
  auto& b = out_.b;
  set_stage(stage);
  for (int phase = 0; phase < rolled_group; ++phase) {
    Value* const position = b.CreateAnd(b.CreateSub(stage, b.getInt64(static_cast<std::uint64_t>(1 + phase))),
                                        b.getInt64(rolled_group - 1));
    sums_of_stage_[static_cast<std::size_t>(phase)] = out_.at(sums_, b.CreateShl(position, 6));
  }
  has_next_ = b.CreateICmpSLT(stage_plus(1), end);
  Filling& f = *filling_;
  f.passed = f.next = f.read = 0;
  begin_packs();
  run_packs(0, p_.packs.size());
  gap();
  correct_before(deferred_->packs.size());
  solve_by(inverse, deferred_->tangent_row);
  while (f.next < f.slots.size()) fill_next();
  for (const Block& block : p_.blocks)
    if (!block.direct && turn_of(block) == 0) renew(block);
}

/// The stage before the first is corrected: by tangents that are 0 nothing changes.
void RolledEmitter::begin_without_corrections() {
  const auto clear = [&](Slot slot) {
    save(llvm::Constant::getNullValue(vector_), slot_at(deferred_->tangent_row, slot));
  };
  for (Slot slot = 0; slot < program_.unknowns; slot += lanes) clear(slot);
  for (std::size_t i = 0; i < p_.packs.size(); ++i)
    if (deferred_->now[i]) clear(p_.packs[i].out);
}

void RolledEmitter::set_stage_before(Value* stage) {
  set_stage(out_.b.CreateSub(stage, out_.b.getInt64(1)));
  set_correction_factors(1);
  recent_.clear();
  deferred_->done = 0;
  switch_to_stage_before();
}

// ------------------------------------------------------------------------------------- corrections of the stage before

/// What the first packs of a stage read of the stage before is corrected at its end; the rest, which would keep them
/// waiting, between those packs.
void RolledEmitter::choose_deferred() {
  Deferred d;
  d.lag = corrected_lags();
  std::vector<int> lag(d.lag.size(), -1);
  for (std::size_t i = 0; i < p_.packs.size() && p_.packs[i].level == p_.packs[0].level; ++i)
    for (const std::size_t v : read_of_stage_before(i)) lag[v] = d.lag[v];
  d.now = needed_for_corrections(lag);
  const std::vector<bool> needed = needed_for_corrections(d.lag);
  d.turn_of.assign(d.lag.size(), 0);
  for (std::size_t i = 0; i < p_.packs.size(); ++i) {
    if (!needed[i] || d.now[i]) continue;
    d.packs.push_back(i);
    if (const std::size_t v = p_.packs[i].out / lanes; d.lag[v] >= 0) d.turn_of[v] = d.packs.size();
  }
  deferred_ = std::move(d);
  filling_->gaps =
      p_.packs.size() + 2 + static_cast<std::size_t>(std::count(deferred_->now.begin(), deferred_->now.end(), true));
  for (std::size_t slot = 0; slot < filling_->slots.size(); ++slot)
    for (const auto& [key, members] : filling_->slots[slot])
      for (const std::size_t i : members)
        filling_->turn[slot] = std::max(
            {filling_->turn[slot], turn_of(p_.blocks[p_.convolutions[i].a]), turn_of(p_.blocks[p_.convolutions[i].b])});
}

/// Of the operands of the first packs, those of the highest order that a stage has found at its end: they need not go
/// through memory.
std::vector<Slot> RolledEmitter::kept_slots() const {
  std::vector<Slot> out;
  const auto keep = [&](std::uint32_t index) {
    if (index == packed::no_block) return;
    const Block& block = p_.blocks[index];
    const bool is_corrected =
        block.direct && block.first % lanes == 0 && block.first >= program_.unknowns && is_found_now(block.first);
    const bool is_coordinate = !block.direct && block.is_range && block.slots[0] < program_.unknowns;
    if ((is_corrected || is_coordinate) && block.lag == 0 &&
        std::find(out.begin(), out.end(), block.first) == out.end())
      out.push_back(block.first);
  };
  for (std::size_t i = 0; i < p_.packs.size() && p_.packs[i].level == p_.packs[0].level; ++i) {
    const Pack& pack = p_.packs[i];
    for (std::uint32_t k = pack.first_product; k < pack.last_product; ++k)
      keep(p_.products[k].a), keep(p_.products[k].b);
    keep(pack.a), keep(pack.b), keep(pack.y);
  }
  constexpr std::size_t most = 16;  // registers
  if (out.size() > most) out.resize(most);
  return out;
}

/// Whether a vector is corrected at the end of a stage.
bool RolledEmitter::is_found_now(Slot first) const {
  for (std::size_t i = 0; i < p_.packs.size(); ++i)
    if (deferred_->now[i] && p_.packs[i].out == first) return deferred_->lag[first / lanes] >= 0;
  return false;
}

std::vector<std::size_t> RolledEmitter::vectors_of(const Block& block) const {
  std::vector<std::size_t> out;
  for (const Slot slot : block.slots) out.push_back(slot / lanes);
  return out;
}

/// How many deferred corrections come before all that a block holds.
std::size_t RolledEmitter::turn_of(const Block& block) const {
  std::size_t turn = 0;
  for (const std::size_t v : vectors_of(block)) turn = std::max(turn, deferred_->turn_of[v]);
  return turn;
}

/// Vectors of which a pack may read the highest order that the stage before has found.
std::vector<std::size_t> RolledEmitter::read_of_stage_before(std::size_t index) const {
  const Pack& pack = p_.packs[index];
  std::vector<std::size_t> out;
  for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
    const Column& column = p_.columns[c];
    for (Slot k = 0; k < lanes; ++k) {
      const Slot slot = column.kind == Column::Broadcast    ? column.source
                        : column.kind == Column::Contiguous ? column.source + k
                        : column.kind == Column::Reversed   ? column.source - k
                                                            : column.sources[k];
      if (ahead_of(pack) + column.shift == 1 - program_.lags[slot]) out.push_back(slot / lanes);
    }
  }
  const auto add = [&](std::uint32_t block) {
    if (block == packed::no_block) return;
    for (const std::size_t v : vectors_of(p_.blocks[block])) out.push_back(v);
  };
  for (std::uint32_t k = pack.first_product; k < pack.last_product; ++k) add(p_.products[k].a), add(p_.products[k].b);
  add(pack.a), add(pack.b), add(pack.y);
  return out;
}

/// At the end of a stage.
void RolledEmitter::correct_now(Value* tangent_row) {
  for (std::size_t i = 0; i < p_.packs.size(); ++i) {
    if (!deferred_->now[i]) continue;
    correct_pack(i, tangent_row);
    gap();
  }
}

void RolledEmitter::correct_pack(std::size_t index, Value* tangent_row) {
  const Pack& pack = p_.packs[index];
  ++time_;
  tangent(pack, tangent_row);
  if (const int lag = deferred_->lag[pack.out / lanes]; lag >= 0) correct(pack.out, lag, in_register(pack.out));
}

/// Until `count` of them are there.
void RolledEmitter::correct_before(std::size_t count) {
  Deferred& d = *deferred_;
  if (d.done >= count) return;
  switch_to_stage_before();
  while (d.done < count) {
    correct_pack(d.packs[d.done++], d.tangent_row);
    for (const Block& block : p_.blocks)
      if (!block.direct && turn_of(block) == d.done) renew(block);
  }
  switch_to_stage_before();
}

void RolledEmitter::correct_up_to(const std::vector<std::size_t>& vectors) {
  std::size_t turn = 0;
  for (const std::size_t v : vectors) turn = std::max(turn, deferred_->turn_of[v]);
  correct_before(turn);
}

/// And back.
void RolledEmitter::switch_to_stage_before() {
  Deferred& d = *deferred_;
  std::swap(stage_, d.stage), std::swap(rows_of_stage_, d.rows_of_stage),
      std::swap(correction_factors_, d.correction_factors);
  std::swap(recent_, d.recent), std::swap(scan_, d.scan);
  std::swap(passing_row_, d.passing_row), std::swap(time_, d.time);
}

}  // namespace maupertuis::llvm_backend

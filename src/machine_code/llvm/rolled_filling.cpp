#include "machine_code/llvm/rolled_emitter.hpp"

#include <algorithm>

/// Sums for later stages between the packs of a stage (rolled_later.cpp). What waits in a stage, from one running sum
/// to the next and from the residual to q̈, leaves the processor idle, and these wait for nothing of it. Convolutions
/// share *slots* between the packs, and each has a *phase*, so that a quarter of them begins a group in each stage, and
/// every stage has the same amount of work.
///
/// In stage s, of which nothing is final, a group of the stages s + 1 … s + 4 begins for the convolutions of phase s
/// mod 4; for the others what stage s − 1 has made final goes to those of their group that follow stage s. (Stage s
/// itself has it from late_terms().) Before the first group a stage is added up by itself.
namespace maupertuis::llvm_backend {

using llvm::Value;
using packed::rolled_group;

/// Convolutions in the order of their packs, a few to a slot between the packs.
void RolledEmitter::choose_slots() {
  constexpr std::size_t most_slots = 8, in_slot = 2;
  const std::size_t count = p_.convolutions.size(),
                    slots = count == 0 ? 0 : std::clamp<std::size_t>(count / in_slot, 1, most_slots);
  Filling f;
  f.slots.resize(slots), f.last.resize(slots);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t slot = i * slots / count;
    phase_[i] = slot % rolled_group;
    f.slots[slot][class_of(p_.convolutions[i])].push_back(i);
    f.last[slot] = i;
  }
  const std::vector<bool> corrected = needed_for_corrections(corrected_lags());
  f.gaps = p_.packs.size() + 2 + static_cast<std::size_t>(std::count(corrected.begin(), corrected.end(), true));
  filling_ = std::move(f);
}

/// Between two packs: the slots that are due, if the stage has read the sums that they write over.
void RolledEmitter::gap() {
  if (!filling_) return;
  Filling& f = *filling_;
  ++f.passed;
  while (f.next < f.slots.size() && f.next * f.gaps < f.passed * f.slots.size() && f.last[f.next] < f.read) fill_next();
}

/// The next slot: what there is to do for it in this stage.
void RolledEmitter::fill_next() {
  auto& b = out_.b;
  Filling& f = *filling_;
  const auto& members = f.slots[f.next];
  const int phase = static_cast<int>(f.next++ % rolled_group);
  llvm::Function* const function = b.GetInsertBlock()->getParent();
  const auto block = [&] { return llvm::BasicBlock::Create(out_.context, "", function); };
  llvm::BasicBlock* const needed = block();
  llvm::BasicBlock *const alone = block(), *const grouped = block(), *const begins = block(), *const done = block();
  Value* const position =
      b.CreateAnd(b.CreateSub(stage_, b.getInt64(static_cast<std::uint64_t>(phase))), b.getInt64(rolled_group - 1));
  b.CreateCondBr(has_next_, needed, done);
  b.SetInsertPoint(needed);
  b.CreateCondBr(b.CreateICmpSLT(stage_, b.getInt64(static_cast<std::uint64_t>(phase + rolled_group))), alone, grouped);
  const auto each = [&](llvm::BasicBlock* in, const auto& body) {
    b.SetInsertPoint(in);
    for (const auto& [key, which] : members) each_of(key, which, body);
    b.CreateBr(done);
  };
  each(alone, [&](const Class& c, Value* x, Value* y, Value* sums) {
    save(sum_of_next(c, x, y), out_.at(sums, b.CreateShl(position, 6)));
  });
  b.SetInsertPoint(grouped);
  llvm::SwitchInst* const choice = b.CreateSwitch(position, begins);
  each(begins, [&](const Class& c, Value* x, Value* y, Value* sums) { add_up_group(c, {1, phase}, x, y, sums); });
  for (int passed = 1; passed < rolled_group; ++passed) {
    llvm::BasicBlock* const passing = block();
    choice->addCase(b.getInt64(static_cast<std::uint64_t>(passed)), passing);
    each(passing, [&](const Class& c, Value* x, Value* y, Value* sums) { pass_on(c, passed - 1, 1, x, y, sums); });
  }
  b.SetInsertPoint(done);
}

/// Of one class and one slot, so that they are neighbours: one after the other if they are few, else in a loop.
void RolledEmitter::each_of(const Class& key, const std::vector<std::size_t>& members,
                            const std::function<void(const Class&, Value*, Value*, Value*)>& body) {
  constexpr std::size_t few = 2;
  if (members.size() > few) return loop_over(key, members, out_.b.getInt64(0), out_.b.getInt64(members.size()), body);
  for (const std::size_t i : members) {
    const packed::Convolution& c = p_.convolutions[i];
    body(key, slot_at(rows_, p_.blocks[c.a].first), slot_at(rows_, p_.blocks[c.b].first),
         at(sums_, static_cast<std::int64_t>(sums_of_[i]) * sums_bytes));
  }
}

/// Of stage 1. Where a product is that of two newest coefficients, that stage has it twice among its late terms.
void RolledEmitter::add_up_first() {
  for (std::size_t slot = 0; slot < filling_->slots.size(); ++slot)
    for (const auto& [key, members] : filling_->slots[slot])
      each_of(key, members, [&](const Class& c, Value* x, Value* y, Value* sums) {
        const auto [lag, a_ahead, b_ahead] = c;
        Value* sum = sum_of_next(c, x, y);
        if (lag == 1 + a_ahead + b_ahead)
          sum = out_.fma(out_.negate(load(at(x, (2 - lag + a_ahead) * row_bytes_))),
                         load(at(y, (1 - a_ahead) * row_bytes_)), sum);
        save(sum,
             at(sums, static_cast<std::int64_t>((rolled_group - slot % rolled_group) % rolled_group) * vector_bytes));
      });
}

/// Of the stage s + 1, which belongs to no group: what is final up to stage s − 1.
Value* RolledEmitter::sum_of_next(const Class& c, Value* x, Value* y) {
  auto& b = out_.b;
  const auto [lag, a_ahead, b_ahead] = c;
  const int first = std::max(0, 2 - b_ahead);
  Value* const end = stage_plus(4 - lag - std::max(0, 2 - a_ahead));  // m = s + 3 − lag
  Value* const top =
      out_.at(y, b.CreateNSWMul(stage_plus(3 - lag - first), b.getInt64(static_cast<std::uint64_t>(row_bytes_))));
  return out_.loop(b.getInt64(static_cast<std::uint64_t>(first)), end,
                   {llvm::Constant::getNullValue(vector_), at(x, first * row_bytes_), top},
                   [&](Value*, const std::vector<Value*>& now) {
                     return std::vector<Value*>{out_.fma(load(now[1]), load(now[2]), now[0]), at(now[1], row_bytes_),
                                                at(now[2], -row_bytes_)};
                   })[0];
}

}  // namespace maupertuis::llvm_backend

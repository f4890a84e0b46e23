#include "machine_code/llvm/rolled_emitter.hpp"

#include "kernel/packed/code.hpp"

#include <algorithm>
#include <cstddef>

/// All stages from 1 on in one loop, where −M₀⁻¹ solves them. Sums for later stages, which wait for nothing of a stage,
/// stand between its packs and its corrections (rolled_filling.cpp).
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
  Value* const inverse = field(offsetof(packed::CompiledArguments, inverse));
  Value* const tangent_row = field(offsetof(packed::CompiledArguments, tangent_row));
  set_stage(b.getInt64(0));
  for (const Block& block : p_.blocks)
    if (!block.direct) renew(block);
  add_up_first();
  Value* const zero = llvm::Constant::getNullValue(vector_);  // as long as all is finite
  Value* const last = out_.loop(b.getInt64(1), end, {zero}, [&](Value* stage, const std::vector<Value*>& now) {
    final_.clear();
    later_stage(stage, end, inverse, tangent_row);
    Value* check = now[0];
    for (Slot slot = 0; slot < program_.unknowns; slot += lanes) check = out_.fma(final_.at(slot), zero, check);
    return std::vector<Value*>{check};
  })[0];
  filling_.reset();
  std::fill(phase_.begin(), phase_.end(), 0);
  find_passing(false);
  Value* const is_finite = b.CreateAndReduce(b.CreateFCmpOEQ(last, last));
  b.CreateRet(b.CreateZExt(is_finite, out_.integer()));
}

/// One turn of the loop.
void RolledEmitter::later_stage(Value* stage, Value* end, Value* inverse, Value* tangent_row) {
  auto& b = out_.b;
  set_stage(stage);
  for (int phase = 0; phase < rolled_group; ++phase) {
    Value* const position = b.CreateAnd(b.CreateSub(stage, b.getInt64(static_cast<std::uint64_t>(1 + phase))),
                                        b.getInt64(rolled_group - 1));
    sums_of_stage_[static_cast<std::size_t>(phase)] = out_.at(sums_, b.CreateShl(position, 6));
  }
  has_next_ = b.CreateICmpSLT(stage_plus(1), end);
  filling_->passed = filling_->next = filling_->read = 0;
  begin_packs();
  run_packs(0, p_.packs.size());
  gap();
  solve_by(inverse, tangent_row);
  while (filling_->next < filling_->slots.size()) fill_next();
  for (const Block& block : p_.blocks)
    if (!block.direct) renew(block);
}

}  // namespace maupertuis::llvm_backend

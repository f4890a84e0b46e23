#include "kernel/llvm/unrolled_emitter.hpp"

#include "kernel/packed/code.hpp"

namespace maupertuis::llvm_backend {

using llvm::Type;
using llvm::Value;
using packed::Pack;
using packed::PackedProgram;

UnrolledEmitter::UnrolledEmitter(Emission& out, const PackedProgram& program, std::size_t stride, int order)
    : module_(*out.module),
      context_(out.context),
      b_(context_),
      p_(program),
      fuses_(out.features.fma),
      stride_(stride),
      order_(order),
      n_(program.program.unknowns),
      pack_of_(program.program.slots, nullptr),
      tangents_(program.packs.size()),
      second_order_(program.packs.size()) {
  for (const Pack& pack : p_.packs)
    for (unsigned lane = 0; lane < pack.width; ++lane) {
      if (pack.kind == Pack::Scalar && p_.program.instructions[pack.instruction].second != no_slot)
        pack_of_[p_.program.instructions[pack.instruction].second] = &pack;
      pack_of_[pack.out + lane] = &pack;
    }
}

void UnrolledEmitter::run() {
  declare();
  find_awaited();
  look_ahead_ = !follows_ && has_second_tangents();
  for (int stage = p_.program.first_stage; stage < order_; ++stage) {
    begin_stage(stage);
    const auto waits_for_solution = [&](const Pack& pack) {
      return follows_ && stage >= 0 && !awaited_[index_of(pack)];
    };
    for (const Pack& pack : p_.packs)
      if (!waits_for_solution(pack)) dynamics(pack);
    if (stage == 0) factor();
    if (stage >= 0) {
      solve();
      correct();
    }
    for (const Pack& pack : p_.packs)
      if (waits_for_solution(pack)) dynamics(pack);
    if (stage == 1 && look_ahead_) find_second_tangents();
    renew_blocks();
    keep_recent();
  }
  finish();
}

/// Which packs the residual of a stage waits for. Where they hold nothing that follows q̈ but the coordinates, as with a
/// constant M, all others come after the solution and need no corrections.
void UnrolledEmitter::find_awaited() {
  awaited_.assign(p_.packs.size(), false);
  std::vector<Slot> open(p_.program.residual.begin(), p_.program.residual.end());
  while (!open.empty()) {
    const Slot slot = open.back();
    open.pop_back();
    if (slot < n_ || !pack_of_[slot] || awaited_[index_of(*pack_of_[slot])]) continue;
    awaited_[index_of(*pack_of_[slot])] = true;
    for (const Slot operand : read_at_once(*pack_of_[slot])) open.push_back(operand);
  }
  follows_ = std::none_of(p_.packs.begin(), p_.packs.end(),
                          [&](const Pack& pack) { return awaited_[index_of(pack)] && is_corrected(pack.out); });
}

/// Slots whose coefficient of the same stage a pack reads.
std::vector<Slot> UnrolledEmitter::read_at_once(const Pack& pack) const {
  std::vector<Slot> out;
  const auto add_block = [&](std::uint32_t index, int delay) {
    if (index == packed::no_block || p_.blocks[index].lag != pack.lag + delay) return;
    out.insert(out.end(), p_.blocks[index].slots.begin(), p_.blocks[index].slots.begin() + p_.blocks[index].width);
  };
  if (pack.kind == Pack::Scalar) {
    const Instruction& i = p_.program.instructions[pack.instruction];
    const bool is_sum = i.op == Op::Linear || i.op == Op::Products;
    const auto add = [&](Slot slot, std::uint32_t shift) {
      if (slot != no_slot && (!is_sum || p_.program.lags[slot] + static_cast<int>(shift) >= pack.lag))
        out.push_back(slot);
    };
    add(i.a, 0), add(i.b, 0);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
      add(p_.program.terms[t].a, p_.program.terms[t].shift), add(p_.program.terms[t].b, 0);
    return out;
  }
  for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c)
    for (const Slot slot : sources_of(p_.columns[c], pack.width))
      if (p_.program.lags[slot] + p_.columns[c].shift >= pack.lag) out.push_back(slot);
  for (std::uint32_t t = pack.first_product; pack.kind == Pack::Sum && t < pack.last_product; ++t)
    add_block(p_.products[t].a, 0), add_block(p_.products[t].b, 0);
  for (const std::uint32_t block : {pack.a, pack.b}) add_block(block, 0), add_block(block, 1);
  return out;
}

void UnrolledEmitter::declare() {
  Type* const pointer = b_.getPtrTy();
  auto* const type = llvm::FunctionType::get(b_.getInt32Ty(), {pointer}, false);
  function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, "expand", module_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  b_.SetInsertPoint(llvm::BasicBlock::Create(context_, "", function_));
  const auto field = [&](std::size_t offset) {
    return b_.CreateLoad(pointer, b_.CreateConstInBoundsGEP1_64(b_.getInt8Ty(), function_->getArg(0), offset));
  };
  rows_ = field(offsetof(packed::CompiledArguments, rows));
  given_q_ = field(offsetof(packed::CompiledArguments, q));
  given_v_ = field(offsetof(packed::CompiledArguments, v));
  coefficients_ = field(offsetof(packed::CompiledArguments, coefficients));
  term_coefficients_ = field(offsetof(packed::CompiledArguments, term_coefficients));
  constants_ = field(offsetof(packed::CompiledArguments, constants));
  sincos_ = field(offsetof(packed::CompiledArguments, sincos));
  elementary_ = field(offsetof(packed::CompiledArguments, elementary));
  wide_ = width_of(n_);
}

/// The sum of all q̈_k times 0 tells whether all were finite.
void UnrolledEmitter::finish() {
  Value* const zero = vector_of(0.0, wide_);
  Value* bad = b_.CreateFCmpUNE(b_.CreateFMul(check_, zero), zero);
  if (wide_ > 1) bad = b_.CreateOrReduce(bad);
  b_.CreateRet(b_.CreateZExt(bad, b_.getInt32Ty()));
}

}  // namespace maupertuis::llvm_backend

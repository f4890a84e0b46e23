#include "kernel/llvm/straight_emitter.hpp"

#include "kernel/packed/compiled.hpp"

namespace maupertuis::llvm_backend {

using llvm::Type;
using llvm::Value;
using packed::Pack;
using packed::PackedProgram;

StraightEmitter::StraightEmitter(Emission& out, const PackedProgram& program, std::size_t stride, int order)
    : module_(*out.module), context_(out.context), b_(context_), p_(program), fuses_(out.features.fma), stride_(stride), order_(order),
      n_(program.program.unknowns), pack_of_(program.program.slots, nullptr), tangents_(program.packs.size()),
      second_order_(program.packs.size()) {
  for (const Pack& pack : p_.packs)
    for (unsigned lane = 0; lane < pack.width; ++lane) {
      if (pack.kind == Pack::Scalar && p_.program.instructions[pack.instruction].second != no_slot)
        pack_of_[p_.program.instructions[pack.instruction].second] = &pack;
      pack_of_[pack.out + lane] = &pack;
    }
}

void StraightEmitter::run() {
  declare();
  look_ahead_ = has_second_tangents();
  for (int stage = p_.program.first_stage; stage < order_; ++stage) {
    begin_stage(stage);
    for (const Pack& pack : p_.packs) dynamics(pack);
    if (stage == 0) factor();
    if (stage >= 0) {
      solve();
      correct();
    }
    if (stage == 1 && look_ahead_) find_second_tangents();
    renew_blocks();
  }
  finish();
}

void StraightEmitter::declare() {
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
void StraightEmitter::finish() {
  Value* const zero = vector_of(0.0, wide_);
  Value* bad = b_.CreateFCmpUNE(b_.CreateFMul(check_, zero), zero);
  if (wide_ > 1) bad = b_.CreateOrReduce(bad);
  b_.CreateRet(b_.CreateZExt(bad, b_.getInt32Ty()));
}

}  // namespace maupertuis::llvm_backend

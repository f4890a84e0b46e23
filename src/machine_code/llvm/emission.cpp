#include "machine_code/llvm/emission.hpp"

#include "machine_code/llvm/emitters.hpp"

#include <llvm/IR/Intrinsics.h>
#include <llvm/Target/TargetMachine.h>

namespace maupertuis::llvm_backend {

using llvm::Value;

Emission::Emission(llvm::TargetMachine& machine, const Features& f)
    : module(std::make_unique<llvm::Module>("maupertuis", context)), b(context), features(f) {
  module->setTargetTriple(machine.getTargetTriple().str());
  module->setDataLayout(machine.createDataLayout());
  module->setPICLevel(llvm::PICLevel::BigPIC);
}

llvm::Type* Emission::real(int width) {
  if (width == 1) return b.getDoubleTy();
  return llvm::FixedVectorType::get(b.getDoubleTy(), static_cast<unsigned>(width));
}

llvm::Function* Emission::function(const std::string& name, const std::vector<llvm::Type*>& parameters, bool exported,
                                   llvm::Type* result) {
  const auto linkage = exported ? llvm::Function::ExternalLinkage : llvm::Function::InternalLinkage;
  auto* const type = llvm::FunctionType::get(result ? result : b.getVoidTy(), parameters, false);
  llvm::Function* const f = llvm::Function::Create(type, linkage, name, *module);
  f->addFnAttr(llvm::Attribute::NoUnwind);  // so no tables for unwinding either
  if (!exported) f->addFnAttr(llvm::Attribute::NoInline);
  for (llvm::Argument& argument : f->args())
    if (argument.getType()->isPointerTy()) argument.addAttr(llvm::Attribute::NoAlias);
  b.SetInsertPoint(llvm::BasicBlock::Create(context, "", f));
  return f;
}

// -------------------------------------------------------------------------------------------------------------- memory

/// Addresses are multiples of the size of what they hold, up to a cache line.
static llvm::Align alignment(llvm::Type* type) {
  const std::uint64_t bytes = type->getPrimitiveSizeInBits().getFixedValue() / 8;
  return llvm::Align(std::min<std::uint64_t>(bytes, 64));
}

Value* Emission::load(llvm::Type* type, Value* address) { return b.CreateAlignedLoad(type, address, alignment(type)); }

void Emission::store(Value* value, Value* address) {
  b.CreateAlignedStore(value, address, alignment(value->getType()));
}

Value* Emission::at(Value* address, std::int64_t offset) {
  return offset == 0 ? address : b.CreateInBoundsPtrAdd(address, b.getInt64(static_cast<std::uint64_t>(offset)));
}
Value* Emission::at(Value* address, Value* offset) { return b.CreateInBoundsPtrAdd(address, offset); }

// ---------------------------------------------------------------------------------------------------------- arithmetic

Value* Emission::number(double value, llvm::Type* like) { return llvm::ConstantFP::get(like, value); }

Value* Emission::splat(Value* scalar, llvm::Type* like) {
  auto* const vector = llvm::dyn_cast<llvm::FixedVectorType>(like);
  return vector ? b.CreateVectorSplat(vector->getNumElements(), scalar) : scalar;
}

Value* Emission::fma(Value* x, Value* y, Value* z) {
  if (!features.fma) return add(multiply(x, y), z);
  return b.CreateIntrinsic(llvm::Intrinsic::fma, {x->getType()}, {x, y, z});
}
Value* Emission::square_root(Value* x) { return b.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, x); }
Value* Emission::absolute(Value* x) { return b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, x); }
Value* Emission::minimum(Value* x, Value* y) {
  return b.CreateSelect(b.CreateFCmpOGE(x, y), y, b.CreateSelect(b.CreateFCmpUNO(y, y), y, x));
}
Value* Emission::maximum(Value* x, Value* y) {
  return b.CreateSelect(b.CreateFCmpOLE(x, y), y, b.CreateSelect(b.CreateFCmpUNO(y, y), y, x));
}

/// Markstein: the remainder of a first guess is exact, and its quotient is added to it.
Value* Emission::quotient(Value* x, Value* y, Value* reciprocal) {
  if (!features.fma) return divide(x, y);
  Value* const guess = multiply(x, reciprocal);
  Value* const remainder = fma(negate(guess), y, x);
  return fma(remainder, reciprocal, guess);
}

// --------------------------------------------------------------------------------------------------------------- loops

std::vector<Value*> Emission::loop(Value* begin, Value* end, std::vector<Value*> carried,
                                   const std::function<std::vector<Value*>(Value*, const std::vector<Value*>&)>& body) {
  llvm::Function* const f = b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const before = b.GetInsertBlock();
  llvm::BasicBlock* const head = llvm::BasicBlock::Create(context, "", f);
  llvm::BasicBlock* const turn = llvm::BasicBlock::Create(context, "", f);
  llvm::BasicBlock* const after = llvm::BasicBlock::Create(context, "", f);
  b.CreateBr(head);
  b.SetInsertPoint(head);
  std::vector<llvm::PHINode*> phis;
  for (Value* const value : carried) {
    phis.push_back(b.CreatePHI(value->getType(), 2));
    phis.back()->addIncoming(value, before);
  }
  llvm::PHINode* const i = b.CreatePHI(begin->getType(), 2);
  i->addIncoming(begin, before);
  b.CreateCondBr(b.CreateICmpSLT(i, end), turn, after);
  b.SetInsertPoint(turn);
  std::vector<Value*> now(phis.begin(), phis.end());
  const std::vector<Value*> next = body(i, now);
  i->addIncoming(b.CreateNUWAdd(i, llvm::ConstantInt::get(i->getType(), 1)), b.GetInsertBlock());
  for (std::size_t k = 0; k < phis.size(); ++k) phis[k]->addIncoming(next[k], b.GetInsertBlock());
  b.CreateBr(head);
  b.SetInsertPoint(after);
  return now;
}

void Emission::when(Value* condition, const std::function<void()>& body) {
  llvm::Function* const f = b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const inside = llvm::BasicBlock::Create(context, "", f);
  llvm::BasicBlock* const after = llvm::BasicBlock::Create(context, "", f);
  b.CreateCondBr(condition, inside, after);
  b.SetInsertPoint(inside);
  body();
  b.CreateBr(after);
  b.SetInsertPoint(after);
}

}  // namespace maupertuis::llvm_backend

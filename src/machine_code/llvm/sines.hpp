#pragma once
#include <llvm/IR/IRBuilder.h>

#include <functional>
#include <utility>

namespace maupertuis::llvm_backend {

using SineAndCosine = std::pair<llvm::Value*, llvm::Value*>;

/// sin x and cos x, a number or a vector of them, within one unit in the last place and equal at every width: written
/// out where they are wanted, so that neither a call nor memory stands between them and what waits for them. `beyond`
/// writes what gives both where some |x| is 2²⁰ or more, or not a number. Precondition: the processor has fused
/// products.
SineAndCosine sines_in_place(llvm::IRBuilder<>& b, llvm::Value* x, const std::function<SineAndCosine()>& beyond);

}  // namespace maupertuis::llvm_backend

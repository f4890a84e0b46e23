#include "machine_code/llvm/emission.hpp"
#include "machine_code/llvm/emitters.hpp"

namespace maupertuis::llvm_backend {

/// Arithmetic, a root, and a call of SLEEF's: what the other emitters rest on.
void emit_self_test(Emission& out, const machine_code::Request& request) {
  const llvm::Function* const f = out.function("self_test", {out.pointer(), out.pointer()});
  llvm::Value* const x = out.load(out.real(request.width), f->getArg(0));
  const auto [sine, cosine] = out.sincos(x);
  llvm::Value* const sum = out.fma(out.multiply(x, cosine), cosine, out.multiply(sine, sine));
  out.store(out.square_root(sum), f->getArg(1));
  out.end_function();
}

}  // namespace maupertuis::llvm_backend

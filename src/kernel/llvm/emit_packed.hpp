#pragma once
#include "kernel/packed/layout.hpp"

namespace llvm {
class Module;
}

namespace maupertuis::llvm_backend {

/// Whether a packed program can be compiled as a whole: few unknowns, no constraints, not too many operations.
bool can_emit_packed(const packed::PackedProgram& program, int order);

/// Defines `expand` (packed::CompiledExpand) in the module: `order` stages after those of the start, unrolled, on rows of
/// `stride` doubles.
void emit_packed(llvm::Module& module, const packed::PackedProgram& program, std::size_t stride, int order);

}  // namespace maupertuis::llvm_backend

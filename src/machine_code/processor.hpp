#pragma once

namespace maupertuis {

/// Vector instructions, each kind with those before it. Avx2: with fused multiply-add; Avx512: F, DQ and VL.
enum class VectorInstructions { None, Avx2, Avx512 };

/// Those that this processor has; fewer where the environment variable MAUPERTUIS_INSTRUCTIONS says `none` or `avx2`,
/// so that a run can be repeated as on another processor. Asked once: a process keeps to one kind.
VectorInstructions vector_instructions();

/// LLVM's name of the processor that code is for where the environment variable holds something back; else "": this
/// one.
const char* code_processor();

}  // namespace maupertuis

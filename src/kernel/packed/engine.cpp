#include "kernel/packed/engine.hpp"

#include "kernel/program/processor.hpp"

namespace maupertuis::packed {

namespace baseline { extern const Engine engine; }
#ifdef MAUPERTUIS_X86_64
namespace avx2 { extern const Engine engine; }
namespace avx512 { extern const Engine engine; }
#endif

const Engine& engine() {
#ifdef MAUPERTUIS_X86_64
  if (vector_instructions() == VectorInstructions::Avx512) return avx512::engine;
  if (vector_instructions() == VectorInstructions::Avx2) return avx2::engine;
#endif
  return baseline::engine;
}

}  // namespace maupertuis::packed

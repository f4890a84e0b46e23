#include "kernel/packed/engine.hpp"

namespace maupertuis::packed {

namespace baseline { extern const Engine engine; }
#ifdef MAUPERTUIS_X86_64
namespace avx2 { extern const Engine engine; }
namespace avx512 { extern const Engine engine; }
#endif

const Engine& engine() {
#ifdef MAUPERTUIS_X86_64
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return avx512::engine;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2::engine;
#endif
  return baseline::engine;
}

}  // namespace maupertuis::packed

#include "kernel/dynamics/evaluate.hpp"

namespace maupertuis::dynamics {

Evaluate best_evaluate() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (avx512 && avx512_evaluate()) return avx512_evaluate();
  if (avx2 && avx2_evaluate()) return avx2_evaluate();
#endif
  return baseline_evaluate();
}

}  // namespace maupertuis::dynamics

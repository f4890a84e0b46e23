#include "kernel/sparse/loops.hpp"

namespace maupertuis::sparse {
namespace {

Loops best_loops() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (avx512 && avx512_loops().factor) return avx512_loops();
  if (avx2 && avx2_loops().factor) return avx2_loops();
#endif
  return baseline_loops();
}

}  // namespace

const Loops& loops() {
  static const Loops best = best_loops();
  return best;
}

}  // namespace maupertuis::sparse

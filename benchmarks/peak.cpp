// The double-precision peak of one core: fused products in independent accumulators, for each instruction set that the
// processor has. Each result is compared with the closed form of its recurrence.
#include "measure.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

constexpr int accumulators = 12, turns = 1000;

/// x ← a x + b, `turns` times, in every lane of every accumulator: a fixed point at 1 keeps the numbers in range.
#define PEAK(NAME, FEATURES, LANES)                                                                     \
  typedef double NAME##_vector __attribute__((vector_size(8 * LANES)));                                 \
  __attribute__((target(FEATURES), noinline, optimize("fp-contract=fast"))) double NAME(double start) { \
    NAME##_vector x[accumulators];                                                                      \
    const NAME##_vector a = NAME##_vector{} + 0.75, b = NAME##_vector{} + 0.25;                         \
    for (int i = 0; i < accumulators; ++i) x[i] = NAME##_vector{} + start;                              \
    for (int turn = 0; turn < turns; ++turn) {                                                          \
      _Pragma("GCC unroll 12") for (int i = 0; i < accumulators; ++i) x[i] = x[i] * a + b;              \
      asm volatile("");                                                                                 \
    }                                                                                                   \
    double sum = 0;                                                                                     \
    for (int i = 0; i < accumulators; ++i)                                                              \
      for (int lane = 0; lane < LANES; ++lane) sum += x[i][lane];                                       \
    return sum / (accumulators * LANES);                                                                \
  }
PEAK(avx512, "avx512f,fma", 8)
PEAK(avx2, "avx2,fma", 4)

void peak(benchmark::State& state, double (*kernel)(double), int lanes, bool available) {
  if (!available) return state.SkipWithError("the processor lacks it");
  // 1 + (start − 1) 0.75^turns is 1 to all digits.
  if (std::abs(kernel(2.0) - 1) > 1e-15) return state.SkipWithError("wrong result");
  double start = 2;
  for (auto _ : state) benchmark::DoNotOptimize(start = kernel(start));
  state.counters["flops"] = benchmark::Counter(
      2.0 * lanes * accumulators * turns * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(peak, avx512, avx512, 8, __builtin_cpu_supports("avx512f") != 0);
BENCHMARK_CAPTURE(peak, avx2, avx2, 4, __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));

}  // namespace

BENCHMARK_MAIN();

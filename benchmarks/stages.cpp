// Each stage against the number of links of a chain, with Google Benchmark.
#include "chain.hpp"

#include <benchmark/benchmark.h>

#include <maupertuis/certificate.hpp>
#include <maupertuis/simulation.hpp>
#include <stdexcept>

namespace {

using namespace maupertuis;

void read_text(benchmark::State& state) {
  const std::string text = bench::chain_text(static_cast<int>(state.range(0)));
  if (bench::read(text)->system.coordinates.size() != static_cast<std::size_t>(state.range(0)))
    throw std::runtime_error("wrong number of freedoms");
  for (auto _ : state) benchmark::DoNotOptimize(bench::read(text));
  state.SetComplexityN(state.range(0));
}

void residual(benchmark::State& state) {
  const std::string text = bench::chain_text(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    state.PauseTiming();
    const auto model = bench::read(text);  // a context of its own, so that nothing is interned yet
    state.ResumeTiming();
    benchmark::DoNotOptimize(bench::derive(model));
  }
  state.SetComplexityN(state.range(0));
}

void certificate(benchmark::State& state) {
  const EquationsOfMotion equations = bench::derive(bench::read(bench::chain_text(static_cast<int>(state.range(0)))));
  if (!certify(equations, nullptr).passed()) throw std::runtime_error("not certified");
  for (auto _ : state) benchmark::DoNotOptimize(certify(equations, nullptr));
  state.SetComplexityN(state.range(0));
}

void one_second(benchmark::State& state) {
  const auto model = bench::read(bench::chain_text(static_cast<int>(state.range(0))));
  const EquationsOfMotion equations = bench::derive(model);
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto result = simulate(*model, equations, {}, diagnostics);
    if (!result || !result->ok() || result->statistics.energy_drift > 1e-11) throw std::runtime_error("wrong motion");
    state.counters["steps"] = static_cast<double>(result->statistics.steps);
    state.counters["us_per_step"] = 1e6 * result->statistics.seconds / static_cast<double>(result->statistics.steps);
  }
}

BENCHMARK(read_text)->RangeMultiplier(4)->Range(2, 128)->Complexity()->Unit(benchmark::kMillisecond);
BENCHMARK(residual)->RangeMultiplier(4)->Range(2, 128)->Complexity()->Unit(benchmark::kMillisecond);
BENCHMARK(certificate)->RangeMultiplier(4)->Range(2, 128)->Complexity()->Unit(benchmark::kMillisecond);
BENCHMARK(one_second)->RangeMultiplier(2)->Range(1, 16)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();

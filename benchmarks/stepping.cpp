// Taylor steps of chains of pendulums by the public API (Google Benchmark): compiled and by the interpreter alone.
// Before anything is timed, the energy has to be conserved, and the compiled motion has to be that of the interpreter.
//
//     bench_stepping --benchmark_filter=compiled/8
#include "chain.hpp"
#include "measure.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <maupertuis/integrator.hpp>
#include <string>

namespace {

using namespace maupertuis;
using bench::require;

/// order 0: the one that follows from the tolerance.
TaylorStepper stepper_of(const bench::ChainMotion& chain, Backend backend, int order = 0) {
  TaylorOptions options;
  options.backend = backend;
  options.order = order;
  return TaylorStepper(chain.kernel, chain.parameters, options);
}

void run(TaylorStepper& stepper, const bench::ChainMotion& chain, double time) {
  stepper.start(0, chain.q, chain.v);
  while (stepper.time() != time) require(stepper.step(time).ending == StepEnding::None, "the run ended early");
}

/// The largest relative error of the energy after any step.
double energy_drift(TaylorStepper& stepper, const bench::ChainMotion& chain, double time) {
  stepper.start(0, chain.q, chain.v);
  const double begin = bench::chain_energy(chain.q, chain.v).value;
  double worst = 0, terms = 0;
  while (stepper.time() != time) {
    require(stepper.step(time).ending == StepEnding::None, "the run ended early");
    const bench::ChainEnergy energy = bench::chain_energy(stepper.q(), stepper.v());
    worst = std::max(worst, std::abs(energy.value - begin));
    terms = std::max(terms, energy.terms);
  }
  return worst / terms;
}

/// Both motions are computed to rounding errors, which chaos lets grow: a short time.
void compare_with_interpreter(TaylorStepper& stepper, const bench::ChainMotion& chain, double time) {
  TaylorStepper other = stepper_of(chain, Backend::Interpreter);
  run(other, chain, time);
  run(stepper, chain, time);
  for (std::size_t i = 0; i < chain.q.size(); ++i) require(std::abs(stepper.q()[i] - other.q()[i]) < 1e-11, "state");
}

/// Arguments: links, milliseconds of motion, order.
void steps(benchmark::State& state, Backend backend) {
  try {
    const bench::ChainMotion chain = bench::chain_motion(static_cast<int>(state.range(0)));
    const double time = 1e-3 * static_cast<double>(state.range(1));
    TaylorStepper stepper = stepper_of(chain, backend, static_cast<int>(state.range(2)));
    if (backend == Backend::Compiled) compare_with_interpreter(stepper, chain, std::min(time, 0.5));
    if (backend == Backend::Compiled) bench::settle(stepper, chain);
    const double drift = energy_drift(stepper, chain, time);
    require(drift <= 2e-12, "energy");
    std::size_t steps = 0;
    for (auto _ : state) {
      run(stepper, chain, time);
      steps += stepper.steps();
    }
    state.SetLabel(stepper.backend().compiled ? "compiled" : "interpreter");
    state.counters["energy_drift"] = drift;
    state.counters["order"] = stepper.order();
    state.counters["steps_of_a_run"] = static_cast<double>(stepper.steps());
    state.counters["step"] =
        benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

void sizes(benchmark::internal::Benchmark* rows) {
  rows->ArgNames({"links", "ms", "order"})->Unit(benchmark::kMillisecond);
  for (const auto& [links, milliseconds] : {std::pair{1, 100'000},
                                            {2, 1'000'000},
                                            {4, 100'000},
                                            {8, 20'000},
                                            {16, 10'000},
                                            {32, 5000},
                                            {50, 2000},
                                            {100, 1000},
                                            {200, 500},
                                            {500, 200},
                                            {1000, 100}})
    rows->Args({links, milliseconds, 0});
}

BENCHMARK_CAPTURE(steps, compiled, Backend::Compiled)->Apply(sizes)->Args({2, 1'000'000, 26});
BENCHMARK_CAPTURE(steps, interpreter, Backend::Interpreter)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();

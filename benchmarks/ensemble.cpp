// Batches of trajectories of a chain of pendulums on one thread (Google Benchmark). Before anything is timed, the
// energy of every trajectory has to be conserved, and some of them have to agree with a stepper of their own.
#include "chain.hpp"

#include <benchmark/benchmark.h>

#include <maupertuis/ensemble.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace maupertuis;

constexpr std::size_t trajectories = 256;

/// m = l = 1, g = 9.81, at rest from angles linearly from 2.0 to 2.5 rad, spread by 0.1 rad.
struct Batch {
  MotionKernel motion;
  std::size_t n;
  std::vector<double> q, v;

  explicit Batch(int links)
      : motion(motion_kernel(bench::derive(bench::read(bench::chain_text(links))))),
        n(static_cast<std::size_t>(links)),
        v(trajectories * n, 0.0) {
    for (std::size_t i = 0; i < trajectories; ++i)
      for (std::size_t k = 0; k < n; ++k) {
        const double linear = n > 1 ? 0.5 * static_cast<double>(k) / static_cast<double>(n - 1) : 0;
        q.push_back(2.0 + linear + 0.1 * (static_cast<double>(i) / (trajectories - 1) - 0.5));
      }
  }

  /// order 0: the one that follows from the tolerance.
  EnsembleResult run(double duration, int width, Backend backend, int order) const {
    EnsembleOptions options;
    options.order = order;
    options.backend = backend;
    options.width = width;
    options.threads = 1;
    options.energy_terms = motion.energy_terms;
    return advance_ensemble(motion.kernel, {q, v, motion.parameters, {}, {&duration, 1}, {}}, options);
  }
};

void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("wrong result: ") + what);
}

void check(const Batch& batch, int width, Backend backend, int order) {
  const double duration = 1;
  const EnsembleResult result = batch.run(duration, width, backend, order);
  for (const TrajectoryEnding& ending : result.endings)
    require(ending.ok() && !ending.alone && ending.energy_drift < 1e-13, "energy");
  for (std::size_t i = 0; i < trajectories; i += 37) {
    TaylorStepper stepper(batch.motion.kernel, batch.motion.parameters, {});
    stepper.start(0, std::span(batch.q).subspan(i * batch.n, batch.n),
                  std::span(batch.v).subspan(i * batch.n, batch.n));
    while (stepper.time() != duration) require(stepper.step(duration).ending == StepEnding::None, "stepper");
    for (std::size_t k = 0; k < batch.n; ++k) require(std::abs(stepper.q()[k] - result.q_of(i)[k]) < 1e-11, "state");
  }
}

void ensemble(benchmark::State& state, Backend backend) {
  const Batch batch(static_cast<int>(state.range(0)));
  const int width = static_cast<int>(state.range(1));
  const int order = static_cast<int>(state.range(2));
  check(batch, width, backend, order);
  const double duration = 10;
  std::size_t steps = 0;
  for (auto _ : state) {
    const EnsembleResult result = batch.run(duration, width, backend, order);
    for (const TrajectoryEnding& ending : result.endings) steps += ending.steps;
    state.SetLabel(result.backend);
  }
  const double motion = duration * static_cast<double>(trajectories) * static_cast<double>(state.iterations());
  state.counters["trajectory_seconds_per_second"] = benchmark::Counter(motion, benchmark::Counter::kIsRate);
  state.counters["time_of_a_lane_step"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(ensemble, interpreter, Backend::Interpreter)
    ->ArgNames({"links", "width", "order"})
    ->ArgsProduct({{1, 2, 4, 8}, {1, 8, 16}, {0}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ensemble, compiled, Backend::Compiled)
    ->ArgNames({"links", "width", "order"})
    ->ArgsProduct({{1, 2, 4, 8}, {8, 16}, {0, 26}})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();

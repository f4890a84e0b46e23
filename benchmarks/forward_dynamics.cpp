// Accelerations per call, of chains and of an arm with seven joints; beside MuJoCo's mj_forward where it is installed.
#include "chain.hpp"

#include <benchmark/benchmark.h>
#ifdef MAUPERTUIS_MUJOCO
#include <mujoco/mujoco.h>
#endif

#include <maupertuis/forward_dynamics.hpp>
#include <maupertuis/simulation.hpp>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace {

using namespace maupertuis;

struct Case {
  EquationsOfMotion equations;
  DynamicsSource source;
  Kernel kernel;
  ForwardDynamics dynamics;
  std::vector<double> q, v, a;

  explicit Case(const std::string& text, Backend backend)
      : equations(bench::derive(bench::read(text))),
        source(dynamics_source(equations)),
        kernel(build_kernel(source.kernel)),
        dynamics(kernel, source.inputs, {.backend = backend, .cache = false}),
        q(kernel.freedoms()),
        v(q),
        a(q) {
    dynamics.set_parameters(source.parameters);
    if (const CompileReport& report = dynamics.compile_report(); report.compiled != (backend == Backend::Compiled))
      throw std::runtime_error("no compiled code: " + report.trouble);
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = 0.3 + 0.11 * static_cast<double>(i % 7), v[i] = 0.5 - 0.2 * static_cast<double>(i % 3);
    check();
  }

  /// R(q, q̇, q̈) = 0 by the program with accelerations, and q̈ as a workspace finds it.
  void check() {
    KernelWorkspace work(kernel, 1);
    work.set_parameters(source.parameters);
    std::vector<double> rest(q.size()), weight(q.size());
    if (dynamics.accelerations(0, q, v, {}, a) != KernelStatus::Ok || work.evaluate(0, q, v) != KernelStatus::Ok)
      throw std::runtime_error("no accelerations");
    dynamics.forces(0, q, v, a, {}, rest);
    dynamics.bias(0, q, v, {}, weight);
    double largest = 0;
    for (const double x : a) largest = std::max(largest, std::abs(x));
    for (std::size_t i = 0; i < q.size(); ++i)
      if (!(std::abs(rest[i]) <= 1e-10 * (1 + std::abs(weight[i]))) ||
          !(std::abs(a[i] - work.acceleration(i)) <= 1e-9 * largest))
        throw std::runtime_error("wrong accelerations");
  }

  void run(benchmark::State& state) {
    for (auto _ : state) {
      dynamics.accelerations(0, q, v, {}, a);
      benchmark::DoNotOptimize(a.data());
      q[0] += 1e-9 * a[0];
    }
    if (dynamics.compile_report().compiled) state.counters["compile_ms"] = 1e3 * dynamics.compile_report().seconds;
  }
};

void run(const std::string& text, Backend backend, benchmark::State& state) {
  try {
    Case(text, backend).run(state);
  } catch (const std::runtime_error& error) {
    state.SkipWithError(error.what());
  }
}

void chain(benchmark::State& state, Backend backend) {
  run(bench::chain_text(static_cast<int>(state.range(0))), backend, state);
}

void arm(benchmark::State& state, Backend backend) {
  std::ifstream file(PROJECT_DIR "/tests/problems/arm_seven_joints.lag");
  std::stringstream text;
  text << file.rdbuf();
  run(text.str(), backend, state);
}

void interpreted_chain(benchmark::State& state) { chain(state, Backend::Interpreter); }
void compiled_chain(benchmark::State& state) { chain(state, Backend::Compiled); }
void interpreted_arm(benchmark::State& state) { arm(state, Backend::Interpreter); }
void compiled_arm(benchmark::State& state) { arm(state, Backend::Compiled); }

BENCHMARK(interpreted_chain)
    ->Name("chain")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Arg(500)
    ->Arg(1000)
    ->Unit(benchmark::kNanosecond);
// Longer ones are declined.
BENCHMARK(compiled_chain)
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kNanosecond);
BENCHMARK(interpreted_arm)->Name("arm")->Unit(benchmark::kNanosecond);
BENCHMARK(compiled_arm)->Unit(benchmark::kNanosecond);

#ifdef MAUPERTUIS_MUJOCO

/// The same chain: relative angles φ_i = θ_i − θ_{i−1} about the axis −y … in the plane x z, a point mass at the end of
/// each link.
std::string mujoco_chain(int links) {
  std::string head, tail;
  for (int i = 0; i < links; ++i) {
    head += std::string("<body pos='0 0 ") + (i == 0 ? "0" : "-1") +
            "'><joint type='hinge' axis='0 -1 0'/><inertial pos='0 0 -1' mass='1' diaginertia='1e-9 1e-9 1e-9'/>";
    tail += "</body>";
  }
  return "<mujoco><compiler boundmass='0' boundinertia='0'/><option gravity='0 0 -9.81'><flag contact='disable' "
         "constraint='disable'/></option>"
         "<worldbody>" +
         head + tail + "</worldbody></mujoco>";
}

void mujoco(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  mjVFS files;
  mj_defaultVFS(&files);
  const std::string text = mujoco_chain(n);
  mj_makeEmptyFileVFS(&files, "chain.xml", static_cast<int>(text.size()));
  text.copy(static_cast<char*>(files.filedata[mj_findFileVFS(&files, "chain.xml")]), text.size());
  char error[300] = "";
  mjModel* model = mj_loadXML("chain.xml", &files, error, sizeof error);
  mj_deleteVFS(&files);
  if (!model) throw std::runtime_error(error);
  mjData* data = mj_makeData(model);
  Case ours(bench::chain_text(n), Backend::Interpreter);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    data->qpos[i] = ours.q[k] - (i > 0 ? ours.q[k - 1] : 0);
    data->qvel[i] = ours.v[k] - (i > 0 ? ours.v[k - 1] : 0);
  }
  mj_forward(model, data);
  double sum = 0, largest = 0, worst = 0;
  for (const double x : ours.a) largest = std::max(largest, std::abs(x));
  for (int i = 0; i < n; ++i)
    sum += data->qacc[i], worst = std::max(worst, std::abs(sum - ours.a[static_cast<std::size_t>(i)]));
  if (!(worst <= 1e-6 * largest)) throw std::runtime_error("MuJoCo has other accelerations");
  for (auto _ : state) {
    mj_forward(model, data);
    benchmark::DoNotOptimize(data->qacc);
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}
// The depth of its XML ends near 100 links.
BENCHMARK(mujoco)->Arg(1)->Arg(2)->Arg(4)->Arg(8)->Arg(20)->Arg(50)->Unit(benchmark::kNanosecond);

#endif

}  // namespace

BENCHMARK_MAIN();

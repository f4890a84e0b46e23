// Taylor steps of chains of pendulums: what a step costs, by the public API.
#include "chain.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <maupertuis/integrator.hpp>
#include <maupertuis/kernel.hpp>
#include <maupertuis/simulation.hpp>
#include <stdexcept>
#include <vector>

namespace {

using namespace maupertuis;

/// The time that this thread ran: others may share the machine.
struct Clock {
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
};

struct Chain {
  std::shared_ptr<const Model> model;
  std::vector<double> parameters, q, v;
  std::shared_ptr<Kernel> kernel;
};

Chain chain(int links) {
  Chain c;
  c.model = bench::read(bench::chain_text(links));
  const EquationsOfMotion equations = bench::derive(c.model);
  KernelSource source;
  for (const Coordinate& x : c.model->system.coordinates) source.coordinates.push_back(x.q);
  for (const Parameter& p : c.model->system.parameters) source.parameters.push_back(p.symbol), c.parameters.push_back(p.name == "g" ? 9.81 : 1.0);
  source.residual = equations.balance();
  c.kernel = std::make_shared<Kernel>(build_kernel(source));
  for (int i = 0; i < links; ++i) c.q.push_back(2.0 + 0.5 * i / std::max(1, links - 1)), c.v.push_back(0);
  return c;
}

double seconds(double begin) { return Clock::now() - begin; }

void measure(int links, double time, Backend backend) {
  const Chain c = chain(links);
  const auto before = Clock::now();
  TaylorOptions options;
  options.backend = backend;
  TaylorStepper stepper(*c.kernel, c.parameters, options);
  const double setup = seconds(before);
  double best = 1e9;
  std::size_t steps = 0;
  for (int round = 0; round < 5; ++round) {
    stepper.start(0, c.q, c.v);
    const auto begin = Clock::now();
    while (stepper.time() != time)
      if (stepper.step(time).ending != StepEnding::None) throw std::runtime_error("the run ended early");
    best = std::min(best, seconds(begin));
    steps = stepper.steps();
  }
  KernelWorkspace work(*c.kernel, 20);
  work.set_parameters(c.parameters);
  if (backend == Backend::Compiled) work.compile({false, 20, true, {}});
  const int turns = std::max(10, 20000 / links);
  double expand = 1e9;
  for (int round = 0; round < 5; ++round) {
    const auto begin = Clock::now();
    for (int i = 0; i < turns; ++i) work.expand(0, c.q, c.v);
    expand = std::min(expand, seconds(begin) / turns);
  }
  fmt::print("n = {:4}: {:9.3f} µs a step ({} steps, {:.1f} ms), expansion alone {:9.3f} µs, set-up {:.1f} ms\n", links,
             1e6 * best / static_cast<double>(steps), steps, 1e3 * best, 1e6 * expand, 1e3 * setup);
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 2) {
    measure(std::atoi(arguments[1]), std::atof(arguments[2]), count > 3 ? Backend::Compiled : Backend::Interpreter);
    return 0;
  }
  for (const auto& [links, time] : std::vector<std::pair<int, double>>{{1, 1000}, {2, 1000}, {4, 200}, {8, 100}, {16, 50}, {32, 10}, {100, 2}})
    for (const Backend backend : {Backend::Interpreter, Backend::Compiled}) measure(links, time, backend);
}

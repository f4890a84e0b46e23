// A fixed amount of work, for counting instructions (scripts/instructions): nothing here depends on time.
//
//     bench_workload steps LINKS COUNT        Taylor steps of a chain by the interpreter
//     bench_workload forward LINKS COUNT      accelerations of a chain at a point
//     bench_workload derive LINKS COUNT       text to equations of motion, certified
#include "chain.hpp"
#include "measure.hpp"

#include <cmath>
#include <cstdlib>
#include <maupertuis/certificate.hpp>
#include <maupertuis/forward_dynamics.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/simulation.hpp>

namespace {

using namespace maupertuis;
using bench::require;

void steps(int links, int count) {
  const bench::ChainMotion chain = bench::chain_motion(links);
  TaylorOptions options;
  options.backend = Backend::Interpreter;
  TaylorStepper stepper(chain.kernel, chain.parameters, options);
  stepper.start(0, chain.q, chain.v);
  for (int i = 0; i < count; ++i) require(stepper.step(1e6).ending == StepEnding::None, "a step failed");
  const bench::ChainEnergy begin = bench::chain_energy(chain.q, chain.v),
                           end = bench::chain_energy(stepper.q(), stepper.v());
  require(std::abs(end.value - begin.value) <= 1e-12 * (begin.terms + end.terms), "energy");
}

void forward(int links, int count) {
  const EquationsOfMotion equations = bench::derive(bench::read(bench::chain_text(links)));  // owns the expressions
  const DynamicsSource source = dynamics_source(equations);
  const Kernel kernel = build_kernel(source.kernel);
  ForwardDynamics dynamics(kernel, source.inputs);
  dynamics.set_parameters(source.parameters);
  std::vector<double> q(kernel.freedoms(), 0.3), v(q.size(), 0.5), a(q.size()), rest(q.size());
  for (int i = 0; i < count; ++i) require(dynamics.accelerations(0, q, v, {}, a) == KernelStatus::Ok, "accelerations");
  dynamics.forces(0, q, v, a, {}, rest);
  for (const double x : rest) require(std::abs(x) <= 1e-9 * static_cast<double>(links), "forces");
}

void derive(int links, int count) {
  for (int i = 0; i < count; ++i)
    require(certify(bench::derive(bench::read(bench::chain_text(links))), nullptr).passed(), "certificate");
}

}  // namespace

int main(int arguments, char** argument) {
  require(arguments == 4, "three arguments are expected");
  const std::string what = argument[1];
  const int links = std::atoi(argument[2]), count = std::atoi(argument[3]);
  if (what == "steps")
    steps(links, count);
  else if (what == "forward")
    forward(links, count);
  else if (what == "derive")
    derive(links, count);
  else
    require(false, ("no work named " + what).c_str());
}

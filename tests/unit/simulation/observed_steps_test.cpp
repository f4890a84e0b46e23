// Observables of a run: found when they are asked for, and not at every step.
#include <maupertuis/integrator.hpp>
#include <maupertuis/kernel.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include "../model_text.hpp"

using namespace maupertuis;

namespace {

/// Springs in a ring that stiffen; the energy is observable 0, x_0 x_1' the other.
std::string ring(int masses) {
  std::string text = "dimensionless\nparam k = 1, b = 0.3\n";
  for (int i = 0; i < masses; ++i) text += "coord x" + std::to_string(i) + " : number\n";
  for (int i = 0; i < masses; ++i) {
    const std::string x = "x" + std::to_string(i), next = "x" + std::to_string((i + 1) % masses);
    text += "T += 1/2 " + x + "'^2\nV += 1/2 k (" + x + " - " + next + ")^2 + 1/4 b (" + x + " - " + next + ")^4\n";
  }
  return text + "start x0 = 1, x1' = 0.5\n";
}

Kernel kernel_of(const ModelText& m) {
  DynamicsSource source = dynamics_source(m.equations);
  source.kernel.observables = {m.equations.energy_function,
                               m.equations.system->coordinates[0].q * m.equations.system->coordinates[1].velocity};
  return build_kernel(source.kernel);
}

const std::vector<double> parameters{1, 0.3};

}  // namespace

TEST_CASE("observables of an expansion are those of the point, whenever they are asked for") {
  const ModelText m(ring(10));
  const Kernel kernel = kernel_of(m);
  KernelWorkspace work(kernel, 20), point(kernel, 20);
  work.set_parameters(parameters), point.set_parameters(parameters);
  std::vector<double> q(10), v(10);
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 10; ++i) q[i] = 0.1 * static_cast<double>(i) - round, v[i] = 0.3 - 0.2 * round;
    REQUIRE(work.expand(0, q, v) == KernelStatus::Ok);
    REQUIRE(point.evaluate(0, q, v) == KernelStatus::Ok);
    for (int times = 0; times < 2; ++times) {
      CHECK(work.observable(0) == point.observable(0));
      CHECK(work.observable(1) == q[0] * v[1]);
    }
  }
}

TEST_CASE("a stepper has observables at every so-manieth step, and none in between") {
  const ModelText m(ring(10));
  const Kernel kernel = kernel_of(m);
  TaylorOptions options;
  options.backend = Backend::Interpreter;
  TaylorStepper all(kernel, parameters, options);
  options.observed_steps = 3;
  TaylorStepper some(kernel, parameters, options);
  std::vector<double> q(10), v(10);
  q[0] = 1, v[1] = 0.5;
  all.start(0, q, v), some.start(0, q, v);
  for (int step = 0; step < 10; ++step) {
    all.step(100), some.step(100);
    REQUIRE(all.time() == some.time());
    REQUIRE(all.step_start().observables.size() == 2);
    CHECK(some.step_start().q == all.step_start().q);
    if (step % 3 == 0)
      CHECK(some.step_start().observables == all.step_start().observables);
    else
      CHECK(some.step_start().observables.empty());
    CHECK(some.sample(some.time()).observables == all.sample(all.time()).observables);
  }
}

TEST_CASE("the energy of many coordinates is looked at along the run: a term that pumps it in is seen") {
  ModelText conserved(ring(10) + "run 20\n");
  SimulationOptions options;
  options.errors = ErrorEstimates::None;
  const auto r = simulate(conserved.model, conserved.equations, options, conserved.diagnostics);
  REQUIRE(r);
  CHECK(r->statistics.energy_drift > 0);
  CHECK(r->statistics.energy_drift < 1e-14);
  // With a large tolerance it drifts, and most within the run.
  options.tolerance = 1e-5;
  const auto rough = simulate(conserved.model, conserved.equations, options, conserved.diagnostics);
  REQUIRE(rough);
  CHECK(rough->statistics.energy_drift > 1e-9);
}

// bench_first_step LINKS: from the text of a chain to its first compiled step, once, in a fresh process and with nothing read from
// a cache. Prints {"links", "cpu_seconds", "compile_seconds"}; the processor time is that of the whole process, loading included.
#include "chain.hpp"
#include "measure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <maupertuis/integrator.hpp>

int main(int, char** arguments) {
  using namespace maupertuis;
  const bench::ChainMotion chain = bench::chain_motion(std::atoi(arguments[1]));
  TaylorOptions options;
  options.backend = Backend::Compiled;
  options.cache = false;
  TaylorStepper stepper(chain.kernel, chain.parameters, options);
  stepper.start(0, chain.q, chain.v);
  const Step step = stepper.step(0.01);
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);

  const bench::ChainEnergy begin = bench::chain_energy(chain.q, chain.v), end = bench::chain_energy(stepper.q(), stepper.v());
  bench::require(step.ending == StepEnding::None && stepper.backend().compiled, "no compiled step: " + stepper.backend().trouble);
  bench::require(std::abs(end.value - begin.value) <= 1e-13 * begin.terms, "energy");
  fmt::print("{{\"links\": {}, \"cpu_seconds\": {:.6f}, \"compile_seconds\": {:.6f}}}\n", chain.q.size(),
             static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec), stepper.backend().compile_seconds);
}

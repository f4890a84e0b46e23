// bench_first_step LINKS: from the text of a chain to its first compiled step, once, in a fresh process and with
// nothing read from a cache. Prints {"links", "cpu_seconds", "compiled"}; the processor time is that of the whole
// process, loading included. Where compiled code does not apply the step is the interpreter's, and "compiled" is false.
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

  const bench::ChainEnergy begin = bench::chain_energy(chain.q, chain.v),
                           end = bench::chain_energy(stepper.q(), stepper.v());
  bench::require(step.ending == StepEnding::None, ("no step: " + step.reason).c_str());
  bench::require(std::abs(end.value - begin.value) <= 1e-13 * begin.terms, "energy");
  fmt::print("{{\"links\": {}, \"cpu_seconds\": {:.6f}, \"compiled\": {}}}\n", chain.q.size(),
             static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec), stepper.backend().compiled);
}

// Systems of particles: a step by the compiled code and by the interpreter, on the widest vectors of this processor or
// on those that MAUPERTUIS_INSTRUCTIONS allows. Every row first has its energy checked by a closed form.
//
//     bench_particles [WORDS OF A NAME]
#include "particles.hpp"

#include "chain.hpp"
#include "measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <maupertuis/integrator.hpp>
#include <maupertuis/simulation.hpp>

namespace {

using namespace maupertuis;

struct Motion {
  Kernel kernel;
  std::vector<double> parameters, q, v;
  double derivation = 0;  // s
};

Motion motion_of(const bench::Particles& particles) {
  const double begin = bench::thread_seconds();
  const auto model = bench::read(particles.text);
  DynamicsSource source = dynamics_source(bench::derive(model));
  source.kernel.observables.clear();
  Motion motion{build_kernel(source.kernel), source.parameters, particles.q, particles.v};
  motion.derivation = bench::thread_seconds() - begin;
  return motion;
}

struct Measured {
  double step = 0, derivation = 0, compilation = 0, energy = 0;
  std::size_t steps = 0, of_a_run = 0;
  bool compiled = false;
};

void run(TaylorStepper& stepper, const Motion& motion, double time) {
  stepper.start(0, motion.q, motion.v);
  while (stepper.time() != time) bench::require(stepper.step(time).ending == StepEnding::None, "the run ended early");
}

Measured measure(const bench::Particles& particles, Backend backend) {
  const Motion motion = motion_of(particles);
  Measured out;
  out.derivation = motion.derivation;
  TaylorOptions options;
  options.backend = backend;
  const double begin = bench::thread_seconds();
  TaylorStepper stepper(motion.kernel, motion.parameters, options);
  out.compilation = bench::thread_seconds() - begin;
  const auto energy = [&](std::span<const double> q, std::span<const double> v) {
    return particles.energy(particles.parameters, q.data(), v.data(), q.size());
  };
  run(stepper, motion, particles.time);
  out.compiled = stepper.backend().compiled;
  out.of_a_run = stepper.steps();
  const double first = energy(motion.q, motion.v);
  out.energy = std::abs(energy(stepper.q(), stepper.v()) - first) / std::max(1e-300, std::abs(first));
  bench::require(out.energy < 1e-11, "the energy");
  double least = 1e300;
  for (double all = 0; all < 1.0;) {
    const double start = bench::thread_seconds();
    run(stepper, motion, particles.time);
    const double seconds = bench::thread_seconds() - start;
    all += seconds;
    least = std::min(least, seconds / static_cast<double>(stepper.steps()));
  }
  out.step = least;
  return out;
}

std::string with_unit(double seconds) {
  return seconds < 1e-6 ? fmt::format("{:.0f} ns", 1e9 * seconds) : fmt::format("{:.3g} µs", 1e6 * seconds);
}

void row(const bench::Particles& particles) {
  const Measured compiled = measure(particles, Backend::Compiled),
                 interpreted = measure(particles, Backend::Interpreter);
  const std::string pair =
      particles.pairs > 1 ? with_unit(compiled.step / static_cast<double>(particles.pairs)) : std::string();
  fmt::print("| {} | {}{} | {} | {} | {} | {:.1e} | {:.2f} s, {:.2f} s |\n", particles.name, with_unit(compiled.step),
             compiled.compiled ? "" : " (interpreter)", pair, with_unit(interpreted.step), compiled.of_a_run,
             compiled.energy, compiled.derivation, compiled.compilation);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print(
      "| particles | a step | a pair | by the interpreter | steps of a run | energy | derived, compiled "
      "|\n|---|---|---|---|---|---|---|\n");
  int wrong = 0;
  for (const bench::Particles& particles :
       {bench::kepler(), bench::henon_heiles(), bench::outer_solar_system(), bench::pleiades(), bench::bodies(8),
        bench::bodies(32), bench::bodies(64), bench::lennard_jones(), bench::spring_lattice(6), bench::toda(100),
        bench::fput(100)}) {
    if (argc > 1 && particles.name.find(argv[1]) == std::string::npos) continue;
    try {
      row(particles);
    } catch (const std::exception& error) {
      ++wrong;
      fmt::print("| {} | {} | | | | | |\n", particles.name, error.what());
    }
  }
  return wrong;
}

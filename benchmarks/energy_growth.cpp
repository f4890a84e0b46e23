// How the energy error grows with the number of steps: with √t where rounding errors are independent (Brouwer's law),
// with t where they are not. Kepler's orbit and the double pendulum, compiled steps at rounding level;
// bench_energy_growth [STEPS], 10⁷ by default.
#include "chain.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <numeric>
#include <stdexcept>

namespace {

using namespace maupertuis;

constexpr char kepler[] =
    "system kepler\ndimensionless\nparam m = 1, k = 1\ncoord x, y : number\nT = 1/2 m (x'^2 + y'^2)\nV = -k/(x^2 + "
    "y^2)^(1/2)\n"
    "start x = 0.4, y = 0, x' = 0, y' = 2\nrun 1\n";

double energy(const Sample& sample, std::size_t terms) {
  return std::accumulate(sample.observables.begin(), sample.observables.begin() + static_cast<std::ptrdiff_t>(terms),
                         0.0);
}

void measure(const char* name, const std::string& text, const std::vector<double>& q, const std::vector<double>& v,
             double largest) {
  const MotionKernel motion = motion_kernel(bench::derive(bench::read(text)));
  TaylorOptions options;
  options.backend = Backend::Compiled;
  TaylorStepper stepper(motion.kernel, motion.parameters, options);
  stepper.start(0, q, v);
  const Sample first = stepper.sample(0);
  const double scale = std::accumulate(first.observables.begin(),
                                       first.observables.begin() + static_cast<std::ptrdiff_t>(motion.energy_terms),
                                       0.0, [](double sum, double x) { return sum + std::abs(x); });
  const double begin = energy(first, motion.energy_terms);
  double next = 1e3;
  double sum = 0;
  std::size_t count = 0;
  fmt::print("{}{}\n", name, stepper.backend().compiled ? "" : " (interpreter)");
  while (stepper.steps() < static_cast<std::size_t>(largest)) {
    if (stepper.step(1e300).ending != StepEnding::None) throw std::runtime_error("the run ended early");
    if (stepper.steps() % 64 != 0) continue;
    const double error = (energy(stepper.step_start(), motion.energy_terms) - begin) / scale;
    sum += error * error, ++count;
    if (static_cast<double>(stepper.steps()) < next) continue;
    fmt::print("  {:9} steps: mean error {:.1e} since the last line, over √steps {:.1e}\n", stepper.steps(),
               std::sqrt(sum / static_cast<double>(count)), std::sqrt(sum / static_cast<double>(count) / next));
    sum = 0, count = 0;
    next *= 10;
  }
}

}  // namespace

int main(int count, char** arguments) {
  const double steps = count > 1 ? std::atof(arguments[1]) : 1e7;
  measure("Kepler, e = 0.6", kepler, {0.4, 0}, {0, 2}, steps);
  measure("double pendulum", bench::chain_text(2), {2.0, 2.5}, {0, 0}, steps);
}

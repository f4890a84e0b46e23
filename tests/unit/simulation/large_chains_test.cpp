// Steps of large systems: what rounding of the state makes of q̈ is no reason to take a step back.
#include <maupertuis/integrator.hpp>
#include <maupertuis/kernel.hpp>
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

using namespace maupertuis;

namespace {

/// Equal pendulums by absolute angles, one below the other.
std::string pendulums(int links) {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ngravity (0, -g)\n";
  for (int i = 1; i <= links; ++i) {
    const std::string k = std::to_string(i), above = i > 1 ? "P" + std::to_string(i - 1) + " + " : "";
    text += "coord a" + k + " : angle\npoint P" + k + " mass m at " + above + "l (sin a" + k + ", -cos a" + k + ")\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a chain of a hundred links takes no step back for the rounding of its accelerations") {
  constexpr std::size_t links = 100;
  const ModelText m(pendulums(links));
  TaylorOptions options;
  options.backend = Backend::Interpreter;
  const Kernel kernel = build_kernel(dynamics_source(m.equations).kernel);
  TaylorStepper stepper(kernel, std::vector<double>{1, 1, 9.81}, options);
  std::vector<double> q(links), v(links);
  for (std::size_t i = 0; i < links; ++i) q[i] = 2.0 + 0.5 * static_cast<double>(i) / (links - 1);
  stepper.start(0, q, v);
  while (stepper.time() != 1) REQUIRE(stepper.step(1).ending == StepEnding::None);
  CHECK(stepper.steps() > 30);
  CHECK(stepper.rejected() == 0);
}

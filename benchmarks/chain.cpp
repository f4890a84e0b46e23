#include "chain.hpp"
#include "measure.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <maupertuis/forward_dynamics.hpp>
#include <maupertuis/simulation.hpp>
#include <stdexcept>

namespace bench {

using namespace maupertuis;

std::string chain_text(int links) {
  std::string names, points, start;
  for (int i = 1; i <= links; ++i) {
    names += fmt::format("{}θ{}", i > 1 ? ", " : "", i);
    points +=
        fmt::format("point P{0} mass m at {1}l (sin θ{0}, -cos θ{0})\n", i, i > 1 ? fmt::format("P{} + ", i - 1) : "");
    start += fmt::format("{}θ{} = {:.6f} rad", i > 1 ? ", " : "", i, 2.0 + 0.5 * (i - 1) / std::max(1, links - 1));
  }
  return fmt::format(
      "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord {} : angle\n{}gravity (0, -g)\nstart {}\nrun 1 s\n",
      names, points, start);
}

std::shared_ptr<const Model> read(const std::string& text) {
  const SourceText source("benchmark", text);
  Diagnostics diagnostics;
  const syntax::SyntaxTree tree = syntax::parse(source, diagnostics);
  auto model = elaborate(tree, source, diagnostics);
  if (!model || diagnostics.has_errors()) throw std::runtime_error(render(diagnostics, source));
  return std::make_shared<const Model>(std::move(*model));
}

EquationsOfMotion derive(const std::shared_ptr<const Model>& model) {
  Diagnostics diagnostics;
  auto equations = euler_lagrange({model, &model->system}, diagnostics);
  if (!equations) throw std::runtime_error(render(diagnostics, SourceText("benchmark", "")));
  return std::move(*equations);
}

ChainMotion chain_motion(int links) {
  const auto model = read(chain_text(links));
  DynamicsSource source = dynamics_source(derive(model));
  source.kernel.observables.clear();
  ChainMotion motion{
      build_kernel(source.kernel), source.parameters, {}, std::vector<double>(static_cast<std::size_t>(links), 0.0)};
  for (int i = 0; i < links; ++i) motion.q.push_back(2.0 + 0.5 * i / std::max(1, links - 1));
  return motion;
}

void settle(maupertuis::TaylorStepper& stepper, const ChainMotion& chain) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t first_look = 512, second_tier = 210'000;  // steps
  constexpr double far = 1e9;
  const bool has_tiers = chain.q.size() <= 8;
  stepper.start(0, chain.q, chain.v);
  const auto go_on = [&] { require(stepper.step(far).ending == maupertuis::StepEnding::None, "a long run"); };
  while (stepper.steps() <= (has_tiers ? second_tier : first_look)) go_on();
  // The second tier is compiled beside the run, in half a second at most.
  for (const auto begin = Clock::now(); has_tiers && Clock::now() - begin < std::chrono::seconds(1);) go_on();
}

ChainEnergy chain_energy(std::span<const double> q, std::span<const double> v) {
  ChainEnergy energy;
  double y = 0, vx = 0, vy = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    y -= std::cos(q[i]);
    vx += v[i] * std::cos(q[i]);
    vy += v[i] * std::sin(q[i]);
    const double kinetic = 0.5 * (vx * vx + vy * vy), potential = 9.81 * y;
    energy.value += kinetic + potential;
    energy.terms += kinetic + std::abs(potential);
  }
  return energy;
}

}  // namespace bench

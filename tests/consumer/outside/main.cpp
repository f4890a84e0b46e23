// A program of somebody else: a pendulum from its text to its motion.
#include <maupertuis/ensemble.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/study.hpp>

#include <cmath>
#include <cstdio>

using namespace maupertuis;

/// Pendulums let go at many angles: none may gain or lose energy, and the one from 60° has to move as `expected` did.
bool ensemble_agrees(const EquationsOfMotion& equations, double expected) {
  const MotionKernel motion = motion_kernel(equations);
  std::vector<double> q, v, end{10};
  for (int i = 1; i <= 30; ++i) q.push_back(i * std::acos(-1.0) / 45), v.push_back(0);
  EnsembleStart start;
  start.q = q, start.v = v, start.end = end, start.parameters = motion.parameters;
  EnsembleOptions options;
  options.energy_terms = motion.energy_terms;
  const EnsembleResult result = advance_ensemble(motion.kernel, start, options);
  for (const TrajectoryEnding& ending : result.endings)
    if (!ending.ok() || ending.energy_drift > 1e-13) return false;
  return std::abs(result.q_of(14)[0] - expected) < 1e-12;
}

int main() {
  Study study(SourceText("pendulum.lag",
                         "system pendulum\n"
                         "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\n"
                         "coord θ : angle\n"
                         "point bob mass m at l (sin θ, -cos θ)\n"
                         "gravity (0, -g)\n"
                         "start θ = 10 deg\n"
                         "run 10 s\n"));
  study.override_with(OverrideKind::Start, "angle", "θ = 60 deg");
  const EquationsOfMotion* equations = study.equations();
  if (!equations) return std::puts(render(study.diagnostics(), study.texts()).c_str()), 1;
  const std::string text = to_plain(study.derivation(false)->equations.at(0), equations->order) + " = 0";
  if (text != "m l^2 θ'' + m g l sin θ = 0") return std::puts(text.c_str()), 3;
  if (!study.certificate()->passed()) return 4;
  const auto result = study.motion();
  if (!result || !result->ok() || result->statistics.energy_drift > 1e-12) return 5;
  if (!ensemble_agrees(*equations, result->final.q[0])) return 6;
  std::printf("%s\nθ(10 s) = %.15g\n", text.c_str(), result->final.q[0]);
  return 0;
}

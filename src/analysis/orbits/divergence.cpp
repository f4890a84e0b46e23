#include "analysis/orbits/divergence.hpp"

#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>

namespace maupertuis::orbits {
namespace {

struct Node {
  double place, weight;
};
/// Gauss's rule on [−1, 1] with eight nodes: these and their mirror images (Abramowitz and Stegun, table 25.4).
constexpr Node half_rule[] = {{0.183434642495649805, 0.362683783378361983},
                              {0.525532409916328986, 0.313706645877887287},
                              {0.796666477413626740, 0.222381034453374471},
                              {0.960289856497536232, 0.101228536290376259}};

}  // namespace

std::optional<double> integrated_divergence(const EquationsOfMotion& equations, const TangentGeometry& geometry,
                                            const MotionState& start, double duration) {
  if (geometry.symplectic()) return 0.0;
  if (!geometry.divergence(start)) return std::nullopt;
  const MotionKernel motion = motion_kernel(equations);
  TaylorStepper stepper(motion.kernel, motion.parameters, {});
  stepper.start(start.t, start.q, start.v);
  const double end = start.t + duration;
  double sum = 0;
  MotionState at = start;
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    if (step.ending != StepEnding::None) return std::nullopt;
    const double middle = 0.5 * (step.begin + step.end), half = 0.5 * (step.end - step.begin);
    for (const Node& node : half_rule)
      for (const double side : {-1.0, 1.0}) {
        at.t = middle + side * node.place * half;
        stepper.state(at.t, at.q, at.v);
        sum += half * node.weight * *geometry.divergence(at);
      }
  }
  return sum;
}

}  // namespace maupertuis::orbits

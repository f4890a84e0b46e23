#include "analysis/orbits/divergence.hpp"

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

DivergenceIntegral::DivergenceIntegral(const EquationsOfMotion& equations, const TangentGeometry& geometry)
    : geometry_(geometry) {
  if (geometry.symplectic()) return;
  const MotionKernel motion = motion_kernel(equations);
  stepper_.emplace(motion.kernel, motion.parameters, TaylorOptions{});
}

std::optional<double> DivergenceIntegral::operator()(const MotionState& start, double end) {
  if (!stepper_) return 0.0;
  if (!geometry_.divergence(start)) return std::nullopt;
  stepper_->start(start.t, start.q, start.v);
  double sum = 0;
  MotionState at = start;
  while (stepper_->time() != end) {
    const Step step = stepper_->step(end);
    if (step.ending != StepEnding::None) return std::nullopt;
    const double middle = 0.5 * (step.begin + step.end), half = 0.5 * (step.end - step.begin);
    for (const Node& node : half_rule)
      for (const double side : {-1.0, 1.0}) {
        at.t = middle + side * node.place * half;
        stepper_->state(at.t, at.q, at.v);
        sum += half * node.weight * *geometry_.divergence(at);
      }
  }
  return sum;
}

}  // namespace maupertuis::orbits

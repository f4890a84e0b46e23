#include "analysis/orbits/divergence.hpp"

#include <cmath>

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
constexpr int most_halvings = 8;

}  // namespace

DivergenceIntegral::DivergenceIntegral(const EquationsOfMotion& equations, const TangentGeometry& geometry)
    : geometry_(geometry) {
  if (geometry.symplectic()) return;
  const MotionKernel motion = free_motion_kernel(equations);
  stepper_.emplace(motion.kernel, motion.parameters, TaylorOptions{});
}

std::optional<double> DivergenceIntegral::operator()(const MotionState& start, double end) {
  if (!stepper_) return 0.0;
  if (!geometry_.divergence(start)) return std::nullopt;
  stepper_->start(start.t, start.q, start.v);
  double sum = 0;
  while (stepper_->time() != end) {
    const Step step = stepper_->step(end);
    if (step.ending != StepEnding::None) return std::nullopt;
    const Sum whole = on_nodes({step.begin, step.end});
    constexpr double rounding = 1e-13;
    sum += refined({step.begin, step.end}, whole.value, rounding * whole.size, most_halvings);
  }
  return sum;
}

DivergenceIntegral::Sum DivergenceIntegral::on_nodes(const Interval& interval) {
  MotionState at{0, std::vector<double>(stepper_->q().size()), std::vector<double>(stepper_->q().size())};
  const double middle = 0.5 * (interval.begin + interval.end), half = 0.5 * (interval.end - interval.begin);
  Sum sum;
  for (const Node& node : half_rule)
    for (const double side : {-1.0, 1.0}) {
      at.t = middle + side * node.place * half;
      stepper_->state(at.t, at.q, at.v);
      const double term = half * node.weight * *geometry_.divergence(at);
      sum.value += term, sum.size += std::abs(term);
    }
  return sum;
}

/// A step is as long as the motion allows, at rest as long as is asked for: where the divergence changes faster, the
/// halves say something else than the whole, and are halved in turn.
double DivergenceIntegral::refined(const Interval& interval, double whole, double tolerance, int halvings) {
  const double middle = 0.5 * (interval.begin + interval.end);
  const Interval first{interval.begin, middle}, second{middle, interval.end};
  const double a = on_nodes(first).value, b = on_nodes(second).value;
  if (!(std::abs(a + b - whole) > tolerance) || halvings == 0) return a + b;
  return refined(first, a, tolerance, halvings - 1) + refined(second, b, tolerance, halvings - 1);
}

}  // namespace maupertuis::orbits

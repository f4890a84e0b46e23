#pragma once
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/tangent.hpp>

#include <optional>

namespace maupertuis::orbits {

/// ∫ divergence dt over stretches of a motion, by Gauss's rule with eight nodes in each Taylor step, or in parts
/// of it where these agree no sooner.
class DivergenceIntegral {
 public:
  /// `geometry` has to live as long.
  DivergenceIntegral(const EquationsOfMotion& equations, const TangentGeometry& geometry);

  /// From `start` to the time `end`; nothing where there is no divergence (TangentGeometry), or the motion ends before.
  std::optional<double> operator()(const MotionState& start, double end);

 private:
  struct Interval {
    double begin, end;
  };
  struct Sum {
    double value = 0, size = 0;  // ∫, ∫ | |
  };
  Sum on_nodes(const Interval& interval);
  double refined(const Interval& interval, double whole, double tolerance, int halvings);

  const TangentGeometry& geometry_;
  std::optional<TaylorStepper> stepper_;  // where the divergence is not known to be zero
};

}  // namespace maupertuis::orbits

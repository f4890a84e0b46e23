#pragma once
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/tangent.hpp>

#include <optional>

namespace maupertuis::orbits {

/// ∫ divergence dt over stretches of a motion, by Gauss's rule with eight nodes in each Taylor step.
class DivergenceIntegral {
 public:
  /// `geometry` has to live as long.
  DivergenceIntegral(const EquationsOfMotion& equations, const TangentGeometry& geometry);

  /// From `start` to the time `end`; nothing where there is no divergence (TangentGeometry), or the motion ends before.
  std::optional<double> operator()(const MotionState& start, double end);

 private:
  const TangentGeometry& geometry_;
  std::optional<TaylorStepper> stepper_;  // where the divergence is not known to be zero
};

}  // namespace maupertuis::orbits

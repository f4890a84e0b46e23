#pragma once
#include "analysis/linearization/point_equations.hpp"
#include "linear_algebra/cone_problem.hpp"

#include <maupertuis/contact_mode.hpp>

#include <optional>

namespace maupertuis {

/// Forces of closed contacts and of what sticks at a point of rest, where the balance does not determine them (two feet
/// with friction, three legs in a plane): the multipliers of the mode that keep the limits of friction, of those the
/// shortest that leave it a margin (resting_forces). `limits`: of friction i by its μ_s; of a friction of a coordinate
/// its limit itself, or NaN where that hangs on forces: these are left to the constraints.
class SharedForces {
 public:
  /// `equations`: of the mode. The point's multipliers do not count.
  SharedForces(const MechanicalSystem& system, const ContactMode& mode, const EquationsOfMotion& equations,
               PointEquations::Impl& points, const OperatingPoint& point, const std::vector<double>& limits);

  /// Whether the balance leaves them open.
  bool are_open() const { return open_; }
  /// With every contact pressing by `least` or more. Nothing where there are none such.
  std::optional<std::vector<double>> pressing_by(double least) const;

 private:
  void sort_multipliers(const MechanicalSystem& system, const ContactMode& mode, const EquationsOfMotion& equations,
                        const std::vector<double>& limits);
  void pose(const RowsAtPoint& balance);

  std::vector<Index> within_limits_;  // multipliers, in the order of the problem
  std::vector<Index> others_;         // of constraints, and of what never slides
  std::vector<bool> is_normal_;       // [within_limits_]
  Vector rows_;                       // [n] the balance without forces, by rows of a size
  Matrix by_multipliers_;             // [n × m] of it
  ConeProblem problem_;
  bool open_ = false;
};

}  // namespace maupertuis

#pragma once
#include "integrator/ensemble/batch.hpp"
#include "integrator/taylor/end_check.hpp"
#include "integrator/taylor/safe_length.hpp"

#include <maupertuis/lanes.hpp>

#include <span>
#include <vector>

namespace maupertuis::ensemble {

/// What TaylorStepper asks of each step, for the motions in the lanes: lengths that no value of the program forbids,
/// and equations that hold at the end. A lane that fails is to be run alone.
class LaneSafety {
 public:
  LaneSafety(const Job& job, const LaneWorkspace& work);

  /// A motion begins in a lane.
  void begin(std::size_t lane, std::span<const double> parameters);
  /// Of the disk on which sizes are wanted for a step of that length.
  double radius(double wanted, double left) const;
  /// The largest safe length up to `wanted` for steps up to `left`; both > 0. t: of the lane; sizes: LaneArrays::sizes
  /// from the lane on, at that radius.
  double within(std::size_t lane, double t, double wanted, double left, const double* sizes);
  /// The step that the lane has made, whose end the next expansion decides on, and q̈ there by the polynomial: [n],
  /// `width` apart.
  void expect(std::size_t lane, double tau, const double* acceleration);
  /// Whether q̈ of the present expansion is what the last step ended with.
  bool holds(std::size_t lane, double t);
  /// The same at an end that is not expanded any more. q, v: [n].
  bool holds_at(std::size_t lane, double t, std::span<const double> q, std::span<const double> v);

 private:
  bool holds_but_for_rounding(std::size_t lane, const double* half_by_equations, std::size_t step, double t,
                              std::span<const double> q, std::span<const double> v);
  void take_state(std::size_t lane, std::vector<double>& q, std::vector<double>& v) const;

  struct Lane {
    taylor::SafeLength safe;
    taylor::EndCheck end;
    std::vector<double> expected;  // [n] q̈ at the end of the last step
    std::vector<double> constants;
    double tau = 0;  // its length; 0: there is none
  };

  const LaneWorkspace& work_;
  std::size_t n_, width_;
  int order_;
  std::vector<Lane> lanes_;
  std::vector<std::vector<double>> parameters_;  // [lanes]
  KernelWorkspace point_;                        // M, and what rounding makes of q̈
  Disks point_disks_;
  std::size_t point_lane_ = ~std::size_t{0};
  KernelWorkspace& point_of(std::size_t lane);
};

}  // namespace maupertuis::ensemble

#pragma once
#include "integrator/taylor/turns.hpp"

#include <span>
#include <vector>

namespace maupertuis::taylor {

/// Where a motion is: t, q, q̇ and its integrals, each with what additions left behind.
class MotionState {
 public:
  explicit MotionState(const Kernel& kernel);

  void start(double time, std::span<const double> position, std::span<const double> velocity);
  /// Angles back within a turn.
  void wind();
  /// To τ after the beginning `from` of a step; where it ends at `bound`, to that time exactly.
  void move(const DenseOutput& step, const Compensated& from, double tau);
  void arrive(double bound) { t = {bound, 0}; }
  /// Back to the beginning of a step.
  void take_back(const DenseOutput& step, const Compensated& from, const Turns& turns_then);
  /// The state moved by these, [n] each.
  void add(std::span<const double> dq, std::span<const double> dv);

  Compensated t;
  std::vector<Compensated> q, v, integrals;
  std::vector<double> q_now, v_now;  // [n] their leading parts
  Turns turns;                       // of q

 private:
  void renew_leading_parts();
};

}  // namespace maupertuis::taylor

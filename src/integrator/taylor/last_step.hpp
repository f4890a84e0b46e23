#pragma once
#include "integrator/taylor/motion_state.hpp"

#include <maupertuis/integrator.hpp>

namespace maupertuis::taylor {

/// The last step: its polynomial, and samples of it.
class LastStep {
 public:
  LastStep(const Kernel& kernel, int order);

  /// Before any step it is the starting point.
  void start(const MotionState& state);
  /// The step that begins at this state, by the expansion in the workspace, which what is compiled adds up there.
  void keep(const KernelWorkspace& work, const MotionState& state);
  /// The same, but for its polynomial.
  void keep_state(const MotionState& state);
  /// What there is at its beginning, by the workspace that expanded it, with observables or without.
  void record_start(const KernelWorkspace& work, bool observe);
  /// `point` has the parameters and sides of the step.
  Sample sample(double time, KernelWorkspace& point) const;
  void state(double time, std::span<double> q, std::span<double> v) const;
  std::span<const double> accelerations(double time) const;  // of the polynomial
  double tau_of(double time) const { return (time - begin.hi) - begin.lo; }
  /// How far it went to this time: the rounding of t counts in short steps.
  double tau_of(const Compensated& time) const { return (time.hi - begin.hi) + (time.lo - begin.lo); }

  Compensated begin;
  DenseOutput dense;
  Turns turns;  // of dense.q
  Sample start_sample;

 private:
  std::size_t multipliers_, observables_;
  int degree_;
};

}  // namespace maupertuis::taylor

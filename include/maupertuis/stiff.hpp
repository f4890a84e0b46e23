#pragma once
#include <maupertuis/motion_functions.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <memory>
#include <span>
#include <vector>

/// Implicit steps of a stiff motion (docs/theory/stiff.md); used as a TaylorStepper is.
namespace maupertuis {

struct StiffOptions {
  double tolerance = 1e-12;  // relative, per step
  double absolute = 0;       // in the unit of each coordinate and velocity; 0: 1e-4 · tolerance, of sizes at the start
  /// [n] Coordinates with one number share a unit. The largest of them at the start is their size, and that of their
  /// velocities, where it is less than 1; a start at zero leaves it 1. Empty: 1.
  std::vector<std::size_t> kinds = {};
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;  // looked at once a step
};

/// Radau IIA (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.8): collocation at s = 7 points of a
/// step, of order 2s − 1 = 13; at 5 from a tolerance of 1e-7 on, at 3 from 1e-4. With constraints on the index-2 form
/// of Gear, Gupta and Leimkuhler: the unknowns are q, v, λ and μ, the last two without a part in the control of the
/// error. The derivatives for Newton's iteration are exact. What is given out is projected onto φ = 0 and the velocity
/// constraints, to rounding, and its a and λ follow from the bordered system. Redundant constraints are left out by
/// pivoting. Integrals ride along, without a part in the control of the error. Cost of a step: some rounds of Newton's
/// iteration, s evaluations each, and LU factors of (s + 1)/2 matrices of all unknowns where the step changed.
class StiffStepper {
 public:
  /// Preconditions: parameters.size() == functions' parameters; tolerance > 0.
  StiffStepper(const MotionFunctions& functions, std::span<const double> parameters, const StiffOptions& options);
  ~StiffStepper();
  StiffStepper(StiffStepper&&) noexcept;

  int order() const;
  /// Whether the parts of the motion near a state that are too fast for steps of a length die out by themselves:
  /// eigenvalues λ of the linearized accelerations with |λ| length > ½ lie within 70° of the negative real axis, and
  /// there are some. Others are damped by the steps, or followed with short ones. Cost: one solve, O(n³).
  bool fast_parts_die_out(double t, std::span<const double> q, std::span<const double> v, double length);
  void start(double t, std::span<const double> q, std::span<const double> v);
  /// One step towards `bound`, at most up to it; time() == bound exactly when it is reached. Backwards if bound <
  /// time().
  Step step(double bound);

  double time() const;
  std::span<const double> q() const;  // [n]
  std::span<const double> v() const;  // [n]
  std::size_t steps() const;
  /// Steps so far that were taken back, since a force acted within them that the points of the step had not seen.
  std::size_t rejected() const;
  std::size_t switches() const { return 0; }
  /// The largest so far of φ and its rate at the ends of steps, as TaylorStepper::constraint_residual measures it.
  double constraint_residual() const;

  bool covers(double t) const;
  /// The motion at a time in the last step, from the polynomial of the step, projected. Precondition: covers(t).
  Sample sample(double t) const;
  /// The state alone. q, v: [n].
  void state(double t, std::span<double> q, std::span<double> v) const;
  /// The motion at the beginning of the last step.
  const Sample& step_start() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis

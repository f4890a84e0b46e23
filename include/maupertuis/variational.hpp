#pragma once
#include <maupertuis/motion_functions.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <cstddef>
#include <memory>
#include <span>

/// Steps of a motion by a variational integrator (docs/theory/variational.md); used as a TaylorStepper is.
namespace maupertuis {

struct VariationalOptions {
  double step = 0;  // s, > 0; the same for the whole run, but the last step may be shorter
  int order = 4;    // of accuracy: 2, 4, …, 12; an odd number counts as the next even one
  std::size_t maximum_steps = 100'000'000;
  const StopFlag* interrupt = nullptr;  // looked at once a step
};

/// Galerkin variational integrator on Gauss nodes, or on Lobatto nodes when there are constraints. The map from step to
/// step preserves the symplectic form and the momenta of symmetries to rounding; forces enter by the discrete
/// principle of Lagrange and d'Alembert; position constraints and the velocity constraints that they imply hold at
/// every step to rounding. L may depend on q, v and t in any way. Events and integrands are functions of q, v, λ and t.
class VariationalStepper {
 public:
  /// Preconditions: parameters.size() == functions' parameters; options.step > 0; 2 ≤ order ≤ 12;
  /// functions.motion.holonomic.
  VariationalStepper(const VariationalFunctions& functions, std::span<const double> parameters,
                     const VariationalOptions& options);
  ~VariationalStepper();
  VariationalStepper(VariationalStepper&&) noexcept;

  int order() const;
  void start(double t, std::span<const double> q, std::span<const double> v);
  /// One step towards `bound`, at most up to it; time() == bound exactly when it is reached. Backwards if bound <
  /// time().
  Step step(double bound);

  double time() const;
  std::span<const double> q() const;  // [n]
  std::span<const double> v() const;  // [n]
  std::span<const double> p() const;  // [n] ∂L/∂v
  std::size_t steps() const;
  std::size_t switches() const { return 0; }
  /// The largest so far of φ and its rate at the ends of steps, as TaylorStepper::constraint_residual measures it.
  double constraint_residual() const;

  bool covers(double t) const;
  /// The motion at a time in the last step, by a shorter step of the same method from its beginning: as accurate as the
  /// steps themselves, and on the constraints. Precondition: covers(t).
  Sample sample(double t) const;
  /// The state alone, by the polynomials of the step: of lower order than the steps. q, v: [n].
  void state(double t, std::span<double> q, std::span<double> v) const;
  /// The motion at the beginning of the last step.
  const Sample& step_start() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace maupertuis

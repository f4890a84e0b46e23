#pragma once
#include "integrator/taylor/code_choice.hpp"
#include "integrator/taylor/constraint_error.hpp"
#include "integrator/taylor/end_check.hpp"
#include "integrator/taylor/last_step.hpp"
#include "integrator/taylor/polynomial_motion.hpp"
#include "integrator/taylor/rest.hpp"
#include "integrator/taylor/safe_length.hpp"
#include "integrator/taylor/shrinking_steps.hpp"
#include "integrator/taylor/step_size.hpp"
#include "integrator/taylor/watched_functions.hpp"

namespace maupertuis {

/// A step: expand the motion, decide the sides of switch functions that begin at a zero, choose a length, shorten it to
/// the first crossing, advance, and look whether the equations hold at its end; a step that fails is taken back.
struct TaylorStepper::Impl {
  Impl(const Kernel& k, std::span<const double> parameters, const TaylorOptions& o)
      : kernel(k),
        options(o),
        usual_control(taylor::step_control(o.tolerance, o.order)),
        control(taylor::control_of(k.program(), usual_control)),
        n(k.freedoms()),
        m(k.constraints()),
        work(k, control.order),
        probe(k, 1),
        state(k),
        last(k, control.order),
        watched(k, work),
        safe(work.program(), control.order, taylor::safe_tolerance(o.tolerance)),
        end_check(n, o.tolerance),
        constraints(n, m),
        sizes(4 * n) {
    work.set_parameters(parameters);
    probe.set_parameters(parameters);
    if (options.backend == Backend::Compiled) code.compile_at_once(work, options);
  }

  // A step (stepper.cpp).
  Step step(double bound);
  std::string why_steps_shrink() const;
  bool may_go_on(double bound, Step& result);
  bool expand(double bound, Step& result);
  bool decide_sides(double bound, Step& result);
  std::optional<double> trial(double bound);
  bool switches_have_values(double bound, Step& result);
  double choose_length(double bound);
  bool is_at_rest() const;
  bool rests_for_ever() const;
  bool stays(double h) const;
  taylor::Crossing crossing_within(double& h);
  bool make_step(double bound, double h, Step& result);
  void advance(double bound, double h, const taylor::Crossing& crossing, Step& result);
  double moved(double tau, double h, bool meets_events_alone) const;
  bool accelerations_grow() const;
  void end(Step& result, StepEnding ending, std::string reason) const;
  bool fail(Step& result, KernelStatus status);
  double remaining(double bound) const { return (bound - state.t.hi) - state.t.lo; }

  // Its end (step_end.cpp).
  bool settles(double bound, const taylor::Crossing& crossing, Step& result);
  bool equations_hold(const KernelWorkspace& at_end);
  std::vector<double> accelerations_at_end(const KernelWorkspace& at_end, double tau) const;
  bool take_back(Step& result);

  // Constraints (constrained_step.cpp).
  bool forces_diverge();
  bool project(Step& result, bool known = false);
  void land(Step& result, double tau);
  void move_to(double tau, Step& result);

  // Steps that no series makes (passing.cpp).
  class Collocation;
  enum class Place { OfFormulas, OfConstraints };  // singular where a step passes
  bool passes(double h, double bound, Place place, Step& result);
  void pass(const Collocation& c, double bound, Step& result);
  bool passes_from_here(double bound, Step& result);
  bool seems_smooth(double h) const;
  bool passes_shrinking(double chosen, double bound, Step& result);

  Kernel kernel;
  TaylorOptions options;
  taylor::StepControl usual_control;  // of any motion
  taylor::StepControl control;        // of this one
  const std::size_t n, m;             // freedoms, constraints
  KernelWorkspace work;
  mutable KernelWorkspace probe;  // for the kernel at points within the step
  taylor::MotionState state;
  taylor::LastStep last;
  taylor::WatchedFunctions watched;
  taylor::CodeChoice code;

  // Lengths.
  taylor::SafeLength safe;
  taylor::EndCheck end_check;
  taylor::ConstraintRecord constraints;
  taylor::ShrinkingSteps shrinking;
  std::vector<double> sizes;            // [4][n] by code: of q on its disk, as SafeLength::within takes them
  std::vector<double> integrand_sizes;  // [integrals] the largest so far
  double length = 0;                    // the last one that the control chose
  double longest = 0;                   // so far
  double tried = 0;                     // the last one at which no place was passed
  double followed = 0;                  // the last one in which a watched function swings as often as it may; 0: none

  // How the run goes.
  bool has_start_sample = false;  // before the first step it is made when it is asked for
  bool first = true;              // no step made yet
  bool has_started = false;
  bool expanded = false;                       // the workspace holds the motion through the present state already
  bool noisy = false;                          // halving did not mend the last steps, see equations_hold()
  int attempts = 0;                            // at the present step that were taken back
  std::vector<taylor::Balanced> balanced;      // in the last step
  int stuck = 0;                               // crossings in a row that did not move time
  KernelStatus end_status = KernelStatus::Ok;  // of the last look at an end
  std::size_t steps = 0, switches = 0, rejected = 0;
  mutable std::vector<double> q_unwound;  // [n]
};

}  // namespace maupertuis

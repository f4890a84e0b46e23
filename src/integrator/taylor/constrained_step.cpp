#include "integrator/taylor/constraint_error.hpp"
#include "integrator/taylor/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

/// How a step keeps to the constraints, and where it must not end.
namespace maupertuis {

/// A row of A that goes to zero while the steps do: its multiplier has a pole there. Rounding errors of the state grow
/// with it, so that further steps would lead to whatever branch of the configurations they happen to be on.
bool TaylorStepper::Impl::forces_diverge() {
  longest = std::max(longest, length);
  return constraints.has_vanishing_row(work) && length > 0 && length < taylor::ConstraintRecord::vanishing * longest;
}

/// Brings q and q̇ back to the constraints. The expansion has factored the bordered matrix, so that this costs two
/// solves; only where the corrections are above rounding is the motion expanded anew.
/// `known`: the corrections are there.
bool TaylorStepper::Impl::project(Step& result, bool known) {
  // Before the first step nothing is known of the motion: the start is off by rounding of its own coordinates, which
  // the terms of |P| = l, a root, do not show.
  taylor::UsualSizes of_start;
  if (first && constraints.usual.q.empty())
    for (const double x : state.q_now) of_start.q.push_back(std::abs(x));
  const taylor::UsualSizes& usual = of_start.q.empty() ? constraints.usual : of_start;
  double error = taylor::constraint_error(work, n, m, length, usual);
  if (!first) constraints.residual = std::max(constraints.residual, error);
  // In a rotation the radius of convergence is no bound: steps get so long that each order of λ multiplies the rounding
  // errors of those before it. What a step leaves in the constraints shows it.
  if (!first && error > taylor::rounding_of_constraints + options.tolerance) constraints.restraint = 0.45;
  const double allowed = std::max(1e-7, 1e3 * options.tolerance);
  for (int turn = 0; turn < 20; ++turn) {
    if (!std::exchange(known, false)) work.corrections(constraints.dq, constraints.dv);
    if (!first && !(error <= allowed && taylor::correction_size(work, m, constraints.dq, constraints.dv, length,
                                                                constraints.usual) <= allowed)) {
      end(result, StepEnding::SingularConstraints,
          "The constraints are singular near here: they do not determine where the motion goes.");
      return false;
    }
    state.add(constraints.dq, constraints.dv);
    if (error <= taylor::rounding_of_constraints) return true;
    if (const KernelStatus status = work.expand(state.t.hi, state.q_now, state.v_now); status != KernelStatus::Ok)
      return fail(result, status);
    const double now = taylor::constraint_error(work, n, m, length, usual);
    if (turn > 2 && now > 0.5 * error) break;
    error = now;
  }
  if (error < 1e-10) return true;
  end(result, StepEnding::SingularConstraints, "The constraints cannot be met near here.");
  return false;
}

/// Next to a singular configuration of the constraints what rounding left of them is blown up by the projection, and λ
/// and q̈ lose digits as the pivots fall. The motion goes through it all the same where it is determined, so that a step
/// must not end just there: then it is made shorter, and the next one passes. The expansion at its end is that of the
/// next step.
void TaylorStepper::Impl::land(Step& result, double tau) {
  const double sound = std::max(1e-12, 1e2 * options.tolerance), allowed = std::max(1e-7, 1e3 * options.tolerance);
  bool defined = false;
  for (int trial = 0; trial < 12; ++trial) {
    watched.set_sides(work);
    if (work.expand(state.t.hi, state.q_now, state.v_now) == KernelStatus::Ok) {
      defined = true;
      work.corrections(constraints.dq, constraints.dv);
      const double error = taylor::constraint_error(work, n, m, length, constraints.usual);
      const std::size_t in_force = work.constraints_in_force();
      const bool regular =
          in_force >= constraints.most_in_force && work.pivot_ratio() > 1e-6 * constraints.best_pivot_ratio;
      if (regular && error <= allowed &&
          taylor::correction_size(work, m, constraints.dq, constraints.dv, length, constraints.usual) <= sound) {
        if (in_force > constraints.most_in_force) constraints.best_pivot_ratio = 0;
        constraints.most_in_force = in_force;
        constraints.best_pivot_ratio = std::max(constraints.best_pivot_ratio, work.pivot_ratio());
        Step projected;
        expanded = project(projected, true);
        return;
      }
    }
    tau *= 0.83;
    move_to(tau, result);
  }
  if (!defined) return;  // the next step says why
  move_to(0, result);
  end(result, StepEnding::SingularConstraints,
      "The constraints are singular near here: they do not determine where the motion goes.");
}

/// Ends the last step earlier.
void TaylorStepper::Impl::move_to(double tau, Step& result) {
  state.move(last.dense, last.begin, tau);
  result.end = state.t.hi;
}

}  // namespace maupertuis

#pragma once
#include "integrator/dense_output/dense_output.hpp"
#include "integrator/taylor/step_size.hpp"
#include "integrator/taylor/switches.hpp"
#include "integrator/taylor/turns.hpp"

#include <maupertuis/integrator.hpp>

namespace maupertuis {

/// A step: expand the motion, decide the sides of switch functions that begin at a zero, choose a length, shorten it to
/// the first crossing, advance.
struct TaylorStepper::Impl {
  Impl(const Kernel& k, std::span<const double> parameters, const TaylorOptions& o)
      : kernel(k), options(o), control(taylor::step_control(o.tolerance, o.order)), work(k, control.order),
        probe(k, 1), n(k.freedoms()), m(k.constraints()), turns(k), dense_turns(k), switch_state(k.switches().size()), event_state(k.events()) {
    work.set_parameters(parameters);
    probe.set_parameters(parameters);
    dense.resize(n, k.integrands(), control.order + 1);
    for (auto* state : {&q, &v}) state->resize(n);
    for (auto* values : {&q_now, &v_now}) values->resize(n);
    for (auto* values : {&dq, &dv}) values->resize(n);
    integrals.resize(k.integrands());
    if (options.backend == Backend::Compiled) compile(false);
  }

  struct Crossing {
    double x = 1;       // fraction of the step
    bool found = false;
    std::vector<std::size_t> switches;
    std::optional<std::size_t> event;
  };

  Step step(double bound);
  bool forces_diverge();
  void compile(bool long_run);
  void compile_if_it_pays(double bound);
  bool expand(double bound, Step& result);
  bool project(Step& result, bool known = false);
  void land(Step& result, double tau);
  void move_to(double tau, Step& result);
  bool decide_sides(double bound, Step& result);
  std::optional<double> trial(double bound);
  bool expands_once() const { return m == 0 && switch_state.empty(); }
  bool watches() const { return !switch_state.empty() || !event_state.empty(); }
  void keep_polynomial();
  void restore_polynomial();
  void record_start() const;
  Crossing first_crossing(double h) const;
  std::int8_t event_side(std::size_t index, const taylor::ScaledPolynomial& polynomial) const;
  void note(Crossing& crossing, double x) const;
  void advance(double bound, double h, const Crossing& crossing, Step& result);
  void mark_crossings(const Crossing& crossing, Step& result);
  void end(Step& result, StepEnding ending, std::string reason) const;
  bool fail(Step& result, KernelStatus status) const;
  double remaining(double bound) const { return (bound - t.hi) - t.lo; }
  double tau_of(double time) const { return (time - begin.hi) - begin.lo; }
  void set_sides(KernelWorkspace& w) const {
    if (!switch_state.empty()) copy_sides(w);
  }
  void copy_sides(KernelWorkspace& w) const;
  void choose_first_sides();
  Sample sample(double time) const;

  Kernel kernel;
  TaylorOptions options;
  taylor::StepControl control;
  KernelWorkspace work;
  mutable KernelWorkspace probe;         // for the kernel at points within the step
  const std::size_t n, m;                // freedoms, constraints

  Compensated t, begin;                  // now; the beginning of the last step
  std::vector<Compensated> q, v, integrals;
  std::vector<double> q_now, v_now;      // [n] their leading parts
  std::vector<double> dq, dv;            // [n] back to the constraints
  double constraint_residual = 0;
  DenseOutput dense;
  taylor::Turns turns, dense_turns;      // of q, and of the last step
  mutable std::vector<double> q_unwound; // [n]
  std::vector<taylor::Watched> switch_state, event_state;
  bool first = true;                     // no step made yet
  bool expanded = false;                 // the workspace holds the motion through the present state already
  double length = 0;                     // the last length that the control chose
  double best_pivot_ratio = 0;           // of the bordered matrix so far
  std::size_t most_in_force = 0;         // constraints so far
  double restraint = 1;                  // of the lengths that the control chooses
  double longest = 0;                    // length so far
  std::vector<double> largest_row;       // [constraints] of A so far
  std::size_t steps = 0, switches = 0;
  bool runs_long = false;                // code was asked for that pays in long runs
  int stuck = 0;                         // crossings in a row that did not move time
  BackendUse backend;
  double run_begin = 0;
  mutable Sample start_sample;
  mutable bool start_is_recorded = false;
};

}  // namespace maupertuis

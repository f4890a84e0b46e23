#pragma once
#include "integrator/dense_output/dense_output.hpp"
#include "integrator/taylor/end_check.hpp"
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/safe_length.hpp"
#include "integrator/taylor/step_size.hpp"
#include "integrator/taylor/switches.hpp"
#include "integrator/taylor/turns.hpp"

#include <maupertuis/integrator.hpp>

namespace maupertuis {

/// A step: expand the motion, decide the sides of switch functions that begin at a zero, choose a length, shorten it to
/// the first crossing, advance, and look whether the equations hold at its end; a step that fails is taken back.
struct TaylorStepper::Impl {
  Impl(const Kernel& k, std::span<const double> parameters, const TaylorOptions& o)
      : kernel(k), options(o), control(taylor::step_control(o.tolerance, o.order)), work(k, control.order),
        probe(k, 1), n(k.freedoms()), m(k.constraints()), safe(work.program(), control.order, taylor::safe_tolerance(o.tolerance)), end_check(n, o.tolerance),
        turns(k), dense_turns(k), switch_state(k.switches().size()), event_state(k.events()) {
    work.set_parameters(parameters);
    probe.set_parameters(parameters);
    dense.resize(n, k.integrands(), control.order + 1);
    for (auto* state : {&q, &v}) state->resize(n);
    for (auto* values : {&q_now, &v_now}) values->resize(n);
    for (auto* values : {&dq, &dv}) values->resize(n);
    integrals.resize(k.integrands());
    if (watches()) {
      std::vector<Slot> slots = work.program().switch_slots;
      slots.insert(slots.end(), work.program().events.begin(), work.program().events.end());
      roots.emplace(work.program(), control.order, slots);
    }
    if (options.backend == Backend::Compiled) compile(false);
  }

  struct Crossing {
    double x = 1;                        // fraction of the step
    bool found = false;
    std::vector<std::size_t> roots;      // switches, then events
    std::vector<taylor::Watched> after;  // the same, as the step leaves them
  };

  struct Collocation;  // passing.cpp

  Step step(double bound);
  double choose_length(double bound);
  bool is_at_rest() const;
  bool comes_to_a_stop(double bound);
  bool make_step(double bound, double h, Step& result);
  bool settles(double bound, const Crossing& crossing, Step& result);
  bool equations_hold(const KernelWorkspace& at_end);
  bool take_back(Step& result);
  void renew_momenta();
  bool evaluate_on_constraints(double time, std::vector<double>& position, std::vector<double>& velocity);
  bool ask_beside(Collocation& c, double x);
  bool keeps_events() const;
  double smooth() const;
  bool collocate(Collocation& c);
  bool is_smooth(Collocation& c);
  void pass(const Collocation& c, double bound, Step& result);
  bool passes(double h, double bound, Step& result);
  bool passes_from_here(double bound, Step& result);
  bool seems_smooth(double h) const;
  bool passes_shrinking(double chosen, double bound, Step& result);
  bool forces_diverge();
  void compile(bool long_run);
  void compile_if_it_pays(double bound);
  bool expand(double bound, Step& result);
  bool project(Step& result, bool known = false);
  void land(Step& result, double tau);
  void move_to(double tau, Step& result);
  bool decide_sides(double bound, Step& result);
  std::optional<double> trial(double bound);
  bool watches() const { return !switch_state.empty() || !event_state.empty(); }
  void keep_polynomial();
  void record_start();
  Crossing first_crossing(double h);
  bool begins_past_root(std::size_t index, double h, taylor::Watched& watched) const;
  void note(Crossing& crossing, double x, std::size_t index, double together) const;
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
  taylor::SafeLength safe;
  taylor::EndCheck end_check;

  Compensated t, begin;                  // now; the beginning of the last step
  std::vector<Compensated> q, v, integrals;
  std::vector<double> q_now, v_now;      // [n] their leading parts
  std::vector<double> dq, dv;            // [n] back to the constraints
  double constraint_residual = 0;
  DenseOutput dense;
  taylor::Turns turns, dense_turns;      // of q, and of the last step
  mutable std::vector<double> q_unwound; // [n]
  std::vector<taylor::Watched> switch_state, event_state;
  std::optional<taylor::RootSearch> roots;  // where something is watched
  bool first = true;                     // no step made yet
  bool expanded = false;                 // the workspace holds the motion through the present state already
  double length = 0;                     // the last length that the control chose
  double best_pivot_ratio = 0;           // of the bordered matrix so far
  std::size_t most_in_force = 0;         // constraints so far
  double restraint = 1;                  // of the lengths that the control chooses
  double longest = 0;                    // length so far
  std::vector<double> largest_row;       // [constraints] of A so far
  std::size_t steps = 0, switches = 0, rejected = 0;
  std::size_t last_look = 0;             // the number of steps at which comes_to_a_stop() looked
  double length_at_look = 0, time_at_look = 0;  // mean of the steps before it, and the time then
  bool noisy = false;                    // halving did not mend the last steps, see equations_hold()
  int attempts = 0;                      // at the present step that were taken back
  KernelStatus end_status = KernelStatus::Ok;  // of the last look at an end
  bool runs_long = false;                // code was asked for that pays in long runs
  int stuck = 0;                         // crossings in a row that did not move time
  BackendUse backend;
  double run_begin = 0;
  Sample start_sample;
};

}  // namespace maupertuis

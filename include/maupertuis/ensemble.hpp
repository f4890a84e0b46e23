#pragma once
#include <maupertuis/lanes.hpp>
#include <maupertuis/step.hpp>
#include <maupertuis/stop_flag.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Many motions of one kernel, each with a start, parameters and a duration of its own (docs/design/ensembles.md).
///
///     EnsembleStart start;
///     start.q = positions;  start.v = velocities;    // [trajectories × n], one trajectory after the other
///     start.parameters = values;                     // [p] for all, or [trajectories × p]
///     start.end = {&duration, 1};
///     const EnsembleResult result = advance_ensemble(kernel, start);
///     for (std::size_t i = 0; i < result.endings.size(); ++i)
///       if (result.endings[i].ok()) use(result.q_of(i), result.v_of(i));
namespace maupertuis {

/// Where the motions begin and how far they go. Nothing is copied: the arrays must live as long as the call.
struct EnsembleStart {
  std::span<const double> q, v;            // [trajectories × n]
  std::span<const double> parameters;      // [trajectories × p], or [p] for all
  std::span<const double> begin;           // s, [trajectories] or [1]; empty: 0
  std::span<const double> end;             // s, [trajectories] or [1]; before begin: backwards
  std::span<const double> times;           // s, ascending: the states wanted on the way, of every trajectory
  std::span<const double> step_factors{};  // [trajectories] in (0, 1], of the lengths that the tolerance asks for;
                                           // empty: 1. Not of those that go alone

  double begin_of(std::size_t trajectory) const {
    return begin.empty() ? 0 : begin[begin.size() == 1 ? 0 : trajectory];
  }
  double end_of(std::size_t trajectory) const { return end[end.size() == 1 ? 0 : trajectory]; }
  /// `count`: the parameters of a trajectory, p.
  std::span<const double> parameters_of(std::size_t trajectory, std::size_t count) const {
    return parameters.size() == count ? parameters : parameters.subspan(trajectory * count, count);
  }
};

struct EnsembleOptions {
  double tolerance = 0;                     // relative, per step, less than 1; 0: rounding level of double
  int order = 0;                            // of the polynomial of q̇, at most 100; 0: from the tolerance
  std::size_t maximum_steps = 100'000'000;  // of one trajectory
  int width = 0;                            // motions side by side: 1, 2, 4, 8, 16; 0: what suits the processor
  int threads = 0;                          // 0: as many as the machine runs at once
  std::size_t energy_terms = 0;             // so many first observables add up to an energy that is conserved
  const StopFlag* interrupt = nullptr;      // looked at once a step
  /// Automatic: compiled code where as many steps are expected as pay for it; that differs from the interpreter by
  /// rounding errors.
  Backend backend = Backend::Automatic;
  bool cache = true;  // of compiled code
  /// What expands the motions, instead of a backend. Called once, with the width.
  std::function<std::shared_ptr<const LaneExpansion>(const Kernel&, int width)> expansion;
};

/// How and where a trajectory ended.
struct TrajectoryEnding {
  StepEnding ending = StepEnding::None;  // None: it reached its end, or an event
  std::string reason;                    // one sentence for every ending but None
  double t = 0;                          // s, of the state that it ended with
  std::size_t steps = 0;
  std::optional<std::size_t> event;  // it ended at a root of this event function
  double energy_drift = 0;           // max |E(t) − E(begin)| / max Σ|terms|, over the samples and the end
  bool alone = false;                // by a TaylorStepper of its own
  bool ok() const { return ending == StepEnding::None; }
};

struct EnsembleResult {
  std::vector<TrajectoryEnding> endings;  // [trajectories]
  std::vector<double> q, v;               // [trajectories × n] at the end
  std::vector<double> sampled_q,
      sampled_v;  // [trajectories × times × n]; NaN at times that a trajectory did not come to
  std::size_t freedoms = 0, times = 0;
  int order = 0, width = 0;   // width 0: every trajectory alone
  std::string backend;        // of the lanes, "interpreter" or "compiled"; empty: every trajectory alone
  std::string trouble;        // why compiled code that was asked for is not used
  std::string cache_trouble;  // it could not be kept for the next run
  double compile_seconds = 0;

  std::span<const double> q_of(std::size_t trajectory) const { return {q.data() + trajectory * freedoms, freedoms}; }
  std::span<const double> v_of(std::size_t trajectory) const { return {v.data() + trajectory * freedoms, freedoms}; }
  std::span<const double> q_of(std::size_t trajectory, std::size_t time) const {
    return {sampled_q.data() + (trajectory * times + time) * freedoms, freedoms};
  }
  std::span<const double> v_of(std::size_t trajectory, std::size_t time) const {
    return {sampled_v.data() + (trajectory * times + time) * freedoms, freedoms};
  }
};

/// The sizes of the lists, and the order of the times; see below.
void check_ensemble_start(const EnsembleStart& start, std::size_t coordinates, std::size_t parameters);

/// Advances every trajectory from its begin to its end. Each has steps of its own length, as TaylorStepper chooses
/// them; a trajectory that is done makes room for the next. Events end a trajectory.
///
/// Trajectories go alone, by TaylorStepper, when the kernel does not fit into lanes (fits_lanes), when M₀ comes close
/// to a singular matrix, when something is not finite, or when steps shrink below the resolution of time: the ending
/// and the state are then the stepper's own.
///
/// With a given backend the result of a trajectory depends neither on the others and their order, nor on the width, nor
/// on the number of threads, to the bit. (It may differ from TaylorStepper's by rounding errors, since sums are fused
/// and taken in another order.) Backend::Automatic looks at the first trajectory and at the durations of all.
///
/// A trajectory with a number that is infinite or undefined, or with a start off the constraints (trouble_of_start),
/// ends where it starts, with StepEnding::Refused and the reason.
/// Throws std::invalid_argument, which names the list, where sizes are not those of the comments of EnsembleStart,
/// times do not ascend, or a number is none that its comment allows.
EnsembleResult advance_ensemble(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options = {});

}  // namespace maupertuis

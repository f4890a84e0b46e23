#pragma once
#include "integrator/taylor/step_size.hpp"

#include <maupertuis/ensemble.hpp>

#include <atomic>
#include <limits>
#include <memory>

namespace maupertuis::ensemble {

/// One call of advance_ensemble: what its threads share. Each trajectory is written by the thread that took it.
struct Job {
  const Kernel& kernel;
  const EnsembleStart& start;
  const EnsembleOptions& options;
  taylor::StepControl control;
  std::shared_ptr<const LaneExpansion> expansion;  // none: every trajectory alone
  std::size_t trajectories, freedoms;
  EnsembleResult& result;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};  // a thread threw: the others stop

  double begin(std::size_t trajectory) const { return start.begin_of(trajectory); }
  double end(std::size_t trajectory) const { return start.end_of(trajectory); }
  std::span<const double> q(std::size_t trajectory) const { return start.q.subspan(trajectory * freedoms, freedoms); }
  std::span<const double> v(std::size_t trajectory) const { return start.v.subspan(trajectory * freedoms, freedoms); }
  std::span<const double> parameters(std::size_t trajectory) const {
    return start.parameters_of(trajectory, kernel.parameters());
  }
  double step_factor(std::size_t trajectory) const {
    return start.step_factors.empty() ? 1 : start.step_factors[trajectory];
  }
  bool interrupted() const { return options.interrupt && options.interrupt->load(std::memory_order_relaxed); }
  /// The number of a trajectory that nobody has taken; `trajectories` when there is none.
  std::size_t take();
};

/// The requested times of one trajectory, in the order in which it comes to them.
class OutputTimes {
 public:
  OutputTimes() = default;
  OutputTimes(std::span<const double> times, double begin, double end);
  /// Calls f(index, time) for those up to `reached`, each once.
  template <class F>
  void up_to(double reached, F&& f) {
    for (; left_ > 0 && (reached - times_[next_]) * direction_ >= 0;
         next_ += static_cast<std::size_t>(direction_), --left_)
      f(next_, times_[next_]);
  }
  /// The next one, or infinity.
  double next() const { return left_ > 0 ? times_[next_] : std::numeric_limits<double>::infinity(); }

 private:
  std::span<const double> times_;
  std::size_t next_ = 0, left_ = 0;
  int direction_ = 1;
};

/// max |E(t) − E(begin)| / max Σ|terms| of one trajectory.
class EnergyDrift {
 public:
  void add(std::span<const double> terms);
  double value() const { return scale_ > 0 ? error_ / scale_ : 0; }

 private:
  bool begun_ = false;
  double first_ = 0, error_ = 0, scale_ = 0;
};

/// Whether the start, the parameters, the begin and the end of a trajectory are finite numbers.
bool is_finite(const Job& job, std::size_t trajectory);

/// One trajectory by TaylorStepper, from its begin; one that may not begin is told so.
void run_alone(Job& job, std::size_t trajectory);

/// Takes trajectories until none is left, and carries as many at once as there are lanes.
void run_in_lanes(Job& job);

}  // namespace maupertuis::ensemble

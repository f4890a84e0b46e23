#include "integrator/ensemble/batch.hpp"
#include "integrator/ensemble/lane_safety.hpp"
#include "integrator/ensemble/lane_steps.hpp"
#include "integrator/taylor/turns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

namespace maupertuis::ensemble {
namespace {

/// The best that the processor has: LaneSteps give the same bits on all.
LaneSteps best_steps() {
  if (has_instruction_set(InstructionSet::Avx512)) return avx512_steps();
  if (has_instruction_set(InstructionSet::Avx2)) return avx2_steps();
  return baseline_steps();
}

struct AlignedDelete {
  void operator()(double* data) const { ::operator delete (data, std::align_val_t{64}); }
};
using AlignedArray = std::unique_ptr<double[], AlignedDelete>;

AlignedArray aligned(std::size_t size) {
  AlignedArray array(static_cast<double*>(::operator new (size * sizeof(double), std::align_val_t{64})));
  std::fill_n(array.get(), size, 0.0);
  return array;
}

class Batch {
 public:
  explicit Batch(Job& job);
  void run();

 private:
  /// The motion that a lane carries.
  struct Lane {
    std::size_t trajectory = 0;
    bool active = false;
    std::size_t first_round = 0;
    OutputTimes times;
    EnergyDrift drift;
  };

  void refill(std::size_t lane);
  void begin(std::size_t lane, std::size_t trajectory);
  void step();
  void interrupt();
  void expand();
  void check_ends();
  void choose_lengths();
  void keep_lengths_safe();
  double first_length(std::size_t lane) const;
  double velocity(std::size_t lane, std::size_t i, int k) const;
  void look();
  void look_at(std::size_t lane);
  std::size_t steps(std::size_t lane) const { return rounds_ - lanes_[lane].first_round; }
  void sample(std::size_t lane, double reached);
  void wind();
  void state_after(std::size_t lane, double tau, std::span<Compensated> q, std::span<double> v) const;
  void note_energy(std::size_t lane, double t, std::span<const Compensated> q, std::span<const double> v);
  void finish(std::size_t lane, StepEnding ending, std::string reason);
  void finish_if_it_holds(std::size_t lane);
  void go_alone(std::size_t lane);

  std::size_t at(std::size_t i, std::size_t lane) const { return i * width_ + lane; }
  double* take(std::size_t count) {
    double* const from = memory_.get() + used_;
    used_ += count * width_;
    return from;
  }

  Job& job_;
  LaneSteps arithmetic_;
  std::size_t n_, width_;
  LaneWorkspace work_;
  LaneSafety safety_;
  std::unique_ptr<KernelWorkspace> point_;  // energies
  std::vector<Lane> lanes_;
  std::vector<taylor::Turns> turns_;  // [lanes]
  std::vector<double> energy_, leading_;
  std::vector<double> chosen_;           // [lanes] lengths that the control chose
  std::vector<Compensated> position_;    // [n] of one lane
  std::vector<double> whole_, inverse_;  // see LaneArrays
  AlignedArray memory_;
  std::size_t used_ = 0;
  LaneArrays arrays_{};
  double *end_, *fresh_, *next_, *factor_;
  std::size_t active_ = 0;
  std::size_t rounds_ = 0;      // steps of all lanes so far
  std::size_t last_round_ = 0;  // in which no lane has used up its steps
  bool any_fresh_ = false;      // a lane has no length yet
  bool shared_parameters_, exhausted_ = false;
};

Batch::Batch(Job& job)
    : job_(job),
      arithmetic_(best_steps()),
      n_(job.freedoms),
      width_(static_cast<std::size_t>(job.expansion->width())),
      work_(job.kernel, job.control.order, job.expansion),
      safety_(job, work_),
      lanes_(width_),
      turns_(width_, taylor::Turns(job.kernel)),
      energy_(job.options.energy_terms),
      leading_(n_),
      chosen_(width_),
      position_(n_),
      memory_(aligned((8 * n_ + 11) * width_)) {
  if (job.options.energy_terms > 0) point_ = std::make_unique<KernelWorkspace>(job.kernel, 1);
  arrays_.width = width_;
  arrays_.freedoms = n_;
  arrays_.order = job.control.order;
  for (int k = 0; k < arrays_.order + 3; ++k) {
    whole_.push_back(k);
    inverse_.push_back(-1.0 / k);
  }
  arrays_.whole = whole_.data();
  arrays_.inverse = inverse_.data();
  arrays_.coefficients = work_.coordinate(0);
  arrays_.row = static_cast<std::size_t>(work_.coordinate(1) - work_.coordinate(0));
  arrays_.q_high = take(n_), arrays_.q_low = take(n_), arrays_.v_high = take(n_), arrays_.v_low = take(n_);
  arrays_.t_high = take(1), arrays_.t_low = take(1), arrays_.length = take(1), arrays_.step = take(1);
  arrays_.reaches = take(1), arrays_.shrinks = take(1);
  arrays_.end = end_ = take(1), fresh_ = take(1);
  arrays_.next = next_ = take(1);
  arrays_.factor = factor_ = take(1);
  arrays_.acceleration = take(n_), arrays_.sizes = take(3 * n_), arrays_.radius = take(1);
  std::fill_n(factor_, width_, job.control.factor);
  arrays_.quality = work_.quality();
  // LinearSolver takes M₀ for singular at a sixteenth of this.
  arrays_.least_quality = 64 * std::numeric_limits<double>::epsilon() * static_cast<double>(n_);
  shared_parameters_ = job.start.parameters.size() == job.kernel.parameters();
  if (!shared_parameters_) return;
  for (std::size_t lane = 0; lane < width_; ++lane) work_.set_parameters(static_cast<int>(lane), job.start.parameters);
  if (point_) point_->set_parameters(job.start.parameters);
}

void Batch::run() {
  for (std::size_t lane = 0; lane < width_; ++lane) refill(lane);
  while (active_ > 0) step();
}

// --------------------------------------------------------------------------------------------------------- filling

/// The next trajectory that has a way to go.
void Batch::refill(std::size_t lane) {
  while (!exhausted_ && !lanes_[lane].active) {
    const std::size_t trajectory = job_.take();
    if (trajectory == job_.trajectories)
      exhausted_ = true;
    else if (!is_finite(job_, trajectory))
      run_alone(job_, trajectory);
    else
      begin(lane, trajectory);
  }
}

void Batch::begin(std::size_t lane, std::size_t trajectory) {
  Lane& l = lanes_[lane];
  l = {trajectory, true, rounds_, OutputTimes(job_.start.times, job_.begin(trajectory), job_.end(trajectory)), {}};
  next_[lane] = l.times.next();
  factor_[lane] = job_.control.factor * job_.step_factor(trajectory);
  last_round_ = 0;
  ++active_;
  if (!shared_parameters_) work_.set_parameters(static_cast<int>(lane), job_.parameters(trajectory));
  for (std::size_t i = 0; i < n_; ++i) {
    arrays_.q_high[at(i, lane)] = job_.q(trajectory)[i];
    arrays_.v_high[at(i, lane)] = job_.v(trajectory)[i];
    arrays_.q_low[at(i, lane)] = arrays_.v_low[at(i, lane)] = 0;
  }
  arrays_.t_high[lane] = job_.begin(trajectory);
  arrays_.t_low[lane] = 0;
  end_[lane] = job_.end(trajectory);
  arrays_.length[lane] = 0;
  any_fresh_ = true;
  safety_.begin(lane, job_.parameters(trajectory));
  turns_[lane].forget();
  for (std::size_t i = 0; i < n_; ++i) position_[i] = {job_.q(trajectory)[i], 0};
  note_energy(lane, arrays_.t_high[lane], position_, job_.v(trajectory));
  if (end_[lane] != arrays_.t_high[lane]) return;
  sample(lane, end_[lane]);
  finish(lane, StepEnding::None, {});
}

// ----------------------------------------------------------------------------------------------------------- steps

void Batch::step() {
  if (job_.interrupted()) return interrupt();
  wind();
  expand();
  check_ends();
  choose_lengths();
  keep_lengths_safe();
  const bool wanted = arithmetic_.cut_to_end(arrays_) || rounds_ >= last_round_;
  std::copy_n(chosen_.begin(), width_, arrays_.length);
  if (wanted) look();
  arithmetic_.advance(arrays_);
  for (std::size_t lane = 0; lane < width_; ++lane)
    if (lanes_[lane].active) safety_.expect(lane, arrays_.step[lane], arrays_.acceleration + lane);
  ++rounds_;
  for (std::size_t lane = 0; wanted && lane < width_; ++lane) {
    if (lanes_[lane].active && arrays_.reaches[lane] != 0) finish_if_it_holds(lane);
    refill(lane);
  }
}

void Batch::interrupt() {
  for (std::size_t lane = 0; lane < width_; ++lane)
    if (lanes_[lane].active) finish(lane, StepEnding::Interrupted, "The run was interrupted.");
  // Those that are left end where they begin.
  for (std::size_t trajectory = job_.take(); trajectory != job_.trajectories; trajectory = job_.take())
    run_alone(job_, trajectory);
}

/// As TaylorStepper: angles stay within a turn, so that what is rounded does not grow with the number of turns.
void Batch::wind() {
  if (!arithmetic_.exceed(arrays_, taylor::Turns::limit)) return;
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t lane = 0; lane < width_; ++lane) {
      double &high = arrays_.q_high[at(i, lane)], &low = arrays_.q_low[at(i, lane)];
      Compensated angle{high, low};
      if (lanes_[lane].active && turns_[lane].wind(i, angle)) high = angle.hi, low = angle.lo;
    }
}

void Batch::expand() {
  const std::size_t size = n_ * width_;
  std::copy_n(arrays_.q_high, size, work_.coordinate(0));
  std::copy_n(arrays_.v_high, size, work_.coordinate(1));
  std::copy_n(arrays_.t_high, width_, work_.time());
  work_.expand();
}

/// Where no step was made before, the control begins with a guess and takes a few turns.
void Batch::choose_lengths() {
  for (std::size_t lane = 0; any_fresh_ && lane < width_; ++lane) {
    const bool fresh = lanes_[lane].active && arrays_.length[lane] == 0;
    fresh_[lane] = fresh;
    if (fresh) arrays_.length[lane] = first_length(lane);
  }
  for (int turn = 0; any_fresh_ && turn < 3; ++turn) arithmetic_.choose_length(arrays_, fresh_);
  any_fresh_ = false;
  arithmetic_.choose_length(arrays_, nullptr);
}

/// A lane whose last step did not end as the equations say is run anew alone, where steps can be taken back.
void Batch::check_ends() {
  bool refilled = false;
  for (std::size_t lane = 0; lane < width_; ++lane)
    if (lanes_[lane].active && !safety_.holds(lane, arrays_.t_high[lane])) {
      go_alone(lane);
      refill(lane);
      refilled = true;
    }
  if (refilled) expand();
}

/// Lengths that no value of the program forbids, as TaylorStepper has them. The control goes on from what it chose
/// itself.
void Batch::keep_lengths_safe() {
  std::copy_n(arrays_.length, width_, chosen_.begin());
  const auto left = [this](std::size_t lane) {
    return std::abs((end_[lane] - arrays_.t_high[lane]) - arrays_.t_low[lane]);
  };
  const auto makes_step = [&](std::size_t lane) {
    return lanes_[lane].active && left(lane) > 0 && arrays_.length[lane] > 0;
  };
  for (std::size_t lane = 0; lane < width_; ++lane)
    arrays_.radius[lane] = makes_step(lane) ? safety_.radius(arrays_.length[lane], left(lane)) : 0.0;
  arithmetic_.find_sizes(arrays_);
  for (std::size_t lane = 0; lane < width_; ++lane) {
    if (!makes_step(lane)) continue;
    arrays_.length[lane] =
        safety_.within(lane, arrays_.t_high[lane], arrays_.length[lane], left(lane), arrays_.sizes + lane);
  }
}

double Batch::velocity(std::size_t lane, std::size_t i, int k) const {
  return (k + 1) * std::abs(work_.coordinate(k + 1)[at(i, lane)]);
}

/// From the decay of the first coefficients to the last: first_guess of integrator/taylor/step_size.cpp.
double Batch::first_length(std::size_t lane) const {
  const int p = job_.control.order;
  double growth = 0;
  for (std::size_t i = 0; i < n_; ++i)
    for (int k = p - 1; k <= p; ++k)
      for (int j = std::min({3, p - 2, k - 1}); j >= 0; --j)
        if (velocity(lane, i, j) > 0)
          growth = std::max(growth, std::pow(velocity(lane, i, k) / velocity(lane, i, j), 1.0 / (k - j)));
  return growth > 0 ? 1 / growth : 1;
}

void Batch::look() {
  constexpr std::size_t never = std::numeric_limits<std::size_t>::max();
  last_round_ = never;
  for (std::size_t lane = 0; lane < width_; ++lane) {
    if (!lanes_[lane].active) continue;
    const std::size_t first = lanes_[lane].first_round, most = job_.options.maximum_steps;
    last_round_ = std::min(last_round_, most < never - first ? first + most : never);
    look_at(lane);
  }
}

/// Decides whether the lane may make its step, and takes from it what is wanted on the way.
void Batch::look_at(std::size_t lane) {
  if (steps(lane) >= job_.options.maximum_steps)
    return finish(lane, StepEnding::TooManySteps, "The run used up its steps.");
  // Comparisons with NaN are false.
  if (!(arrays_.quality[lane] > arrays_.least_quality) || arrays_.shrinks[lane] != 0) return go_alone(lane);
  if (!std::isfinite(arrays_.length[lane])) arrays_.length[lane] = 0, any_fresh_ = true;
  const double reached =
      arrays_.reaches[lane] != 0 ? end_[lane] : arrays_.t_high[lane] + (arrays_.t_low[lane] + arrays_.step[lane]);
  sample(lane, reached);
}

void Batch::go_alone(std::size_t lane) {
  lanes_[lane].active = false;
  --active_;
  run_alone(job_, lanes_[lane].trajectory);
}

// --------------------------------------------------------------------------------------------------------- results

/// The requested times up to `reached`, by the polynomial of the step.
void Batch::sample(std::size_t lane, double reached) {
  Lane& l = lanes_[lane];
  l.times.up_to(reached, [&](std::size_t index, double t) {
    const std::size_t to = (l.trajectory * job_.result.times + index) * n_;
    const std::span<double> q = std::span(job_.result.sampled_q).subspan(to, n_),
                            v = std::span(job_.result.sampled_v).subspan(to, n_);
    state_after(lane, (t - arrays_.t_high[lane]) - arrays_.t_low[lane], position_, v);
    for (std::size_t i = 0; i < n_; ++i) q[i] = turns_[lane].unwound(i, position_[i]);
    note_energy(lane, t, position_, v);
  });
  next_[lane] = l.times.next();
}

/// As DenseOutput::advance.
void Batch::state_after(std::size_t lane, double tau, std::span<Compensated> q, std::span<double> v) const {
  for (std::size_t i = 0; i < n_; ++i) {
    double dq = 0, dv = 0;
    // At the beginning the coefficients may not be there yet.
    for (int k = job_.control.order + 1; tau != 0 && k >= 2; --k) {
      const double c = work_.coordinate(k)[at(i, lane)];
      dq = (dq + c) * tau;
      dv = dv * tau + k * c;
    }
    const std::size_t here = at(i, lane);
    q[i] = {arrays_.q_high[here], arrays_.q_low[here]};
    q[i].add((dq + (arrays_.v_high[here] + arrays_.v_low[here])) * tau);
    v[i] = arrays_.v_high[here] + (arrays_.v_low[here] + dv * tau);
  }
}

/// `q` is wound.
void Batch::note_energy(std::size_t lane, double t, std::span<const Compensated> q, std::span<const double> v) {
  if (!point_) return;
  if (!shared_parameters_) point_->set_parameters(job_.parameters(lanes_[lane].trajectory));
  for (std::size_t i = 0; i < n_; ++i) leading_[i] = q[i].hi;
  if (point_->evaluate(t, leading_, v) != KernelStatus::Ok) return;
  for (std::size_t i = 0; i < energy_.size(); ++i) energy_[i] = point_->observable(i);
  turns_[lane].add_to(energy_);
  lanes_[lane].drift.add(energy_);
}

/// The end of the last step is not expanded.
void Batch::finish_if_it_holds(std::size_t lane) {
  std::vector<double> v(n_);
  for (std::size_t i = 0; i < n_; ++i) leading_[i] = arrays_.q_high[at(i, lane)], v[i] = arrays_.v_high[at(i, lane)];
  if (safety_.holds_at(lane, arrays_.t_high[lane], leading_, v))
    finish(lane, StepEnding::None, {});
  else
    go_alone(lane);
}

void Batch::finish(std::size_t lane, StepEnding reason, std::string sentence) {
  Lane& l = lanes_[lane];
  const std::span<double> q = std::span(job_.result.q).subspan(l.trajectory * n_, n_),
                          v = std::span(job_.result.v).subspan(l.trajectory * n_, n_);
  for (std::size_t i = 0; i < n_; ++i) {
    position_[i] = {arrays_.q_high[at(i, lane)], arrays_.q_low[at(i, lane)]};
    q[i] = turns_[lane].unwound(i, position_[i]), v[i] = arrays_.v_high[at(i, lane)];
  }
  note_energy(lane, arrays_.t_high[lane], position_, v);
  TrajectoryEnding& ending = job_.result.endings[l.trajectory];
  ending.ending = reason;
  ending.reason = std::move(sentence);
  ending.t = arrays_.t_high[lane];
  ending.steps = steps(lane);
  ending.energy_drift = l.drift.value();
  l.active = false;
  --active_;
}

}  // namespace

void run_in_lanes(Job& job) { Batch(job).run(); }

}  // namespace maupertuis::ensemble

#include "integrator/ensemble/batch.hpp"

#include <maupertuis/integrator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace maupertuis::ensemble {

std::size_t Job::take() {
  if (failed.load(std::memory_order_relaxed)) return trajectories;
  return std::min(next.fetch_add(1, std::memory_order_relaxed), trajectories);
}

OutputTimes::OutputTimes(std::span<const double> times, double begin, double end)
    : times_(times), direction_(end < begin ? -1 : 1) {
  const auto low =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), std::min(begin, end)) - times.begin());
  const auto high =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), std::max(begin, end)) - times.begin());
  left_ = high - low;
  next_ = direction_ > 0 ? low : high - 1;  // not looked at where none is left
}

void EnergyDrift::add(std::span<const double> terms) {
  double energy = 0, scale = 0;
  for (const double term : terms) energy += term, scale += std::abs(term);
  if (!std::isfinite(energy)) return;  // a state without forces: the ending tells
  if (!begun_) first_ = energy;
  begun_ = true;
  scale_ = std::max(scale_, scale);
  error_ = std::max(error_, std::abs(energy - first_));
}

namespace {

/// What a lane has written before it was given up does not count.
void forget_samples(Job& job, std::size_t trajectory) {
  const std::size_t samples = job.result.times * job.freedoms;
  for (auto* values : {&job.result.sampled_q, &job.result.sampled_v})
    std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(trajectory * samples), samples,
                std::numeric_limits<double>::quiet_NaN());
}

std::string trouble_of(const Job& job, std::size_t trajectory) {
  if (!std::isfinite(job.end(trajectory))) return "The end is infinite or undefined.";
  return trouble_of_start(job.kernel, job.parameters(trajectory), job.begin(trajectory), job.q(trajectory),
                          job.v(trajectory));
}

/// It stays where it starts.
void refuse(Job& job, std::size_t trajectory, std::string reason) {
  TrajectoryEnding& ending = job.result.endings[trajectory];
  ending = {};
  ending.ending = StepEnding::Refused;
  ending.reason = std::move(reason);
  ending.t = job.begin(trajectory);
  ending.alone = true;
  forget_samples(job, trajectory);
  const auto place = static_cast<std::ptrdiff_t>(trajectory * job.freedoms);
  std::copy_n(job.q(trajectory).begin(), job.freedoms, job.result.q.begin() + place);
  std::copy_n(job.v(trajectory).begin(), job.freedoms, job.result.v.begin() + place);
}

}  // namespace

bool is_finite(const Job& job, std::size_t trajectory) {
  const auto finite = [](std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  return std::isfinite(job.begin(trajectory)) && std::isfinite(job.end(trajectory)) && finite(job.q(trajectory)) &&
         finite(job.v(trajectory)) && finite(job.parameters(trajectory));
}

void run_alone(Job& job, std::size_t trajectory) {
  if (std::string trouble = trouble_of(job, trajectory); !trouble.empty())
    return refuse(job, trajectory, std::move(trouble));
  TaylorOptions options;
  options.tolerance = job.options.tolerance;
  options.order = job.options.order;
  options.maximum_steps = job.options.maximum_steps;
  options.interrupt = job.options.interrupt;
  TaylorStepper stepper(job.kernel, job.parameters(trajectory), options);
  const double begin = job.begin(trajectory), end = job.end(trajectory);
  const std::size_t n = job.freedoms, energy_terms = job.options.energy_terms;
  stepper.start(begin, job.q(trajectory), job.v(trajectory));
  TrajectoryEnding& ending = job.result.endings[trajectory];
  ending = {};
  ending.alone = true;
  forget_samples(job, trajectory);
  OutputTimes times(job.start.times, begin, end);
  EnergyDrift drift;
  const auto energy_at = [&](double t) {
    if (energy_terms == 0) return;
    const Sample sample = stepper.sample(t);
    drift.add(std::span(sample.observables).first(energy_terms));
  };
  const auto output = [&] {
    times.up_to(stepper.time(), [&](std::size_t index, double t) {
      const std::size_t at = (trajectory * job.result.times + index) * n;
      stepper.state(t, std::span(job.result.sampled_q).subspan(at, n), std::span(job.result.sampled_v).subspan(at, n));
      energy_at(t);
    });
  };
  energy_at(begin);
  output();
  while (stepper.time() != end) {
    const Step step = stepper.step(end);
    output();
    ending.ending = step.ending;
    ending.reason = step.reason;
    ending.event = step.event;
    if (step.ending != StepEnding::None || step.event) break;
  }
  energy_at(stepper.time());
  ending.t = stepper.time();
  ending.steps = stepper.steps();
  ending.energy_drift = drift.value();
  std::copy_n(stepper.q().begin(), n, job.result.q.begin() + static_cast<std::ptrdiff_t>(trajectory * n));
  std::copy_n(stepper.v().begin(), n, job.result.v.begin() + static_cast<std::ptrdiff_t>(trajectory * n));
}

}  // namespace maupertuis::ensemble

#include "integrator/ensemble/batch.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

namespace maupertuis {
namespace {

using ensemble::Job;

void check(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options) {
  const std::size_t n = kernel.freedoms(), p = kernel.parameters();
  MAUP_REQUIRE(n > 0 && start.q.size() % n == 0 && start.v.size() == start.q.size());
  const std::size_t count = start.q.size() / n;
  MAUP_REQUIRE(start.parameters.size() == p || start.parameters.size() == count * p);
  MAUP_REQUIRE(start.begin.empty() || start.begin.size() == 1 || start.begin.size() == count);
  MAUP_REQUIRE(start.end.size() == 1 || start.end.size() == count);
  MAUP_REQUIRE(std::is_sorted(start.times.begin(), start.times.end()));
  MAUP_REQUIRE(options.energy_terms <= kernel.observables());
  MAUP_REQUIRE(options.width >= 0 && options.width <= 16 && (options.width & (options.width - 1)) == 0);
}

/// The interpreter decodes each instruction once for all lanes, so that two registers side by side pay.
std::shared_ptr<const LaneExpansion> expansion_for(const Kernel& kernel, const EnsembleOptions& options) {
  if (!fits_lanes(kernel)) return nullptr;
  if (options.expansion) return options.expansion(kernel, options.width > 0 ? options.width : best_lane_width());
  if (options.width == 0 && !lanes_pay()) return nullptr;
  return interpreted_lanes(kernel, options.width > 0 ? options.width : 2 * best_lane_width());
}

EnsembleResult empty_result(const Job& job, std::size_t times) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EnsembleResult result;
  result.freedoms = job.freedoms;
  result.times = times;
  result.order = job.control.order;
  result.endings.resize(job.trajectories);
  for (auto* values : {&result.q, &result.v}) values->resize(job.trajectories * job.freedoms);
  for (auto* values : {&result.sampled_q, &result.sampled_v}) values->assign(job.trajectories * times * job.freedoms, nothing);
  if (job.expansion) {
    result.width = job.expansion->width();
    result.backend = job.expansion->backend();
  }
  return result;
}

void work_on(Job& job) {
  if (job.expansion) return ensemble::run_in_lanes(job);
  for (std::size_t trajectory = job.take(); trajectory != job.trajectories; trajectory = job.take())
    ensemble::run_alone(job, trajectory);
}

/// As many threads as there is work for; the one that called is among them.
std::size_t thread_count(const Job& job) {
  const std::size_t wanted = job.options.threads > 0 ? static_cast<std::size_t>(job.options.threads)
                                                     : std::max(1u, std::thread::hardware_concurrency());
  const std::size_t at_once = job.expansion ? static_cast<std::size_t>(job.expansion->width()) : 1;
  return std::min(wanted, std::max<std::size_t>(1, job.trajectories / at_once));
}

/// Every thread until no trajectory is left. What one of them throws is thrown again when all have stopped.
void run(Job& job) {
  std::exception_ptr thrown;
  std::mutex guard;
  const auto guarded = [&] {
    try {
      work_on(job);
    } catch (...) {
      job.failed = true;
      const std::lock_guard lock(guard);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < thread_count(job); ++i) others.emplace_back(guarded);
  guarded();
  for (std::thread& thread : others) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace

EnsembleResult advance_ensemble(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options) {
  check(kernel, start, options);
  EnsembleResult result;
  Job job{.kernel = kernel, .start = start, .options = options, .control = taylor::step_control(options.tolerance, options.order),
          .expansion = expansion_for(kernel, options), .trajectories = start.q.size() / kernel.freedoms(),
          .freedoms = kernel.freedoms(), .result = result};
  result = empty_result(job, start.times.size());
  if (job.trajectories > 0) run(job);
  return result;
}

}  // namespace maupertuis

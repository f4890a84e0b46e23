#include "integrator/ensemble/batch.hpp"

#include <maupertuis/arguments.hpp>
#include <maupertuis/on_threads.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

using ensemble::Job;

void check(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options) {
  check_ensemble_start(start, kernel.freedoms(), kernel.parameters());
  check_argument(start.step_factors.empty() || start.step_factors.size() == start.q.size() / kernel.freedoms(),
                 "advance_ensemble: start.step_factors has another length than there are trajectories");
  check_argument(
      std::all_of(start.step_factors.begin(), start.step_factors.end(), [](double f) { return f > 0 && f <= 1; }),
      "advance_ensemble: one of start.step_factors is not in (0, 1]");
  check_argument(options.energy_terms <= kernel.observables(),
                 "advance_ensemble: options.energy_terms is more than the kernel has observables");
  check_argument(options.width >= 0 && options.width <= 16 && (options.width & (options.width - 1)) == 0,
                 "advance_ensemble: options.width is none of 0, 1, 2, 4, 8, 16");
}

/// Steps of all trajectories together, if all were as long as the first one of the first trajectory. Zero where it has
/// none.
double expected_steps(const Kernel& kernel, const EnsembleStart& start, const taylor::StepControl& control) {
  const std::size_t n = kernel.freedoms(), count = start.q.size() / n;
  if (count == 0) return 0;
  KernelWorkspace work(kernel, control.order);
  work.set_parameters(start.parameters.first(kernel.parameters()));
  const double begin = start.begin.empty() ? 0 : start.begin[0];
  if (work.expand(begin, start.q.first(n), start.v.first(n)) != KernelStatus::Ok) return 0;
  double duration = 0;
  for (std::size_t i = 0; i < count; ++i) duration += std::abs(start.end_of(i) - start.begin_of(i));
  return duration / taylor::step_size(work, n, control, 0);
}

/// The steps that pay for a compilation: it takes some tenths of a second, and saves some tenths of a microsecond a
/// step.
constexpr double enough_steps = 500'000;

/// Decided by the work that is expected, not by the clock nor by what the cache holds, so that equal calls give equal
/// results.
bool wants_code(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options,
                const taylor::StepControl& control) {
  if (options.backend != Backend::Automatic) return options.backend == Backend::Compiled;
  return expected_steps(kernel, start, control) >= enough_steps;
}

/// The expansion, with what there is to say of it. None: every trajectory goes alone.
CompiledLanes lanes_for(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options,
                        const taylor::StepControl& control) {
  CompiledLanes out;
  if (!fits_lanes(kernel)) return out;
  const int width = options.width > 0 ? options.width : best_lane_width();
  if (options.expansion) {
    out.expansion = options.expansion(kernel, width);
    return out;
  }
  if (options.width == 0 && !lanes_pay()) return out;
  if (wants_code(kernel, start, options, control))
    out = compiled_lanes(kernel, width, {.cache = options.cache, .long_run = true, .in_tiers = false, .processor = {}});
  // The interpreter decodes each instruction once for all lanes, so that two registers side by side pay.
  if (!out.expansion)
    out.expansion = interpreted_lanes(kernel, options.width > 0 ? options.width : std::min(16, 2 * width));
  return out;
}

EnsembleResult empty_result(const Job& job, std::size_t times) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EnsembleResult result;
  result.freedoms = job.freedoms;
  result.times = times;
  result.order = job.control.order;
  result.endings.resize(job.trajectories);
  for (auto* values : {&result.q, &result.v}) values->resize(job.trajectories * job.freedoms);
  for (auto* values : {&result.sampled_q, &result.sampled_v})
    values->assign(job.trajectories * times * job.freedoms, nothing);
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

/// Every thread until no trajectory is left.
void run(Job& job) {
  const std::size_t at_once = job.expansion ? static_cast<std::size_t>(job.expansion->width()) : 1;
  const std::size_t threads = thread_count(job.options.threads, job.trajectories / at_once);
  on_threads(
      threads, [&] { work_on(job); }, [&] { job.failed = true; });
}

}  // namespace

void check_ensemble_start(const EnsembleStart& start, std::size_t coordinates, std::size_t parameters) {
  check_argument(coordinates > 0, "advance_ensemble: the system has no coordinates");
  check_argument(start.q.size() % coordinates == 0,
                 "advance_ensemble: the length of start.q is no multiple of the number of coordinates");
  check_argument(start.v.size() == start.q.size(), "advance_ensemble: start.v has another length than start.q");
  const std::size_t count = start.q.size() / coordinates;
  const auto one_or_each = [&](std::size_t size) { return size == 1 || size == count; };
  check_argument(start.parameters.size() == parameters || start.parameters.size() == count * parameters,
                 "advance_ensemble: start.parameters has neither one value a parameter nor those of each trajectory");
  check_argument(start.begin.empty() || one_or_each(start.begin.size()),
                 "advance_ensemble: start.begin has neither one time nor one a trajectory");
  check_argument(one_or_each(start.end.size()),
                 "advance_ensemble: start.end has neither one time nor one a trajectory");
  check_argument(std::none_of(start.times.begin(), start.times.end(), [](double t) { return std::isnan(t); }),
                 "advance_ensemble: one of start.times is no time");
  check_argument(std::is_sorted(start.times.begin(), start.times.end()), "advance_ensemble: start.times do not ascend");
}

EnsembleResult advance_ensemble(const Kernel& kernel, const EnsembleStart& start, const EnsembleOptions& options) {
  check(kernel, start, options);
  EnsembleResult result;
  const taylor::StepControl control = taylor::step_control(options.tolerance, options.order);
  const CompiledLanes lanes = lanes_for(kernel, start, options, control);
  Job job{.kernel = kernel,
          .start = start,
          .options = options,
          .control = control,
          .expansion = lanes.expansion,
          .trajectories = start.q.size() / kernel.freedoms(),
          .freedoms = kernel.freedoms(),
          .result = result};
  result = empty_result(job, start.times.size());
  result.trouble = lanes.trouble;
  result.cache_trouble = lanes.cache_trouble;
  result.compile_seconds = lanes.seconds;
  if (job.trajectories > 0) run(job);
  return result;
}

}  // namespace maupertuis

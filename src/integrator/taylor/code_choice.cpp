#include "integrator/taylor/code_choice.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::taylor {

namespace {

/// Whether all stages of an expansion can be code without a loop that is there soon.
bool is_written_out_soon(const Kernel& kernel) {
  constexpr std::size_t most_unknowns = 8;
  return kernel.constraints() == 0 && kernel.freedoms() <= most_unknowns && kernel.switches().empty();
}

/// Steps from which code pays (docs/design/kernel_speed.md, "Default runs").
struct EnoughSteps {
  double stage_code, long_code;
};

EnoughSteps enough_for(const Kernel& kernel) {
  constexpr double written_out_soon = 3'500;  // an unknown
  constexpr double an_expansion = 200'000, slow_expansion = 1'000'000, usual_size = 8;
  constexpr std::size_t largest_written_out = 16;
  const std::size_t unknowns = kernel.freedoms() + kernel.constraints();
  const auto count = static_cast<double>(unknowns);
  const double a_stage = kernel.steps_that_repay_code();
  if (is_written_out_soon(kernel)) return {a_stage, written_out_soon * count};
  const bool is_slow_to_compile = count > usual_size && unknowns <= largest_written_out;
  return {a_stage, is_slow_to_compile ? slow_expansion : an_expansion};
}

}  // namespace

void CodeChoice::compile(KernelWorkspace& work, bool cache, Length length) {
  runs_long_ = length == Length::WholeExpansion;
  const CompileReport report =
      work.compile({.cache = cache, .long_run = runs_long_, .in_tiers = runs_long_, .processor = {}});
  const double before = use_.compile_seconds;
  if (report.compiled || !use_.compiled)
    use_ = {report.compiled, before + report.seconds, report.trouble, report.cache_trouble};
}

void CodeChoice::compile_at_once(KernelWorkspace& work, const TaylorOptions& options) {
  compile(work, options.cache, Length::Stage);
}

void CodeChoice::begin(double t, std::size_t steps) {
  const bool goes_on = (t - run_begin_) * way_ > 0;
  steps_before_ = goes_on ? steps_before_ + steps : 0;
  if (!goes_on) run_begin_ = t;
}

/// The expected number of steps decides, not the clock and not what the cache holds: so that equal runs give equal
/// results.
void CodeChoice::compile_if_it_pays(KernelWorkspace& work, const Kernel& kernel, const TaylorOptions& options,
                                    std::size_t steps, double t, double bound) {
  constexpr std::size_t first_look = 64;
  way_ = bound - t;
  const std::size_t all = steps_before_ + steps;
  if (options.backend == Backend::Interpreter || all < first_look || (all & (all - 1)) != 0) return;
  if (!use_.trouble.empty() || runs_long_) return;
  const double expected = static_cast<double>(all) * (1 + std::abs(way_ / (t - run_begin_)));
  const EnoughSteps enough = enough_for(kernel);
  if (expected >= enough.long_code)
    compile(work, options.cache, Length::WholeExpansion);
  else if (!use_.compiled && expected >= enough.stage_code)
    compile(work, options.cache, Length::Stage);
}

}  // namespace maupertuis::taylor

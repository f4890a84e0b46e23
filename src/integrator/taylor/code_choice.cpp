#include "integrator/taylor/code_choice.hpp"

#include <algorithm>

namespace maupertuis::taylor {

void CodeChoice::compile(KernelWorkspace& work, bool cache, bool long_run) {
  const CompileReport report = work.compile({.cache = cache, .long_run = long_run, .processor = {}});
  runs_long_ = long_run;
  const double before = use_.compile_seconds;
  if (report.compiled || !use_.compiled)
    use_ = {report.compiled, before + report.seconds, report.trouble, report.cache_trouble};
}

/// Code for a stage is there soon; code for the whole expansion of a small program is one and a half to six times as
/// fast and takes as long to compile as some 10⁵ steps, from 9 unknowns on as 10⁶. The expected number of steps
/// decides, not the clock and not what the cache holds: so that equal runs give equal results.
void CodeChoice::compile_if_it_pays(KernelWorkspace& work, const TaylorOptions& options, std::size_t unknowns,
                                    std::size_t steps, double done, double left) {
  constexpr std::size_t first_look = 512;
  constexpr double enough = 20'000, enough_for_long_code = 200'000, usual_size = 8;  // docs/design/kernel_speed.md
  constexpr double enough_for_slow_code =
      1'000'000;  // beyond the usual size, as far as whole expansions are written out
  constexpr std::size_t largest_written_out = 16;
  if (options.backend == Backend::Interpreter || steps < first_look || (steps & (steps - 1)) != 0) return;
  if (!use_.trouble.empty() || runs_long_) return;
  const double expected = static_cast<double>(steps) * (1 + left / done);
  const double size = std::max(1.0, static_cast<double>(unknowns) / usual_size);  // a step saves more of more
  const bool is_slow_to_compile = unknowns > usual_size && unknowns <= largest_written_out;
  if (expected >= (is_slow_to_compile ? enough_for_slow_code : enough_for_long_code))
    compile(work, options.cache, true);
  else if (!use_.compiled && expected * size >= enough)
    compile(work, options.cache, false);
}

}  // namespace maupertuis::taylor

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {

SimulationOptions report_run(const Model& model, SimulationOptions options) {
  if (options.output_every || model.experiment.output_every) return options;
  Expr length = model.experiment.until ? model.experiment.within : model.experiment.duration;
  double duration = options.duration.value_or(0);
  if (!options.duration && length)
    duration = evaluate(in_terms_of_motion(model.system, {&length, 1}).front(), parameter_bindings(model.system));
  if (std::isfinite(duration) && duration != 0)
    options.output_every = std::abs(duration) / std::clamp(std::round(50 * std::abs(duration)), 1000.0, 10'000.0);
  return options;
}

}  // namespace maupertuis

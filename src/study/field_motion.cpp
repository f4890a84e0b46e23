#include <maupertuis/evaluate.hpp>
#include <maupertuis/study.hpp>

namespace maupertuis {
namespace {

/// A map over time shows what happens between a hundred moments.
void refine_for_pictures(FieldRunOptions& options, bool line) {
  if (!(options.every > 0)) options.every = options.duration / (line ? 240 : 120);
  options.least_values = line ? 480 : 64;
}

}  // namespace

std::optional<FieldRunResult> Study::field_motion(const SimulationOptions& settings, const FieldMotionOptions& kept) {
  const FieldEquations* equations = field_equations();
  Diagnostics found;
  if (model() && !has_fields()) {
    found.error("E0512", std::nullopt, "this question is about fields, and the model has none",
                "Its motion is that of coordinates.", "`simulate` and Study::motion run it.");
    tell(found);
  }
  if (!equations) return std::nullopt;
  const Model& model = *this->model();
  const FieldSystem& s = equations->system();
  Bindings values;
  for (const Parameter& p : model.system.parameters) values[p.symbol] = p.si_value;
  const auto number = [&](Expr e) { return e ? evaluate(s.expanded(e), values) : 0.0; };
  FieldRunOptions options;
  options.interrupt = settings.interrupt;
  options.progress = settings.progress;
  options.announce = kept.announce;
  options.begin = number(model.experiment.start_time);
  options.duration = settings.duration ? *settings.duration : number(model.experiment.duration);
  options.every = settings.output_every ? *settings.output_every : number(model.experiment.output_every);
  options.trajectory = kept.rows;
  options.errors = options.orders = kept.errors;
  options.moments = kept.moments;
  options.currents = kept.currents;
  if (kept.pictured) refine_for_pictures(options, s.space.size() == 1);
  const bool until = model.experiment.until && runs_as_one_system(*equations) && !settings.duration;
  if (!(options.duration > 0) && !until) {
    found.error("E0701", std::nullopt, "the model does not say how long it runs",
                "A run of a field goes on for a time.",
                "Add `run 10 s`, or give --duration; the equilibrium next to the start is that of `maup modes`.");
    tell(found);
    return std::nullopt;
  }
  const InterruptScope scope = interruptible();
  auto result = runs_as_one_system(*equations) ? run_coupled(model, *equations, kept.questions, options, found)
                                               : run_fields(*equations, kept.questions, options, found);
  tell(found);
  return result;
}

}  // namespace maupertuis

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/study.hpp>

namespace maupertuis {

std::optional<ConsistentStart> look_into_start(const Model& model, const EquationsOfMotion& equations,
                                               Diagnostics& diagnostics) {
  auto start = consistent_start(model, equations, diagnostics);
  const MotionState* state = start ? &start->state : nullptr;
  report_constraints(analyse_constraints(equations, state), equations, state, diagnostics);
  const bool runs = !model.experiment.start.empty() || model.experiment.duration || model.experiment.until;
  if (state && model.system.has_modes() && runs) contact_start(model, equations, *state, diagnostics);
  diagnostics.sort_by_place();
  return start;
}

}  // namespace maupertuis

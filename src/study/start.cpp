#include <maupertuis/study.hpp>

namespace maupertuis {

StartFindings look_into_start(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  StartFindings out;
  out.start = consistent_start(model, equations, diagnostics);
  const MotionState* state = out.start ? &out.start->state : nullptr;
  out.constraints = analyse_constraints(equations, state);
  report_constraints(out.constraints, equations, state, diagnostics);
  const bool asks_for_motion = !model.experiment.start.empty() || model.experiment.duration || model.experiment.until;
  if (state && model.system.has_modes() && asks_for_motion)
    out.contacts = contact_start(model, equations, *state, diagnostics);
  diagnostics.sort_by_place();
  return out;
}

}  // namespace maupertuis

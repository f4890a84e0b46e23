#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/orbits.hpp>
#include <maupertuis/page_findings.hpp>
#include <maupertuis/simulation.hpp>

namespace maupertuis {

std::optional<Invariants> page_invariants(const Model& model, const EquationsOfMotion& equations) {
  InvariantsOptions search;
  search.largest_basis = 600;
  search.drift = false;
  Diagnostics unheard;
  return find_invariants(model, equations, search, unheard);
}

PageModes page_modes(const Model& model, const EquationsOfMotion& equations, const Interrupt& interrupt) {
  Diagnostics unheard;
  const auto start = consistent_start(model, equations, unheard);
  if (!start || has_free_functions(equations)) return {};
  PointEquations at_points(solvable_equations(equations));
  PageModes out;
  out.modes = modal_study(at_points, start->state, unheard);
  if (out.modes) settle_driven(*out.modes, at_points, model, equations, interrupt);
  interrupt.throw_if_asked();
  if (const auto& sweep = model.experiment.sweep) {
    const auto value = [&](Expr e) {
      return evaluate(in_terms_of_motion(model.system, {&e, 1}).front(), parameter_bindings(model.system));
    };
    out.locus = parameter_locus(at_points, start->state, sweep->parameter, value(sweep->from), value(sweep->to),
                                sweep->steps, driven_neighbours(model, equations, sweep->parameter, interrupt));
    if (out.locus->interrupted) throw Interrupted();
  }
  return out;
}

}  // namespace maupertuis

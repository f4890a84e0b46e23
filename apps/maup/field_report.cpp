#include "field_report.hpp"

#include "fields_text.hpp"
#include "interrupt.hpp"

#include <fmt/format.h>

#include <maupertuis/field_report.hpp>
#include <maupertuis/field_verification.hpp>

#include <algorithm>

namespace maupertuis::app {

void check_field_sections(const std::vector<std::string>& chosen, Diagnostics& diagnostics) {
  for (const char* name : {"orbits", "paths", "phase-space"})
    if (std::find(chosen.begin(), chosen.end(), name) != chosen.end())
      diagnostics.error("E0809", {}, fmt::format("--sections: a report of fields has no section `{}`.", name),
                        "It is about coordinates, and the model has fields.",
                        "It has equations, motion, modes, conserved, derivation, expectations.");
}

std::optional<std::string> page_of_fields(Study& study, const SimulationOptions& settings, bool with_run,
                                          SectionBudget& budget) {
  const FieldEquations* equations = study.field_equations();
  if (!equations) return std::nullopt;
  const Model& model = *study.model();
  Context& context = *equations->system().context;
  FieldReportParts parts;
  std::optional<FieldRunResult> run;
  std::optional<FieldCurrents> currents;
  std::optional<ComplexExpr> waves;
  FieldModes modes;
  std::optional<Verification> verification;
  Diagnostics unheard;
  budget.carry_out("conserved", context, [&](const Interrupt&) { currents = field_currents(*equations); });
  if (with_run && model.experiment.duration)
    budget.carry_out("motion", context, [&](const Interrupt& interrupt) {
      SimulationOptions within = settings;
      within.interrupt = interrupt;
      run = run_of_fields(study, within, {true, true, {}, currents ? &*currents : nullptr});
    });
  if (study.wrong()) return std::nullopt;
  budget.carry_out("expectations", context, [&](const Interrupt& interrupt) {
    SimulationOptions within = settings;
    within.interrupt = interrupt;
    if (!model.experiment.expectations.empty() || !model.fields->expectations.empty())
      verification = verify_fields(model, *equations, study.source(), within, study.diagnostics());
  });
  budget.carry_out("modes", context, [&](const Interrupt&) {
    std::string trouble;
    waves = dispersion(*equations, trouble);
    modes = field_modes(*equations, 6, unheard);  // none where the field has no such modes
  });
  parts.with_equations = budget.wanted("equations"), parts.with_derivation = budget.wanted("derivation");
  if (run && run->trajectory.rows() > 1) parts.run = &*run;
  if (currents) parts.currents = &*currents;
  if (waves) parts.dispersion = &*waves;
  if (!modes.frequencies.empty() || modes.equilibrium) parts.modes = &modes;
  if (verification) parts.verification = &*verification;
  ReportContent content = compose_field_report(model, study.source(), *equations, *study.field_certificate(), parts);
  study.diagnostics().append(budget.warnings());
  add_messages(content, study.diagnostics(), study.source());
  return report_html(content);
}

}  // namespace maupertuis::app

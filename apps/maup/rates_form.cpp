#include "rates_form.hpp"

#include <fmt/format.h>

#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

namespace maupertuis::app {

EquationForm rates_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  const MechanicalSystem& system = *equations.shown().system;
  const std::vector<Rate> rates = system.rates.empty() ? body_rates(system) : system.rates;
  if (rates.empty()) {
    study.diagnostics().error("E0694", {}, "The model names no rates, and no body turns in space.",
                              "The form in rates has other velocities than q': combinations of them that are given.",
                              "Write for example `rates v = x' cos ψ + y' sin ψ, w = ψ'`.");
    return {};
  }
  const RatesResult result = equations_in_rates(equations, rates);
  if (!result.equations) {
    study.diagnostics().error("E0695", {}, "The equations cannot be written in these rates.", result.reason,
                              "`--form standard` shows them in q''.");
    return {};
  }
  const EquationsInRates& found = *result.equations;
  if (found.certificate.verdict != Verdict::Zero)
    study.diagnostics().warning("W0691", {}, "The form in rates could not be compared with the derivation.",
                                found.certificate.reason, "It is shown, but it is not certified.");
  EquationForm form;
  form.order = found.order;
  form.intermediates = found.intermediates;
  for (const EquationsInRates::Row& row : found.rows) {
    form.lines.push_back({row.rate, {}, row.form, {}, {}, {}, false});
    form.intermediates.insert(form.intermediates.end(), row.form.intermediates.begin(), row.form.intermediates.end());
  }
  for (const EquationsInRates::Velocity& v : found.kinematics) {
    const Coordinate& c = system.coordinates[v.coordinate];
    form.lines.push_back({c.name, lay_out(c.velocity, found.order), v.form, {}, {}, {}, false});
    form.intermediates.insert(form.intermediates.end(), v.form.intermediates.begin(), v.form.intermediates.end());
  }
  const Derivation& derivation = *study.derivation(false);
  for (std::size_t k = 0; k < derivation.constraints.size(); ++k) {
    if (system.constraints[k].level == Constraint::Level::Velocity) continue;  // q' obeys it
    EquationLine line;
    line.right.value = derivation.constraints[k].left;
    line.equal_to = derivation.constraints[k].right;
    line.note = derivation.constraints[k].name;
    form.constraints.push_back(std::move(line));
  }
  return form;
}

}  // namespace maupertuis::app

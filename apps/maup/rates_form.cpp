#include "rates_form.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <maupertuis/higher_order.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

namespace maupertuis::app {
namespace {

std::string with_legend(const std::string& left, const ReadableForm& form, const ReadingOrder& order) {
  std::string out = fmt::format("  {} = {}\n", left, to_plain(form.value, order));
  for (const Intermediate& i : form.intermediates)
    out += fmt::format("    with {} = {}\n", to_plain(i.symbol, order), to_plain(i.value, order));
  return out;
}

std::vector<Rate> rates_of(const MechanicalSystem& system) {
  return system.rates.empty() ? body_rates(system) : system.rates;
}

/// Rows of one set of equations list the same names.
void append_line(EquationForm& form, const ReadableForm& line) {
  for (const Intermediate& i : line.intermediates) {
    const bool known = std::any_of(form.intermediates.begin(), form.intermediates.end(),
                                   [&](const Intermediate& other) { return other.symbol == i.symbol; });
    if (!known) form.intermediates.push_back(i);
  }
}

EquationForm form_of(EquationsInRates found, Study& study) {
  const MechanicalSystem& system = *study.equations()->shown().system;
  EquationForm form;
  form.intermediates = found.intermediates;
  for (const EquationsInRates::Row& row : found.rows) {
    form.lines.push_back({row.rate, {}, row.form, {}, {}, {}, false});
    append_line(form, row.form);
  }
  for (const EquationsInRates::Velocity& v : found.kinematics) {
    const Coordinate& c = system.coordinates[v.coordinate];
    form.kinematics.push_back({c.name, lay_out(c.velocity, found.order), v.form, {}, {}, {}, false});
    append_line(form, v.form);
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
  form.in_rates = std::make_shared<const EquationsInRates>(std::move(found));
  return form;
}

/// The width of all its lines, as a reader goes through them.
double width_of(const EquationForm& form, const ReadingOrder& order) {
  double all = 0;
  for (const auto* lines : {&form.lines, &form.kinematics, &form.constraints})
    for (const EquationLine& line : *lines) {
      const FormulaLine shown = shown_line(line, order);
      all += width(shown.left) + width(shown.right);
    }
  for (const Intermediate& i : form.intermediates) all += width(lay_out(i.value, order));
  return all;
}

}  // namespace

EquationForm rates_form(Study& study) {
  const EquationsOfMotion& equations = *study.equations();
  const std::vector<Rate> rates = rates_of(*equations.shown().system);
  if (rates.empty()) {
    study.diagnostics().error("E0694", {}, "The model names no rates, and no body turns in space.",
                              "The form in rates has other velocities than q': combinations of them that are given.",
                              "Write for example `rates v = x' cos ψ + y' sin ψ, w = ψ'`.");
    return {};
  }
  RatesResult result = equations_in_rates(equations, rates);
  if (!result.equations) {
    study.diagnostics().error("E0695", {}, "The equations cannot be written in these rates.", result.reason,
                              "`--form standard` shows them in q''.");
    return {};
  }
  if (result.equations->certificate.verdict != Verdict::Zero)
    study.diagnostics().warning("W0691", {}, "The form in rates could not be compared with the derivation.",
                                result.equations->certificate.reason, "It is shown, but it is not certified.");
  return form_of(*std::move(result.equations), study);
}

EquationForm form_in_rates_if_shorter(Study& study, const EquationForm& standard) {
  const EquationsOfMotion& equations = *study.equations();
  std::optional<EquationsInRates> found = equations_in_own_rates(equations);
  if (!found) return standard;
  const bool named = !equations.shown().system->rates.empty();
  EquationForm form = form_of(*std::move(found), study);
  return named || width_of(form, form.order(equations)) < width_of(standard, equations.order) ? form : standard;
}

std::vector<FormulaLine> rate_definitions(const EquationForm& form, const EquationsOfMotion& equations) {
  std::vector<FormulaLine> lines;
  const EquationsInRates& r = *form.in_rates;
  for (std::size_t a = 0; a < r.rates.size(); ++a) {
    if (r.definitions[a] == r.rates[a]) continue;  // a velocity that stays
    FormulaLine line;
    line.left = lay_out(r.rates[a], r.order);
    line.right = lay_out(readable(r.definitions[a], equations.order).value, r.order);
    line.known = true;
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string rates_text(const EquationForm& form, const EquationsOfMotion& equations) {
  const EquationsInRates& r = *form.in_rates;
  std::string out = "\nRates\n";
  for (const FormulaLine& line : rate_definitions(form, equations)) out += fmt::format("  {}\n", plain_text(line));
  out += "\nLagrangian in rates\n" + with_legend("L", readable(r.lagrangian, r.order), r.order);
  out += "\nMomenta\n";
  for (std::size_t a = 0; a < r.rates.size(); ++a)
    out += with_legend("∂L/∂" + to_plain(r.rates[a], r.order), r.momenta[a], r.order);
  return out;
}

std::vector<DerivationStep> steps_to(const EquationForm& form, Study& study) {
  if (!study.equations()->system->higher.empty()) return higher_order_steps(*study.equations());
  std::vector<DerivationStep> steps = study.derivation(true)->steps;
  if (!form.in_rates) return steps;
  std::erase_if(steps, [](const DerivationStep& step) {
    const std::string& s = step.section;
    return s.substr(0, 12) == "Equation of " || s.substr(0, 6) == "Solved" || s == "Multipliers eliminated" ||
           s == "Reactions" || s == "Constraints differentiated";
  });
  steps.insert(steps.end(), form.in_rates->steps.begin(), form.in_rates->steps.end());
  return steps;
}

Certificate with_rates_check(Certificate certificate, const EquationForm& form) {
  if (!form.in_rates) return certificate;
  const ZeroTest& test = form.in_rates->certificate;
  CertificateCheck check;
  check.name = "rates_form";
  check.statement = "the equations in rates are Lagrange's along the velocities that the constraints leave free";
  check.verdict = test.verdict;
  check.points = test.points;
  check.error_bound = test.error_bound;
  check.reason = test.reason;
  certificate.checks.push_back(std::move(check));
  return certificate;
}

}  // namespace maupertuis::app

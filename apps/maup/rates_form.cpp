#include "rates_form.hpp"

#include <fmt/format.h>

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

}  // namespace

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
  EquationForm form;
  form.in_rates = std::make_shared<const EquationsInRates>(*result.equations);
  const EquationsInRates& found = *form.in_rates;
  if (found.certificate.verdict != Verdict::Zero)
    study.diagnostics().warning("W0691", {}, "The form in rates could not be compared with the derivation.",
                                found.certificate.reason, "It is shown, but it is not certified.");
  form.intermediates = found.intermediates;
  for (const EquationsInRates::Row& row : found.rows) {
    form.lines.push_back({row.rate, {}, row.form, {}, {}, {}, false});
    form.intermediates.insert(form.intermediates.end(), row.form.intermediates.begin(), row.form.intermediates.end());
  }
  for (const EquationsInRates::Velocity& v : found.kinematics) {
    const Coordinate& c = system.coordinates[v.coordinate];
    form.kinematics.push_back({c.name, lay_out(c.velocity, found.order), v.form, {}, {}, {}, false});
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

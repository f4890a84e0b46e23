#include "derivation_text.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/higher_order.hpp>

#include "outcome.hpp"
#include "quantity.hpp"
#include "rates_form.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <maupertuis/across_switches.hpp>
#include <maupertuis/couplings.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/shared_form.hpp>

namespace maupertuis::app {
namespace {

std::string step_text(const DerivationStep& step, const ReadingOrder& order) {
  if (!step.right) return step.sentence;
  const std::string rule = step.rule.empty() ? step.section : step.rule;
  const std::string note = step.sentence.empty() ? rule : rule + "; " + step.sentence;
  return fmt::format("{} = {}    ({})", to_plain(step.left), to_plain(step.right, order), note);
}

std::string steps_text(const std::vector<DerivationStep>& steps, const ReadingOrder& order) {
  std::string out, section;
  for (const DerivationStep& step : steps) {
    if (step.section != section) {
      section = step.section;
      out += fmt::format("{}{}\n", out.empty() ? "" : "\n", section);
    }
    out += "  " + step_text(step, order) + "\n";
    for (const Intermediate& i : step.intermediates)
      out += fmt::format("    with {} = {}\n", to_plain(i.symbol, order), to_plain(i.value, order));
  }
  return out;
}

std::string legend(const MechanicalSystem& system, const ReadingOrder& order) {
  std::string out;
  for (const Definition& definition : system.definitions)
    if (definition.symbol && definition.value)
      out += fmt::format("  {} = {}\n", to_plain(definition.symbol, order), to_plain(definition.value, order));
  return out.empty() ? out : "\nDefinitions\n" + out;
}

std::string readable_line(const std::string& left, Expr value, const ReadingOrder& order) {
  const ReadableForm form = readable(value, order);
  std::string out = fmt::format("  {} = {}\n", left, to_plain(form.value, order));
  for (const Intermediate& i : form.intermediates)
    out += fmt::format("    with {} = {}\n", to_plain(i.symbol, order), to_plain(i.value, order));
  return out;
}

/// Lines of a system in which everything is coupled: by the parts that they share with what stands above.
class SharedLines {
 public:
  SharedLines(const ReadingOrder& order, std::vector<Intermediate> known) : order_(order), known_(std::move(known)) {}

  std::string operator()(const std::vector<std::string>& names, std::span<const Expr> values) {
    const SharedForm form = shared_form(values, order_, known_);
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i)
      out += fmt::format("  {} = {}\n", names[i], to_plain(form.rows[i], order_));
    if (!form.intermediates.empty()) out += "with\n";
    for (const Intermediate& i : form.intermediates)
      out += fmt::format("  {} = {}\n", to_plain(i.symbol, order_), to_plain(i.value, order_));
    known_.insert(known_.end(), form.intermediates.begin(), form.intermediates.end());
    return out;
  }

 private:
  const ReadingOrder& order_;
  std::vector<Intermediate> known_;
};

std::string momenta_and_energy(const EquationsOfMotion& equations, const Derivation& derivation) {
  const ConservedQuantities conserved = conserved_quantities(equations);
  std::vector<std::string> momenta;
  for (const Coordinate& c : equations.system->coordinates) momenta.push_back("p_" + c.name);
  SharedLines shared(equations.order, derivation.intermediates);
  const bool is_dense = couples_too_much_to_read(equations);
  const auto lines = [&](const std::vector<std::string>& names, std::span<const Expr> values) {
    if (is_dense) return shared(names, values);
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) out += readable_line(names[i], values[i], equations.order);
    return out;
  };
  std::string out = "\nMomenta\n" + lines(momenta, equations.shown().momenta);
  out += "\nEnergy function\n" + lines({"h_E"}, {&equations.shown().energy_function, 1});
  if (!conserved.energy_case.empty()) out += fmt::format("  {}\n", conserved.energy_case);
  if (!conserved.energy_conserved)
    out += lines({"dh_E/d" + equations.system->independent}, {&equations.shown().power, 1});
  if (const auto jump = across_switches(*equations.system, equations.energy_function, equations.order).jump)
    out += fmt::format("  h_E jumps where {}: what is switched there does work at once.\n", jump->place);

  std::vector<std::string> names;
  for (const std::size_t i : conserved.conserved_momenta)
    names.push_back(fmt::format("{} ({} is cyclic)", momenta[i], equations.system->coordinates[i].name));
  if (conserved.energy_conserved) names.emplace_back("h_E");
  out += fmt::format("\nConserved\n  {}\n",
                     names.empty() ? "nothing among the momenta and h_E" : fmt::format("{}", fmt::join(names, ", ")));
  return out;
}

/// With what force the constraints hold, and what its sign means.
std::string reactions_text(const EquationsOfMotion& equations) {
  std::string out;
  for (const Reaction& r : reactions(equations)) {
    if (out.empty()) out = "\nReactions\n";
    if (r.value)
      out += readable_line(r.name, r.value, equations.order) + "    " + r.sentence + "\n";
    else
      out += fmt::format("  {}: {}\n", r.name, r.sentence);
  }
  return out;
}

}  // namespace

/// Random points are a proof as far as the probability goes with which they miss a difference.
std::string verdict_of(const Certificate& certificate) {
  constexpr double proved = 1e-3;
  if (!certificate.passed()) return "NOT PASSED";
  const bool all = std::all_of(certificate.checks.begin(), certificate.checks.end(), [](const CertificateCheck& check) {
    return !check.applies || check.error_bound <= proved;
  });
  return all ? "passed" : "passed at random points, not proved: the formulas are too large for a useful bound";
}

std::string certificate_text(const Certificate& certificate) {
  std::string out = fmt::format("\nCertificate: {}\n", verdict_of(certificate));
  std::size_t name_width = 17;
  for (const CertificateCheck& check : certificate.checks) name_width = std::max(name_width, check.name.size());
  for (const CertificateCheck& check : certificate.checks) {
    std::string ground;
    if (!check.applies)
      ground = "does not apply";
    else if (check.verdict != Verdict::Zero)
      ground = fmt::format("{}: {}", verdict_name(check.verdict), check.reason);
    else if (check.points == 0 && check.error_bound == 0)
      ground = "term by term";
    else if (check.error_bound < 1)
      ground = fmt::format("{} points, error below {}", check.points, brief(check.error_bound));
    else
      ground = fmt::format("{} points, no bound claimed", check.points);
    out += fmt::format("  {:<{}} {} ({})\n", check.name, name_width, check.statement, ground);
  }
  return out;
}

std::string equations_text(const EquationForm& form, const ReadingOrder& order) {
  std::string out;
  for (const auto* lines : {&form.lines, &form.kinematics, &form.constraints})
    for (const EquationLine& line : *lines)
      out += fmt::format("  {}{}\n", plain_text(shown_line(line, order)),
                         line.note.empty() ? "" : "    (" + line.note + ")");
  if (!form.intermediates.empty()) out += "with\n";
  for (const Intermediate& i : form.intermediates)
    out += fmt::format("  {} = {}\n", to_plain(i.symbol, order), to_plain(i.value, order));
  return out;
}

std::string lecture(Study& study, const EquationForm& form, const Certificate& certificate, bool with_steps) {
  const EquationsOfMotion& equations = *study.equations();
  const ReadingOrder& order = form.order(equations);
  std::string out;
  if (with_steps) out += steps_text(steps_to(form, study), order) + "\n";
  out += fmt::format("Equations of motion of {}{}\n", spoken_name(*equations.system), form.in_rates ? " in rates" : "");
  out += equations_text(form, order);
  out += legend(*equations.system, order);
  if (form.in_rates) return out + rates_text(form, equations) + certificate_text(with_rates_check(certificate, form));
  out += reactions_text(equations);
  if (!equations.system->higher.empty())
    return out + "\n" + steps_text(higher_order_lines(equations), order) + certificate_text(certificate);
  if (study.degenerate()) out += "\n" + steps_text(degenerate_lines(*study.degenerate(), *equations.system), order);
  out += momenta_and_energy(equations, *study.derivation(false));
  return out + certificate_text(certificate);
}

std::vector<FormulaLine> step_lines(const std::vector<DerivationStep>& steps, const MechanicalSystem& system,
                                    const ReadingOrder& order) {
  std::vector<FormulaLine> lines;
  for (const DerivationStep& step : steps) {
    FormulaLine line;
    line.section = step.section;
    line.note = step.rule;
    line.sentence = step.sentence;
    line.left = step.left;
    if (step.right) line.right = lay_out(step.right, order);
    if (step.is_equation()) std::swap(line.left, line.right);
    lines.push_back(std::move(line));
    for (const Intermediate& i : step.intermediates) {
      lines.push_back(definition_line(i, system, order));
      lines.back().section = step.section;
      lines.back().note = "with";
    }
  }
  return lines;
}

Json steps_json(const std::vector<DerivationStep>& steps, const ReadingOrder& order) {
  Json list = Json::array();
  for (const DerivationStep& step : steps)
    list.push_back({{"section", step.section},
                    {"rule", step.rule},
                    {"left", to_plain(step.left)},
                    {"right", step.right ? to_plain(step.right, order) : std::string()},
                    {"latex", step.right ? to_latex(step.left) + " = " + to_latex(step.right, order) : std::string()},
                    {"sentence", step.sentence}});
  return list;
}

}  // namespace maupertuis::app

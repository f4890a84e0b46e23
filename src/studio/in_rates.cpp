#include "studio/in_rates.hpp"

#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

namespace maupertuis::studio {
namespace {

using Formula = ReportContent::Formula;

double width_of(const std::vector<Formula>& lines) {
  double all = 0;
  for (const Formula& line : lines) all += width(line.left) + width(line.right);
  return all;
}

/// Rows, q' by the rates, and the constraints that q' does not obey by itself; what they abbreviate goes to `with`.
std::vector<Formula> lines_of(const EquationsInRates& r, Study& study, std::vector<Formula>& with) {
  const MechanicalSystem& system = *study.equations()->shown().system;
  std::vector<Formula> lines;
  const auto note = [&](const std::vector<Intermediate>& intermediates) {
    for (const Intermediate& i : intermediates)
      with.push_back({lay_out(i.symbol, r.order), lay_out(i.value, r.order), "", ""});
  };
  note(r.intermediates);
  for (const EquationsInRates::Row& row : r.rows) {
    lines.push_back({lay_out(row.form, r.order), layouts::number("0"), "", ""});
    note(row.form.intermediates);
  }
  for (const EquationsInRates::Velocity& v : r.kinematics) {
    lines.push_back({lay_out(v.velocity, r.order), lay_out(v.form, r.order), "", ""});
    note(v.form.intermediates);
  }
  const Derivation& derivation = *study.derivation(true);
  for (std::size_t k = 0; k < derivation.constraints.size(); ++k)
    if (system.constraints[k].level != Constraint::Level::Velocity)
      lines.push_back({lay_out(derivation.constraints[k].left, r.order),
                       lay_out(derivation.constraints[k].right, r.order), "", derivation.constraints[k].name});
  return lines;
}

/// σ = Y q' + y of those that are no velocities themselves, and L in them.
std::vector<Formula> definitions_of(const EquationsInRates& r) {
  std::vector<Formula> lines;
  for (std::size_t a = 0; a < r.rates.size(); ++a)
    if (r.definitions[a] != r.rates[a])
      lines.push_back({lay_out(r.rates[a], r.order), lay_out(readable(r.definitions[a], r.order), r.order), "", ""});
  lines.push_back({layouts::name("L"), lay_out(readable(r.lagrangian, r.order), r.order), "", ""});
  return lines;
}

Json check_json(const ZeroTest& test) {
  return {{"name", "rates_form"},
          {"statement", "the equations in rates are Lagrange's along the velocities that the constraints leave free"},
          {"verdict", "agrees"},
          {"passed", true},
          {"applies", true},
          {"points", test.points},
          {"error_bound", test.error_bound}};
}

}  // namespace

Json equations_in_rates_json(Study& study, const ReportContent& standard) {
  const EquationsOfMotion& equations = *study.equations();
  if (!equations.system->higher.empty()) return nullptr;
  const auto found = equations_in_own_rates(equations);
  if (!found) return nullptr;
  std::vector<Formula> with;
  const std::vector<Formula> lines = lines_of(*found, study, with);
  const bool named = !equations.shown().system->rates.empty();
  if (!named && width_of(lines) + width_of(with) >= width_of(standard.equations) + width_of(standard.intermediates))
    return nullptr;
  std::vector<Formula> definitions = definitions_of(*found);
  definitions.insert(definitions.begin(), with.begin(), with.end());
  return {{"equations", lines_json(lines)},
          {"definitions", lines_json(definitions)},
          {"check", check_json(found->certificate)}};
}

}  // namespace maupertuis::studio

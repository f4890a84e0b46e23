#include "constraint_text.hpp"

#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <maupertuis/print.hpp>

namespace maupertuis::app {
namespace {

std::string labels(const MechanicalSystem& system, const std::vector<std::size_t>& of) {
  std::string out;
  for (const std::size_t i : of) out += (out.empty() ? "" : ", ") + system.constraint_label(i);
  return out;
}

std::string integral_text(const EquationsOfMotion& equations, const FirstIntegral& integral) {
  return integral.found() ? to_plain(integral.value, equations.order) + " = const" : std::string();
}

std::string constraint_line(const EquationsOfMotion& equations, const ConstraintReport& report, std::size_t index) {
  const MechanicalSystem& system = *equations.system;
  std::string out = fmt::format("{}: {}, {}", system.constraint_label(index), words(report.constraint_class),
                                report.scleronomic ? "scleronomic" : "rheonomic");
  if (report.integral.found()) out += "; " + integral_text(equations, report.integral);
  if (report.redundant && report.depends_on.empty())
    out += "; redundant: its gradient vanishes";
  else if (report.redundant)
    out += "; redundant: depends on " + labels(system, report.depends_on);
  return out;
}

}  // namespace

void summarise_constraints(const EquationsOfMotion& equations, const ConstraintAnalysis& analysis,
                           const SummaryLine& line) {
  const MechanicalSystem& system = *equations.system;
  if (!system.constrained()) return line("freedoms", std::to_string(analysis.configuration_freedoms));
  const std::size_t count = analysis.constraints.size();
  constexpr std::size_t most_lines = 12;
  for (std::size_t i = 0; i < count && i < most_lines; ++i)
    line(i == 0 ? "constraints" : "", constraint_line(equations, analysis.constraints[i], i));
  if (count > most_lines) line("", fmt::format("… ({} of them)", count));
  for (const IntegrableCombination& found : analysis.combinations)
    line("integrable together",
         fmt::format("{}{}{}", labels(system, found.constraints), found.integral.found() ? ": " : "",
                     integral_text(equations, found.integral)));
  line("rank", fmt::format("{} of {} rows", analysis.rank, count));
  line("freedoms", fmt::format("{} of configuration, {} at an instant", analysis.configuration_freedoms,
                               analysis.instantaneous_freedoms));
  line("undetermined λ", labels(system, analysis.undetermined));
}

std::string moved_start(const MechanicalSystem& system, const ConsistentStart& start) {
  std::string out;
  double largest = 0;
  for (const StartAdjustment& a : start.adjustments) largest = std::max(largest, std::abs(a.to));
  for (const StartAdjustment& a : start.adjustments) {
    if (std::abs(a.to - a.from) < 1e-14 * largest) continue;  // rounding
    const Coordinate& c = system.coordinates[a.coordinate];
    const std::string unit = to_string(a.order == 0 ? c.dimension : c.dimension / system.independent_dimension);
    out += fmt::format("{}{}{} = {}{}", out.empty() ? "" : ", ", c.name, a.order == 0 ? "" : "'", brief(a.to),
                       system.dimensionless || unit == "1" || unit.empty() ? "" : " " + unit);
  }
  return out;
}

Json constraints_to_json(const EquationsOfMotion& equations, const ConstraintAnalysis& analysis) {
  Json out = Json::array();
  for (std::size_t i = 0; i < analysis.constraints.size(); ++i) {
    const ConstraintReport& report = analysis.constraints[i];
    const Constraint& constraint = equations.system->constraints[i];
    Json depends = Json::array();
    for (const std::size_t k : report.depends_on) depends.push_back(equations.system->constraint_label(k));
    out.push_back(
        {{"name", constraint.name.empty() ? equations.system->constraint_label(i) : constraint.name},
         {"class", word(report.constraint_class)},
         {"scleronomic", report.scleronomic},
         {"redundant", report.redundant},
         {"depends_on", depends},
         {"integral", report.integral.found() ? Json(integral_text(equations, report.integral)) : Json(nullptr)}});
  }
  return out;
}

}  // namespace maupertuis::app

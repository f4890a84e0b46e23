#include "report/motion_parts.hpp"
#include "report/notation.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr std::size_t most_samples = 1000;

// The values of a function of q, q', t along the rows of a run.
std::vector<double> along_run(const EquationsOfMotion& equations, Expr function, const Trajectory& run) {
  const MechanicalSystem& system = *equations.system;
  const Expr wanted = in_terms_of_motion(system, {&function, 1}).front();
  Bindings state = parameter_bindings(system);
  std::vector<double> values;
  const std::size_t stride = run.rows() / most_samples + 1;
  for (std::size_t row = 0; row < run.rows(); row += stride) {
    state[system.context->time()] = run.times[row];
    for (const Coordinate& c : system.coordinates) {
      const auto q = run.column(c.name), v = run.column(c.name + "'");
      if (!q || !v) return {};
      state[c.q] = run.at(row, *q);
      state[c.velocity] = run.at(row, *v);
    }
    values.push_back(evaluate(wanted, state));
  }
  return values;
}

// Largest change, relative to the largest value; of a quantity that is zero at the start, absolute.
std::string drift_of(const std::vector<double>& values, const std::string& unit) {
  double change = 0, size = 0;
  for (const double value : values) {
    change = std::max(change, std::abs(value - values[0]));
    size = std::max(size, std::abs(value));
  }
  if (values[0] == 0) return quantity(change, unit, 2) + " (absolute)";
  return short_number(size > 0 ? change / size : 0, 2);
}

ReportContent::Formula formula(Layout left, Expr right, const ReadingOrder& order) {
  const ReadableForm form = readable(expand_time_derivatives(right), order);
  return {std::move(left), lay_out(form.value, order), "", ""};
}

void add_momentum(ReportContent& content, const EquationsOfMotion& equations, std::size_t i,
                  const SimulationResult* run) {
  const MechanicalSystem& system = *equations.system;
  const Coordinate& c = system.coordinates[i];
  ReportContent::Conserved quantity_row;
  quantity_row.sentence =
      system.has_modes()
          ? fmt::format(
                "{} is cyclic, and nothing but contacts and friction acts on it: without them its momentum is "
                "conserved.",
                c.name)
          : fmt::format("{} is cyclic, and nothing acts on it: its momentum is conserved.", c.name);
  quantity_row.formula = formula(layouts::indexed(layouts::name("p"), {lay_out(c.q, equations.order)}),
                                 equations.shown().momenta[i], equations.order);
  if (run) {
    const std::string unit =
        system.dimensionless ? "" : to_string(system.lagrangian_dimension * system.independent_dimension / c.dimension);
    add_values_along_run(quantity_row, equations, equations.momenta[i], unit, run->trajectory);
    if (system.has_modes()) quantity_row.drift.clear();  // what contacts and friction do is no drift
  }
  content.conserved.push_back(std::move(quantity_row));
}

void add_energy(ReportContent& content, const EquationsOfMotion& equations, const ConservedQuantities& conserved,
                const SimulationResult* run) {
  ReportContent::Conserved row;
  row.sentence = conserved.energy_case;
  if (!conserved.energy_conserved) {
    row.sentence += " It is not conserved; along the motion it changes at the rate";
    row.formula =
        formula(layouts::rate(layouts::name("h_E"), lay_out(equations.system->context->time(), equations.order), true),
                equations.shown().power, equations.order);
    content.conserved.push_back(std::move(row));
    return;
  }
  const bool has_modes = equations.system->has_modes();
  row.sentence += has_modes ? " Without contacts and friction it is conserved." : " It is conserved.";
  row.formula = formula(layouts::name("h_E"), equations.shown().energy_function, equations.order);
  const auto column = run ? run->trajectory.column("energy") : std::nullopt;
  // A run that ended where it began may have no energy to show.
  if (column && run->trajectory.rows() > 0 && std::isfinite(run->trajectory.at(0, *column))) {
    row.value = quantity(run->trajectory.at(0, *column), run->trajectory.columns[*column].unit, 10);
    if (!has_modes) row.drift = short_number(run->statistics.energy_drift, 2);
  }
  content.conserved.push_back(std::move(row));
}

}  // namespace

void add_values_along_run(ReportContent::Conserved& row, const EquationsOfMotion& equations, Expr function,
                          const std::string& unit, const Trajectory& run) {
  const auto values = along_run(equations, function, run);
  if (values.empty() || !std::isfinite(values[0]))
    return;  // the run ended where it began, in a state that has no such value
  row.value = quantity(values[0], unit, 10);
  row.drift = drift_of(values, unit);
}

void add_conserved(ReportContent& content, const EquationsOfMotion& equations, const ConservedQuantities& conserved,
                   const SimulationResult* run, const Invariants* invariants) {
  add_energy(content, equations, conserved, run);
  if (invariants) return add_invariants(content, equations, *invariants, run);
  for (const std::size_t i : conserved.conserved_momenta) add_momentum(content, equations, i, run);
}

}  // namespace maupertuis

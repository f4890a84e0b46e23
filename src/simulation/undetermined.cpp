#include "simulation/undetermined.hpp"

#include "simulation/state_quantities.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

/// The names of columns that depend on the free functions.
std::vector<std::string> undetermined_names(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  const DegenerateAnalysis& analysis = *equations.degenerate;
  std::vector<std::string> out;
  for (const Coordinate& c : system.coordinates) {
    if (!analysis.is_determined(c.q)) out.push_back(c.name);
    if (!analysis.is_determined(c.velocity)) out.push_back(c.name + "'");
  }
  static constexpr const char* axes[] = {".x", ".y", ".z"};
  for (const Point& p : system.points)
    for (std::size_t k = 0; k < p.position.size(); ++k)
      if (!analysis.is_determined(p.position[k])) out.push_back(p.name + axes[k]);
  if (!analysis.is_determined(equations.energy_function)) out.push_back("energy");
  return out;
}

bool contains_name(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void leave_out_columns(SimulationResult& result, const std::vector<std::string>& names) {
  Trajectory& t = result.trajectory;
  const std::size_t width = t.columns.size();
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < width; ++j)
    if (!contains_name(names, t.columns[j].name)) kept.push_back(j);
  const auto narrowed = [&](const std::vector<double>& rows) {
    std::vector<double> out;
    out.reserve(rows.size() / width * kept.size());
    for (std::size_t row = 0; row + width <= rows.size(); row += width)
      for (const std::size_t j : kept) out.push_back(rows[row + j]);
    return out;
  };
  t.values = narrowed(t.values);
  t.errors = narrowed(t.errors);
  std::vector<std::size_t> uncertain;
  for (const std::size_t j : result.uncertain.columns)
    if (const auto place = std::find(kept.begin(), kept.end(), j); place != kept.end())
      uncertain.push_back(static_cast<std::size_t>(place - kept.begin()));
  result.uncertain.columns = std::move(uncertain);
  std::vector<Trajectory::Column> columns;
  for (const std::size_t j : kept) columns.push_back(t.columns[j]);
  t.columns = std::move(columns);
}

void without_rests(State& state, std::size_t multipliers) {
  if (state.multipliers.size() > multipliers) state.multipliers.resize(multipliers);
  if (state.errors && state.errors->multipliers.size() > multipliers) state.errors->multipliers.resize(multipliers);
}

/// What can be shown in place of the coordinates that depend on the free functions.
void add_determined(SimulationResult& result, const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  std::vector<Trajectory::Column> columns;
  ExprVector wanted;
  for (const DeterminedQuantity& quantity : determined_quantities(equations)) {
    if (result.trajectory.column(quantity.name)) continue;
    columns.push_back({quantity.name, system.dimensionless ? std::string() : to_string(quantity.dimension)});
    wanted.push_back(quantity.value);
  }
  StateQuantities values(system, wanted);
  values.put_into(result);
  result.quantities = columns;
  values.put_into(result.trajectory, columns, *result.trajectory.of_one_choice);
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

}  // namespace

void forget_drift_of_nothing(SimulationResult& result, const EquationsOfMotion& equations) {
  const auto& where = equations.degenerate->chain.where;
  result.statistics.energy_vanishes = where && where->vanishes(equations.energy_function) == Verdict::Zero;
  if (result.statistics.energy_vanishes) result.statistics.energy_drift = 0;
}

void in_terms_of_system(SimulationResult& result, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const std::size_t multipliers = equations.multipliers.size();
  for (State* state : {&result.start, &result.final}) without_rests(*state, multipliers);
  for (State& state : result.at) without_rests(state, multipliers);
  if (result.ending == Ending::SingularConstraints || result.ending == Ending::SingularMass)
    result.reason =
        "The equations that determine the motion of this degenerate Lagrangian, some of its rows and the derivatives "
        "of "
        "its constraints, are singular near here or jump. They were chosen once, and the motion itself may go on.";
  if (equations.degenerate->free.empty()) return;
  result.undetermined = undetermined_names(equations);
  if (result.undetermined.empty()) return;
  const auto all = std::make_shared<const Trajectory>(result.trajectory);
  leave_out_columns(result, result.undetermined);
  result.trajectory.of_one_choice = all;
  add_determined(result, equations);
  diagnostics.note(
      "N0630", std::nullopt,
      fmt::format("left out, since {} on functions that are free: {}",
                  result.undetermined.size() == 1 ? "it depends" : "they depend", joined(result.undetermined)),
      "The motion was computed with one choice of them; what is shown is the same with any other.",
      "Formulas that do not depend on them can be asked for: `--columns FORMULA`, `expect FORMULA at …`. "
      "`gauge EXPR = EXPR` makes a choice of your own.");
}

bool refuse_undetermined(const Experiment& experiment, const Probe* probe, const EquationsOfMotion& equations,
                         Diagnostics& diagnostics) {
  if (!has_free_functions(equations)) return false;
  bool refused = false;
  const auto look_at = [&](Expr e, const std::optional<Span>& span, const std::string& what) {
    if (!e || equations.degenerate->is_determined(with_reactions(equations, {&e, 1}).front())) return;
    diagnostics.error("E0631", span, fmt::format("{} depends on functions that are free", what),
                      "The Lagrangian leaves them open, so that it has no value of its own.",
                      "`gauge EXPR = EXPR` makes a choice.");
    refused = true;
  };
  look_at(experiment.until, std::nullopt, "the condition of `run until`");
  for (const ModelEvent& event : experiment.events) {
    look_at(event.function, event.span, "the event");
    for (const ModelEvent::Assignment& set : event.sets) look_at(set.value, set.span, "what the event sets");
  }
  if (probe)
    for (const Expr& e : probe->expressions) look_at(e, std::nullopt, to_plain(e, equations.order));
  return refused;
}

}  // namespace maupertuis

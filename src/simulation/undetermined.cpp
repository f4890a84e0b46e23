#include "simulation/undetermined.hpp"

#include <maupertuis/degenerate.hpp>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Values of the determined quantities at states, with errors from those of q and q̇.
class Quantities {
 public:
  Quantities(const EquationsOfMotion& equations, const std::vector<DeterminedQuantity>& quantities)
      : system_(*equations.system), count_(quantities.size()), bindings_(parameter_bindings(system_)) {
    for (const Coordinate& c : system_.coordinates) symbols_.push_back(c.q);
    for (const Coordinate& c : system_.coordinates) symbols_.push_back(c.velocity);
    for (const DeterminedQuantity& quantity : quantities) wanted_.push_back(quantity.value);
    for (const DeterminedQuantity& quantity : quantities)
      for (const Expr& slope : gradient(quantity.value, symbols_)) wanted_.push_back(slope);
  }

  /// `state`, `errors`: [q, q̇]; the errors may be missing. The values, then as many errors.
  std::vector<double> at(double t, const double* state, const double* errors) {
    bindings_[system_.context->time()] = t;
    for (std::size_t i = 0; i < symbols_.size(); ++i) bindings_[symbols_[i]] = state[i];
    const std::vector<double> found = evaluate(wanted_, bindings_);
    std::vector<double> out(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count_));
    for (std::size_t k = 0; errors && k < count_; ++k) {
      double error = 0;
      for (std::size_t i = 0; i < symbols_.size(); ++i)
        if (const double slope = found[count_ + k * symbols_.size() + i]; slope != 0)
          error += std::abs(slope) * errors[i];
      out.push_back(error);
    }
    return out;
  }

  void put_into(State& state) {
    if (state.q.empty()) return;
    const auto together = [](std::vector<double> q, const std::vector<double>& v) {
      q.insert(q.end(), v.begin(), v.end());
      return q;
    };
    const std::vector<double> numbers = together(state.q, state.v);
    const std::vector<double> errors =
        state.errors ? together(state.errors->q, state.errors->v) : std::vector<double>();
    const std::vector<double> found = at(state.t, numbers.data(), errors.empty() ? nullptr : errors.data());
    const auto end_of_values = found.begin() + static_cast<std::ptrdiff_t>(count_);
    state.determined.assign(found.begin(), end_of_values);
    if (state.errors) state.errors->determined.assign(end_of_values, found.end());
  }

  /// As further columns, after those that are there.
  void put_into(Trajectory& rows, const std::vector<Trajectory::Column>& columns, const Trajectory& all) {
    const std::size_t width = rows.columns.size();
    std::vector<double> values, errors;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      const std::size_t begin = row * all.columns.size();
      const std::vector<double> found =
          at(rows.times[row], &all.values[begin], all.errors.empty() ? nullptr : &all.errors[begin]);
      const auto copy = [&](std::vector<double>& to, const std::vector<double>& from, std::size_t first) {
        const auto start = from.begin() + static_cast<std::ptrdiff_t>(row * width);
        to.insert(to.end(), start, start + static_cast<std::ptrdiff_t>(width));
        const auto more = found.begin() + static_cast<std::ptrdiff_t>(first);
        to.insert(to.end(), more, more + static_cast<std::ptrdiff_t>(count_));
      };
      copy(values, rows.values, 0);
      if (!all.errors.empty()) copy(errors, rows.errors, count_);
    }
    rows.values = std::move(values);
    rows.errors = std::move(errors);
    rows.columns.insert(rows.columns.end(), columns.begin(), columns.end());
  }

 private:
  const MechanicalSystem& system_;
  std::size_t count_;
  Bindings bindings_;
  ExprVector symbols_, wanted_;
};

/// What can be shown in place of the coordinates that depend on the free functions.
void add_determined(SimulationResult& result, const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  std::vector<DeterminedQuantity> quantities;
  for (DeterminedQuantity& quantity : determined_quantities(equations))
    if (!result.trajectory.column(quantity.name)) quantities.push_back(std::move(quantity));
  for (const DeterminedQuantity& quantity : quantities)
    result.determined.push_back({quantity.name, system.dimensionless ? std::string() : to_string(quantity.dimension)});
  Quantities values(equations, quantities);
  for (State* state : {&result.start, &result.final}) values.put_into(*state);
  for (State& state : result.at) values.put_into(state);
  values.put_into(result.trajectory, result.determined, *result.trajectory.of_one_choice);
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

}  // namespace

void in_terms_of_system(SimulationResult& result, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const std::size_t multipliers = equations.multipliers.size();
  for (State* state : {&result.start, &result.final}) without_rests(*state, multipliers);
  for (State& state : result.at) without_rests(state, multipliers);
  if (result.ending == Ending::SingularConstraints || result.ending == Ending::SingularMass)
    result.reason =
        "The equations that determine the motion of this degenerate Lagrangian, some of its rows and the derivatives "
        "of "
        "its constraints, are singular near here or jump. They were chosen once, and the motion itself may go on.";
  const auto& where = equations.degenerate->chain.where;
  result.statistics.energy_vanishes = where && where->vanishes(equations.energy_function) == Verdict::Zero;
  if (result.statistics.energy_vanishes) result.statistics.energy_drift = 0;  // nothing but rounding by itself
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

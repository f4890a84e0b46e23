#include "simulation/run_plan.hpp"

#include "simulation/unique_start.hpp"

#include <maupertuis/reactions.hpp>
#include <maupertuis/rounded_value.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int default_rows = 1000;        // intervals of the output when the model names none
constexpr double most_rows = 20'000'000;  // beyond it the trajectory would not fit in memory

class Planner {
 public:
  Planner(const Model& model, const EquationsOfMotion& equations, const SimulationOptions& options,
          Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        options_(options),
        diagnostics_(diagnostics),
        bindings_(parameter_bindings(model.system)) {}

  std::optional<RunPlan> plan() {
    if (!plan_start() || !plan_length() || !plan_output()) return std::nullopt;
    return plan_;
  }

 private:
  double value_of(Expr e, double otherwise) const {
    if (!e) return otherwise;
    return rounded_value(in_terms_of_motion(model_.system, {&e, 1}).front(), bindings_);
  }

  bool plan_start() {
    const auto start = consistent_start(model_, equations_, diagnostics_);
    if (!start) return false;
    plan_.begin = start->state.t;
    plan_.q = start->state.q;
    plan_.v = start->state.v;
    return true;
  }

  bool plan_length() {
    const Experiment& experiment = model_.experiment;
    std::optional<double> duration = options_.duration;
    plan_.until = static_cast<bool>(experiment.until) && !duration;
    if (plan_.until && !plan_condition()) return false;
    if (!duration && experiment.until) duration = value_of(experiment.within, 0);
    if (!duration && experiment.duration) duration = value_of(experiment.duration, 0);
    if (!duration && options_.at.empty()) {
      diagnostics_.error("E0701", std::nullopt, "this model does not say how long to run",
                         "A motion goes on for ever; a run needs an end.",
                         "Add a line such as `run 10 s` to the model, or give --duration 10s.");
      return false;
    }
    plan_.end = plan_.begin + duration.value_or(0);
    for (const double t : options_.at) extend_to(t);
    if (!std::isfinite(plan_.end) || !std::isfinite(plan_.begin)) {
      diagnostics_.error("E0703", std::nullopt, "the length of the run is not a finite number",
                         "A run begins and ends at definite times.", "Give a duration such as 10 s.");
      return false;
    }
    return true;
  }

  /// Forces of constraints follow from the equations; one that they do not determine ends no run.
  bool plan_condition() {
    plan_.condition = with_reactions(equations_, {&model_.experiment.until, 1}).front();
    const std::vector<Expr> symbols = symbols_of({&plan_.condition, 1});
    for (const Reaction& r : reactions(equations_)) {
      if (r.value || std::find(symbols.begin(), symbols.end(), r.symbol) == symbols.end()) continue;
      diagnostics_.error(
          "E0726", std::nullopt,
          fmt::format("the model does not determine the force of `{}`, with which the run is to end", r.name),
          r.sentence, "End the run with a condition on coordinates, velocities or determined forces.");
      return false;
    }
    return true;
  }

  /// A run goes on to the last time that is asked for. Times on the other side of the start are refused by `simulate`.
  void extend_to(double t) {
    const bool backwards = plan_.end < plan_.begin || (plan_.end == plan_.begin && t < plan_.begin);
    plan_.end = backwards ? std::min(plan_.end, t) : std::max(plan_.end, t);
  }

  bool plan_output() {
    const double length = std::abs(plan_.end - plan_.begin);
    double every = options_.output_every ? *options_.output_every : value_of(model_.experiment.output_every, 0);
    plan_.even_rows = every != 0 || !options_.rows_of_steps;
    if (every == 0) every = length / default_rows;
    if (!(every > 0) && length > 0) {
      diagnostics_.error("E0704", std::nullopt, "the output interval is not a positive time",
                         "Rows of the trajectory follow one another in time.",
                         "Write a line such as `output every 10 ms`.");
      return false;
    }
    if (length > 0 && length / every > most_rows) {
      diagnostics_.error("E0705", std::nullopt, fmt::format("this run would write {:.3g} rows", length / every),
                         "The whole trajectory is kept in memory until it is written.",
                         "Choose a longer `output every`, or a shorter run.");
      return false;
    }
    const double direction = plan_.end < plan_.begin ? -1 : 1;
    const auto rows = length > 0 ? static_cast<std::size_t>(std::floor(length / every * (1 + 1e-12))) : 0;
    for (std::size_t i = 0; i <= rows; ++i)
      plan_.output_times.push_back(plan_.begin + direction * every * static_cast<double>(i));
    double& last = plan_.output_times.back();
    if (std::abs(last - plan_.end) <= 1e-9 * every)
      last = plan_.end;
    else
      plan_.output_times.push_back(plan_.end);
    plan_.row_interval = every;
    add_rows_asked_for();
    if (options_.errors == ErrorEstimates::States) plan_comparison();
    return true;
  }

  /// Between few rows nobody would see where the motion is lost, nor how large it becomes.
  void plan_comparison() {
    const std::vector<double>& rows = plan_.output_times;
    const std::size_t parts = rows.size() > 1 ? usual_comparisons / (rows.size() - 1) : 0;
    for (std::size_t row = 0; row + 1 < rows.size(); ++row)
      for (std::size_t k = 1; k < parts; ++k)
        plan_.times_between.push_back(rows[row] + (rows[row + 1] - rows[row]) * static_cast<double>(k) /
                                                      static_cast<double>(parts));
  }

  void add_rows_asked_for() {
    const auto before = [&](double a, double b) { return plan_.end < plan_.begin ? a > b : a < b; };
    std::vector<double>& times = plan_.output_times;
    for (const double t : options_.rows_at)
      if (!before(t, plan_.begin) && !before(plan_.end, t)) times.push_back(t);
    std::sort(times.begin(), times.end(), before);
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }

  const Model& model_;
  const EquationsOfMotion& equations_;
  const SimulationOptions& options_;
  Diagnostics& diagnostics_;
  Bindings bindings_;
  RunPlan plan_;
};

}  // namespace

std::optional<RunPlan> plan_run(const Model& model, const EquationsOfMotion& equations,
                                const SimulationOptions& options, Diagnostics& diagnostics) {
  auto out = Planner(model, equations, options, diagnostics).plan();
  if (out && !start_has_one_motion(model, equations, *out, diagnostics)) return std::nullopt;
  return out;
}

bool requests_lie_ahead(const MechanicalSystem& system, const RunPlan& plan, const SimulationOptions& options,
                        Diagnostics& diagnostics) {
  for (const double t : options.at) {
    const bool ahead = plan.end >= plan.begin ? t >= plan.begin : t <= plan.begin;
    if (ahead && std::isfinite(t)) continue;
    const std::string unit = system.independent_unit().empty() ? "" : " " + system.independent_unit();
    diagnostics.error(
        "E0706", std::nullopt,
        fmt::format("the state at {} is not on the way of this run", system.moment(fmt::format("{:g}", t))),
        fmt::format("The run goes from {:g}{} to {:g}{}.", plan.begin, unit, plan.end, unit),
        "Ask for times after the start, or run backwards with a negative duration.");
    return false;
  }
  return true;
}

}  // namespace maupertuis

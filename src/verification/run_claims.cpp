#include "verification/run_claims.hpp"

#include "verification/judge.hpp"
#include "verification/phase_space_claims.hpp"

#include <maupertuis/across_switches.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace maupertuis {
namespace {

constexpr const char* kNoStart = "The run could not start.";

std::string beyond_digits(const ValueVerdict& verdict, const std::string& uncertainty) {
  const std::string known = uncertainty == "no digit is certain"
                                ? "of what came out no digit is certain"
                                : "what came out is known to " + uncertainty + " alone";
  if (verdict.passed) return known + ", so that the tolerance asks for more digits than there are";
  return known +
         (verdict.may_hold ? ", so that this run does not tell whether it holds" : ", and still it does not hold");
}

void report_drift(ExpectationResult& result, double drift, double tolerance) {
  result.expected = "constant along the run";
  result.actual = fmt::format("drift {:.3g}", drift);
  result.tolerance = fmt::format("rel {:g}", tolerance);
  result.passed = drift <= tolerance;
  if (!result.passed) result.message = "It changes more than the tolerance along the run.";
}

/// Whether the inputs as they are given and parameters that are 0 leave no power: a motor that is off, c = 0.
bool no_power_at_values(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.system;
  if (across_switches(system, equations.energy_function, equations.order).jump) return false;
  ExprMap zeros;
  for (const Parameter& p : system.parameters)
    if (p.value.is_zero()) zeros.emplace(p.symbol, system.context->number(0));
  if (zeros.empty() && system.inputs.empty()) return false;
  ExprVector power = {expand_time_derivatives(in_terms_of_motion(system, {&equations.power, 1}).front())};
  power = substitute(power, zeros);
  return zero_test(power).verdict == Verdict::Zero;
}

/// What impacts, friction, moving contacts and events do to the energy, in units of the largest that it has.
double energy_exchanged(const SimulationResult& run) {
  if (!run.books) return 0;
  double largest = 0;
  const std::size_t column = run.trajectory.columns.size() - 1;
  for (std::size_t row = 0; row < run.trajectory.rows(); ++row)
    largest = std::max(largest, std::abs(run.trajectory.at(row, column)));
  const double exchanged = std::abs(run.books->impacts) + std::abs(run.books->friction) + std::abs(run.books->moving) +
                           std::abs(run.books->events);
  return exchanged == 0 ? 0 : exchanged / std::max(largest, exchanged);
}

}  // namespace

std::vector<const Happening*> happenings_named(const std::vector<Happening>& all, const std::string& name,
                                               const std::string& change) {
  std::vector<const Happening*> out;
  for (const Happening& h : all) {
    if (h.name != name || (!change.empty() && word_of(h.kind) != change)) continue;
    const bool same_as_last = change.empty() && !out.empty() && h.kind == Happening::Kind::Made &&
                              out.back()->kind == Happening::Kind::Impact && out.back()->t == h.t;
    if (!same_as_last) out.push_back(&h);
  }
  return out;
}

std::string happening_called(const std::string& name, const std::string& change) {
  return change.empty() ? name : name + " " + change;
}

bool RunClaims::watches_whole_run() const {
  return !(energies_.empty() && drifts_.empty() && events_.empty() && counts_.empty());
}

double RunClaims::number(Expr e, double otherwise) const { return number_of(model_.system, e, otherwise); }

void RunClaims::carry_out(std::vector<ExpectationResult>& results) {
  take_timed(results);
  find_end(results);
  if (values_.empty() && !watches_whole_run()) return;
  run_direction(true, results);
  run_direction(false, results);
}

/// Those that the model wants in more digits than double has are decided at once.
void RunClaims::take_timed(std::vector<ExpectationResult>& results) {
  const double begin = number(model_.experiment.start_time);
  const ExtendedClaims claims(model_, equations_, options_.interrupt);
  std::vector<ExtendedClaims::Line> ahead, behind;
  for (const ExtendedClaims::Line& line : timed_) {
    const expectation::ValueAt& e = *line.expectation;
    const double time = number(e.time, begin);
    if (claims.takes(e))
      (time >= begin ? ahead : behind).push_back(line);
    else
      values_.push_back({line.index, &e.expected, e.subject, time});
  }
  for (const auto* lines : {&ahead, &behind})
    if (!lines->empty()) claims.decide(*lines, results, diagnostics_);
}

/// When the condition of `run until` is met: by the model's own run.
void RunClaims::find_end(std::vector<ExpectationResult>& results) {
  if (ends_.empty()) return;
  Diagnostics unheard;  // a run that cannot start says so once
  const bool alone = values_.empty() && !watches_whole_run();
  const auto run = simulate(model_, equations_, options_, alone ? diagnostics_ : unheard);
  for (const End& end : ends_) {
    ExpectationResult& result = results[end.line];
    if (!run)
      result.message = kNoStart;
    else if (run->ending != Ending::UntilReached)
      result.message = ended_before(run->reason);
    else if (!end.subject)
      judge_value(*end.expected, run->final.t, run->final.errors ? run->final.errors->t : 0.0, result);
    else
      values_.push_back({end.line, end.expected, end.subject, run->final.t});
  }
}

/// The run evaluates all formulas at all times: each of both is asked for once, however many lines name it, and no more
/// values are taken than it has room for.
std::vector<RunClaims::Cell> RunClaims::ask_once(std::span<const Value> values, Probe& probe,
                                                 std::vector<double>& times) const {
  constexpr std::size_t room = 1'000'000;  // formulas times times
  std::unordered_map<Expr, std::size_t, ExprHash> columns;
  std::unordered_map<double, std::size_t> rows;
  std::vector<Cell> out;
  times.clear();
  for (const Value& v : values) {
    if (!out.empty() && (columns.size() + 1) * (rows.size() + 1) > room) break;
    const auto [column, is_new_formula] = columns.emplace(v.subject, probe.expressions.size());
    if (is_new_formula) probe.expressions.push_back(with_momenta(v.subject, equations_));
    const auto [row, is_new_time] = rows.emplace(v.time, times.size());
    if (is_new_time) times.push_back(v.time);
    out.push_back({row->second, column->second});
  }
  return out;
}

/// Quantities that are watched all along the run, and its energy, belong to the way forwards.
void RunClaims::run_direction(bool forwards, std::vector<ExpectationResult>& results) {
  const double begin = number(model_.experiment.start_time);
  std::vector<Value> values;
  std::copy_if(values_.begin(), values_.end(), std::back_inserter(values),
               [&](const Value& v) { return (v.time >= begin) == forwards; });
  const bool whole_run = forwards && watches_whole_run();
  if (values.empty() && !whole_run) return;

  std::span<const Value> left(values);
  left = left.subspan(run_once(left, whole_run, diagnostics_, results));
  Diagnostics unheard;  // the first run said it
  while (!left.empty()) left = left.subspan(run_once(left, false, unheard, results));
}

/// Returns how many of the values, from the first on, were asked of this run: at least one, if there is one.
std::size_t RunClaims::run_once(std::span<const Value> values, bool whole_run, Diagnostics& diagnostics,
                                std::vector<ExpectationResult>& results) {
  SimulationOptions options = options_;
  if (!whole_run) options.duration = 0.0;  // as far as the times asked for
  Probe probe;
  const std::vector<Cell> cells = ask_once(values, probe, options.at);
  const std::size_t columns_of_values = probe.expressions.size();
  if (whole_run && !drifts_.empty()) {
    for (const Drift& d : drifts_) probe.expressions.push_back(with_momenta(d.expectation->subject, equations_));
    const std::vector<double> along = samples();
    options.at.insert(options.at.end(), along.begin(), along.end());
  }
  const auto run = simulate(model_, equations_, options, diagnostics, &probe);
  for (std::size_t i = 0; i < cells.size(); ++i) judge_value_at(values[i], cells[i], run, probe, results);
  if (!whole_run) return cells.size();
  for (std::size_t i = 0; i < drifts_.size(); ++i)
    judge_drift(drifts_[i], columns_of_values + i, run, probe, results[drifts_[i].line]);
  for (const Energy& e : energies_) judge_energy(e, run, results[e.line]);
  for (const Event& e : events_) judge_event(e, run, results[e.line]);
  for (const EventCount& e : counts_) judge_count(e, run, results[e.line]);
  return cells.size();
}

/// Times along the run: within each step as many as its polynomials need to show their extremes, so that what repeats
/// itself is not met at one phase alone; of more than a budget every second, third … and always the last.
std::vector<double> RunClaims::samples() const {
  constexpr std::size_t most = 20'000;
  SimulationOptions options = options_;
  options.at.clear();
  options.rows_of_steps = true;
  options.errors = ErrorEstimates::None;
  Diagnostics unheard;  // the run that is judged says it
  const auto run = simulate(model_, equations_, options, unheard);
  std::vector<double> times;
  if (!run) return times;
  const std::vector<double>& rows = run->trajectory.times;
  const std::size_t every = rows.size() / most + 1;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (k % every == 0 || k + 1 == rows.size()) times.push_back(rows[k]);
  return times;
}

void RunClaims::judge_value_at(const Value& value, const Cell& cell, const std::optional<SimulationResult>& run,
                               const Probe& probe, std::vector<ExpectationResult>& results) const {
  ExpectationResult& result = results[value.line];
  if (!run)
    result.message = kNoStart;
  else if (probe.values[cell.row].empty())
    result.message = ended_before(run->reason);
  else
    judge_value(*value.expected, probe.values[cell.row][cell.column],
                probe.errors.empty() ? 0 : probe.errors[cell.row][cell.column], result);
}

/// `uncertainty`: by how much `actual` may be off; 0 where nobody asked.
void RunClaims::judge_value(const expectation::Number& e, double actual, double uncertainty,
                            ExpectationResult& result) const {
  judge_number(e, model_.system, actual, result);
  if (!std::isfinite(actual)) return;
  const double expected = number(e.value);
  const ValueVerdict verdict =
      value_verdict(actual, expected, allowed_difference(e.tolerance, model_.system, expected), uncertainty);
  result.passed = verdict.passed;
  result.beyond_digits = verdict.beyond_digits;
  if (uncertainty > 0)
    result.uncertainty = std::isinf(uncertainty)
                             ? "no digit is certain"
                             : fmt::format("± {:.2g}{}", uncertainty / std::abs(e.unit.factor), unit_after(e.unit));
  if (verdict.beyond_digits) result.message += "; " + beyond_digits(verdict, result.uncertainty);
}

void RunClaims::judge_drift(const Drift& drift, std::size_t column, const std::optional<SimulationResult>& run,
                            const Probe& probe, ExpectationResult& result) const {
  if (!run) {
    result.message = kNoStart;
    return;
  }
  if (!run->ok()) {
    result.message = ended_before(run->reason);
    return;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0;
  for (const auto& row : probe.values) {
    if (row.empty()) {
      result.message = ended_before(run->reason);
      return;
    }
    low = std::min(low, row[column]);
    high = std::max(high, row[column]);
    largest = std::max(largest, std::abs(row[column]));
  }
  report_drift(result, largest > 0 ? (high - low) / largest : 0, number(drift.expectation->tolerance.size));
}

void RunClaims::judge_event(const Event& event, const std::optional<SimulationResult>& run,
                            ExpectationResult& result) const {
  const expectation::Event& e = *event.expectation;
  if (!run) {
    result.message = kNoStart;
    return;
  }
  const auto found = happenings_named(run->happenings, e.name, e.change);
  if (found.size() >= static_cast<std::size_t>(e.occurrence)) {
    const Happening& h = *found[static_cast<std::size_t>(e.occurrence) - 1];
    judge_value(e.time, h.t, h.error, result);
    return;
  }
  result.actual = fmt::format("{} times", found.size());
  result.expected = fmt::format("at least {}", e.occurrence);
  result.message =
      fmt::format("`{}` happens {} times along the run.", happening_called(e.name, e.change), found.size());
  if (!run->ok()) result.message += " " + ended_before(run->reason);
}

void RunClaims::judge_count(const EventCount& count, const std::optional<SimulationResult>& run,
                            ExpectationResult& result) const {
  const expectation::EventCount& e = *count.expectation;
  if (!run) {
    result.message = kNoStart;
    return;
  }
  const double found = static_cast<double>(happenings_named(run->happenings, e.name, e.change).size()),
               expected = number(e.number);
  result.actual = fmt::format("{:g}", found);
  result.expected = fmt::format("{:g}", expected);
  result.passed = found == expected && run->ok();
  result.message = run->ok()
                       ? fmt::format("`{}` happens {:g} times along the run", happening_called(e.name, e.change), found)
                       : ended_before(run->reason);
}

void RunClaims::judge_energy(const Energy& energy, const std::optional<SimulationResult>& run,
                             ExpectationResult& result) const {
  constexpr double usual_tolerance = 1e-12;
  if (!run) {
    result.message = kNoStart;
  } else if (!conserved_quantities(equations_).energy_conserved && !no_power_at_values(equations_)) {
    result.expected = "constant along the run";
    result.actual = "not conserved";
    const auto jump = across_switches(model_.system, equations_.energy_function, equations_.order).jump;
    result.message =
        !jump ? "Forces, friction or an explicit time in L change the energy of this system."
              : fmt::format("The energy jumps where {}: what is switched there does work at once.", jump->place);
  } else if (!run->ok()) {
    result.message = ended_before(run->reason);
  } else if (const double lost = energy_exchanged(*run);
             lost > number(energy.expectation->tolerance.size, usual_tolerance)) {
    report_drift(result, lost, number(energy.expectation->tolerance.size, usual_tolerance));
    result.message = "Impacts, friction, moving contacts or events that set the state change the energy along the run.";
  } else {
    report_drift(result, run->statistics.energy_drift, number(energy.expectation->tolerance.size, usual_tolerance));
  }
}

ValueVerdict value_verdict(double actual, double expected, double tolerance, double error) {
  constexpr double most_pessimistic = 100, last_bits = 4 * std::numeric_limits<double>::epsilon();
  const double off = std::abs(actual - expected);
  ValueVerdict out;
  out.beyond_digits = error > tolerance && error > last_bits * std::abs(actual);
  out.passed = off <= tolerance && (!out.beyond_digits || error <= most_pessimistic * tolerance);
  out.may_hold = !out.passed && off <= tolerance + error;
  return out;
}

}  // namespace maupertuis

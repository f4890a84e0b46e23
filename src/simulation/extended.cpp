#include "simulation/ending.hpp"
#include "simulation/extended_problem.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

/// A run in many digits: the exact plan, the run, the check run with a wider mantissa, and what both agree on.
namespace maupertuis {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

struct Level {
  Mantissa mantissa, check;
  int bits, check_bits, digits;
  double log2_tolerance;
};

Level level_of(Precision precision) {
  if (precision == Precision::Quad) return {Mantissa::Bits113, Mantissa::Bits192, 113, 192, 33, log2_rounding(Mantissa::Bits113)};
  return {Mantissa::Bits384, Mantissa::Bits448, 384, 448, 100, -105 * std::log2(10.0)};
}

bool has_method(const Model& model, const ExtendedSimulationOptions& options, Diagnostics& diagnostics) {
  const StepMethod method = options.method.value_or(model.experiment.method.value_or(MethodChoice{}).method);
  if (method == StepMethod::Automatic || method == StepMethod::Taylor) return true;
  diagnostics.error("E0725", std::nullopt,
                    fmt::format("the {} method calculates in double alone", method == StepMethod::Stiff ? "stiff" : "variational"),
                    "Its order is bounded, so that a hundred digits would cost more steps than anyone can wait for.",
                    "Take --method taylor, or leave it out.");
  return false;
}

class ExtendedRun {
 public:
  ExtendedRun(const Model& model, const EquationsOfMotion& equations, const ExtendedSimulationOptions& options, ExtendedPlan plan,
              const Observables& observables)
      : model_(model), system_(*equations.system), options_(options), plan_(std::move(plan)), observables_(observables),
        level_(level_of(options.precision)) {
    settings_.log2_tolerance = options.tolerance > 0 ? std::log2(options.tolerance) : level_.log2_tolerance;
    settings_.log2_tolerance = std::max(settings_.log2_tolerance, log2_rounding(level_.mantissa));
    const MethodChoice choice = model.experiment.method.value_or(MethodChoice{});
    settings_.order = options.order == 0 && choice.method == StepMethod::Taylor ? choice.order : options.order;
    settings_.maximum_steps = options.maximum_steps;
    settings_.interrupt = options.interrupt;
  }

  ExtendedResult carry_out() {
    name_columns();
    auto begin = Clock::now();
    if (options_.progress) settings_.progress = [this](double fraction) { options_.progress(0.4 * fraction); };
    const ExtendedMotion rough = run_extended(plan_.problem, level_.mantissa, settings_);
    out_.statistics = {rough.steps, 0, rough.switches, rough.order, 0, level_.bits, level_.check_bits, seconds_since(begin), 0};
    tell_ending(rough);
    out_.at.resize(options_.at.size());
    if (out_.ending == Ending::Interrupted || !rough.final.reached) return std::move(out_);
    begin = Clock::now();
    const ExtendedMotion fine = check_run(rough);
    out_.statistics.check_steps = fine.steps;
    out_.statistics.check_order = fine.order;
    out_.statistics.check_seconds = seconds_since(begin);
    compare(rough, fine);
    return std::move(out_);
  }

 private:
  /// Where the first run could not go on, its check ends at the same time.
  ExtendedMotion check_run(const ExtendedMotion& rough) {
    ExtendedProblem problem = plan_.problem;
    if (rough.ending != StepEnding::None) {
      plan_.numbers[plan_.end_index] = system_.context->number(*Rational::parse(rough.final.t));
      problem.numbers = kernel_of_numbers(plan_.numbers);
    }
    ExtendedOptions settings = settings_;
    settings.log2_tolerance = std::max(settings.log2_tolerance - 4 * std::log2(10.0), log2_rounding(level_.check));
    if (settings.order > 0) settings.order += 4;
    settings.maximum_steps = 2 * rough.steps + 1000;
    if (options_.progress) settings.progress = [this](double fraction) { options_.progress(0.4 + 0.6 * fraction); };
    return run_extended(problem, level_.check, settings);
  }

  void tell_ending(const ExtendedMotion& motion) {
    out_.ending = ending_of(motion.ending);
    out_.reason = motion.reason;
    if (!motion.final.t.empty()) out_.reached = Rational::parse(motion.final.t)->to_double();
    if (motion.ending != StepEnding::None || !plan_.problem.until) return;
    out_.ending = motion.met ? Ending::UntilReached : Ending::UntilNotReached;
    out_.reason = motion.met ? "the condition of `run until` was met" : "the condition of `run until` was not met within the time given";
  }

  void compare(const ExtendedMotion& rough, const ExtendedMotion& fine) {
    for (std::size_t i = 0; i < rough.at.size(); ++i) out_.at[plan_.order_of_times[i]] = agreed(rough.at[i], fine.at[i]);
    if (fine.ending == StepEnding::Interrupted) {
      out_.ending = Ending::Interrupted;
      out_.reason = fine.reason;
      return;
    }
    out_.final = agreed(rough.final, fine.final);
    for (std::size_t i = 0; i < std::min(rough.rows.size(), fine.rows.size()); ++i)
      out_.rows.push_back(agreed(rough.rows[i], fine.rows[i]));
  }

  AgreedNumber agreed(const std::string& rough, const std::string& fine) const {
    return rough.empty() || fine.empty() ? AgreedNumber{} : agreed_number(rough, fine, level_.digits);
  }

  std::vector<AgreedNumber> agreed(const std::vector<std::string>& rough, const std::vector<std::string>& fine, std::size_t first,
                                   std::size_t count) const {
    std::vector<AgreedNumber> out;
    for (std::size_t i = first; i < first + count; ++i) out.push_back(agreed(rough[i], fine[i]));
    return out;
  }

  ExtendedState agreed(const ExtendedSample& rough, const ExtendedSample& fine) const {
    ExtendedState out;
    if (!rough.reached || !fine.reached) return out;
    const std::size_t n = rough.q.size();
    out.reached = true;
    out.t = agreed(rough.t, fine.t);
    out.q = agreed(rough.q, fine.q, 0, n);
    out.v = agreed(rough.v, fine.v, 0, n);
    out.energy = agreed(rough.observables[0], fine.observables[0]);
    out.points = agreed(rough.observables, fine.observables, 1, plan_.points);
    out.reactions = agreed(rough.observables, fine.observables, 1 + plan_.points, plan_.reactions);
    for (const Observables::Dependence& d : observables_.dependences)
      if (rough.multipliers[d.constraint].empty()) out.reactions[d.observable - observables_.energy_terms - plan_.points] = {};
    return out;
  }

  void name_columns() {
    Trajectory names;
    name_trajectory_columns(model_.system, observables_, names.columns, out_.reactions);
    out_.independent = {model_.system.independent, model_.system.independent_unit()};
    out_.columns = names.columns;
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const ExtendedSimulationOptions& options_;
  ExtendedPlan plan_;
  const Observables& observables_;
  Level level_;
  ExtendedOptions settings_;
  ExtendedResult out_;
};

SimulationOptions in_double(const ExtendedSimulationOptions& options) {
  SimulationOptions out;
  if (options.duration) out.duration = options.duration->to_double();
  for (const Rational& t : options.at) out.at.push_back(t.to_double());
  if (options.output_every) out.output_every = options.output_every->to_double();
  return out;
}

}  // namespace

std::optional<ExtendedResult> simulate_extended(const Model& model, const EquationsOfMotion& equations,
                                                const ExtendedSimulationOptions& options, Diagnostics& diagnostics) {
  if (!has_method(model, options, diagnostics)) return std::nullopt;
  const SimulationOptions rough = in_double(options);
  const auto plan = plan_run(model, equations, rough, diagnostics);
  if (!plan || !requests_lie_ahead(model.system, *plan, rough, diagnostics)) return std::nullopt;
  const Observables observables = collect_observables(equations, nullptr);
  return ExtendedRun(model, equations, options, plan_extended(model, equations, options, *plan, observables), observables).carry_out();
}

namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string to_csv(const ExtendedResult& result) {
  const auto heading = [](const Trajectory::Column& c) { return quoted(c.unit.empty() ? c.name : c.name + " [" + c.unit + "]"); };
  std::string out = heading(result.independent);
  for (const Trajectory::Column& c : result.columns) out += "," + heading(c);
  out += "\r\n";
  for (const ExtendedState& row : result.rows) {
    out += row.t.text;
    for (const auto* part : {&row.q, &row.v, &row.points, &row.reactions})
      for (const AgreedNumber& x : *part) out += "," + (x.digits > 0 ? x.text : std::string());
    out += "," + (row.energy.digits > 0 ? row.energy.text : std::string()) + "\r\n";
  }
  return out;
}

}  // namespace maupertuis

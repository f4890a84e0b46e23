#include <maupertuis/integrator.hpp>
#include <maupertuis/simulation.hpp>

#include "simulation/energy_terms.hpp"
#include "simulation/run_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

/// One run, in named stages: plan (numbers), kernel (program), steps, measures. The observables of the kernel are, in
/// this order: the terms of h_E, the positions of the points, the probes.
namespace maupertuis {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

struct Observables {
  std::size_t energy_terms = 0, points = 0, probes = 0;
  std::vector<Expr> expressions;
};

Observables collect_observables(const EquationsOfMotion& equations, const Probe* probe) {
  Observables out;
  out.expressions = energy_terms(equations);
  out.energy_terms = out.expressions.size();
  for (const Point& point : equations.system->points)
    out.expressions.insert(out.expressions.end(), point.position.begin(), point.position.end());
  out.points = out.expressions.size() - out.energy_terms;
  if (probe) {
    out.expressions.insert(out.expressions.end(), probe->expressions.begin(), probe->expressions.end());
    out.probes = probe->expressions.size();
  }
  return out;
}

Kernel kernel_of(const Model& model, const EquationsOfMotion& equations, const Observables& observables, bool until) {
  const MechanicalSystem& system = model.system;
  KernelSource source;
  for (const Coordinate& c : system.coordinates) source.coordinates.push_back(c.q);
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.residual = in_terms_of_motion(system, equations.balance());
  source.multipliers = equations.multipliers;
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    const Constraint& c = system.constraints[i];
    const Expr value = in_terms_of_motion(system, {&c.value, 1}).front();
    source.constraints.push_back({value, c.level == Constraint::Level::Position ? 0 : 1, system.constraint_label(i)});
  }
  source.observables = in_terms_of_motion(system, observables.expressions);
  if (until) source.events = in_terms_of_motion(system, {&model.experiment.until, 1});
  source.integrands = in_terms_of_motion(system, {&equations.power, 1});
  return build_kernel(source);
}

Ending ending_of(StepEnding ending) {
  switch (ending) {
    case StepEnding::SingularMass: return Ending::SingularMass;
    case StepEnding::SingularConstraints: return Ending::SingularConstraints;
    case StepEnding::Overflow: return Ending::Overflow;
    case StepEnding::StepUnderflow: return Ending::StepUnderflow;
    case StepEnding::Sliding: return Ending::Sliding;
    case StepEnding::TooManySteps: return Ending::TooManySteps;
    case StepEnding::Interrupted: return Ending::Interrupted;
    case StepEnding::None: break;
  }
  return Ending::Finished;
}

/// energy_drift = max |h_E(t) − h_E(0) − work(t)| / max Σ |terms of h_E|.
class EnergyBalance {
 public:
  explicit EnergyBalance(std::size_t terms) : terms_(terms) {}

  void add(const Sample& sample) {
    double energy = 0, scale = 0;
    for (std::size_t i = 0; i < terms_; ++i) {
      energy += sample.observables[i];
      scale += std::abs(sample.observables[i]);
    }
    if (!std::isfinite(energy)) return;  // a state without forces: the ending tells
    if (!begun_) first_ = energy;
    begun_ = true;
    largest_scale_ = std::max(largest_scale_, scale);
    largest_error_ = std::max(largest_error_, std::abs(energy - first_ - sample.integrals[0]));
  }

  double energy_of(const Sample& sample) const {
    return std::accumulate(sample.observables.begin(), sample.observables.begin() + static_cast<std::ptrdiff_t>(terms_), 0.0);
  }
  double drift() const { return largest_scale_ > 0 ? largest_error_ / largest_scale_ : 0; }

 private:
  std::size_t terms_;
  bool begun_ = false;
  double first_ = 0, largest_scale_ = 0, largest_error_ = 0;
};

class Run {
 public:
  Run(const Model& model, const SimulationOptions& options, const RunPlan& plan, const Observables& observables,
      const Kernel& kernel, Probe* probe)
      : model_(model), options_(options), plan_(plan), observables_(observables), probe_(probe),
        stepper_(kernel, parameter_values(model.system), stepper_options(options)), balance_(observables.energy_terms) {
    name_columns();
    sort_requests();
  }

  SimulationResult carry_out() {
    stepper_.start(plan_.begin, plan_.q, plan_.v);
    result_.start = state_of(stepper_.sample(plan_.begin));
    result_.statistics.order = stepper_.order();
    const auto begin = Clock::now();
    record_covered();
    while (stepper_.time() != plan_.end && advance()) record_covered();
    result_.statistics.seconds = seconds_since(begin);
    finish();
    return std::move(result_);
  }

 private:
  static std::vector<double> parameter_values(const MechanicalSystem& system) {
    std::vector<double> values;
    for (const Parameter& p : system.parameters) values.push_back(p.si_value);
    return values;
  }
  static TaylorOptions stepper_options(const SimulationOptions& options) {
    TaylorOptions out;
    out.tolerance = options.tolerance;
    out.maximum_steps = options.maximum_steps;
    out.interrupt = options.interrupt;
    return out;
  }

  void name_columns() {
    auto& columns = result_.trajectory.columns;
    const auto unit = [&](const Dimension& d) { return model_.system.dimensionless ? std::string() : to_string(d); };
    for (const Coordinate& c : model_.system.coordinates) columns.push_back({c.name, unit(c.dimension)});
    for (const Coordinate& c : model_.system.coordinates)
      columns.push_back({c.name + "'", unit(c.dimension / dimensions::time())});
    for (const Point& p : model_.system.points)
      for (std::size_t axis = 0; axis < p.position.size(); ++axis)
        columns.push_back({p.name + "." + "xyz"[axis], unit(dimensions::length())});
    columns.push_back({"energy", unit(dimensions::energy())});
  }

  /// The requested times in the order of the run.
  void sort_requests() {
    requests_.resize(options_.at.size());
    std::iota(requests_.begin(), requests_.end(), std::size_t{0});
    const bool backwards = plan_.end < plan_.begin;
    std::stable_sort(requests_.begin(), requests_.end(), [&](std::size_t a, std::size_t b) {
      return backwards ? options_.at[a] > options_.at[b] : options_.at[a] < options_.at[b];
    });
    answers_.resize(options_.at.size());
    if (probe_) probe_->values.assign(options_.at.size(), {});
  }

  /// One step. False when the run ends here.
  bool advance() {
    const Step step = stepper_.step(plan_.end);
    if (step.begin != step.end) balance_.add(stepper_.step_start());
    if (step.ending != StepEnding::None) {
      result_.ending = ending_of(step.ending);
      result_.reason = step.reason;
      record_covered();
      return false;
    }
    if (step.event && plan_.until) {
      result_.ending = Ending::UntilReached;
      result_.reason = fmt::format("the condition of `run until` was met at t = {:.17g} s", stepper_.time());
      record_covered();
      return false;
    }
    if (options_.progress && stepper_.steps() % 1024 == 0)
      options_.progress((stepper_.time() - plan_.begin) / (plan_.end - plan_.begin));
    return true;
  }

  void record_covered() {
    while (next_output_ < plan_.output_times.size() && stepper_.covers(plan_.output_times[next_output_]))
      add_row(stepper_.sample(plan_.output_times[next_output_++]));
    while (next_request_ < requests_.size() && stepper_.covers(options_.at[requests_[next_request_]])) {
      const std::size_t index = requests_[next_request_++];
      const Sample sample = stepper_.sample(options_.at[index]);
      answers_[index] = state_of(sample);
      if (probe_)
        probe_->values[index].assign(sample.observables.end() - static_cast<std::ptrdiff_t>(observables_.probes),
                                     sample.observables.end());
    }
  }

  void add_row(const Sample& sample) {
    Trajectory& trajectory = result_.trajectory;
    trajectory.times.push_back(sample.t);
    auto& values = trajectory.values;
    values.insert(values.end(), sample.q.begin(), sample.q.end());
    values.insert(values.end(), sample.v.begin(), sample.v.end());
    const auto points = sample.observables.begin() + static_cast<std::ptrdiff_t>(observables_.energy_terms);
    values.insert(values.end(), points, points + static_cast<std::ptrdiff_t>(observables_.points));
    values.push_back(balance_.energy_of(sample));
  }

  static State state_of(const Sample& sample) { return {sample.t, sample.q, sample.v, sample.a, sample.multipliers}; }

  void finish() {
    const Sample last = stepper_.sample(stepper_.time());
    balance_.add(last);
    if (result_.trajectory.times.empty() || result_.trajectory.times.back() != last.t) add_row(last);
    result_.final = state_of(last);
    result_.at.assign(answers_.begin(), answers_.end());
    if (result_.ending == Ending::Finished && plan_.until) {
      result_.ending = Ending::UntilNotReached;
      result_.reason = fmt::format("the condition of `run until` was not met within {:g} s", std::abs(plan_.end - plan_.begin));
    }
    result_.statistics.steps = stepper_.steps();
    result_.statistics.switches = stepper_.switches();
    result_.statistics.constraint_residual = stepper_.constraint_residual();
    result_.statistics.energy_drift = balance_.drift();
  }

  const Model& model_;
  const SimulationOptions& options_;
  const RunPlan& plan_;
  const Observables& observables_;
  Probe* probe_;
  TaylorStepper stepper_;
  EnergyBalance balance_;
  SimulationResult result_;
  std::vector<std::size_t> requests_;
  std::vector<State> answers_;
  std::size_t next_output_ = 0, next_request_ = 0;
};

bool requests_lie_ahead(const RunPlan& plan, const SimulationOptions& options, Diagnostics& diagnostics) {
  for (const double t : options.at) {
    const bool ahead = plan.end >= plan.begin ? t >= plan.begin : t <= plan.begin;
    if (ahead && std::isfinite(t)) continue;
    diagnostics.error("E0706", std::nullopt, fmt::format("the state at t = {:g} s is not on the way of this run", t),
                      fmt::format("The run goes from {:g} s to {:g} s.", plan.begin, plan.end),
                      "Ask for times after the start, or run backwards with a negative duration.");
    return false;
  }
  return true;
}

}  // namespace

std::optional<SimulationResult> simulate(const Model& model, const EquationsOfMotion& equations,
                                         const SimulationOptions& options, Diagnostics& diagnostics, Probe* probe) {
  const auto plan = plan_run(model, equations, options, diagnostics);
  if (!plan || !requests_lie_ahead(*plan, options, diagnostics)) return std::nullopt;

  const auto begin = Clock::now();
  const Observables observables = collect_observables(equations, probe);
  const Kernel kernel = kernel_of(model, equations, observables, plan->until);
  Run run(model, options, *plan, observables, kernel, probe);
  const double compile_seconds = seconds_since(begin);

  SimulationResult result = run.carry_out();
  result.statistics.compile_seconds = compile_seconds;
  result.trajectory.metadata["system"] = model.system.name;
  result.trajectory.metadata["method"] = fmt::format("Taylor, order {}", result.statistics.order);
  return result;
}

}  // namespace maupertuis

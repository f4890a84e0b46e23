#include <maupertuis/across_switches.hpp>
#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/integrator.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include "simulation/companions.hpp"
#include "simulation/contact_checks.hpp"
#include "simulation/ending.hpp"
#include "simulation/energy_balance.hpp"
#include "simulation/energy_terms.hpp"
#include "simulation/errors.hpp"
#include "simulation/hybrid_motion.hpp"
#include "simulation/literals.hpp"
#include "simulation/methods.hpp"
#include "simulation/motion_kernel.hpp"
#include "simulation/observables.hpp"
#include "simulation/run_plan.hpp"
#include "simulation/state_quantities.hpp"
#include "simulation/stiffness.hpp"
#include "simulation/stopwatch.hpp"
#include "simulation/undetermined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

/// One run, in named stages: plan (numbers), kernel (program), steps, measures, companions (errors). The observables of
/// the kernel are, in this order: the terms of h_E, the positions of the points, the reactions, formulas that were
/// asked, the probes.
namespace maupertuis {
namespace {

/// Contacts, friction and events go through modes, by Taylor's steps.
std::unique_ptr<HybridMotion> hybrid_method(const Model& model, const EquationsOfMotion& equations,
                                            const WantedFunctions& wanted, const SimulationOptions& options,
                                            Diagnostics& diagnostics) {
  if (options.method == StepMethod::Stiff || options.method == StepMethod::Variational) {
    diagnostics.error("E0727", std::nullopt, "this method does not go through contacts, friction or events",
                      "They are located on the polynomials of Taylor's steps.",
                      "Use --method taylor, or leave the method out.");
    return nullptr;
  }
  if (!can_go_through_modes(equations, diagnostics)) return nullptr;
  return std::make_unique<HybridMotion>(std::make_shared<ModeLibrary>(model, equations, wanted),
                                        parameter_values(model.system), taylor_options(options));
}

std::string_view word_of(StepMethod method) {
  return method == StepMethod::Stiff ? "stiff" : method == StepMethod::Variational ? "variational" : "taylor";
}

std::string with_blank(const std::string& unit) { return unit.empty() ? unit : " " + unit; }

class Run {
 public:
  /// Makes the method that takes over at a state where steps have become short, if what keeps them so dies out.
  using StiffFrom = std::function<std::unique_ptr<Method>(const Sample& state, double length)>;

  /// `stiff` may be empty.
  Run(const Model& model, const SimulationOptions& options, const RunPlan& plan, const Observables& observables,
      const CloseObservables& close, std::unique_ptr<Method> method, StiffFrom stiff, Probe* probe, bool energy_jumps,
      HybridMotion* hybrid)
      : model_(model),
        options_(options),
        plan_(plan),
        observables_(observables),
        close_(close),
        parameters_(parameter_values(model.system)),
        probe_(probe),
        method_(std::move(method)),
        stiff_(std::move(stiff)),
        hybrid_(hybrid),
        balance_(observables.energy_terms, energy_jumps, observables.of_places) {
    result_.statistics.method = word_of(*options.method);
    result_.trajectory.independent = {model.system.independent, model.system.independent_unit()};
    name_trajectory_columns(model.system, observables, result_.trajectory.columns, result_.reactions);
    sort_requests();
  }

  SimulationResult carry_out() {
    method_->start(plan_.begin, plan_.q, plan_.v);
    result_.start = state_of(sample(plan_.begin));
    result_.statistics.order = method_->order();
    const double compiled_before = method_->backend().compile_seconds;
    const auto begin = Clock::now();
    record_covered();
    while (method_->time() != plan_.end && advance()) record_step();
    result_.statistics.seconds = seconds_since(begin);
    note_backend(method_->backend(), compiled_before);
    finish();
    return std::move(result_);
  }

  bool turned_stiff() const { return turned_stiff_; }
  const StatesBetween& between() const { return between_; }
  const Roundings& roundings() const { return roundings_; }
  const BackendUse& backend() const { return backend_; }

 private:
  /// Compilation on the way is no stepping.
  void note_backend(const BackendUse& use, double compiled_before) {
    if (!turned_stiff_) backend_ = use;
    if (backend_.compiled) result_.statistics.backend = "compiled";
    result_.statistics.compile_seconds = backend_.compile_seconds - compiled_before;
    result_.statistics.seconds -= result_.statistics.compile_seconds;
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
    roundings_.at.resize(options_.at.size());
    for (std::size_t i = 0; i < answers_.size(); ++i) answers_[i].t = options_.at[i];  // also where it is not reached
    if (probe_) probe_->values.assign(options_.at.size(), {});
  }

  /// One step. False when the run ends here.
  bool advance() {
    balance_.before_step(*method_);
    const bool jumps = hybrid_ && hybrid_->will_jump() && jumps_ < most_jumps;
    if (jumps) add_row_before_jump();
    const Step step = method_->step(plan_.end);
    if (jumps && step.begin != step.end) add_row(shown(method_->step_start()));
    balance_.after_step(*method_, step);
    if (step.ending != StepEnding::None) {
      result_.ending = ending_of(step.ending);
      result_.reason = step.reason;
      record_covered();
      return false;
    }
    if (step.event && hybrid_ && hybrid_->record().stopped_by) {
      result_.ending = Ending::Stopped;
      result_.reason = fmt::format("the event `{}` stopped the run at {}", *hybrid_->record().stopped_by,
                                   model_.system.moment(fmt::format("{}", method_->time())));
      record_covered();
      return false;
    }
    if (step.event && plan_.until) {
      result_.ending = Ending::UntilReached;
      result_.reason =
          "the condition of `run until` was met at " + model_.system.moment(fmt::format("{}", method_->time()));
      record_covered();
      return false;
    }
    if (stiff_ && watch_.sees_stiffness(method_->step_start(), step, plan_.end)) change_method();
    if (options_.progress && method_->steps() % 1024 == 0)
      options_.progress((method_->time() - plan_.begin) / (plan_.end - plan_.begin));
    return true;
  }

  /// From the state that is reached. What the last step covers has to be recorded before.
  void change_method() {
    record_covered();
    const Sample last = method_->sample(method_->time());
    auto stiff = std::exchange(stiff_, nullptr)(last, watch_.length());
    if (!stiff) return;
    balance_.carry_over(last);
    backend_ = method_->backend();
    steps_before_ += method_->steps();
    rejected_before_ += method_->rejected();
    residual_before_ = method_->constraint_residual();
    method_ = std::move(stiff);
    method_->start(last.t, last.q, last.v);
    result_.statistics.method = word_of(StepMethod::Stiff);
    result_.statistics.order = method_->order();
    turned_stiff_ = true;
  }

  void record_covered() {
    while (next_output_ < plan_.output_times.size() && method_->covers(plan_.output_times[next_output_]))
      add_row(sample(plan_.output_times[next_output_++]));
    const std::vector<double>& between = plan_.times_between;
    while (between_.times.size() < between.size() && method_->covers(between[between_.times.size()]))
      add_state_between(between[between_.times.size()]);
    while (next_request_ < requests_.size() && method_->covers(options_.at[requests_[next_request_]])) {
      const std::size_t index = requests_[next_request_++];
      Sample found = sample(options_.at[index]);
      roundings_.at[index] = close_.put_into(found, parameters_);
      answers_[index] = state_of(found);
      if (probe_)
        probe_->values[index].assign(found.observables.end() - static_cast<std::ptrdiff_t>(observables_.probes),
                                     found.observables.end());
    }
  }

  void add_state_between(double t) {
    const std::size_t n = plan_.q.size(), from = between_.values.size();
    between_.times.push_back(t);
    between_.values.resize(from + 2 * n);
    const std::span<double> values = std::span(between_.values).subspan(from);
    method_->state(t, values.first(n), values.last(n));
  }

  /// The rows that the last step covers, with those between the output times where they are asked for: 2p/5 of them in
  /// a step of order p, at order 20 some 46 in a period of an oscillator. An interval of output times takes a hundred,
  /// some periods of what is fastest: the picture of a longer run shows how far it swings.
  ///
  ///     output times   |                   |                   |
  ///     steps          |----|----|----|----|----|----|----|----|
  ///     rows           |....|....|..       |....|....|..       |
  void record_step() {
    constexpr std::size_t most_between = 100;
    const double begin = method_->step_start().t, end = method_->time();
    const int parts = std::max(1, 2 * method_->order() / 5);
    const bool is_fine = plan_.even_rows || std::abs(end - begin) >= parts * plan_.row_interval;
    for (int k = 1; k <= parts && !is_fine; ++k) {
      const double t = k == parts ? end : begin + (end - begin) * k / parts;
      const std::size_t before = next_output_;
      while (next_output_ < plan_.output_times.size() &&
             std::abs(plan_.output_times[next_output_] - begin) <= std::abs(t - begin))
        add_row(sample(plan_.output_times[next_output_++]));
      if (next_output_ != before) rows_since_output_ = 0;
      if (rows_since_output_++ >= most_between)
        left_out_ = true;
      else if (result_.trajectory.times.back() != t)
        add_row(sample(t));
    }
    record_covered();
  }

  Sample sample(double t) const { return shown(method_->sample(t)); }
  Sample shown(Sample out) const {
    leave_out_undetermined(out, observables_);
    return out;
  }

  /// The last state before an impact; the first one after it follows, with the same time.
  void add_row_before_jump() {
    ++jumps_;
    const auto& times = result_.trajectory.times;
    if (times.empty() || times.back() != method_->time()) add_row(sample(method_->time()));
  }

  void add_row(const Sample& sample) {
    Trajectory& trajectory = result_.trajectory;
    if (std::exchange(left_out_, false)) trajectory.gaps.push_back(trajectory.rows());
    trajectory.times.push_back(sample.t);
    append_row(trajectory.values, sample, observables_);
  }

  State state_of(const Sample& sample) const {
    const auto reactions =
        sample.observables.begin() + static_cast<std::ptrdiff_t>(observables_.energy_terms + observables_.points);
    return {sample.t,           sample.q,
            sample.v,           sample.a,
            sample.multipliers, {reactions, reactions + static_cast<std::ptrdiff_t>(observables_.reactions.size())}};
  }

  void finish() {
    Sample last = sample(method_->time());
    balance_.add(last);
    if (result_.trajectory.times.empty() || result_.trajectory.times.back() != last.t) add_row(last);
    roundings_.final = close_.put_into(last, parameters_);
    result_.final = state_of(last);
    result_.at.assign(answers_.begin(), answers_.end());
    if (result_.ending == Ending::Finished && plan_.until) {
      result_.ending = Ending::UntilNotReached;
      result_.reason = fmt::format("the condition of `run until` was not met within {:g}{}",
                                   std::abs(plan_.end - plan_.begin), with_blank(model_.system.independent_unit()));
    }
    if (result_.ok() && balance_.is_lost()) {
      result_.ending = Ending::Overflow;
      result_.reason = EnergyBalance::lost;
    }
    result_.statistics.steps = steps_before_ + method_->steps();
    result_.statistics.rejected = rejected_before_ + method_->rejected();
    result_.statistics.switches = method_->switches();
    result_.statistics.constraint_residual = std::max(residual_before_, method_->constraint_residual());
    result_.statistics.energy_drift = balance_.drift(hybrid_ ? hybrid_->rounding_of_energy() : 0);
    if (hybrid_) take_record(last);
  }

  void take_record(const Sample& last) {
    hybrid_->finish();
    const HybridRecord& record = hybrid_->record();
    result_.first_mode = record.first_mode;
    result_.happenings = hybrid_->take_happenings();
    result_.remarks = record.remarks;
    const bool has_modes = model_.system.has_modes();
    if (has_modes || record.books.events != 0) result_.books = record.books;
    if (!has_modes) return;
    result_.books->friction = last.integrals[1];
    result_.books->dampers = last.integrals[2];
    result_.books->moving += last.integrals[3];
  }

  const Model& model_;
  const SimulationOptions& options_;
  const RunPlan& plan_;
  const Observables& observables_;
  const CloseObservables& close_;
  std::vector<double> parameters_;
  Probe* probe_;
  std::unique_ptr<Method> method_;
  StiffFrom stiff_;
  HybridMotion* hybrid_;  // the method, where the model has contacts, friction or events
  StiffnessWatch watch_;
  BackendUse backend_;
  bool turned_stiff_ = false;
  std::size_t steps_before_ = 0, rejected_before_ = 0;
  double residual_before_ = 0;
  EnergyBalance balance_;
  SimulationResult result_;
  std::vector<std::size_t> requests_;
  std::vector<State> answers_;
  std::size_t next_output_ = 0, next_request_ = 0;
  StatesBetween between_;
  Roundings roundings_;
  std::size_t rows_since_output_ = 0;                // since the last output time
  bool left_out_ = false;                            // a row, since the last one
  static constexpr std::size_t most_jumps = 10'000;  // that have rows of their own
  std::size_t jumps_ = 0;
};

std::string title_of(const std::string& method) {
  return method == "taylor" ? "Taylor" : method == "stiff" ? "stiff (Radau)" : "variational";
}

void note_stiffness(const SimulationResult& result, const MechanicalSystem& system, double tolerance,
                    Diagnostics& diagnostics) {
  diagnostics.note(
      "N0702", std::nullopt, "the stiff method took over",
      fmt::format("Fast, strongly damped parts of the motion had died out, and yet limited Taylor's steps; "
                  "Radau's implicit steps went on with a tolerance of {:g} to {}.",
                  tolerance, system.moment(fmt::format("{:g}", result.final.t))),
      "Use --method taylor to keep Taylor's steps, or --tol for another tolerance.");
}

/// What the run had to do without. In automatic runs a program that is not compiled is nothing to be told.
void warn_of_backend(const BackendUse& use, Backend wanted, Diagnostics& diagnostics) {
  const char* const help =
      "`maup doctor` tells what this installation has; --backend interpreter leaves the message out.";
  if (wanted == Backend::Compiled && !use.compiled)
    diagnostics.warning("W0703", std::nullopt, "the run was carried out without compiled code", use.trouble, help);
  if (wanted == Backend::Automatic && !use.compiled && !use.trouble.empty() && !backend_status().compiled)
    diagnostics.note("N0704", std::nullopt, "compiled code would have paid for this run, and is not here", use.trouble,
                     help);
  if (!use.cache_trouble.empty())
    diagnostics.warning("W0705", std::nullopt, "the kept code of earlier runs is not as it should be",
                        use.cache_trouble,
                        "Make the folder yours and writable by you alone (chmod 700), name another by XDG_CACHE_HOME, "
                        "or give --no-cache.");
}

/// The errors, as companion runs tell them.
void add_errors(SimulationResult& result, Probe* probe, const Model& model, const EquationsOfMotion& equations,
                const SimulationOptions& options, const RunPlan& plan, const Observables& observables,
                const CloseObservables& close, const Roundings& roundings, const WantedFunctions& wanted,
                const HybridMotion* hybrid, const StatesBetween& between) {
  const auto begin = Clock::now();
  const auto of_literals = hybrid ? with_literals_as_parameters(model, wanted) : nullptr;
  const RoundedNumbers numbers(of_literals ? of_literals->model : model,
                               of_literals ? of_literals->equations : equations, plan, wanted);
  const CompanionPlan companion_plan{
      model,
      equations,
      options,
      plan,
      observables,
      close,
      roundings,
      result,
      between,
      comparison_grid(result.trajectory, between, plan, options.errors),
      options.errors == ErrorEstimates::Rows,
      of_literals ? std::make_shared<ModeLibrary>(of_literals->model, of_literals->equations, of_literals->wanted)
      : hybrid    ? hybrid->library()
                  : nullptr,
      hybrid ? hybrid->largest_accelerations() : std::vector<double>()};
  const Companions companions = run_companions(companion_plan, wanted, numbers);
  if (companions.interrupted) {
    result.ending = Ending::Interrupted;
    result.reason = "the run was done, but interrupted while its errors were looked for";
    return;
  }
  tell_errors(result, probe, companion_plan, companions, numbers);
  result.statistics.companions = companions.runs.size();
  result.statistics.companion_seconds = seconds_since(begin);
}

/// Whether rounding of h_E explains its drift, as near the bottom of 1 − cos θ, where its value in double has few
/// digits.
bool is_rounding_of_energy(const SimulationResult& result, const EquationsOfMotion& equations) {
  constexpr double usual_sum = 100;  // of the roundings of a run
  if (result.final.q.empty()) return false;
  const MotionState last{result.final.t, result.final.q, result.final.v};
  return result.statistics.energy_drift <= usual_sum * rounding_of_energy(equations, last);
}

/// Far beyond what steps leave: something was passed that the equations do not hold. Variational steps may.
void warn_of_drift(const SimulationResult& result, const EquationsOfMotion& equations, const SimulationOptions& options,
                   Diagnostics& diagnostics) {
  constexpr double always = 1e-7, of_tolerance = 1e5;
  const double drift = result.statistics.energy_drift;
  if (result.statistics.energy_vanishes || options.method == StepMethod::Variational) return;
  const double tolerance =
      result.statistics.method == word_of(StepMethod::Stiff) ? stiff_tolerance(options) : options.tolerance;
  if (!(drift > std::max(always, of_tolerance * tolerance)) || is_rounding_of_energy(result, equations)) return;
  diagnostics.warning(
      "W0734", std::nullopt,
      fmt::format("the energy drifts by {:.2g} of its terms, far beyond the errors of the steps", drift),
      "Nothing in the equations of motion changes it so. Where an energy jumps, a force acts that no "
      "derivative of it shows, and the motion goes through as if there were none.",
      "Let the pieces of energies meet, or round the jump: V0/2 (1 + tanh((x - a)/w)); a force may "
      "jump.");
}

void warn_of_values(const HybridRecord& record, const Model& model, Diagnostics& diagnostics) {
  for (const HybridRecord::WithoutValue& w : record.without_value) {
    const ModelEvent& event = model.experiment.events[w.event];
    const std::string where = w.times == w.of ? std::string("all along the motion")
                                              : fmt::format("at {} of {} steps, first at {}", w.times, w.of,
                                                            model.system.moment(fmt::format("{:.6g}", w.first)));
    diagnostics.warning("W0736", event.span, fmt::format("the event `{}` has no value {}", event.name, where),
                        "Its function is no real number there, a root or a logarithm of what is negative: it is never "
                        "met as long as that lasts.",
                        "Write a condition that has a value everywhere, as x^2 = a in place of x = sqrt(a).");
  }
}

}  // namespace

std::optional<SimulationResult> simulate(const Model& model, const EquationsOfMotion& equations,
                                         const SimulationOptions& asked, Diagnostics& diagnostics, Probe* probe) {
  const ExpressionLock lock(*equations.system->context);
  if (equations.determined) {
    if (refuse_undetermined(model.experiment, probe, equations, diagnostics)) return std::nullopt;
    auto result = simulate(with_determined_system(model, equations), *equations.determined, asked, diagnostics, probe);
    if (result) in_terms_of_system(*result, equations, diagnostics);
    if (result && !has_free_functions(equations)) add_rates(*result, model.system);
    return result;
  }
  const SimulationOptions options = with_method_of(model, asked);
  const auto plan = plan_run(model, equations, options, diagnostics);
  if (!plan || !requests_lie_ahead(model.system, *plan, options, diagnostics)) return std::nullopt;

  if (!start_keeps_contacts(model, plan->begin, plan->q, diagnostics)) return std::nullopt;

  const auto begin = Clock::now();
  std::span<const AskedFormula> formulas;  // elsewhere the state of a row says them
  if (model.system.has_modes()) formulas = model.experiment.asked;
  const Observables observables = collect_observables(equations, probe, formulas);
  WantedFunctions wanted{observables.expressions, {}, {}};
  if (!equations.power.is_zero()) wanted.integrands.push_back(equations.power);
  if (plan->until) wanted.events.push_back(plan->condition);
  const bool is_hybrid = goes_through_modes(model);
  std::unique_ptr<HybridMotion> through_modes;
  if (is_hybrid) through_modes = hybrid_method(model, equations, wanted, options, diagnostics);
  HybridMotion* const hybrid = through_modes.get();
  std::unique_ptr<Method> method =
      is_hybrid ? std::unique_ptr<Method>(std::move(through_modes))
                : method_of_run(equations, wanted, options, plan->end - plan->begin, diagnostics);
  if (!method) return std::nullopt;
  Run::StiffFrom stiff;
  if (!is_hybrid && options.method == StepMethod::Automatic)
    stiff = [&](const Sample& state, double length) {
      return stiff_method_from(state, length, equations, wanted, stiff_options(options), diagnostics);
    };
  const bool energy_jumps =
      across_switches(*equations.system, equations.energy_function, equations.order).jump.has_value();
  const CloseObservables close(equations, observables);
  Run run(model, options, *plan, observables, close, std::move(method), std::move(stiff), probe, energy_jumps, hybrid);
  const double compile_seconds = seconds_since(begin);

  SimulationResult result = run.carry_out();
  if (options.errors != ErrorEstimates::None && result.ending != Ending::Interrupted)
    add_errors(result, probe, model, equations, options, *plan, observables, close, run.roundings(), wanted, hybrid,
               run.between());
  if (equations.degenerate) forget_drift_of_nothing(result, equations);
  warn_of_drift(result, equations, options, diagnostics);
  if (hybrid) warn_of_values(hybrid->record(), model, diagnostics);
  if (hybrid) tell_ending(result.ending, result.reason, hybrid->record().ended_by, diagnostics);
  if (run.turned_stiff()) note_stiffness(result, model.system, stiff_tolerance(options), diagnostics);
  if (options.method == StepMethod::Automatic || options.method == StepMethod::Taylor ||
      options.backend == Backend::Compiled)
    warn_of_backend(run.backend(), options.backend, diagnostics);
  // Determined equations have a system of their own; the rates of the model are told of that.
  if (!equations.degenerate) add_rates(result, model.system);
  result.statistics.compile_seconds += compile_seconds;
  result.trajectory.metadata["system"] = model.system.name;
  result.trajectory.metadata["method"] =
      fmt::format("{}, order {}", title_of(result.statistics.method), result.statistics.order);
  return result;
}

}  // namespace maupertuis

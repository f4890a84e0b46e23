#include <maupertuis/across_switches.hpp>
#include <maupertuis/arguments.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/ensemble_through_modes.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/on_threads.hpp>

#include "simulation/energy_balance.hpp"
#include "simulation/hybrid_motion.hpp"
#include "simulation/methods.hpp"
#include "simulation/observables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

/// Runs through modes beside each other: each is the run that it would be alone, with the programs of modes shared.
namespace maupertuis {
namespace {

constexpr double not_reached = std::numeric_limits<double>::quiet_NaN();

/// A value that the model bounds: of a model text it is checked once, here with the values of each trajectory.
struct BoundedValue {
  Expr value;
  double least, most;
  std::string what, why;
};

/// What a mistake in the text would be: E0263, E0264, E0403.
std::vector<BoundedValue> bounded_values(const MechanicalSystem& system) {
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  std::vector<BoundedValue> out;
  for (std::size_t i = 0; i < system.contacts.size(); ++i)
    out.push_back({system.contacts[i].restitution, 0, 1, "The restitution of " + system.contact_label(i),
                   "it is the part of the speed that an impact gives back, from 0 to 1"});
  for (std::size_t i = 0; i < system.contacts.size() + system.frictions.size(); ++i) {
    const Friction& friction = friction_of(system, i);
    if (!friction.present()) continue;
    const std::string name = " friction of " + friction.name;
    out.push_back({friction.kinetic, 0, unbounded, "The" + name, "friction takes energy from the motion"});
    out.push_back({friction.static_ - friction.kinetic, 0, unbounded, "Static minus kinetic" + name,
                   "what holds a body that rests is at least what brakes one that slides"});
  }
  for (const Point& p : system.points)
    if (p.mass) out.push_back({p.mass, 0, unbounded, "The mass of " + p.name, "masses are positive"});
  for (const Body& b : system.bodies)
    if (b.mass) out.push_back({b.mass, 0, unbounded, "The mass of " + b.name, "masses are positive"});
  for (BoundedValue& bound : out) bound.value = in_terms_of_motion(system, {&bound.value, 1}).front();
  std::erase_if(out, [](const BoundedValue& bound) { return has_multipliers(bound.value); });  // known in a mode alone
  return out;
}

/// What the threads share. Each trajectory is written by the thread that took it.
struct Members {
  const EnsembleStart& start;
  const ThroughModesOptions& options;
  std::shared_ptr<ModeLibrary> library;
  std::size_t energy_terms;
  bool energy_jumps;
  Kernel kernel;  // of the motion without contacts: its constraints are those that starts keep
  std::vector<BoundedValue> bounds;
  std::size_t count, freedoms;
  ThroughModesResult& result;
  std::atomic<std::size_t> next{0};

  bool interrupted() const { return options.interrupt && options.interrupt->load(std::memory_order_relaxed); }
};

void check(const Model& model, const EnsembleStart& start) {
  check_argument(goes_through_modes(model),
                 "advance_ensemble: the model has no contacts, friction or events; take motion_kernel and "
                 "advance_ensemble(kernel, …)");
  check_ensemble_start(start, model.system.coordinates.size(), model.system.parameters.size());
  check_argument(start.step_factors.empty(), "advance_ensemble: start.step_factors is for kernels alone");
}

ThroughModesResult empty_result(std::size_t count, std::size_t freedoms, std::size_t times) {
  ThroughModesResult out;
  out.freedoms = freedoms;
  out.times = times;
  out.endings.resize(count);
  out.through.resize(count);
  for (auto* values : {&out.q, &out.v}) values->assign(count * freedoms, not_reached);
  for (auto* values : {&out.sampled_q, &out.sampled_v}) values->assign(count * times * freedoms, not_reached);
  return out;
}

/// One trajectory.
class Member {
 public:
  Member(Members& members, std::size_t number)
      : members_(members),
        number_(number),
        begin_(members.start.begin_of(number)),
        end_(members.start.end_of(number)),
        motion_(members.library, parameters(), taylor_options(members.options)),
        balance_(members.energy_terms, members.energy_jumps) {}

  void carry_out() {
    motion_.start(begin_, state(members_.start.q), state(members_.start.v));
    take_samples();
    TrajectoryEnding& ending = members_.result.endings[number_];
    bool stopped = false;
    while (motion_.time() != end_ && ending.ok() && !stopped) {
      balance_.before_step(motion_);
      Step step = motion_.step(end_);
      balance_.after_step(motion_, step);
      take_samples();
      ending.ending = step.ending;
      ending.reason = std::move(step.reason);
      stopped = step.event && motion_.record().stopped_by;
    }
    finish(ending);
  }

 private:
  std::span<const double> state(std::span<const double> all) const {
    return all.subspan(number_ * members_.freedoms, members_.freedoms);
  }
  std::vector<double> parameters() const {
    const std::span<const double> found =
        members_.start.parameters_of(number_, members_.library->system().parameters.size());
    return {found.begin(), found.end()};
  }

  /// The wanted times that the last step covers, in the order of the run.
  void take_samples() {
    const std::size_t n = members_.freedoms, count = members_.start.times.size();
    for (; sampled_ < count; ++sampled_) {
      const std::size_t index = end_ < begin_ ? count - 1 - sampled_ : sampled_;
      const double t = members_.start.times[index];
      const bool passed = end_ < begin_ ? t > motion_.time() : t < motion_.time();
      if (motion_.covers(t)) {
        const std::size_t at = (number_ * count + index) * n;
        motion_.state(t, std::span(members_.result.sampled_q).subspan(at, n),
                      std::span(members_.result.sampled_v).subspan(at, n));
      } else if (!passed) {
        return;
      }
    }
  }

  void finish(TrajectoryEnding& ending) {
    const Sample last = motion_.sample(motion_.time());
    balance_.add(last);
    motion_.finish();
    ending.t = last.t;
    ending.steps = motion_.steps();
    ending.energy_drift = balance_.drift(motion_.rounding_of_energy());
    ending.alone = true;
    if (ending.ok() && balance_.is_lost()) ending.ending = StepEnding::Overflow, ending.reason = EnergyBalance::lost;
    const auto place = static_cast<std::ptrdiff_t>(number_ * members_.freedoms);
    std::copy(last.q.begin(), last.q.end(), members_.result.q.begin() + place);
    std::copy(last.v.begin(), last.v.end(), members_.result.v.begin() + place);
    take_record(ending, last);
  }

  void take_record(TrajectoryEnding& ending, const Sample& last) {
    const HybridRecord& record = motion_.record();
    const Model& model = members_.library->model();
    const auto& events = model.experiment.events;
    if (record.stopped_by && ending.ok())
      for (std::size_t k = 0; k < events.size(); ++k)
        if (events[k].name == *record.stopped_by) ending.event = k;
    ThroughModes& out = members_.result.through[number_];
    out.first_mode = out.last_mode = record.first_mode;
    for (const Happening& h : record.happenings) {
      ++out.counts[static_cast<std::size_t>(h.kind)];
      if (h.mode != out.last_mode) ++out.modes;
      out.last_mode = h.mode;
      if (out.happenings.size() < members_.options.happenings) out.happenings.push_back(h);
    }
    out.remarks = record.remarks;
    const bool has_modes = model.system.has_modes();
    if (has_modes || record.books.events != 0) out.books = record.books;
    if (!has_modes) return;
    out.books->friction = last.integrals[1];
    out.books->dampers = last.integrals[2];
    out.books->moving += last.integrals[3];
  }

  Members& members_;
  std::size_t number_;
  double begin_, end_;
  HybridMotion motion_;
  EnergyBalance balance_;
  std::size_t sampled_ = 0;  // times that are done
};

/// A trajectory that is not carried out stays where it starts.
void end_at_start(Members& members, std::size_t number, StepEnding why, std::string reason) {
  TrajectoryEnding& ending = members.result.endings[number];
  ending = {};
  ending.ending = why;
  ending.reason = std::move(reason);
  ending.t = members.start.begin_of(number);
  ending.alone = true;
  const std::size_t n = members.freedoms;
  std::copy_n(members.start.q.begin() + static_cast<std::ptrdiff_t>(number * n), n,
              members.result.q.begin() + static_cast<std::ptrdiff_t>(number * n));
  std::copy_n(members.start.v.begin() + static_cast<std::ptrdiff_t>(number * n), n,
              members.result.v.begin() + static_cast<std::ptrdiff_t>(number * n));
}

/// One sentence where the model does not take the values or the start of a trajectory.
std::string trouble_of(const Members& members, std::size_t number) {
  const MechanicalSystem& system = members.library->system();
  const EnsembleStart& start = members.start;
  const auto values = start.parameters_of(number, system.parameters.size());
  const auto q = start.q.subspan(number * members.freedoms, members.freedoms);
  const auto v = start.v.subspan(number * members.freedoms, members.freedoms);
  if (!std::isfinite(start.end_of(number))) return "The end is infinite or undefined.";
  std::string trouble = trouble_of_start(members.kernel, values, start.begin_of(number), q, v);
  if (!trouble.empty()) return trouble;
  Bindings at = parameter_bindings(system);
  for (std::size_t i = 0; i < values.size(); ++i) at[system.parameters[i].symbol] = values[i];
  at[system.context->time()] = start.begin_of(number);
  for (std::size_t i = 0; i < q.size(); ++i)
    at[system.coordinates[i].q] = q[i], at[system.coordinates[i].velocity] = v[i];
  for (const BoundedValue& bound : members.bounds) {
    const double value = evaluate(bound.value, at);
    if (std::isnan(value)) return fmt::format("{} has no value: {}.", bound.what, bound.why);
    if (value < bound.least || value > bound.most) return fmt::format("{} is {:g}: {}.", bound.what, value, bound.why);
  }
  return {};
}

void carry_out(Members& members, std::size_t number) {
  constexpr const char* interrupted = "The ensemble was interrupted before this motion was done.";
  if (members.interrupted()) return end_at_start(members, number, StepEnding::Interrupted, interrupted);
  if (std::string trouble = trouble_of(members, number); !trouble.empty())
    return end_at_start(members, number, StepEnding::Refused, std::move(trouble));
  try {
    Member(members, number).carry_out();
  } catch (const Interrupted&) {
    end_at_start(members, number, StepEnding::Interrupted, interrupted);
  }
}

}  // namespace

std::optional<ThroughModesResult> advance_ensemble(const Model& model, const EquationsOfMotion& equations,
                                                   const EnsembleStart& start, const ThroughModesOptions& options,
                                                   Diagnostics& diagnostics) {
  check(model, start);
  if (refuse_free_functions(equations, "ensembles", diagnostics)) return std::nullopt;
  if (equations.determined)
    return advance_ensemble(with_determined_system(model, equations), *equations.determined, start, options,
                            diagnostics);
  if (!can_go_through_modes(equations, diagnostics)) return std::nullopt;
  const Observables observables = collect_observables(equations, nullptr);
  const std::size_t n = model.system.coordinates.size(), count = start.q.size() / n;
  ThroughModesResult result = empty_result(count, n, start.times.size());
  Members members{
      .start = start,
      .options = options,
      .library = std::make_shared<ModeLibrary>(model, equations, WantedFunctions{observables.expressions, {}, {}}),
      .energy_terms = observables.energy_terms,
      .energy_jumps = across_switches(*equations.system, equations.energy_function, equations.order).jump.has_value(),
      .kernel = free_motion_kernel(equations).kernel,
      .bounds = bounded_values(*equations.system),
      .count = count,
      .freedoms = n,
      .result = result};
  const InterruptScope scope(*model.system.context, options.interrupt);  // from here on each trajectory tells of it
  const auto work = [&] {
    for (std::size_t number = members.next++; number < count; number = members.next++) carry_out(members, number);
  };
  on_threads(thread_count(options.threads, count), work, [&] { members.next = count; });
  return result;
}

}  // namespace maupertuis

#include "simulation/extended_problem.hpp"

#include "simulation/contact/contact_functions.hpp"
#include "simulation/ending.hpp"
#include "simulation/mode_library.hpp"
#include "simulation/motion_kernel.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace maupertuis {
namespace {

class ExactPlanner {
 public:
  ExactPlanner(const Model& model, const EquationsOfMotion& equations, const ExtendedSimulationOptions& options,
               const RunPlan& plan)
      : model_(model),
        system_(model.system),
        equations_(equations),
        options_(options),
        plan_(plan),
        context_(*model.system.context) {
    for (const Parameter& p : system_.parameters) values_[p.symbol] = p.value;
    values_[context_.time()] = number(0);
  }

  ExtendedPlan find(const Observables& observables) {
    choose_functions(observables);
    for (const Parameter& p : system_.parameters) out_.numbers.push_back(p.value);
    add_times();
    add_start();
    for (const std::size_t i : out_.order_of_times) out_.numbers.push_back(number(options_.at[i]));
    out_.problem.times = options_.at.size();
    out_.problem.numbers = kernel_of_numbers(out_.numbers);
    return std::move(out_);
  }

 private:
  Expr number(const Rational& value) const { return context_.number(value); }
  /// In numbers and π alone.
  Expr value_of(Expr e) const { return substitute(in_terms_of_motion(system_, {&e, 1}).front(), values_); }

  /// Observables: the energy, the points, the reactions, the conditions of the start with their derivatives.
  void choose_functions(const Observables& all) {
    WantedFunctions wanted;
    wanted.has_wide_range = true;
    const auto energies = all.expressions.begin() + static_cast<std::ptrdiff_t>(all.energy_terms);
    wanted.observables.push_back(context_.sum(std::vector<Expr>(all.expressions.begin(), energies)));
    wanted.observables.insert(wanted.observables.end(), energies, all.expressions.end());
    out_.points = all.points;
    out_.reactions = all.reactions.size();
    WantedFunctions along = wanted;
    if (plan_.until) along.events.push_back(plan_.condition);
    if (system_.has_modes()) library_ = std::make_shared<ModeLibrary>(model_, equations_, along);
    out_.problem.first_condition = wanted.observables.size();
    ExprVector positions, velocities;
    for (const Coordinate& c : system_.coordinates) positions.push_back(c.q), velocities.push_back(c.velocity);
    for (const StartCondition& c : model_.experiment.start_conditions) {
      const Expr difference = c.formula - c.value;
      const Expr zero = expand_time_derivatives(in_terms_of_motion(system_, {&difference, 1}).front());
      wanted.observables.push_back(zero);
      for (const Expr& slope : gradient(zero, c.is_of_positions() ? positions : velocities))
        wanted.observables.push_back(slope);
      out_.problem.conditions.push_back(c.is_of_positions());
    }
    if (equations_.degenerate) add_relations(wanted, positions, velocities);
    if (plan_.until) wanted.events.push_back(plan_.condition);
    out_.problem.until = plan_.until;
    watch_events(wanted);
    add_contacts(wanted);
    without_forces(wanted);
    out_.problem.kernel = motion_kernel(equations_, wanted);
  }

  /// What a degenerate Lagrangian asks of every state: only a part of it are constraints of the determined equations,
  /// the rest is kept by motions that begin with it.
  void add_relations(WantedFunctions& wanted, const ExprVector& positions, const ExprVector& velocities) {
    const StateRelations relations(equations_, *equations_.degenerate);
    out_.problem.first_relation = wanted.observables.size();
    out_.problem.relations = relations.values().size();
    for (const Expr& value : expand_time_derivatives(in_terms_of_motion(system_, relations.values()))) {
      wanted.observables.push_back(value);
      for (const ExprVector* states : {&positions, &velocities})
        for (const Expr& slope : gradient(value, *states)) wanted.observables.push_back(slope);
    }
  }

  void watch_events(WantedFunctions& wanted) {
    for (const ModelEvent& e : model_.experiment.events) {
      wanted.events.push_back(with_reactions(equations_, {&e.function, 1}).front());
      ExtendedEvent event{action_of(e.action), e.direction};
      if (const auto reads = state_read_by(e.function, system_)) {
        event.of_state = true;
        for (const StateRead& r : *reads) event.reads.push_back({r.coordinate, r.order});
      }
      for (const ModelEvent::Assignment& a : e.sets) event.sets.push_back({a.coordinate, a.order});
      out_.problem.events.push_back(std::move(event));
    }
    out_.problem.first_set = wanted.observables.size();
    for (const ModelEvent& e : model_.experiment.events)
      for (const ModelEvent::Assignment& a : e.sets) wanted.observables.push_back(a.value);
  }

  static ExtendedEvent::Action action_of(ModelEvent::Action action) {
    using Action = ExtendedEvent::Action;
    return action == ModelEvent::Action::Stop  ? Action::Stop
           : action == ModelEvent::Action::Set ? Action::Set
                                               : Action::Record;
  }

  /// A number for each: that of the first of its dimension.
  template <class Items>
  static std::vector<std::size_t> kinds_of(const Items& items) {
    std::vector<std::size_t> out;
    for (const auto& item : items) {
      std::size_t k = 0;
      while (!(items[k].dimension == item.dimension)) ++k;
      out.push_back(k);
    }
    return out;
  }

  /// What contacts and frictions are at a point, and where the programs of their modes come from.
  void add_contacts(WantedFunctions& wanted) {
    if (!library_) return;
    ExprVector q, v;
    for (const Coordinate& c : system_.coordinates) q.push_back(c.q), v.push_back(c.velocity);
    ExtendedContacts& out = out_.problem.contacts;
    out.count = system_.contacts.size();
    out.simultaneous = system_.impact_law == ImpactLaw::Simultaneous;
    out.kind = kinds_of(system_.coordinates);
    out.gap_kind = kinds_of(system_.contacts);
    out.first = wanted.observables.size();
    for (const Contact& c : system_.contacts) {
      wanted.events.push_back(c.gap);
      wanted.observables.push_back(differentiate(c.gap, context_.time()));
      wanted.observables.push_back(c.restitution);
      for (const Expr& slope : gradient(c.gap, q)) wanted.observables.push_back(slope);
    }
    out.first_slip = wanted.observables.size();
    ExprVector second_slips;
    for (std::size_t i = 0; i < out.count + system_.frictions.size(); ++i) {
      const Friction& f = friction_of(library_->system(), i);
      const bool rubs = f.present();
      out.frictions.push_back({rubs, f.sticking, i >= out.count && has_multipliers(f.normal), f.in_space()});
      const Expr slip = rubs ? expand_time_derivatives(f.slip[0]) : number(0);
      wanted.observables.push_back(slip);
      wanted.observables.push_back(rubs ? f.kinetic : number(0));
      wanted.observables.push_back(rubs ? f.static_ : number(0));
      for (const Expr& slope : gradient(slip, v)) wanted.observables.push_back(slope);
      if (f.in_space()) second_slips.push_back(expand_time_derivatives(f.slip[1]));
    }
    out.first_second_slip = wanted.observables.size();
    for (const Expr& slip : second_slips) {
      wanted.observables.push_back(slip);
      for (const Expr& slope : gradient(slip, v)) wanted.observables.push_back(slope);
    }
    out.direction_degree = options_.precision == Precision::Quad ? 32 : 48;
    out.program = [library = library_, degree = out.direction_degree](const ExtendedMode& mode) {
      return program_of(*library, mode, degree);
    };
  }

  static ExtendedProgram program_of(ModeLibrary& library, const ExtendedMode& mode, int direction_degree) {
    ContactMode same;
    same.closed = mode.closed;
    for (const ExtendedMode::Friction f : mode.friction) same.friction.push_back(state_of(f));
    same.normal_sign = mode.normal_sign;
    const std::shared_ptr<const ModeProgram> found =
        library.program(same, {mode.stops, false, mode.begins, direction_degree});
    ExtendedProgram out{found->kernel, {}, found->slips};
    for (const ModeWatch& w : found->watches) out.watches.push_back({what_of(w.what), w.index});
    return out;
  }

  static FrictionState state_of(ExtendedMode::Friction friction) {
    switch (friction) {
      case ExtendedMode::Friction::Stick:
        return FrictionState::Stick;
      case ExtendedMode::Friction::Forward:
        return FrictionState::Forward;
      case ExtendedMode::Friction::Backward:
        return FrictionState::Backward;
      case ExtendedMode::Friction::Slide:
        return FrictionState::Slide;
      case ExtendedMode::Friction::None:
        break;
    }
    return FrictionState::None;
  }

  static ExtendedWatch::What what_of(ModeWatch::What what) {
    switch (what) {
      case ModeWatch::What::Until:
        return ExtendedWatch::What::Until;
      case ModeWatch::What::Gap:
        return ExtendedWatch::What::Gap;
      case ModeWatch::What::Force:
        return ExtendedWatch::What::Force;
      case ModeWatch::What::Hold:
        return ExtendedWatch::What::Hold;
      case ModeWatch::What::Slip:
        return ExtendedWatch::What::Slip;
      case ModeWatch::What::Normal:
        return ExtendedWatch::What::Normal;
      case ModeWatch::What::Event:
        break;
    }
    return ExtendedWatch::What::Event;
  }

  /// Contacts are open between impacts.
  void without_forces(WantedFunctions& wanted) const {
    ExprMap open;
    for (std::size_t i = 0; i < system_.contacts.size() + system_.frictions.size(); ++i)
      for (const Expr& multiplier : friction_of(system_, i).multipliers) open[multiplier] = number(0);
    for (const Contact& c : system_.contacts) open[c.multiplier] = number(0);
    for (auto* list : {&wanted.observables, &wanted.events})
      if (!open.empty() && !list->empty()) *list = substitute(*list, open);
  }

  void add_times() {
    const Experiment& experiment = model_.experiment;
    const Expr begin = experiment.start_time ? value_of(experiment.start_time) : number(0);
    Expr length = number(0);
    if (options_.duration)
      length = number(*options_.duration);
    else if (experiment.until)
      length = experiment.within ? value_of(experiment.within) : number(0);
    else if (experiment.duration)
      length = value_of(experiment.duration);
    Expr end = begin + length;
    const bool backwards = plan_.end < plan_.begin;
    out_.order_of_times.resize(options_.at.size());
    std::iota(out_.order_of_times.begin(), out_.order_of_times.end(), std::size_t{0});
    std::stable_sort(out_.order_of_times.begin(), out_.order_of_times.end(), [&](std::size_t a, std::size_t b) {
      return backwards ? options_.at[b] < options_.at[a] : options_.at[a] < options_.at[b];
    });
    // A run goes on to the last time that is asked for.
    if (!options_.at.empty()) {
      const Rational& last = options_.at[out_.order_of_times.back()];
      const double there = evaluate(end, {}), wanted = last.to_double();
      if (backwards ? wanted < there : wanted > there) end = number(last);
    }
    Expr every = number(0);
    if (options_.output_every)
      every = number(*options_.output_every);
    else if (experiment.output_every)
      every = value_of(experiment.output_every);
    if (every.is_zero()) every = (plan_.end < plan_.begin ? begin - end : end - begin) / number(1000);
    if (options_.rows) {
      const double count = std::abs(plan_.end - plan_.begin) / evaluate(every, {});
      out_.problem.rows = 1 + (count > 0 ? static_cast<std::size_t>(std::ceil(count * (1 - 1e-12))) - 1 : 0);
    }
    out_.begin = plan_.begin;
    out_.numbers.push_back(begin);
    out_.end_index = out_.numbers.size();
    out_.numbers.push_back(end);
    out_.numbers.push_back(every);
  }

  void add_start() {
    const std::size_t n = system_.coordinates.size();
    std::vector<Expr> q, v;
    for (std::size_t i = 0; i < n; ++i) {
      q.push_back(number(Rational::from_double(plan_.q[i])));
      v.push_back(equations_.degenerate ? number(Rational::from_double(plan_.v[i])) : number(0));
    }
    std::vector<bool> fixed_q(n, false), fixed_v(n, false);
    const auto [contradicted_q, contradicted_v] = contradictions();
    const bool moved_together =
        equations_.degenerate && (contradicted_q || contradicted_v);  // q and q̇: those of the plan
    for (const StartValue& start : model_.experiment.start) {
      if (moved_together) break;
      if (start.span == system_.coordinates[start.coordinate].span && system_.constrained())
        continue;  // a guess for a quaternion
      if (start.order == 0 && contradicted_q) continue;
      (start.order == 0 ? q : v)[start.coordinate] = value_of(start.value);
      (start.order == 0 ? fixed_q : fixed_v)[start.coordinate] = start.order == 0 || !contradicted_v;
    }
    out_.numbers.insert(out_.numbers.end(), q.begin(), q.end());
    out_.numbers.insert(out_.numbers.end(), v.begin(), v.end());
    out_.problem.fixed_q = fixed_q;
    out_.problem.fixed_v = fixed_v;
  }

  /// Whether written positions, or written velocities, had to move.
  std::pair<bool, bool> contradictions() const {
    Diagnostics known;  // the plan has told them
    const auto start = consistent_start(model_, equations_, known);
    std::pair<bool, bool> out{false, false};
    for (const StartAdjustment& a : start->adjustments)
      if (a.written) (a.order == 0 ? out.first : out.second) = true;
    return out;
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  const ExtendedSimulationOptions& options_;
  const RunPlan& plan_;
  Context& context_;
  ExprMap values_;
  std::shared_ptr<ModeLibrary> library_;  // where the model has contacts or friction
  ExtendedPlan out_{{Kernel(nullptr), Kernel(nullptr), {}, {}, 0, {}, 0, 0, false}, {}, 0, {}, 0, 0};
};

}  // namespace

Kernel kernel_of_numbers(const std::vector<Expr>& numbers) {
  KernelSource source;
  source.observables = numbers;
  return build_kernel(source);
}

bool goes_in_many_digits(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  if (!goes_through_modes(model)) return true;
  return can_go_through_modes(equations, diagnostics);
}

ExtendedPlan plan_extended(const Model& model, const EquationsOfMotion& equations,
                           const ExtendedSimulationOptions& options, const RunPlan& plan,
                           const Observables& observables) {
  return ExactPlanner(model, equations, options, plan).find(observables);
}

}  // namespace maupertuis

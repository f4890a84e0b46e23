#include "simulation/extended_problem.hpp"

#include "simulation/ending.hpp"
#include "simulation/motion_kernel.hpp"

#include <maupertuis/constraint_manifold.hpp>
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

  /// Observables: the energy, the points, the reactions, the rates of the start with their derivatives.
  void choose_functions(const Observables& all) {
    WantedFunctions wanted;
    const auto energies = all.expressions.begin() + static_cast<std::ptrdiff_t>(all.energy_terms);
    wanted.observables.push_back(context_.sum(std::vector<Expr>(all.expressions.begin(), energies)));
    wanted.observables.insert(wanted.observables.end(), energies, all.expressions.end());
    out_.points = all.points;
    out_.reactions = all.reactions.size();
    out_.problem.first_rate = wanted.observables.size();
    ExprVector velocities;
    for (const Coordinate& c : system_.coordinates) velocities.push_back(c.velocity);
    for (const StartRate& r : model_.experiment.start_rates) {
      const Expr difference = r.rate - r.value;
      const Expr rate = expand_time_derivatives(in_terms_of_motion(system_, {&difference, 1}).front());
      wanted.observables.push_back(rate);
      for (const Expr& slope : gradient(rate, velocities)) wanted.observables.push_back(slope);
      ++out_.problem.rates;
    }
    if (plan_.until) wanted.events.push_back(plan_.condition);
    out_.problem.until = plan_.until;
    watch_events(wanted);
    watch_contacts(wanted);
    without_forces(wanted);
    out_.problem.kernel = motion_kernel(equations_, wanted);
  }

  void watch_events(WantedFunctions& wanted) {
    for (const ModelEvent& e : model_.experiment.events) {
      wanted.events.push_back(with_reactions(equations_, {&e.function, 1}).front());
      const bool stops = e.action == ModelEvent::Action::Stop;
      out_.problem.events.push_back({stops ? ExtendedEvent::Action::Stop : ExtendedEvent::Action::Record, e.direction});
      out_.watched.push_back({Happening::Kind::Event, e.name});
    }
  }

  void watch_contacts(WantedFunctions& wanted) {
    ExprVector q;
    for (const Coordinate& c : system_.coordinates) q.push_back(c.q);
    out_.problem.first_contact = wanted.observables.size();
    for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
      const Contact& c = system_.contacts[i];
      wanted.events.push_back(c.gap);
      out_.problem.events.push_back({ExtendedEvent::Action::Hit, -1});
      out_.watched.push_back({Happening::Kind::Impact, system_.contact_label(i)});
      wanted.observables.push_back(differentiate(c.gap, context_.time()));
      wanted.observables.push_back(c.restitution);
      for (const Expr& slope : gradient(c.gap, q)) wanted.observables.push_back(slope);
    }
  }

  /// Contacts are open between impacts.
  void without_forces(WantedFunctions& wanted) const {
    ExprMap open;
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
    out_.numbers.push_back(begin);
    out_.end_index = out_.numbers.size();
    out_.numbers.push_back(end);
    out_.numbers.push_back(every);
  }

  void add_start() {
    const std::size_t n = system_.coordinates.size();
    std::vector<Expr> q, v;
    for (std::size_t i = 0; i < n; ++i) q.push_back(number(Rational::from_double(plan_.q[i]))), v.push_back(number(0));
    std::vector<bool> fixed_q(n, false), fixed_v(n, false);
    const auto [contradicted_q, contradicted_v] = contradictions();
    for (const StartValue& start : model_.experiment.start) {
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
  ExtendedPlan out_{{Kernel(nullptr), Kernel(nullptr), {}, {}, 0, 0, 0, 0, false}, {}, 0, {}, 0, 0, {}};
};

}  // namespace

Kernel kernel_of_numbers(const std::vector<Expr>& numbers) {
  KernelSource source;
  source.observables = numbers;
  return build_kernel(source);
}

bool goes_in_many_digits(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics) {
  const MechanicalSystem& system = model.system;
  if (!goes_through_modes(model)) return true;
  const auto refuse = [&](Span span, const std::string& what) {
    diagnostics.error("E0725", span, what + " is not carried through in many digits",
                      "There the motion goes through flights, impacts without friction and events that record or stop; "
                      "contacts that stay closed, friction and states that are set have equations of their own.",
                      "Leave --precision out, or ask one mode: --mode \"…\".");
    return false;
  };
  for (const Contact& c : system.contacts)
    if (c.friction.present()) return refuse(c.span, "friction");
  if (!system.frictions.empty()) return refuse(system.frictions.front().span, "friction");
  if (system.contacts.size() > 1 && system.impact_law == ImpactLaw::Simultaneous)
    return refuse(system.contacts.front().span, "`impact simultaneous`");
  for (const ModelEvent& e : model.experiment.events)
    if (e.action == ModelEvent::Action::Set) return refuse(e.span, "an event that sets the state");
  return can_go_through_modes(equations, diagnostics);
}

ExtendedPlan plan_extended(const Model& model, const EquationsOfMotion& equations,
                           const ExtendedSimulationOptions& options, const RunPlan& plan,
                           const Observables& observables) {
  return ExactPlanner(model, equations, options, plan).find(observables);
}

}  // namespace maupertuis

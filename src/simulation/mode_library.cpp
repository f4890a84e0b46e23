#include "simulation/mode_library.hpp"

#include "simulation/given_forces.hpp"
#include "simulation/motion_kernel.hpp"

#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/slip_signs.hpp>
#include <maupertuis/system_expressions.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

/// From a mode to the program of its motion, with all that is watched there.
namespace maupertuis {
namespace {

constexpr std::size_t most_programs = 128;  // that are kept for the next run

/// Normal forces in multipliers alone.
MechanicalSystem with_plain_normals(const EquationsOfMotion& equations) {
  MechanicalSystem out = *equations.system;
  for (Friction& f : out.frictions)
    if (f.normal) f.normal = with_reactions(equations, {&f.normal, 1}).front();
  return out;
}

/// Gaps of open contacts; λ of closed ones.
void watch_contacts(const MechanicalSystem& system, const ContactMode& mode, std::vector<ModeWatch>& watches,
                    ExprVector& events) {
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const Contact& c = system.contacts[i];
    watches.push_back({mode.closed[i] ? ModeWatch::What::Force : ModeWatch::What::Gap, i});
    events.push_back(mode.closed[i] ? c.multiplier : c.gap);
  }
}

/// What holds while it sticks, |λ_t| ≤ μ_s N; the direction in which it slides; the sign of its normal force.
void watch_frictions(const MechanicalSystem& system, const ContactMode& mode, const std::vector<double>& stops,
                     std::vector<ModeWatch>& watches, ExprVector& events) {
  const std::size_t contacts = system.contacts.size();
  const auto watch = [&](ModeWatch::What what, std::size_t index, Expr event) {
    watches.push_back({what, index});
    events.push_back(event);
  };
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const FrictionState state = mode.friction[i];
    if (state == FrictionState::None) continue;
    const Friction& f = friction_of(system, i);
    const Expr normal = normal_force(system, mode, i);
    if (state == FrictionState::Stick) {
      if (f.sticking) continue;
      const auto most_of = [&](bool forwards) { return limit_of_friction(system, f, f.static_, normal, forwards); };
      if (f.in_space()) {
        const Expr most = most_of(true);
        watch(ModeWatch::What::Hold, i,
              most * most - f.multipliers[0] * f.multipliers[0] - f.multipliers[1] * f.multipliers[1]);
        continue;
      }
      watch(ModeWatch::What::Hold, i, most_of(false) - f.multipliers[0]);
      watch(ModeWatch::What::Hold, i, most_of(true) + f.multipliers[0]);
      watches.back().lower = true;
    } else if (f.in_space()) {
      const Expr stop = system.context->number(Rational::from_double(stops[i]));
      watch(ModeWatch::What::Slip, i, f.slip[0] * f.slip[0] + f.slip[1] * f.slip[1] - stop * stop);
    } else {
      watch(ModeWatch::What::Slip, i, state == FrictionState::Forward ? f.slip[0] : -f.slip[0]);
    }
    if (i >= contacts && has_multipliers(normal)) watch(ModeWatch::What::Normal, i - contacts, normal);
  }
}

/// What surfaces that move give per time: closed contacts −λ ∂g/∂t, friction −λ_t·w, where w is what the slip is
/// without velocities of the system.
Expr given_by_surfaces(const MechanicalSystem& system, const ContactMode& mode) {
  Context& context = *system.context;
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) at_rest[c.velocity] = context.number(0);
  ExprVector out{context.number(0)};
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const bool is_contact = i < mode.closed.size();
    if (is_contact && !mode.closed[i]) continue;
    if (is_contact)
      out.push_back(-(system.contacts[i].multiplier * differentiate(system.contacts[i].gap, context.time())));
    const Friction& f = friction_of(system, i);
    for (std::size_t k = 0; f.present() && k < f.slip.size(); ++k)
      out.push_back(-(f.multipliers[k] * substitute(expand_time_derivatives(f.slip[k]), at_rest)));
  }
  return context.sum(out);
}

/// Forces that do not act in a mode, and friction that slides; `rubbed`: what it takes.
ExprMap forces_in(const MechanicalSystem& system, const ContactMode& mode, ExprVector& rubbed) {
  Context& context = *system.context;
  ExprMap out;
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    const Friction& f = friction_of(system, i);
    const FrictionState state = mode.friction[i];
    if (state == FrictionState::Stick || !f.present()) continue;
    for (const Expr& multiplier : f.multipliers) out[multiplier] = context.number(0);
    if (state == FrictionState::None) continue;
    const Expr normal = normal_force(system, mode, i);
    const Expr force = limit_of_friction(system, f, f.kinetic, normal, state == FrictionState::Forward);
    if (state == FrictionState::Slide) {
      const Expr speed = slip_speed(f);
      rubbed.push_back(force * speed);
      for (std::size_t k = 0; k < f.slip.size(); ++k) out[f.multipliers[k]] = -(force * f.slip[k] / speed);
    } else {
      const bool forward = state == FrictionState::Forward;
      rubbed.push_back(forward ? force * f.slip[0] : -(force * f.slip[0]));
      out[f.multipliers[0]] = forward ? -force : force;
    }
  }
  for (std::size_t i = 0; i < mode.closed.size(); ++i)
    if (!mode.closed[i]) out[system.contacts[i].multiplier] = context.number(0);
  return out;
}

/// The mode without the friction of slips that begin.
ContactMode without_beginnings(ContactMode mode, const ModeDetails& details) {
  for (std::size_t i = 0; i < details.begins.size(); ++i)
    if (details.begins[i]) mode.friction[i] = FrictionState::None;
  return mode;
}

bool sets_states(const Model& model) {
  const auto& events = model.experiment.events;
  return std::any_of(events.begin(), events.end(), [](const ModelEvent& e) { return !e.sets.empty(); });
}

bool rubs_in_space(const MechanicalSystem& system) {
  return std::any_of(system.contacts.begin(), system.contacts.end(),
                     [](const Contact& c) { return c.friction.in_space(); });
}

ExprVector values_set(const Model& model) {
  ExprVector out;
  for (const ModelEvent& e : model.experiment.events)
    for (const ModelEvent::Assignment& a : e.sets) out.push_back(a.value);
  return out;
}

ExprVector constraints_of(const EquationsOfMotion& equations) {
  ExprVector out = constraint_matrix(equations).entries;
  for (const Constraint& c : equations.system->constraints) out.push_back(c.value);
  out.insert(out.end(), equations.constraint_rates.begin(), equations.constraint_rates.end());
  return out;
}

}  // namespace

std::string key_of(const ContactMode& mode, const ModeDetails& details) {
  std::string key;
  for (const bool closed : mode.closed) key += closed ? '1' : '0';
  for (const FrictionState state : mode.friction) key += static_cast<char>('a' + static_cast<int>(state));
  for (const std::int8_t sign : mode.normal_sign) key += sign < 0 ? '-' : '+';
  for (std::size_t i = 0; i < mode.closed.size(); ++i)  // the motion knows at which slip friction in space stops
    if (mode.friction[i] == FrictionState::Slide) key += fmt::format(" {}", details.stops[i]);
  if (details.preloaded) key += " preloaded";
  if (!details.begins.empty()) key += " begins ";
  for (const bool begins : details.begins) key += begins ? '1' : '0';
  if (!details.begins.empty()) key += fmt::format(" by {}", details.direction_degree);
  return key;
}

ModeLibrary::ModeLibrary(const Model& model, const EquationsOfMotion& equations, const WantedFunctions& wanted)
    : model_(model),
      equations_(equations),
      system_(with_plain_normals(equations)),
      wanted_(wanted),
      contacts_(std::make_shared<const ContactPrograms>(equations)) {
  ExprVector functions;
  for (const ModelEvent& e : model.experiment.events) functions.push_back(e.function);
  const std::vector<Expr> plain = with_reactions(equations, functions);
  wanted_.events.insert(wanted_.events.end(), plain.begin(), plain.end());
  wanted_.integrands.clear();
  const bool sets = sets_states(model);
  if (sets || rubs_in_space(system_)) {
    ExprVector outputs = values_set(model);
    outputs.insert(outputs.begin(), equations.energy_function);
    sets_ = build_function(function_of_motion(system_, outputs));
  }
  if (sets && system_.constrained())
    constraints_ = build_function(function_of_motion(system_, constraints_of(equations)));
}

std::shared_ptr<const ModeProgram> ModeLibrary::program(const ContactMode& mode, const ModeDetails& details) {
  const std::lock_guard lock(guard_);
  Kept& kept = kept_[key_of(mode, details)];
  kept.asked_for = ++asked_for_;
  if (!kept.program) kept.program = std::make_shared<const ModeProgram>(derived(mode, details));
  std::shared_ptr<const ModeProgram> out = kept.program;
  const auto older = [](const auto& a, const auto& b) { return a.second.asked_for < b.second.asked_for; };
  if (kept_.size() > most_programs) kept_.erase(std::min_element(kept_.begin(), kept_.end(), older));
  return out;
}

/// The system and what is wanted go to a context of their own, which is gone when the kernel is made.
ModeProgram ModeLibrary::derived(const ContactMode& mode, const ModeDetails& details) const {
  WantedFunctions wanted = wanted_;
  // With events alone the equations stay as they are, also those that were found for a degenerate Lagrangian.
  EquationsOfMotion equations = equations_;
  ExprVector power{equations.power};
  std::vector<std::vector<Expr>*> along{&wanted.observables, &wanted.events};
  if (!system_.has_modes())
    along.insert(along.end(), {&equations.residual, &equations.multipliers, &equations.constraint_forces,
                               &equations.dissipative_terms, &power});
  MechanicalSystem own = in_own_context(system_, along);
  const InterruptScope scope(*own.context, interrupt_of(*system_.context));
  const ContactMode plain = without_beginnings(mode, details);
  ExprVector rubbed{own.context->number(0)}, damped{own.context->number(0)}, slips;
  ExprMap forces = forces_in(own, plain, rubbed);
  if (system_.has_modes()) {
    GivenForces given(own, plain);
    if (details.preloaded) given.preload(mode);
    for (std::size_t i = 0; i < details.begins.size(); ++i) {
      if (!details.begins[i]) continue;
      given.direct(i, details.direction_degree, rubbed);
      slips.insert(slips.end(), own.contacts[i].friction.slip.begin(), own.contacts[i].friction.slip.end());
    }
    for (const auto& [multiplier, force] : given.all()) forces[multiplier] = force;
    Diagnostics unheard;  // the system passed its checks with its contacts
    equations = *euler_lagrange(std::make_shared<const MechanicalSystem>(given.system()), unheard);
  } else {
    equations.system = std::make_shared<const MechanicalSystem>(own);
    equations.power = power.front();
  }
  std::vector<ModeWatch> watches;
  const bool until = wanted.events.size() > model_.experiment.events.size();
  for (std::size_t i = 0; i < wanted.events.size(); ++i)
    watches.push_back(until && i == 0 ? ModeWatch{ModeWatch::What::Until, 0}
                                      : ModeWatch{ModeWatch::What::Event, i - until});
  watch_contacts(own, mode, watches, wanted.events);
  watch_frictions(own, plain, details.stops, watches, wanted.events);
  for (std::size_t i = 0; i < own.coordinates.size(); ++i)
    damped.push_back(equations.dissipative_terms[i] * own.coordinates[i].velocity);
  wanted.integrands = {own.context->sum(rubbed), own.context->sum(damped), given_by_surfaces(own, plain)};
  for (auto* list : {&wanted.observables, &wanted.events, &wanted.integrands})
    if (!forces.empty() && !list->empty()) *list = substitute(*list, forces);
  // The power is of the system that moves: given forces are in it already, beside the multipliers.
  wanted.integrands.insert(wanted.integrands.begin(), equations.power);
  ModeProgram out{std::move(watches), motion_kernel(equations, wanted), std::nullopt};
  if (!slips.empty()) {
    WantedFunctions alone;
    alone.events = std::move(slips);
    out.slips = motion_kernel(equations, alone);
  }
  return out;
}

}  // namespace maupertuis

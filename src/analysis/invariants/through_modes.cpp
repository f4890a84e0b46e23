#include "analysis/invariants/through_sets.hpp"

#include <maupertuis/along_motion.hpp>
#include <maupertuis/contact_mode.hpp>
#include <maupertuis/integrals_through_modes.hpp>
#include <maupertuis/motion_through_modes.hpp>
#include <maupertuis/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace maupertuis {
namespace {

constexpr std::size_t most_modes = 64;
constexpr double rounding = 1e-9;  // of the size of an integral at an impact

using Holds = IntegralThroughModes::Holds;

/// What each contact and each friction of a coordinate may do.
std::vector<ContactMode> modes_of(const MechanicalSystem& system, std::size_t& left_out) {
  std::vector<ContactMode> out{open_mode(system)};
  const std::size_t contacts = system.contacts.size();
  double all = 1;
  const auto multiply = [&](std::size_t i, bool closes, const Friction& f, bool alone) {
    std::vector<ContactMode> more;
    for (const ContactMode& mode : out) {
      if (closes && alone && std::count(mode.closed.begin(), mode.closed.end(), true) > 0) continue;
      ContactMode next = mode;
      if (closes) next.closed[i] = true;
      std::vector<FrictionState> states{FrictionState::None};
      if (f.present()) states = {FrictionState::Stick};
      if (f.present() && !f.sticking) states = {FrictionState::Stick, FrictionState::Forward, FrictionState::Backward};
      if (f.in_space() && !f.sticking) states = {FrictionState::Stick, FrictionState::Slide};
      for (const FrictionState s : states) {
        if (!closes && s == FrictionState::Stick) continue;  // that is there already
        next.friction[i] = s;
        more.push_back(next);
      }
    }
    out.insert(out.end(), more.begin(), more.end());
  };
  for (const Contact& c : system.contacts)
    all *= !c.friction.present() || c.friction.sticking ? 2 : c.friction.in_space() ? 3 : 4;
  for (const Friction& f : system.frictions) all *= f.present() ? 3 : 1;
  const bool alone = all > static_cast<double>(most_modes);
  for (std::size_t i = 0; i < contacts && out.size() <= most_modes; ++i)
    multiply(i, true, system.contacts[i].friction, alone);
  for (std::size_t i = 0; i < system.frictions.size() && out.size() <= most_modes; ++i)
    multiply(contacts + i, false, system.frictions[i], alone);
  if (out.size() > most_modes) out.resize(most_modes);
  left_out = static_cast<std::size_t>(std::max(0.0, std::min(all, 1e15) - static_cast<double>(out.size())));
  return out;
}

Holds holds_of(const ZeroTest& test) {
  return test.verdict == Verdict::Zero ? Holds::Yes : test.verdict == Verdict::Nonzero ? Holds::No : Holds::Undecided;
}

MotionState start_of(const Model& model, const EquationsOfMotion& equations) {
  Diagnostics unheard;
  const auto start = consistent_start(model, equations, unheard);
  const std::size_t n = model.system.coordinates.size();
  return start ? start->state : MotionState{0, std::vector<double>(n, 0.1), std::vector<double>(n, 0.1)};
}

/// Reactions in normal forces written out.
MechanicalSystem with_plain_normal_forces(const EquationsOfMotion& equations) {
  MechanicalSystem out = *equations.system;
  for (Friction& f : out.frictions)
    if (f.normal) f.normal = with_reactions(equations, {&f.normal, 1}).front();
  return out;
}

EquationsOfMotion equations_of_mode(const MechanicalSystem& system, const ContactMode& mode) {
  Diagnostics unheard;
  MechanicalSystem in_mode = system_in_mode(system, mode);
  in_mode.written = nullptr;
  return *euler_lagrange(std::make_shared<const MechanicalSystem>(std::move(in_mode)), unheard);
}

class AtContacts {
 public:
  AtContacts(const Model& model, const EquationsOfMotion& equations)
      : equations_(equations),
        system_(with_plain_normal_forces(equations)),
        start_(start_of(model, equations)),
        impact_(equations) {}

  /// Of each integral, the largest relative change at impacts on a contact; nothing where no state on it was found.
  std::optional<std::vector<double>> changes(std::size_t contact, const std::vector<Expr>& integrals) {
    ContactMode mode = open_mode(system_);
    for (FrictionState& f : mode.friction) f = FrictionState::None;
    mode.closed[contact] = true;
    const EquationsOfMotion on_contact = equations_of_mode(system_, mode);
    const ConstraintManifold surface(on_contact), constraints(equations_);
    const std::vector<Expr> plain = in_terms_of_motion(system_, integrals);
    std::vector<double> out(integrals.size(), 0.0);
    int seen = 0;
    for (int attempt = 0; attempt < 10 * impact_samples && seen < impact_samples; ++attempt) {
      const auto before = state_on(surface, constraints, contact);
      if (!before) continue;
      MotionState after = *before;
      after.v = impact_.after(contact, *before);
      ++seen;
      for (std::size_t k = 0; k < plain.size(); ++k)
        out[k] = std::max(out[k], invariants::relative_change(plain[k], bindings(*before), bindings(after)));
    }
    return seen > 0 ? std::optional(out) : std::nullopt;
  }

 private:
  double draw() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  std::optional<MotionState> state_on(const ConstraintManifold& surface, const ConstraintManifold& constraints,
                                      std::size_t contact) {
    MotionState s = start_;
    s.t += draw();
    for (double& q : s.q) q += 0.3 * (1 + std::abs(q)) * draw();
    for (double& v : s.v) v += (1 + std::abs(v)) * draw();
    const std::vector<bool> free(s.q.size(), false);
    if (!surface.move_positions(s, free)) return std::nullopt;
    if (system_.constrained() && !constraints.move_velocities(s, free)) return std::nullopt;
    if (impact_.rate(contact, s) > 0) {
      for (double& v : s.v) v = -v;
      if (system_.constrained() && !constraints.move_velocities(s, free)) return std::nullopt;
    }
    return impact_.rate(contact, s) < 0 ? std::optional(s) : std::nullopt;
  }

  Bindings bindings(const MotionState& s) const {
    Bindings out = parameter_bindings(system_);
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      out[system_.coordinates[i].q] = s.q[i];
      out[system_.coordinates[i].velocity] = s.v[i];
    }
    out[system_.context->time()] = s.t;
    return out;
  }

  const EquationsOfMotion& equations_;
  MechanicalSystem system_;
  MotionState start_;
  SingleImpact impact_;
  std::mt19937_64 random_{0x696d70};
};

}  // namespace

bool is_in_parts(const Model& model) {
  const auto& events = model.experiment.events;
  return model.system.has_modes() ||
         std::any_of(events.begin(), events.end(), [](const ModelEvent& e) { return !e.sets.empty(); });
}

namespace {

void look_at_events(const Model& model, const EquationsOfMotion& equations, const MotionState& start,
                    const std::vector<Expr>& integrals, std::vector<IntegralThroughModes>& out) {
  invariants::AtSets at(model, equations, start);
  for (const ModelEvent& e : model.experiment.events)
    for (std::size_t k = 0; !e.sets.empty() && k < integrals.size(); ++k)
      out[k].events.push_back(at.at(e, integrals[k]));
}

}  // namespace

bool IntegralThroughModes::everywhere() const {
  return left_out == 0 &&
         std::all_of(modes.begin(), modes.end(), [](const InMode& m) { return m.holds == Holds::Yes; }) &&
         std::all_of(impacts.begin(), impacts.end(), [](const AtImpact& i) { return i.kept == Holds::Yes; }) &&
         std::all_of(events.begin(), events.end(), [](const AtEvent& e) { return e.kept == Holds::Yes; });
}

std::vector<IntegralThroughModes> integrals_through_modes(const Model& model, const EquationsOfMotion& equations,
                                                          const std::vector<Expr>& integrals) {
  std::vector<IntegralThroughModes> out(integrals.size());
  const MechanicalSystem system = with_plain_normal_forces(equations);
  std::size_t left_out = 0;
  const MotionState start = start_of(model, equations);
  for (const ContactMode& mode : modes_of(system, left_out)) {
    const EquationsOfMotion in_mode = equations_of_mode(system, mode);
    AlongMotion along(in_mode);
    along.set_start(start);
    const std::string text = mode_text(system, mode);
    for (std::size_t k = 0; k < integrals.size(); ++k) {
      const Holds holds = along.solvable() ? holds_of(along.vanishes(along.rate(integrals[k]))) : Holds::Undecided;
      out[k].modes.push_back({text.empty() ? "free" : text, holds});
      out[k].left_out = left_out;
    }
  }
  look_at_events(model, equations, start, integrals, out);
  if (system.contacts.empty() || integrals.empty()) return out;
  AtContacts at(model, equations);
  for (std::size_t c = 0; c < std::min(system.contacts.size(), most_modes); ++c) {
    const auto changes = at.changes(c, integrals);
    for (std::size_t k = 0; k < integrals.size(); ++k)
      out[k].impacts.push_back({system.contact_label(c),
                                !changes                    ? Holds::Undecided
                                : (*changes)[k] <= rounding ? Holds::Yes
                                                            : Holds::No,
                                changes ? (*changes)[k] : 0});
  }
  return out;
}

}  // namespace maupertuis

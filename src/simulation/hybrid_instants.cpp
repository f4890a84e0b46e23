#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <maupertuis/evaluate.hpp>
#include <maupertuis/slip_signs.hpp>
#include <maupertuis/transform.hpp>
#include <set>
#include <stdexcept>
#include "simulation/contact/impact_derivative.hpp"
#include "simulation/hybrid_parts.hpp"
/// What neighbours and companions of a motion need of its instants: the functions whose roots they are, the derivatives
/// of what happens there, and how far rounding hides them.

namespace maupertuis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the largest speed of a contact: one that closes more slowly only touches.
constexpr double slow = 1e-9;
constexpr double same = 1e-9;

std::vector<double> rows_of(const MatrixXd& m) {
  std::vector<double> out;
  for (Index i = 0; i < m.rows(); ++i)
    for (Index j = 0; j < m.cols(); ++j) out.push_back(m(i, j));
  return out;
}

/// ∂(q⁺, q̇⁺)/∂(q, q̇, t) of a change of velocities.
std::vector<double> slopes_of_velocities(const MatrixXd& velocities) {
  const Index n = velocities.rows();
  MatrixXd out = MatrixXd::Zero(2 * n, 2 * n + 1);
  out.topLeftCorner(n, n) = MatrixXd::Identity(n, n);
  out.bottomRows(n) = velocities;
  return rows_of(out);
}

bool equal(const VectorXd& a, const VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() <= same * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
}

}  // namespace

/// What is kept while an instant is settled.
struct HybridMotion::Settled {
  ModeInstant instant;
  std::vector<std::size_t> hit;
  struct Ended {
    Expr function;  // of the mode before
    double rate = 0;
  };
  std::vector<Ended> left, sets;  // as in Pending
  std::vector<const ModelEvent*> events;
  std::optional<ImpactProblem> problem;
  ImpactResult impact;
  VectorXd v_before_impact;
  bool ends_bounces = false, was_preload = false;
};

void HybridMotion::keep_instants() {
  derivative_ = std::make_shared<ImpactDerivative>(problem_.equations, problem_.parameters);
  motions_.tell_touches();
}

std::string HybridMotion::touch_sentence(std::size_t contact, double t) const {
  return fmt::format("The contact {} is only touched at t = {:.9g}: some neighbours hit it and others do not.",
                     problem_.system.contact_label(contact), t);
}

/// Before anything is settled. The mode before is asked once more, for the rates of what ends it.
void HybridMotion::note_before(double bound) {
  settled_ = std::make_shared<Settled>();
  Settled& s = *settled_;
  s.instant.mode_before = motions_.now().mode;
  s.instant.before = {here_.t, here_.q, here_.v};
  TaylorStepper& stepper = motions_.stepper();
  s.instant.a_before = stepper.sample(stepper.time()).a;
  s.hit = pending_->hit;
  s.was_preload = motions_.now().given.is_preload;
  s.events = pending_->sets;
  if (pending_->left.empty() && pending_->sets.empty()) return;
  stepper.start(here_.t, here_.q, here_.v, here_.t_rest);
  const Outlook outlook = stepper.outlook(bound);
  // Of the two sides of what holds, the one that is met.
  const auto find = [&](Watch::What what, std::size_t index) {
    HybridMotion::Settled::Ended found{{}, std::numeric_limits<double>::quiet_NaN()};
    double least = HUGE_VAL;
    for (std::size_t k = 0, sides = 0; k < motions_.now().watches().size() && k < outlook.slopes.size(); ++k) {
      if (motions_.now().watches()[k].what != what || motions_.now().watches()[k].index != index) continue;
      const bool second = sides++ > 0;
      if (!(std::abs(outlook.values[k]) < least)) continue;
      least = std::abs(outlook.values[k]);
      found = {function_of(motions_.now().watches()[k], second), outlook.slopes[k]};
    }
    return found;
  };
  for (const Watch& w : pending_->left) s.left.push_back(find(w.what, w.index));
  for (const ModelEvent* e : s.events)
    s.sets.push_back(find(Watch::What::Event, static_cast<std::size_t>(e - problem_.model.experiment.events.data())));
}

void HybridMotion::note_impact(const ImpactProblem& problem, const ImpactResult& result, const VectorXd& v,
                               bool ends_bounces) {
  if (!settled_) return;
  settled_->problem = problem;
  settled_->impact = result;
  settled_->v_before_impact = v;
  settled_->ends_bounces = ends_bounces;
}

/// Once the mode after it is known.
void HybridMotion::note_after(double bound) {
  Settled& s = *settled_;
  ModeInstant& out = s.instant;
  out.mode_after = motions_.now().mode;
  out.after = {here_.t, here_.q, here_.v};
  out.a_after = motions_.stepper().outlook(bound).accelerations;
  if (changes_in_space())
    out.obstacle = fmt::format(
        "Friction in space is hit, begins or stops to slide at t = {:.9g}: neighbours are not carried through that "
        "yet.",
        here_.t);
  else if (motions_.now().given.is_preload || s.was_preload)
    out.obstacle = fmt::format(
        "Contacts hold each other with forces that the motion does not determine at t = {:.9g}: when friction gives "
        "way "
        "to a neighbour is not determined either.",
        here_.t);
  else if (!s.events.empty())
    add_set_jump();
  else if (!s.impact.impulses.empty())
    add_impact_jumps();
  else
    add_change_of_forces();
  instant_ = std::move(out);
  settled_.reset();
}

std::string HybridMotion::at_once_sentence() const {
  return fmt::format("Several things happen at t = {:.9g}, and neighbours meet them one after the other.", here_.t);
}

/// Friction with two components of slip that is met by an impact, or does something else from here on.
bool HybridMotion::changes_in_space() const {
  const Settled& s = *settled_;
  for (const Impulse& i : s.impact.impulses)
    if (problem_.system.contacts[i.contact].friction.in_space()) return true;
  for (std::size_t i = 0; i < s.instant.mode_before.friction.size(); ++i) {
    const bool opens = i < problem_.system.contacts.size() && !s.instant.mode_after.closed[i];
    if (friction_of(problem_.system, i).in_space() && !opens &&
        s.instant.mode_before.friction[i] != s.instant.mode_after.friction[i])
      return true;
  }
  return false;
}

/// An event that sets the state.
void HybridMotion::add_set_jump() {
  Settled& s = *settled_;
  if (s.events.size() > 1 || !s.hit.empty() || !s.left.empty() || !s.impact.impulses.empty()) {
    s.instant.obstacle = at_once_sentence();
    return;
  }
  const ModelEvent& event = *s.events.front();
  const std::size_t n = here_.q.size();
  ExprVector inputs;
  for (const Coordinate& c : problem_.system.coordinates) inputs.push_back(c.q);
  for (const Coordinate& c : problem_.system.coordinates) inputs.push_back(c.velocity);
  inputs.push_back(problem_.system.context->time());
  Bindings values;
  for (std::size_t i = 0; i < n; ++i) {
    values[inputs[i]] = s.instant.before.q[i];
    values[inputs[n + i]] = s.instant.before.v[i];
  }
  values[inputs[2 * n]] = here_.t;
  for (std::size_t i = 0; i < problem_.parameters.size(); ++i)
    values[problem_.system.parameters[i].symbol] = problem_.parameters[i];
  MatrixXd slopes = MatrixXd::Zero(static_cast<Index>(2 * n), static_cast<Index>(2 * n + 1));
  slopes.leftCols(static_cast<Index>(2 * n)).setIdentity();
  for (const ModelEvent::Assignment& a : event.sets) {
    const Expr value = expand_time_derivatives(in_terms_of_motion(problem_.system, {&a.value, 1})).front();
    const std::vector<Expr> gradients = gradient(value, inputs);
    for (std::size_t j = 0; j < inputs.size(); ++j)
      slopes(static_cast<Index>(a.order == 0 ? a.coordinate : n + a.coordinate), static_cast<Index>(j)) =
          evaluate(gradients[j], values);
  }
  s.instant.jumps.push_back({s.sets.front().function, s.sets.front().rate, 0, s.instant.mode_after, s.instant.after,
                             rows_of(slopes), std::nullopt});
}

/// One impulse after the other, each with the gap of its contact; or all at once where they share the impact.
void HybridMotion::add_impact_jumps() {
  Settled& s = *settled_;
  const ImpactProblem& p = *s.problem;
  std::set<std::size_t> open_before;  // those that are hit, or would be hit in another order
  for (const Impulse& i : s.impact.impulses)
    if (!s.instant.mode_before.closed[i.contact]) open_before.insert(i.contact);
  for (std::size_t k = 0; k < p.contacts.size(); ++k)
    if (!s.instant.mode_before.closed[p.contacts[k]] && dot(p.normal[k], s.v_before_impact) + p.drive[k] < -p.rest[k])
      open_before.insert(p.contacts[k]);
  if (!s.left.empty()) {
    s.instant.obstacle = at_once_sentence();
    return;
  }
  const ImpactResult ordered = sequential_impact(p, s.v_before_impact, ImpactOrder::FastestFirst);
  if (open_before.size() > 1) {
    const ImpactResult other = sequential_impact(p, s.v_before_impact, ImpactOrder::FastestLast);
    if (s.ends_bounces || s.impact.bounded || !equal(ordered.v, other.v) || !equal(ordered.v, s.impact.v)) {
      s.instant.obstacle = fmt::format(
          "Several contacts are hit at t = {:.9g}: neighbours hit them one after the other, and what follows depends "
          "on "
          "the order.",
          here_.t);
      return;
    }
  }
  if (equal(ordered.v, s.impact.v))
    add_impulses_in_order(ordered);
  else
    add_impulses_at_once();
}

/// Where the impact that is looked at changes the contacts: those that were hit are open between impulses.
void HybridMotion::add_impulses_in_order(const ImpactResult& ordered) {
  Settled& s = *settled_;
  const ImpactProblem& p = *s.problem;
  MotionState at = s.instant.before;
  ContactMode mode = s.instant.mode_before;
  VectorXd v = s.v_before_impact;
  for (const Impulse& impulse : ordered.impulses) {
    const std::size_t c = impulse.contact;
    const auto k = static_cast<std::size_t>(std::find(p.contacts.begin(), p.contacts.end(), c) - p.contacts.begin());
    const double rate = dot(p.normal[k], v) + p.drive[k];
    // A contact that stays closed after its last impulse does not bounce: its flights would be lost in rounding.
    const bool stays = &impulse == &ordered.impulses.back() && s.instant.mode_after.closed[c];
    const bool plastic = stays || p.restitution[k] == 0;
    const auto slopes = derivative_->one_impulse(c, {here_.t, at.q, at.v, plastic});
    if (!slopes) {
      s.instant.obstacle = fmt::format(
          "The contact {} is hit at t = {:.9g} without slip: neighbours that slide this way and that come out of the "
          "impact in ways that are no linear function of the slip.",
          problem_.system.contact_label(c), here_.t);
      return;
    }
    v += impulse.normal * p.response.col(static_cast<Index>(k));
    if (impulse.tangential != 0) v += impulse.tangential * p.tangent_response.col(static_cast<Index>(k));
    at.v.assign(v.data(), v.data() + v.size());
    mode.closed[c] = false;
    mode.friction[c] = FrictionState::None;
    const bool rubs = problem_.system.contacts[c].friction.present();
    const auto volume = rubs || plastic ? std::nullopt : std::optional(2 * std::log(p.restitution[k]));
    s.instant.jumps.push_back({problem_.system.contacts[c].gap, rate, slow * sizes_.fastest(c), mode, at,
                               slopes_of_velocities(*slopes), volume});
  }
  s.instant.jumps.back().mode = s.instant.mode_after;
  s.instant.jumps.back().after = s.instant.after;
}

void HybridMotion::add_impulses_at_once() {
  Settled& s = *settled_;
  const ImpactProblem& p = *s.problem;
  std::vector<std::size_t> pressing;
  std::optional<std::size_t> met;  // the contact that was open before
  for (const Impulse& i : s.impact.impulses) {
    pressing.push_back(i.contact);
    if (!s.instant.mode_before.closed[i.contact]) met = i.contact;
  }
  if (s.ends_bounces || s.impact.bounded || !met) {
    s.instant.obstacle = fmt::format(
        "At t = {:.9g} infinitely many impacts of several contacts come to their end, and neighbours meet them in "
        "another order.",
        here_.t);
    return;
  }
  const auto k = static_cast<std::size_t>(std::find(p.contacts.begin(), p.contacts.end(), *met) - p.contacts.begin());
  const MatrixXd slopes =
      derivative_->at_once(pressing, {here_.t, s.instant.before.q, s.instant.before.v, p.restitution[k] == 0});
  s.instant.jumps.push_back({problem_.system.contacts[*met].gap, dot(p.normal[k], s.v_before_impact) + p.drive[k],
                             slow * sizes_.fastest(*met), s.instant.mode_after, s.instant.after,
                             slopes_of_velocities(slopes), std::nullopt});
}

/// The state stays. Where accelerations go on, so do those of neighbours, whenever they get there.
void HybridMotion::add_change_of_forces() {
  Settled& s = *settled_;
  const ModeInstant& i = s.instant;
  if (!s.hit.empty()) {
    s.instant.obstacle = touch_sentence(s.hit.front(), here_.t);
    return;
  }
  bool goes_on = true;
  for (std::size_t k = 0; k < here_.q.size(); ++k)
    goes_on = goes_on && std::abs(i.a_before[k] - i.a_after[k]) <= same * std::max(sizes_.acceleration(k), 1e-280);
  if (goes_on) return;
  if (s.left.size() != 1) {
    s.instant.obstacle = s.left.empty() ? fmt::format("An acceleration jumps at a switch at t = {:.9g} s.", here_.t)
                                        : at_once_sentence();
    return;
  }
  s.instant.jumps.push_back({s.left.front().function, s.left.front().rate, 0, i.mode_after, i.after, {}, std::nullopt});
}

/// The function of a condition of the mode that it is in; `second`: the other of two sides.
Expr HybridMotion::function_of(const Watch& watch, bool second) const {
  const std::size_t i = watch.index;
  const ContactMode& mode = motions_.now().mode;
  switch (watch.what) {
    case Watch::What::Gap:
      return problem_.system.contacts[i].gap;
    case Watch::What::Force:
      return problem_.system.contacts[i].multiplier;
    case Watch::What::Slip: {
      const Expr slip = friction_of(problem_.system, i).slip[0];
      return mode.friction[i] == FrictionState::Forward ? slip : -slip;
    }
    case Watch::What::Normal:
      return normal_force(problem_.system, mode, i + problem_.system.contacts.size());
    case Watch::What::Hold: {
      const Friction& f = friction_of(problem_.system, i);
      const Expr most =
          limit_of_friction(problem_.system, f, f.static_, normal_force(problem_.system, mode, i), second);
      return second ? most + f.multipliers[0] : most - f.multipliers[0];
    }
    case Watch::What::Until:
      return problem_.library->wanted().events[0];
    case Watch::What::Event:
      return problem_.library->wanted()
          .events[problem_.library->wanted().events.size() - problem_.model.experiment.events.size() + i];
  }
  throw std::logic_error("an unknown condition of a mode; please report");
}

/// How far rounding may hide the time at which a force comes to its limit: |f/ḟ| where f is as small as it is told from
/// 0, a third of the whole at a triple root, a fifth at one of five. 0 where the root is a simple one.
double HybridMotion::hidden_by_rounding(double bound) {
  constexpr double simple = 1e-8, most = 5;
  if (pending_->left.empty() || !pending_->hit.empty() || !pending_->sets.empty()) return 0;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return 0;
  double out = 0;
  for (std::size_t k = 0; k < motions_.now().watches().size(); ++k) {
    const Watch& w = motions_.now().watches()[k];
    if (w.what != Watch::What::Hold && w.what != Watch::What::Force) continue;
    const bool ends = std::any_of(pending_->left.begin(), pending_->left.end(), [&](const Watch& x) {
      return x.what == w.what && x.index == w.index && x.lower == w.lower;
    });
    const double hidden = std::abs(outlook.values[k] / outlook.slopes[k]);
    if (ends && hidden > simple * outlook.length && hidden < outlook.length) out = std::max(out, most * hidden);
  }
  return out;
}

/// For how long before its root a gap is not told from 0, where it closes ever more slowly: the third root of its
/// rounding at a root of third order. 0 at a simple one, which is known as time is. `length`: of the step.
double HybridMotion::hides_gap(std::size_t contact, double length) {
  constexpr double slow = 1e-4, slower = 2;
  const ContactValues& here = here_.values();
  const double speed = std::abs(here.rate[contact]);
  if (speed > slow * sizes_.fastest(contact)) return 0;
  const double rounding = 8 * rest_unit * sizes_.gap(contact, here);  // to which roots are searched
  std::vector<double> q = here_.q, v = here_.v;
  for (double hidden = rest_unit * std::max(std::abs(here_.t), length); hidden < length; hidden *= 2) {
    const double before = forwards_ ? here_.t - hidden : here_.t + hidden;
    motions_.stepper().state(before, q, v);
    const ContactValues& values = here_.values_at(before, q, v);
    if (std::abs(values.gap[contact]) > rounding) return std::abs(values.rate[contact]) > slower * speed ? hidden : 0;
  }
  return length;
}

/// On in the mode that ends here.
Step HybridMotion::wait(double bound) {
  const double until = time() + (forwards_ ? late_by_ : -late_by_);
  late_by_ = 0;
  Step out = motions_.stepper().step(forwards_ ? std::min(bound, until) : std::max(bound, until));
  out.events.clear();
  if (out.ending == StepEnding::None) note_step();
  return out;
}

}  // namespace maupertuis

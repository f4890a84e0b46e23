#include "simulation/hybrid_neighbours.hpp"

#include "simulation/contact/impact_derivative.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/slip_signs.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace maupertuis::hybrid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the largest speed of a contact: one that closes more slowly only touches.
constexpr double slowest_hit = 1e-9;
constexpr double same_to = 1e-9;

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
  return (a - b).cwiseAbs().maxCoeff() <= same_to * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
}

}  // namespace

struct Neighbours::Ended {
  Expr function;  // of the mode before
  double rate = 0;
};

/// What is kept while an instant is settled.
struct Neighbours::Settled {
  ModeInstant instant;
  std::vector<std::size_t> hit;
  std::vector<Ended> left, sets;  // as in Met
  std::vector<const ModelEvent*> events;
  Impact impact;  // without impulses where nothing is hit
  bool was_preload = false;
};

Neighbours::Neighbours(const Problem& problem, const State& here, const UsualSizes& sizes, const ModeMotions& motions)
    : problem_(problem), here_(here), sizes_(sizes), motions_(motions) {}

Neighbours::~Neighbours() = default;

void Neighbours::start() {
  settled_.reset();
  instant_.reset();
}

void Neighbours::keep() { derivative_ = std::make_unique<ImpactDerivative>(problem_.equations, problem_.parameters); }

void Neighbours::note_before(const Met& met, double bound) {
  settled_ = std::make_unique<Settled>();
  Settled& s = *settled_;
  TaylorStepper& stepper = motions_.stepper();
  s.instant.mode_before = motions_.now().mode;
  s.instant.before = {here_.t, here_.q, here_.v};
  s.instant.a_before = stepper.sample(stepper.time()).a;
  s.hit = met.hit;
  s.was_preload = motions_.now().given.is_preload;
  s.events = met.sets;
  if (met.left.empty() && met.sets.empty()) return;
  stepper.start(here_.t, here_.q, here_.v, here_.t_rest);
  const Outlook outlook = stepper.outlook(bound);
  for (const Watch& w : met.left) s.left.push_back(ended_by(w.what, w.index, outlook));
  for (const ModelEvent* e : s.events)
    s.sets.push_back(
        ended_by(Watch::What::Event, static_cast<std::size_t>(e - problem_.model.experiment.events.data()), outlook));
}

/// Of the two sides of what holds, the one that is met.
Neighbours::Ended Neighbours::ended_by(Watch::What what, std::size_t index, const Outlook& outlook) const {
  Ended out{{}, std::numeric_limits<double>::quiet_NaN()};
  const std::vector<Watch>& watches = motions_.now().watches();
  double least = HUGE_VAL;
  for (std::size_t k = 0, sides = 0; k < watches.size() && k < outlook.slopes.size(); ++k) {
    if (watches[k].what != what || watches[k].index != index) continue;
    const bool second = sides++ > 0;
    if (!(std::abs(outlook.values[k]) < least)) continue;
    least = std::abs(outlook.values[k]);
    out = {function_of(watches[k], second), outlook.slopes[k]};
  }
  return out;
}

void Neighbours::note_impact(Impact impact) {
  if (settled_) settled_->impact = std::move(impact);
}

void Neighbours::note_after(double bound) {
  if (!settled_) return;
  ModeInstant& out = settled_->instant;
  out.mode_after = motions_.now().mode;
  out.after = {here_.t, here_.q, here_.v};
  out.a_after = motions_.stepper().outlook(bound).accelerations;
  add_jumps();
  instant_ = std::move(out);
  settled_.reset();
}

void Neighbours::add_jumps() {
  Settled& s = *settled_;
  if (changes_in_space())
    s.instant.obstacle = fmt::format(
        "Friction in space is hit, begins or stops to slide at t = {:.9g}: neighbours are not carried through that "
        "yet.",
        here_.t);
  else if (motions_.now().given.is_preload || s.was_preload)
    s.instant.obstacle = fmt::format(
        "Contacts hold each other with forces that the motion does not determine at t = {:.9g}: when friction gives "
        "way "
        "to a neighbour is not determined either.",
        here_.t);
  else if (!s.events.empty())
    add_set_jump();
  else if (!s.impact.result.impulses.empty())
    add_impact_jumps();
  else
    add_change_of_forces();
}

/// Friction with two components of slip that is met by an impact, or does something else from here on.
bool Neighbours::changes_in_space() const {
  const Settled& s = *settled_;
  for (const Impulse& i : s.impact.result.impulses)
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
void Neighbours::add_set_jump() {
  Settled& s = *settled_;
  if (s.events.size() > 1 || !s.hit.empty() || !s.left.empty() || !s.impact.result.impulses.empty()) {
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
void Neighbours::add_impact_jumps() {
  Settled& s = *settled_;
  const ImpactProblem& p = s.impact.problem;
  std::set<std::size_t> open_before;  // those that are hit, or would be hit in another order
  for (const Impulse& i : s.impact.result.impulses)
    if (!s.instant.mode_before.closed[i.contact]) open_before.insert(i.contact);
  for (std::size_t k = 0; k < p.contacts.size(); ++k)
    if (!s.instant.mode_before.closed[p.contacts[k]] && dot(p.normal[k], s.impact.v_before) + p.drive[k] < -p.rest[k])
      open_before.insert(p.contacts[k]);
  if (!s.left.empty()) {
    s.instant.obstacle = at_once_sentence();
    return;
  }
  const ImpactResult ordered = sequential_impact(p, s.impact.v_before, ImpactOrder::FastestFirst);
  if (open_before.size() > 1) {
    const ImpactResult other = sequential_impact(p, s.impact.v_before, ImpactOrder::FastestLast);
    if (s.impact.ends_bounces || s.impact.result.bounded || !equal(ordered.v, other.v) ||
        !equal(ordered.v, s.impact.result.v)) {
      s.instant.obstacle = fmt::format(
          "Several contacts are hit at t = {:.9g}: neighbours hit them one after the other, and what follows depends "
          "on "
          "the order.",
          here_.t);
      return;
    }
  }
  if (equal(ordered.v, s.impact.result.v))
    add_impulses_in_order(ordered);
  else
    add_impulses_at_once();
}

/// Where the impact that is looked at changes the contacts: those that were hit are open between impulses.
void Neighbours::add_impulses_in_order(const ImpactResult& ordered) {
  Settled& s = *settled_;
  const ImpactProblem& p = s.impact.problem;
  MotionState at = s.instant.before;
  ContactMode mode = s.instant.mode_before;
  VectorXd v = s.impact.v_before;
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
    s.instant.jumps.push_back({problem_.system.contacts[c].gap, rate, slowest_hit * sizes_.fastest(c), mode, at,
                               slopes_of_velocities(*slopes), volume});
  }
  s.instant.jumps.back().mode = s.instant.mode_after;
  s.instant.jumps.back().after = s.instant.after;
}

void Neighbours::add_impulses_at_once() {
  Settled& s = *settled_;
  const ImpactProblem& p = s.impact.problem;
  std::vector<std::size_t> pressing;
  std::optional<std::size_t> met;  // the contact that was open before
  for (const Impulse& i : s.impact.result.impulses) {
    pressing.push_back(i.contact);
    if (!s.instant.mode_before.closed[i.contact]) met = i.contact;
  }
  if (s.impact.ends_bounces || s.impact.result.bounded || !met) {
    s.instant.obstacle = fmt::format(
        "At t = {:.9g} infinitely many impacts of several contacts come to their end, and neighbours meet them in "
        "another order.",
        here_.t);
    return;
  }
  const auto k = static_cast<std::size_t>(std::find(p.contacts.begin(), p.contacts.end(), *met) - p.contacts.begin());
  const MatrixXd slopes =
      derivative_->at_once(pressing, {here_.t, s.instant.before.q, s.instant.before.v, p.restitution[k] == 0});
  s.instant.jumps.push_back({problem_.system.contacts[*met].gap, dot(p.normal[k], s.impact.v_before) + p.drive[k],
                             slowest_hit * sizes_.fastest(*met), s.instant.mode_after, s.instant.after,
                             slopes_of_velocities(slopes), std::nullopt});
}

/// The state stays. Where accelerations go on, so do those of neighbours, whenever they get there.
void Neighbours::add_change_of_forces() {
  Settled& s = *settled_;
  const ModeInstant& i = s.instant;
  if (!s.hit.empty()) {
    s.instant.obstacle = touch_sentence(s.hit.front());
    return;
  }
  bool goes_on = true;
  for (std::size_t k = 0; k < here_.q.size(); ++k)
    goes_on = goes_on && std::abs(i.a_before[k] - i.a_after[k]) <= same_to * std::max(sizes_.acceleration(k), 1e-280);
  if (goes_on) return;
  if (s.left.size() != 1) {
    s.instant.obstacle = s.left.empty() ? fmt::format("An acceleration jumps at a switch at t = {:.9g} s.", here_.t)
                                        : at_once_sentence();
    return;
  }
  s.instant.jumps.push_back({s.left.front().function, s.left.front().rate, 0, i.mode_after, i.after, {}, std::nullopt});
}

/// The function of a condition of the mode that it is in; `second`: the other of two sides.
Expr Neighbours::function_of(const Watch& watch, bool second) const {
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

std::string Neighbours::at_once_sentence() const {
  return fmt::format("Several things happen at t = {:.9g}, and neighbours meet them one after the other.", here_.t);
}

std::string Neighbours::touch_sentence(std::size_t contact) const {
  return fmt::format("The contact {} is only touched at t = {:.9g}: some neighbours hit it and others do not.",
                     problem_.system.contact_label(contact), here_.t);
}

}  // namespace maupertuis::hybrid

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include "simulation/hybrid_parts.hpp"
/// Steps of a motion through modes: what a step meets waits for the next one, which settles it first.

namespace maupertuis {

namespace {

constexpr std::size_t most_at_once = 1000;  // changes at the same time
constexpr const char* met_backwards =
    "Backwards in time the motion meets a change of contact here: what was before an impact or a stop does not follow "
    "from what is after it.";
constexpr const char* set_backwards =
    "Backwards in time the motion meets an event that sets the state here: what was before it does not follow from "
    "what "
    "is after it.";
constexpr const char* no_cones =
    "The forces of contacts with friction in space were not found: their cones have no solution here, or the "
    "iteration does not converge to it.";

}  // namespace

HybridMotion::HybridMotion(std::shared_ptr<ModeLibrary> library, std::vector<double> parameters,
                           const TaylorOptions& options)
    : problem_(std::move(library), std::move(parameters), options),
      here_(problem_.library->contacts(), problem_.parameters),
      sizes_(problem_.system),
      journal_(problem_, here_, sizes_),
      functions_(problem_),
      slips_(problem_, here_, sizes_),
      motions_(problem_, here_, slips_),
      choices_(problem_, sizes_, slips_),
      cones_(problem_, here_, sizes_, slips_, choices_),
      space_(problem_, here_, sizes_, slips_, motions_, choices_, cones_, functions_, carried_),
      events_(problem_, motions_),
      undetermined_(problem_, here_, sizes_, motions_, cones_, choices_),
      forces_(problem_, here_, motions_, choices_),
      trials_(problem_, here_, sizes_, slips_, motions_, undetermined_, events_),
      choice_(problem_, here_, sizes_, slips_, motions_, choices_, forces_, undetermined_, trials_, journal_) {}

HybridMotion::~HybridMotion() = default;

bool HybridMotion::will_jump() const { return pending_ && (!pending_->hit.empty() || !pending_->sets.empty()); }

void HybridMotion::leave_mode() {
  if (motions_.has_begun()) carried_.take(motions_.stepper());
}

int HybridMotion::order() const { return motions_.stepper().order(); }

void HybridMotion::start(double t, std::span<const double> q, std::span<const double> v) {
  here_.t = t;
  here_.t_rest = 0;
  here_.q.assign(q.begin(), q.end());
  here_.v.assign(v.begin(), v.end());
  carried_ = {};
  same_time_ = 0;
  sizes_.start();
  journal_.start();
  slips_.start();
  space_.start();
  bounces_.assign(problem_.system.contacts.size(), {});
  events_.start();
  trials_.start();
  choice_.start();
  settled_.reset();
  instant_.reset();
  started_ = false;
  late_by_ = longest_step_ = 0;
  step_start_.reset();
  motions_.go_on_in(open_mode(problem_.system));
  motions_.stepper().start(here_.t, here_.q, here_.v, here_.t_rest);
  pending_ = std::make_unique<Met>();
  pending_->begins = true;
  forwards_ = true;
  failed_ = settle(t + 1);
  carried_.forget_work();  // work before the first sample
}

double HybridMotion::time() const { return motions_.stepper().time(); }

bool HybridMotion::covers(double t) const { return motions_.stepper().covers(covered(t)); }

double HybridMotion::covered(double t) const { return space_.moment().covered(t, motions_.stepper().step_start().t); }

std::size_t HybridMotion::steps() const { return carried_.steps + motions_.stepper().steps(); }

std::size_t HybridMotion::rejected() const { return carried_.rejected + motions_.stepper().rejected(); }

std::size_t HybridMotion::switches() const { return carried_.switches + motions_.stepper().switches(); }

double HybridMotion::constraint_residual() const {
  return std::max(carried_.residual, motions_.stepper().constraint_residual());
}

BackendUse HybridMotion::backend() const { return motions_.stepper().backend(); }

void HybridMotion::state(double t, std::span<double> q, std::span<double> v) const {
  motions_.stepper().state(covered(t), q, v);
  space_.moment().move_back(t, motions_.stepper().step_start().t, q, v);
}

/// Of the multipliers those of the system's own constraints, with what is given of them.
Sample HybridMotion::adjusted(Sample sample) const {
  const std::size_t own = problem_.equations.system->constraints.size();
  if (motions_.now().given.is_preload && sample.multipliers.size() >= own)
    for (std::size_t k = 0, made = sample.multipliers.size() - own; k < own; ++k)
      sample.multipliers[k] += motions_.now().given.preload(made + k, sample.t);
  sample.multipliers.resize(own);
  for (std::size_t k = 0; k < sample.integrals.size(); ++k) sample.integrals[k] += carried_.integrals[k];
  return sample;
}

Sample HybridMotion::sample(double t) const {
  Sample out = adjusted(motions_.stepper().sample(covered(t)));
  space_.moment().move_back(t, motions_.stepper().step_start().t, out.q, out.v);
  out.t = t;
  return out;
}

const Sample& HybridMotion::step_start() const {
  if (!step_start_) step_start_ = adjusted(motions_.stepper().step_start());
  return *step_start_;
}

Step HybridMotion::ended(StepEnding ending, std::string reason) const {
  Step out;
  out.begin = out.end = time();
  out.ending = ending;
  out.reason = std::move(reason);
  return out;
}

/// An event that stops the run at the instant that was settled.
Step HybridMotion::stopped_here() const {
  Step out = ended(StepEnding::None, {});
  out.event = 0;
  return out;
}

Step HybridMotion::step(double bound) {
  if (failed_) return *failed_;
  step_start_.reset();
  instant_.reset();
  forwards_ = bound >= time();
  if (!forwards_ && steps() == 0 && hits_at_start())
    return ended(StepEnding::Paradox,
                 "Backwards in time there is no motion from a start at which a contact is hit: what was before the "
                 "impact does not follow from what is after it.");
  // Its mode was chosen for what follows: a contact that opens at the start was hit there.
  if (!forwards_ && steps() == 0 && !goes_on(bound)) return ended(StepEnding::Paradox, met_backwards);
  if (pending_ && late_by_ > 0) return wait(bound);
  while (pending_) {
    if (auto failed = settle(bound)) return std::move(*failed);
    if (journal_.record().stopped_by) return stopped_here();
  }
  if (events_.end_of_sets() && time() == events_.end_of_sets()->t)
    return ended(StepEnding::Unending, events_.sets_without_end());
  const double end = motions_.now().given.end;
  const double until = events_.end_of_sets() ? events_.end_of_sets()->t : bound;
  Step out = motions_.stepper().step(forwards_ ? std::min({until, end, slips_.latest_end(motions_.now())}) : until);
  if (out.end != out.begin) same_time_ = 0;
  longest_step_ = std::max(longest_step_, std::abs(out.end - out.begin));
  space_.moment().end_step();
  if (out.ending != StepEnding::None) return out;
  note_step();
  if (const auto contact =
          violated(std::abs(out.end - out.begin) + std::numeric_limits<double>::epsilon() * std::abs(out.end))) {
    const std::string label = problem_.system.contact_label(*contact);
    if (!std::isfinite(here_.values().gap[*contact]))
      return ended(StepEnding::Overflow, fmt::format("The gap of the contact {} has no value here.", label));
    return ended(
        StepEnding::Paradox,
        fmt::format("The motion went through the contact {} without a sign of it{}.", label,
                    bounces_[*contact].last.empty() ? "" : ": bounces have become too small to be told apart"));
  }
  if (!out.events.empty()) classify(out);
  if (auto why = journal_.too_many(time(), bound)) return ended(StepEnding::Unending, std::move(*why));
  if (events_.end_of_sets() && out.end == events_.end_of_sets()->t && !pending_ && !out.event)
    return ended(StepEnding::Unending, events_.sets_without_end());
  if (pending_) meet_together(bound);
  if (problem_.meets_late && pending_) late_by_ = std::max(hidden_by_rounding(bound), pending_->hidden_sets);
  if (!pending_ && (out.end >= end || slips_.outgrow_stops(motions_.now()))) pending_ = std::make_unique<Met>();
  // A force that jumps may let a contact or a friction go, though none of their conditions has a root.
  if (!pending_ && ((!out.switches.empty() && !goes_on(bound)) || pulls())) {
    take_state();
    pending_ = std::make_unique<Met>();
  }
  return out;
}

/// Whether the motion begins with an impact.
bool HybridMotion::hits_at_start() const {
  return !journal_.record().happenings.empty() &&
         journal_.record().happenings.front().kind == Happening::Kind::Impact &&
         journal_.record().happenings.front().t == time();
}

void HybridMotion::finish() {
  if (motions_.has_begun()) journal_.end_at(time(), forwards_);
  if (journal_.record().stopped_by && pending_)
    for (const ModelEvent* event : pending_->sets)
      journal_.remark(
          fmt::format("The event {} sets the state as the run ends: the last state is the one before.", event->name));
  if (problem_.system.contacts.empty() || !started_) return;
  take_state();
  const ContactValues& values = here_.values();
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    const bool touches = std::abs(values.gap[i]) <= rest_unit * sizes_.widest(i);
    if (motions_.now().mode.closed[i] || !touches || !(values.rate[i] < -sizes_.rest_speed(i, values))) continue;
    journal_.remark(fmt::format("The contact {} is hit as the run ends: the last state is the one before the impact.",
                                problem_.system.contact_label(i)));
  }
  if (space_.cone_residual() >= 0)
    journal_.remark(
        fmt::format("Forces of friction in space: in their cones to {:.1e} of the largest.", space_.cone_residual()));
}

/// Events that hold as the motion begins are told, but do not act: it leaves them.
void HybridMotion::tell_events_at_start(double bound) {
  for (const ModelEvent* const event : events_.at_start(bound, forwards_)) {
    journal_.add(Happening::Kind::Event, event->name).mode = journal_.record().first_mode;
    if (event->action != ModelEvent::Action::Record)
      journal_.remark(
          fmt::format("The motion begins at the event `{}`, which acts when it is met again.", event->name));
  }
}

void HybridMotion::take_state() {
  const TaylorStepper& s = motions_.stepper();
  here_.t = s.time();
  here_.t_rest = s.time_rest();
  here_.q.assign(s.q().begin(), s.q().end());
  here_.v.assign(s.v().begin(), s.v().end());
  if (problem_.options.moved_instants == 0) return;
  // The next mode begins with the state to its last digit: a companion has another one.
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  for (std::vector<double>* const part : {&here_.q, &here_.v})
    for (double& x : *part) x *= 1 + rounding * share_of_rounding(problem_.options.moved_instants, x);
}

/// Whether the conditions of the mode hold as the next step begins.
bool HybridMotion::goes_on(double bound) {
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return true;  // the next step says why it cannot be made
  for (std::size_t k = 0; k < motions_.now().watches().size(); ++k)
    if (motions_.now().watches()[k].keeps_sign() && outlook.sides[k] < 0) return false;
  return true;
}

/// Whether a closed contact pulled as the last step began.
bool HybridMotion::pulls() const {
  constexpr double digits = 1e-9;
  const std::vector<double>& multipliers = motions_.stepper().step_start().multipliers;
  const std::size_t first = problem_.equations.system->constraints.size();
  for (std::size_t i = 0, k = 0; i < motions_.now().mode.closed.size(); ++i) {
    if (!motions_.now().mode.closed[i]) continue;
    const double force = multipliers[first + k] + motions_.now().given.preload(k, motions_.stepper().step_start().t);
    if (force < -digits * std::max(sizes_.hardest(i), 1e-280)) return true;
    ++k;
  }
  return false;
}

/// An event of the last step, with the state that the motion has there.
void HybridMotion::record_event(const std::string& name, double at, double hidden) {
  const double t = forwards_ ? std::min(at, here_.t) : std::max(at, here_.t);  // rounding may lead beyond the step
  Happening& told = journal_.add(Happening::Kind::Event, name);
  told.error = std::max(told.error, hidden);
  if (t == here_.t) return;
  told.t = t;
  if (!told.q.empty()) state(t, told.q, told.v);
  told.mode = mode_text(problem_.system, motions_.now().mode);
}

/// An event whose function comes to 0 this way: 1 rising along the run, −1 falling, 0 touching.
void HybridMotion::meet_event(const ModelEvent& event, const EventRoot& root, Met& pending) {
  const int way = root.direction;
  if (event.direction != 0 && way != event.direction * (forwards_ ? 1 : -1)) return;
  record_event(event.name, root.time, root.hidden);
  if (event.action == ModelEvent::Action::Stop) journal_.stop_by(event.name);
  if (event.action != ModelEvent::Action::Set) return;
  pending.sets.push_back(&event), pending.ways.push_back(way);
  pending.hidden_sets = std::max(pending.hidden_sets, root.hidden);
}

/// Roots of the step: events of the model are recorded at once; what changes the mode waits for the next step.
void HybridMotion::classify(Step& step) {
  take_state();
  step.event.reset();
  auto pending = std::make_unique<Met>();
  // At one instant in the order of the model, whether they end the step or not.
  constexpr double one_instant = 4 * std::numeric_limits<double>::epsilon();
  const auto is_now = [&](const EventRoot& root) {
    return std::abs(root.time - here_.t) <= one_instant * std::abs(here_.t);
  };
  const auto at_end = std::stable_partition(step.events.begin(), step.events.end(), std::not_fn(is_now));
  std::stable_sort(at_end, step.events.end(), [](const EventRoot& a, const EventRoot& b) { return a.event < b.event; });
  for (const EventRoot& root : step.events) {
    const Watch& watch = motions_.now().watches()[root.event];
    if (watch.what == Watch::What::Until) {
      step.event = 0;
    } else if (watch.what == Watch::What::Event) {
      if (is_now(root) && events_.are_of_state(watch.index)) pending->at_zero.push_back({watch.index, root.order});
      if (events_.are_of_positions(watch.index))
        events_.pass(watch.index, is_now(root) ? std::int8_t{0} : static_cast<std::int8_t>(root.direction));
      meet_event(problem_.model.experiment.events[watch.index], root, *pending);
      if (journal_.record().stopped_by) step.event = 0;
    } else if (root.direction <= 0) {
      if (watch.what == Watch::What::Gap) {
        if (trials_.is_just_released(watch.index)) continue;
        pending->hit.push_back(watch.index);
        pending->hidden = std::max(pending->hidden, hides_gap(watch.index, std::abs(step.end - step.begin)));
      } else
        pending->left.push_back(watch);
    }
  }
  step.events.clear();
  events_.leave_zeros_that_are_set(*pending);
  if (!pending->hit.empty() || !pending->left.empty() || !pending->sets.empty()) pending_ = std::move(pending);
}

/// An open contact whose gap has become negative though no step saw it close: then nothing of the motion holds. Where
/// all lies at zero still, gaps are measured by what accelerations make of them in the step.
std::optional<std::size_t> HybridMotion::violated(double step) {
  constexpr double digits = 1e-10;
  const TaylorStepper& s = motions_.stepper();
  if (problem_.system.contacts.empty()) return std::nullopt;
  const ContactValues& values = here_.values_at(s.time(), s.q(), s.v());
  sizes_.note_gaps(values);
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    double way = 0;
    for (const auto& [k, g] : values.normal[i]) way += std::abs(g) * sizes_.acceleration(k) * step * step;
    if (!motions_.now().mode.closed[i] && !(values.gap[i] >= -digits * (sizes_.gap(i, values) + way))) return i;
  }
  return std::nullopt;
}

/// Contacts with g = 0: closed ones, those that were hit, and those whose gap is rounding. Not those that an event has
/// just set apart.
std::vector<std::size_t> HybridMotion::touching(const ContactValues& values) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    if (!pending_->sets.empty() && values.gap[i] > digits_of_sets * sizes_.gap(i, values)) continue;
    const bool hit = std::find(pending_->hit.begin(), pending_->hit.end(), i) != pending_->hit.end();
    // What has come through zero by more than rounding, unseen, and does not come back by itself, is hit too.
    const bool through = values.gap[i] < 0 && values.rate[i] < -sizes_.rest_speed(i, values);
    // Next to zero by the sizes of its coordinates: a body that lies at their zero has no other measure.
    constexpr double next_to_zero = 1e-3 * rest_unit;
    const bool lies = !(values.rate[i] > sizes_.rest_speed(i, values)) &&
                      std::abs(values.gap[i]) <= next_to_zero * sizes_.gap(i, values);
    if (hit || through || lies || motions_.now().mode.closed[i] ||
        std::abs(values.gap[i]) <= rest_unit * sizes_.widest(i))
      out.push_back(i);
  }
  return out;
}

/// False, and why, where a contact that never slides has a slip: the constraint that it is would take it away, with the
/// energy, and no impact that would do so is part of the model.
bool HybridMotion::keeps_sticking(const std::vector<std::size_t>& touching, std::string& reason) {
  constexpr double digits = 1e-9;
  const ContactValues& values = here_.values();
  for (const std::size_t i : touching) {
    if (!problem_.system.contacts[i].friction.sticking || values.rate[i] > sizes_.rest_speed(i, values)) continue;
    if (slip_speed(i, values) <= digits * sizes_.fastest_slip(i)) continue;
    const std::string label = problem_.system.contact_label(i);
    if (pending_->begins && journal_.record().happenings.empty())
      reason = fmt::format("The start slides on the contact {}, which is `sticking` and never slides.", label);
    else if (!pending_->sets.empty())
      reason = fmt::format("The event `{}` sets a state that slides on the contact {}, which never slides.",
                           pending_->sets.front()->name, label);
    else
      reason = fmt::format(
          "The contact {} slides after what happens here, and it is `sticking`: the model does not say what stops it.",
          label);
    return false;
  }
  return true;
}

/// A motion that cannot go on stays where it is, with all that was counted so far.
Step HybridMotion::stopped(StepEnding ending, std::string reason) {
  motions_.stepper().start(here_.t, here_.q, here_.v, here_.t_rest);
  return ended(ending, std::move(reason));
}

/// Sets, impacts, and the mode after them. A step that ended where it cannot go on; nothing where all is well.
std::optional<Step> HybridMotion::settle(double bound) {
  std::string reason;
  if (!forwards_ && (!pending_->hit.empty() || !pending_->left.empty()))
    return ended(StepEnding::Paradox, met_backwards);
  if (!forwards_ && !pending_->sets.empty()) return ended(StepEnding::Paradox, set_backwards);
  if (++same_time_ > most_at_once)
    return ended(StepEnding::Unending,
                 events_.end_of_sets()
                     ? events_.sets_without_end()
                     : fmt::format("{} changes follow each other at the same time without an end.", most_at_once));
  if (auto why = journal_.too_many(time(), bound)) return ended(StepEnding::Unending, std::move(*why));
  if (!pending_->begins) leave_mode();
  if (derivative_ && !pending_->begins) note_before(bound);
  if (!pending_->sets.empty() && !carry_out_sets(reason)) return stopped(StepEnding::SingularConstraints, reason);
  const std::size_t first = journal_.size();
  const ContactValues& values = here_.values();
  if (pending_->begins) sizes_.note_gaps_elsewhere(values);
  if (pending_->begins)
    for (std::size_t i = 0; i < values.gap.size(); ++i)
      if (values.gap[i] < -rest_unit * std::max(values.gap_scale[i], sizes_.widest(i)) || !std::isfinite(values.gap[i]))
        return stopped(StepEnding::Paradox,
                       fmt::format("The start violates the contact {}.", problem_.system.contact_label(i)));
  sizes_.note(here_, values);
  sizes_.set_knows_compliances(false);
  slips_.begin_instant(motions_.now(), *pending_);
  std::vector<std::size_t> touch = touching(here_.values());
  if (!hit(touch, reason)) return stopped(StepEnding::Paradox, reason);
  if (!pending_->begins) close_lowest_flights(touch, bound);
  if (!keeps_sticking(touch, reason)) return stopped(StepEnding::Paradox, reason);
  space_.come_to_rest(touch, bound, forwards_);
  if (!choose(touch, bound, reason)) return stopped(StepEnding::Paradox, reason);
  events_.note_sets(*pending_, here_.t, bound, forwards_);
  if (const ModelEvent* const event = events_.turned_unseen(*pending_, bound, forwards_))
    return stopped(StepEnding::Unending, events_.too_short_to_tell(*event));
  note_rest_that_begins();
  if (pending_->begins) tell_events_at_start(bound);
  if (settled_) note_after(bound);
  journal_.note_errors(first, pending_->hidden);
  started_ = true;
  return meet_unseen(bound);
}

/// Events that rounding hides behind the instant that was settled are met here, to be settled next; one that has just
/// set the state, and is met again in no time, follows itself without an end.
std::optional<Step> HybridMotion::meet_unseen(double bound) {
  const std::unique_ptr<Met> settled = std::move(pending_);
  const Events::Unseen unseen = events_.unseen(*settled, here_.t, bound);
  auto met = std::make_unique<Met>();
  for (const auto& [number, root] : unseen.events) {
    met->at_zero.push_back({number, 1});
    meet_event(problem_.model.experiment.events[number], root, *met);
  }
  if (unseen.follows_itself) return stopped(StepEnding::Unending, events_.too_short_to_tell(*unseen.follows_itself));
  if (!met->sets.empty()) pending_ = std::move(met);
  return std::nullopt;
}

/// The mode that follows, with what is hit on the way to it. False, and why, where there is none.
bool HybridMotion::choose(std::vector<std::size_t>& touch, double bound, std::string& reason) {
  const Instant at{*pending_, touch, bound, started_};
  // Cones may have a solution that slides where others hold the rest.
  const bool rests = problem_.in_space && choice_.rests_undetermined(at);
  bool gave_way = !motions_.now().given.is_preload || !problem_.in_space;  // a rest that was not determined
  if (!rests && !choose_slips(at, false, reason)) return false;
  for (std::size_t turn = 0;; ++turn) {
    const ModeChoice::Chosen chosen = choice_.choose(at);
    if (chosen.is_interrupted) return true;
    if (chosen.found) {
      go_on_in(*chosen.found);
      return true;
    }
    reason = chosen.reason;
    const auto& moved = trials_.moved_through_zero();
    if (!moved && !gave_way) {
      gave_way = true;
      if (!choose_slips(at, true, reason)) return false;
      continue;
    }
    // Constraints of the mode to come may move the next contact through zero: that is hit at the same instant.
    if (!moved || turn >= problem_.system.contacts.size()) return false;
    touch.push_back(*moved);
    if (!hit(touch, reason)) return false;
  }
}

bool HybridMotion::choose_slips(const Instant& at, bool all_give_way, std::string& reason) {
  if (space_.choose_slips(at.touching, at.met, at.bound, all_give_way)) return true;
  reason = no_cones;
  return false;
}

void HybridMotion::go_on_in(const Found& found) {
  const bool rest_ends = motions_.now().given.is_preload && !found.given.is_preload && !pending_->changes_state();
  const std::size_t first = journal_.size();
  const ContactMode before = motions_.now().mode;
  motions_.go_on_in(found.mode, found.given);
  if (started_)
    journal_.change_mode(before, found.mode, found.accelerations, end_of_bounces_);
  else
    journal_.begin_in(before, found.mode, found.accelerations);
  if (rest_ends) journal_.note_end_of_rest(first);
}

/// What a step shows of the sizes of the motion.
void HybridMotion::note_step() {
  const TaylorStepper& s = motions_.stepper();
  take_state();
  const ContactValues& values = here_.values();
  sizes_.note(here_, values);
  note_limits(values);
  const std::vector<double>& a = s.step_start().a;
  if (std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); })) sizes_.note_accelerations(a, values);
  note_holding_forces(s.step_start());
}

void HybridMotion::note_holding_forces(const Sample& sample) {
  const std::span<const double> multipliers(sample.multipliers);
  const std::size_t own = problem_.equations.system->constraints.size();
  if (sizes_.note_holding_forces(motions_.now().mode, multipliers.subspan(own), here_)) sizes_.tell(motions_.stepper());
}

/// A first step may be as long as the rest that it begins: it has to know of the forces that balance in it.
void HybridMotion::note_rest_that_begins() {
  if (!sizes_.knows_holding_forces(motions_.now().mode)) note_holding_forces(motions_.stepper().sample(here_.t));
}

/// A limit of friction below zero is none: the force would drive what it is to brake.
void HybridMotion::note_limits(const ContactValues& values) {
  const std::size_t contacts = problem_.system.contacts.size();
  for (std::size_t i = 0; i < values.kinetic.size(); ++i)
    if (values.kinetic[i] < 0)
      journal_.remark(
          i < contacts ? fmt::format("The coefficient of friction of the contact {} becomes negative: friction drives "
                                     "the motion there, which none does.",
                                     problem_.system.contact_label(i))
                       : fmt::format("The friction along {} has a limit or a coefficient that becomes negative: it "
                                     "drives the motion there, which no friction does.",
                                     problem_.system.frictions[i - contacts].name));
}

/// Rounding of an acceleration a moves what rests by ε a h² in a step of length h. What that does to potentials, and
/// the work of the forces that balance over it: twice the kinetic energy of a speed of √ε a h.
double HybridMotion::rounding_of_energy() {
  if (problem_.library->sets().outputs() == 0) return 0;
  const std::vector<double> still(here_.v.size(), 0);
  const double base = functions_.energy(here_.t, here_.q, still);
  double out = 0;
  for (std::size_t i = 0; i < here_.q.size(); ++i) {
    const double speed = sizes_.acceleration(i) * longest_step_;
    std::vector<double> q = here_.q, v = still;
    q[i] += rest_unit * speed * longest_step_;
    v[i] = std::sqrt(rest_unit) * speed;
    out += std::abs(functions_.energy(here_.t, q, still) - base) +
           2 * std::abs(functions_.energy(here_.t, here_.q, v) - base);
  }
  return std::isfinite(out) ? out : 0;
}

}  // namespace maupertuis

#include "simulation/hybrid_motion.hpp"

#include "simulation/hybrid_checks.hpp"
#include "simulation/hybrid_roots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

/// Steps of a motion through modes: what a step meets waits for the next one, which settles it first.
namespace maupertuis {

using namespace hybrid;

namespace {

constexpr std::size_t most_at_once = 1000;  // changes at the same time
constexpr const char* set_backwards =
    "Backwards in time the motion meets an event that sets the state here: what was before it does not follow from "
    "what is after it.";
constexpr const char* met_backwards =
    "Backwards in time the motion meets a change of contact here: what was before an impact or a stop does not follow "
    "from what is after it.";

/// Whether a root is at the end of the step.
bool is_now(const EventRoot& root, double end) {
  constexpr double one_instant = 4 * std::numeric_limits<double>::epsilon();
  return std::abs(root.time - end) <= one_instant * std::abs(end);
}

/// Those at one instant in the order of the model, whether they end the step or not.
void order_roots(std::vector<EventRoot>& roots, double end) {
  const auto at_end =
      std::stable_partition(roots.begin(), roots.end(), [&](const EventRoot& root) { return !is_now(root, end); });
  std::stable_sort(at_end, roots.end(), [](const EventRoot& a, const EventRoot& b) { return a.event < b.event; });
}

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
      events_(problem_, here_, motions_, journal_),
      neighbours_(problem_, here_, sizes_, motions_),
      change_(problem_, here_, sizes_, slips_, motions_, events_, functions_, carried_, journal_, neighbours_) {}

void HybridMotion::start(double t, std::span<const double> q, std::span<const double> v) {
  here_.t = t;
  here_.t_rest = 0;
  here_.q.assign(q.begin(), q.end());
  here_.v.assign(v.begin(), v.end());
  carried_ = {};
  sizes_.start();
  journal_.start();
  slips_.start();
  events_.start();
  neighbours_.start();
  change_.start();
  same_time_ = 0;
  late_by_ = longest_step_ = 0;
  step_start_.reset();
  motions_.passed_moment().forget();
  motions_.go_on_in(open_mode(problem_.system));
  motions_.stepper().start(here_.t, here_.q, here_.v, here_.t_rest);
  met_ = std::make_unique<Met>();
  met_->begins = true;
  forwards_ = true;
  failed_ = settle(t + 1);
  carried_.forget_work();  // work before the first sample
}

// ------------------------------------------------------------------------------------------------- where it is

int HybridMotion::order() const { return motions_.stepper().order(); }
double HybridMotion::time() const { return motions_.stepper().time(); }
bool HybridMotion::covers(double t) const { return motions_.covers(t); }
void HybridMotion::state(double t, std::span<double> q, std::span<double> v) const { motions_.state(t, q, v); }
BackendUse HybridMotion::backend() const { return motions_.stepper().backend(); }
std::size_t HybridMotion::steps() const { return carried_.steps + motions_.stepper().steps(); }
std::size_t HybridMotion::rejected() const { return carried_.rejected + motions_.stepper().rejected(); }
std::size_t HybridMotion::switches() const { return carried_.switches + motions_.stepper().switches(); }
double HybridMotion::constraint_residual() const {
  return std::max(carried_.residual, motions_.stepper().constraint_residual());
}

Sample HybridMotion::with_carried(Sample sample) const {
  for (std::size_t k = 0; k < sample.integrals.size(); ++k) sample.integrals[k] += carried_.integrals[k];
  return sample;
}

Sample HybridMotion::sample(double t) const { return with_carried(motions_.sample(t)); }

const Sample& HybridMotion::step_start() const {
  if (!step_start_) step_start_ = with_carried(motions_.step_start());
  return *step_start_;
}

void HybridMotion::keep_instants() {
  neighbours_.keep();
  motions_.tell_touches();
}

// ------------------------------------------------------------------------------------------------------- a step

Step HybridMotion::step(double bound) {
  if (failed_) return *failed_;
  step_start_.reset();
  neighbours_.begin_step();
  forwards_ = bound >= time();
  if (auto refused = refused_backwards(bound)) return std::move(*refused);
  if (met_ && late_by_ > 0) return wait(bound);
  while (met_) {
    if (auto failed = settle(bound)) return std::move(*failed);
    if (!journal_.record().stopped_by) continue;
    Step here = ended(StepEnding::None, {});
    here.event = 0;
    return here;
  }
  Step out = step_in_mode(bound);
  if (out.ending != StepEnding::None) return out;
  return end_step(std::move(out), bound);
}

/// At a start backwards in time.
std::optional<Step> HybridMotion::refused_backwards(double bound) {
  if (forwards_ || steps() > 0) return std::nullopt;
  const std::vector<Happening>& told = journal_.record().happenings;
  if (!told.empty() && told.front().kind == Happening::Kind::Impact && told.front().t == time())
    return ended(StepEnding::Paradox,
                 "Backwards in time there is no motion from a start at which a contact is hit: what was before the "
                 "impact does not follow from what is after it.");
  // Its mode was chosen for what follows: a contact that opens at the start was hit there.
  if (!goes_on(motions_.now(), bound)) return ended(StepEnding::Paradox, met_backwards);
  return std::nullopt;
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

/// As far as the mode holds, and no further than sets that accumulate.
Step HybridMotion::step_in_mode(double bound) {
  const auto& last = events_.end_of_sets();
  if (last && time() == last->t) return ended(StepEnding::Unending, events_.sets_without_end());
  const ModeMotion& now = motions_.now();
  const double until = last ? last->t : bound;
  Step out = now.stepper->step(forwards_ ? std::min({until, now.given.end, slips_.latest_end(now)}) : until);
  const double length = std::abs(out.end - out.begin);
  if (out.end != out.begin) same_time_ = 0;
  longest_step_ = std::max(longest_step_, length);
  motions_.passed_moment().end_step();
  if (out.ending == StepEnding::SingularConstraints)
    if (auto paradox = came_to_paradox()) return std::move(*paradox);
  if (out.ending != StepEnding::None) return out;
  events_.look_for_values(out.begin);
  note_step();
  const double way = length + std::numeric_limits<double>::epsilon() * std::abs(out.end);
  if (const auto contact = violated_contact(now, way, here_, sizes_)) return went_through(*contact);
  return out;
}

/// Where friction is about to turn the response of a contact to its own force around, that force grows without bound.
std::optional<Step> HybridMotion::came_to_paradox() {
  constexpr double nearly_none = 1e-3;  // of the response without friction
  take_state();
  const ContactValues& values = here_.values();
  for (std::size_t i = 0; i < problem_.system.contacts.size(); ++i) {
    const auto response = slips_.own_response(i, motions_.now().mode, values);
    if (!response || !(response->with_friction <= nearly_none * response->without)) continue;
    journal_.end_by(problem_.system.contacts[i].span);
    return ended(StepEnding::Paradox,
                 fmt::format("Painlevé's paradox: with the friction of its slip the contact {} yields no more to its "
                             "own force here, which grows without bound. {}",
                             problem_.system.contact_label(i), beyond_painleve));
  }
  return std::nullopt;
}

Step HybridMotion::went_through(std::size_t contact) {
  const std::string label = problem_.system.contact_label(contact);
  if (!std::isfinite(here_.values().gap[contact]))
    return ended(StepEnding::Overflow, fmt::format("The gap of the contact {} has no value here.", label));
  journal_.end_by(problem_.system.contacts[contact].span);
  return ended(StepEnding::Paradox,
               fmt::format("The motion went through the contact {} without a sign of it{}.", label,
                           change_.has_bounced(contact) ? ": bounces have become too small to be told apart" : ""));
}

/// What ends a step waits for the next one.
Step HybridMotion::end_step(Step out, double bound) {
  if (!out.events.empty()) classify(out, bound);
  if (auto why = journal_.too_many(time(), bound)) return ended(StepEnding::Unending, std::move(*why));
  const auto& last = events_.end_of_sets();
  if (last && out.end == last->t && !met_ && !out.event) return ended(StepEnding::Unending, events_.sets_without_end());
  const ModeMotion& now = motions_.now();
  if (met_ && forwards_) meet_together(*met_, now, problem_.system, bound);
  if (met_ && problem_.meets_late) late_by_ = std::max(hidden_by_rounding(now, *met_, bound), met_->hidden_sets);
  if (!met_ && (out.end >= now.given.end || slips_.outgrow_stops(now))) met_ = std::make_unique<Met>();
  // A force that jumps may let a contact or a friction go, though none of their conditions has a root.
  const std::size_t constraints = problem_.equations.system->constraints.size();
  if (!met_ && ((!out.switches.empty() && !goes_on(now, bound)) || pulls(now, constraints, sizes_))) {
    take_state();
    met_ = std::make_unique<Met>();
  }
  return out;
}

/// Roots of the step: events of the model are recorded at once; what changes the mode waits for the next step.
void HybridMotion::classify(Step& step, double bound) {
  take_state();
  step.event.reset();
  auto met = std::make_unique<Met>();
  order_roots(step.events, here_.t);
  for (const EventRoot& root : step.events) {
    const Watch& watch = motions_.now().watches()[root.event];
    if (watch.what == Watch::What::Until) {
      step.event = 0;
    } else if (watch.what == Watch::What::Event) {
      if (events_.stays_at_zero(root, step.end - step.begin, bound)) continue;
      const bool is_at_zero = is_now(root, here_.t);
      if (is_at_zero) met->at_zero.push_back({watch.index, root.order, !events_.are_of_state(watch.index)});
      events_.pass(watch.index, is_at_zero ? std::int8_t{0} : static_cast<std::int8_t>(root.direction));
      events_.meet(problem_.model.experiment.events[watch.index], root, *met, forwards_);
      if (journal_.record().stopped_by) step.event = 0;
    } else if (root.direction <= 0) {
      end_condition(watch, step.end - step.begin, *met);
    }
  }
  step.events.clear();
  events_.meet_with_sets(*met, bound, forwards_);
  if (journal_.record().stopped_by) step.event = 0;
  events_.mark_zeros_that_are_set(*met);
  if (!met->is_empty()) met_ = std::move(met);
}

/// `length`: of the step.
void HybridMotion::end_condition(const Watch& watch, double length, Met& met) const {
  const std::size_t i = watch.index;
  if (watch.what != Watch::What::Gap) {
    met.left.push_back(watch);
  } else if (!change_.is_just_released(i)) {
    met.hit.push_back(i);
    met.hidden = std::max(met.hidden, hides_gap(i, length, motions_.now(), here_, sizes_));
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

/// What a step shows of the sizes of the motion.
void HybridMotion::note_step() {
  const TaylorStepper& s = motions_.stepper();
  take_state();
  const ContactValues& values = here_.values();
  sizes_.note(here_, values);
  journal_.tell_limits(values);
  const std::vector<double>& a = s.step_start().a;
  if (std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); })) sizes_.note_accelerations(a, values);
  note_holding_forces(s.step_start());
}

void HybridMotion::note_holding_forces(const Sample& sample) {
  const std::span<const double> multipliers(sample.multipliers);
  const std::size_t own = problem_.equations.system->constraints.size();
  if (sizes_.note_holding_forces(motions_.now().mode, multipliers.subspan(own), here_)) sizes_.tell(motions_.stepper());
}

// -------------------------------------------------------------------------------------------- what it has met

/// What happens here, and the mode after it. A step that ended where it cannot go on; nothing where all is well.
std::optional<Step> HybridMotion::settle(double bound) {
  if (!forwards_ && (!met_->hit.empty() || !met_->left.empty())) return ended(StepEnding::Paradox, met_backwards);
  if (!forwards_ && !met_->sets.empty()) return ended(StepEnding::Paradox, set_backwards);
  if (auto why = too_many_at_once()) return ended(StepEnding::Unending, std::move(*why));
  if (auto why = journal_.too_many(time(), bound)) return ended(StepEnding::Unending, std::move(*why));
  if (!met_->begins) carried_.take(motions_.stepper());
  if (!met_->begins && neighbours_.are_kept()) neighbours_.note_before(*met_, bound);
  const std::size_t first = journal_.size();
  events_.measure_zeros(*met_, bound);
  if (auto trouble = change_.settle(*met_, bound, forwards_)) return stopped(trouble->ending, trouble->reason);
  events_.note_sets(*met_, bound, forwards_);
  events_.note_stays(*met_, bound);
  if (const ModelEvent* const event = events_.turned_unseen(*met_, bound, forwards_))
    return stopped(StepEnding::Unending, events_.too_short_to_tell(*event));
  // A first step may be as long as the rest that it begins: it has to know of the forces that balance in it.
  if (!sizes_.knows_holding_forces(motions_.now().mode)) note_holding_forces(motions_.stepper().sample(here_.t));
  if (met_->begins) events_.tell_at_start(bound, forwards_);
  neighbours_.note_after(bound);
  journal_.note_errors(first, met_->hidden);
  const std::unique_ptr<Met> settled = std::move(met_);
  Events::Unseen unseen = events_.meet_unseen(*settled, bound, forwards_);
  if (unseen.follows_itself) return stopped(StepEnding::Unending, events_.too_short_to_tell(*unseen.follows_itself));
  if (!unseen.met.sets.empty()) met_ = std::make_unique<Met>(std::move(unseen.met));
  return std::nullopt;
}

/// One sentence where changes follow each other at one instant without an end.
std::optional<std::string> HybridMotion::too_many_at_once() {
  if (++same_time_ <= most_at_once) return std::nullopt;
  if (events_.end_of_sets()) return events_.sets_without_end();
  return fmt::format("{} changes follow each other at the same time without an end.", most_at_once);
}

Step HybridMotion::ended(StepEnding ending, std::string reason) const {
  Step out;
  out.begin = out.end = time();
  out.ending = ending;
  out.reason = std::move(reason);
  return out;
}

/// A motion that cannot go on stays where it is, with all that was counted so far.
Step HybridMotion::stopped(StepEnding ending, std::string reason) {
  motions_.stepper().start(here_.t, here_.q, here_.v, here_.t_rest);
  return ended(ending, std::move(reason));
}

// -------------------------------------------------------------------------------------------- the end of the run

void HybridMotion::finish() {
  if (motions_.has_begun()) journal_.end_at(time(), forwards_);
  if (motions_.has_begun() && !failed_ && !met_) {
    take_state();
    if (!journal_.record().stopped_by) events_.tell_at_end(longest_step_, forwards_);
    events_.look_for_values(time());
  }
  events_.tell_without_value();
  if (journal_.record().stopped_by && met_)
    for (const ModelEvent* event : met_->sets)
      journal_.remark(
          fmt::format("The event {} sets the state as the run ends: the last state is the one before.", event->name));
  if (problem_.system.contacts.empty() || !change_.has_started()) return;
  take_state();
  const ContactValues& values = here_.values();
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    const bool touches = std::abs(values.gap[i]) <= rest_unit * sizes_.widest(i);
    if (motions_.now().mode.closed[i] || !touches || !(values.rate[i] < -sizes_.rest_speed(i, values))) continue;
    journal_.remark(fmt::format("The contact {} is hit as the run ends: the last state is the one before the impact.",
                                problem_.system.contact_label(i)));
  }
  if (change_.cone_residual() >= 0)
    journal_.remark(
        fmt::format("Forces of friction in space: in their cones to {:.1e} of the largest.", change_.cone_residual()));
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

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include "simulation/hybrid_parts.hpp"
#include "simulation/sets_together.hpp"
/// Events that set the state.

namespace maupertuis {

/// Assigns what events set, all from the values before.
bool HybridMotion::carry_out_sets(std::string& reason) {
  const std::vector<double> found = functions_.energy_and_sets(here_.t, here_.q, here_.v);
  const std::string before = pending_->sets.front()->name;
  if (const std::string told = set_more_than_once(problem_.system, pending_->sets, here_.t); !told.empty())
    journal_.remark(told);
  std::vector<double> q = here_.q, v = here_.v;
  std::vector<const double*> first;  // of each event in `found`
  const double* next = found.data() + 1;
  for (const ModelEvent& e : problem_.model.experiment.events) first.push_back(next), next += e.sets.size();
  for (const ModelEvent* event : pending_->sets) {
    const double* value = first[static_cast<std::size_t>(event - problem_.model.experiment.events.data())];
    for (const ModelEvent::Assignment& a : event->sets) (a.order == 0 ? q : v)[a.coordinate] = *value++;
  }
  if (const auto k = functions_.violated_constraint({here_.t, q, v}, digits_of_sets, sizes_)) {
    reason = fmt::format("The event `{}` sets a state that violates {}.", before, problem_.system.constraint_label(*k));
    return false;
  }
  const ContactValues& values = here_.values_at(here_.t, q, v);
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (values.gap[i] < -digits_of_sets * sizes_.gap(i, values)) {
      reason = fmt::format("The event `{}` sets a state that violates the contact {}.", before,
                           problem_.system.contact_label(i));
      return false;
    }
  for (std::size_t i = 0; i < bounces_.size(); ++i)  // what is set down anew bounces anew
    for (const auto& [k, g] : values.normal[i])
      if (q[k] != here_.q[k] || v[k] != here_.v[k]) bounces_[i].before = 0;
  const double gained = functions_.energy_and_sets(here_.t, q, v)[0] - found[0];
  carried_.put_in(gained);  // what a set puts in is work
  journal_.books().events += gained;
  here_.q = q, here_.v = v;
  if (sets_positions(pending_->sets)) event_sides_.assign(event_sides_.size(), 0);
  return true;
}

/// An event whose function turns round by what it sets, so slowly that the motion comes back to it before rounding
/// tells that it has left: it would be passed, and the bounces before it, shorter and shorter, accumulate here.
const ModelEvent* HybridMotion::turned_unseen(double bound) {
  if (pending_->sets.empty() || pending_->at_zero.empty()) return nullptr;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return nullptr;  // the next step says why it cannot be made
  for (std::size_t k = 0; k < motions_.now().watches().size(); ++k) {
    const Watch& watch = motions_.now().watches()[k];
    const auto& zeros = pending_->at_zero;
    if (watch.what != Watch::What::Event || std::find(zeros.begin(), zeros.end(), watch.index) == zeros.end()) continue;
    const ModelEvent* const event = &problem_.model.experiment.events[watch.index];
    const auto at = std::find(pending_->sets.begin(), pending_->sets.end(), event);
    if (at == pending_->sets.end()) continue;
    const int way = pending_->ways[static_cast<std::size_t>(at - pending_->sets.begin())];
    const bool turns = outlook.slopes[k] * (forwards_ ? way : -way) < 0;
    if (turns && outlook.sides[k] != -way) return event;
  }
  return nullptr;
}

namespace {

/// "The event `a` follows itself", "The events `a` and `b` follow each other".
std::string names_of(const std::vector<ModelEvent>& events, std::vector<std::size_t> which) {
  std::sort(which.begin(), which.end());
  which.erase(std::unique(which.begin(), which.end()), which.end());
  std::string out;
  for (std::size_t k = 0; k < which.size(); ++k)
    out += fmt::format("{}`{}`", k == 0 ? "" : k + 1 < which.size() ? ", " : " and ", events[which[k]].name);
  return which.size() == 1 ? fmt::format("The event {} follows itself", out)
                           : fmt::format("The events {} follow each other", out);
}

}  // namespace

/// Sets that follow each other in shorter and shorter cycles come to an end, beyond which no step goes.
void HybridMotion::note_sets(double bound) {
  if (pending_->sets.empty()) return;
  for (const ModelEvent* event : pending_->sets)
    sets_that_follow_.add(static_cast<std::size_t>(event - problem_.model.experiment.events.data()), here_.t);
  const auto end = sets_that_follow_.end();  // none where they have become too short: the last one stands
  if (end && (forwards_ ? end->t <= bound : end->t >= bound)) sets_end_ = end;
}

/// One sentence on an event whose returns rounding hides.
std::string HybridMotion::too_short_to_tell(const ModelEvent& event) const {
  if (sets_end_) return sets_without_end();
  return fmt::format(
      "The event `{}` follows itself faster and faster: its returns accumulate here, and have become too short to be "
      "told apart.",
      event.name);
}

/// One sentence on the end of sets that accumulate.
std::string HybridMotion::sets_without_end() const {
  return fmt::format(
      "{} faster and faster, infinitely often up to t = {:.12g}: `set` does not say what comes after it. A `contact` "
      "with `restitution` in place of such an event does: bounces on it end at rest.",
      names_of(problem_.model.experiment.events, sets_end_->kinds), sets_end_->t);
}

/// Events on positions whose sign has changed at the instant that was settled though no root was told: so near to it
/// that rounding hides their own. The motion meets them here, to be settled next; one that has just set the state, and
/// is met again in no time, follows itself without an end.
std::optional<Step> HybridMotion::meet_unseen(double bound) {
  const std::unique_ptr<Met> settled = std::move(pending_);
  if (std::none_of(of_positions_.begin(), of_positions_.end(), [](bool x) { return x; })) return std::nullopt;
  const Outlook outlook = motions_.stepper().outlook(bound);
  if (outlook.ending != StepEnding::None) return std::nullopt;  // the next step says why it cannot be made
  auto met = std::make_unique<Met>();
  for (std::size_t k = 0; k < motions_.now().watches().size(); ++k) {
    const Watch& watch = motions_.now().watches()[k];
    if (watch.what != Watch::What::Event || !of_positions_[watch.index]) continue;
    const std::int8_t before = std::exchange(event_sides_[watch.index], outlook.sides[k]);
    if (!is_hidden(before, outlook, k)) continue;
    const ModelEvent& event = problem_.model.experiment.events[watch.index];
    if (std::find(settled->sets.begin(), settled->sets.end(), &event) != settled->sets.end())
      return stopped(StepEnding::Unending, too_short_to_tell(event));
    met->at_zero.push_back(watch.index);
    event_sides_[watch.index] = 0;
    meet_event(event, {k, -before, here_.t}, *met);
  }
  if (!met->sets.empty()) pending_ = std::move(met);
  return std::nullopt;
}

/// Whether an event that was on the side `before` is on the other one by no more than rounding.
bool HybridMotion::is_hidden(std::int8_t before, const Outlook& outlook, std::size_t watch) {
  constexpr double rounding = 1e-12;  // of its terms
  return before != 0 && outlook.sides[watch] == -before &&
         std::abs(outlook.values[watch]) <= rounding * outlook.reach[watch];
}

}  // namespace maupertuis

#include "simulation/hybrid_parts.hpp"
#include "simulation/sets_together.hpp"

#include <fmt/format.h>

#include <algorithm>

/// Events that set the state.
namespace maupertuis {

/// Assigns what events set, all from the values before.
bool HybridMotion::carry_out_sets(std::string& reason) {
  const std::vector<double> found = energy_and_sets_at(t_, q_, v_);
  const std::string before = pending_->sets.front()->name;
  if (const std::string told = set_more_than_once(system_, pending_->sets, t_); !told.empty()) remark(told);
  std::vector<double> q = q_, v = v_;
  std::vector<const double*> first;  // of each event in `found`
  const double* next = found.data() + 1;
  for (const ModelEvent& e : model_.experiment.events) first.push_back(next), next += e.sets.size();
  for (const ModelEvent* event : pending_->sets) {
    const double* value = first[static_cast<std::size_t>(event - model_.experiment.events.data())];
    for (const ModelEvent::Assignment& a : event->sets) (a.order == 0 ? q : v)[a.coordinate] = *value++;
  }
  if (const auto k = violated_constraint({t_, q, v}, digits_of_sets)) {
    reason = fmt::format("The event `{}` sets a state that violates {}.", before, system_.constraint_label(*k));
    return false;
  }
  const ContactValues& values = functions_.at(t_, q, v);
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (values.gap[i] < -digits_of_sets * size_of_gap(i, values)) {
      reason =
          fmt::format("The event `{}` sets a state that violates the contact {}.", before, system_.contact_label(i));
      return false;
    }
  for (std::size_t i = 0; i < bounces_.size(); ++i)  // what is set down anew bounces anew
    for (const auto& [k, g] : values.normal[i])
      if (q[k] != q_[k] || v[k] != v_[k]) bounces_[i].before = 0;
  const double gained = energy_and_sets_at(t_, q, v)[0] - found[0];
  carried_[0] += gained;  // what a set puts in is work
  record_.books.events += gained;
  q_ = q, v_ = v;
  return true;
}

/// An event whose function turns round by what it sets, so slowly that the motion comes back to it before rounding
/// tells that it has left: it would be passed, and the bounces before it, shorter and shorter, accumulate here.
const ModelEvent* HybridMotion::turned_unseen(double bound) {
  if (pending_->sets.empty() || pending_->at_zero.empty()) return nullptr;
  const TaylorStepper::Outlook outlook = now_->stepper->outlook(bound);
  if (outlook.ending != StepEnding::None) return nullptr;  // the next step says why it cannot be made
  for (std::size_t k = 0; k < now_->watches().size(); ++k) {
    const Watch& watch = now_->watches()[k];
    const auto& zeros = pending_->at_zero;
    if (watch.what != Watch::What::Event || std::find(zeros.begin(), zeros.end(), watch.index) == zeros.end()) continue;
    const ModelEvent* const event = &model_.experiment.events[watch.index];
    const auto at = std::find(pending_->sets.begin(), pending_->sets.end(), event);
    if (at == pending_->sets.end()) continue;
    const int way = pending_->ways[static_cast<std::size_t>(at - pending_->sets.begin())];
    const bool turns = outlook.slopes[k] * (forwards_ ? way : -way) < 0;
    if (turns && outlook.sides[k] != -way) return event;
  }
  return nullptr;
}

}  // namespace maupertuis

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
  if (sets_positions(pending_->sets)) events_.forget_sides();
  return true;
}

}  // namespace maupertuis

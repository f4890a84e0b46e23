#include "simulation/hybrid_change.hpp"

#include "simulation/hybrid_checks.hpp"
#include "simulation/sets_together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis::hybrid {
namespace {

constexpr const char* no_cones =
    "The forces of contacts with friction in space were not found: their cones have no solution here, or the "
    "iteration does not converge to it.";

/// What events set, all from the values before. `values`: of all events, one after the other.
void assign(const std::vector<const ModelEvent*>& sets, const std::vector<ModelEvent>& events, const double* values,
            std::vector<double>& q, std::vector<double>& v) {
  std::vector<const double*> first;  // of each event
  for (const ModelEvent& e : events) first.push_back(values), values += e.sets.size();
  for (const ModelEvent* event : sets) {
    const double* value = first[static_cast<std::size_t>(event - events.data())];
    for (const ModelEvent::Assignment& a : event->sets) (a.order == 0 ? q : v)[a.coordinate] = *value++;
  }
}

}  // namespace

ModeChange::ModeChange(const Problem& problem, State& here, UsualSizes& sizes, SpaceSlips& slips, ModeMotions& motions,
                       Events& events, StateFunctions& functions, Carried& carried, Journal& journal,
                       Neighbours& neighbours)
    : problem_(problem),
      here_(here),
      sizes_(sizes),
      slips_(slips),
      motions_(motions),
      events_(events),
      functions_(functions),
      carried_(carried),
      journal_(journal),
      neighbours_(neighbours),
      choices_(problem, sizes, slips),
      cones_(problem, here, sizes, slips, choices_),
      space_(problem, here, sizes, slips, motions, choices_, cones_, functions, carried),
      undetermined_(problem, here, sizes, motions, cones_, choices_),
      forces_(problem, here, motions, choices_),
      trials_(problem, here, sizes, slips, motions, undetermined_, events),
      choice_(problem, here, sizes, slips, motions, choices_, forces_, undetermined_, trials_, journal),
      impacts_(problem, here, sizes, choices_, forces_, space_, carried, journal) {}

void ModeChange::start() {
  has_started_ = false;
  space_.start();
  trials_.start();
  choice_.start();
  impacts_.start();
}

std::optional<Trouble> ModeChange::settle(Met& met, double bound, bool forwards) {
  if (!met.sets.empty())
    if (auto why = trouble_of_sets(met)) {
      journal_.end_by(met.sets.front()->span);
      return Trouble{StepEnding::ImpossibleState, std::move(*why)};
    }
  const ContactValues& values = here_.values();
  if (met.begins) {
    sizes_.note_gaps_elsewhere(values);
    if (const auto contact = contact_violated_at_start(values, sizes_))
      return Trouble{StepEnding::Paradox,
                     fmt::format("The start violates the contact {}.", problem_.system.contact_label(*contact))};
  }
  sizes_.note(here_, values);
  sizes_.set_knows_compliances(false);
  slips_.begin_instant(motions_.now(), met);
  std::vector<std::size_t> touching = touching_contacts(motions_.now().mode, met, values, sizes_);
  auto why = trouble_of_hits(met, touching, bound);
  if (!why) {
    space_.come_to_rest(touching, bound, forwards);
    why = trouble_of_mode(met, touching, bound);
  }
  if (!why) return std::nullopt;
  if (!touching.empty()) journal_.end_by(problem_.system.contacts[touching.front()].span);
  return Trouble{StepEnding::Paradox, std::move(*why)};
}

/// Impacts, and what they leave.
std::optional<std::string> ModeChange::trouble_of_hits(Met& met, std::vector<std::size_t>& touching, double bound) {
  if (auto why = trouble_of_hit(met, touching)) return why;
  if (!met.begins) impacts_.close_lowest_flights(touching, met, bound);
  return trouble_of_sticking(met, touching);
}

/// Assigns what events set.
std::optional<std::string> ModeChange::trouble_of_sets(Met& met) {
  const std::vector<double> found = functions_.energy_and_sets(here_.t, here_.q, here_.v);
  const std::string& first = met.sets.front()->name;
  if (const std::string told = set_more_than_once(problem_.system, met.sets, here_.t); !told.empty())
    journal_.remark(told);
  std::vector<double> q = here_.q, v = here_.v;
  assign(met.sets, problem_.model.experiment.events, found.data() + 1, q, v);
  const auto is_finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(q.begin(), q.end(), is_finite) || !std::all_of(v.begin(), v.end(), is_finite))
    return fmt::format("The event `{}` sets a state without a value: a formula of it has none here.", first);
  if (const auto k = functions_.violated_constraint({here_.t, q, v}, digits_of_sets, sizes_))
    return fmt::format("The event `{}` sets a state that violates {}.", first, problem_.system.constraint_label(*k));
  const ContactValues& values = here_.values_at(here_.t, q, v);
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (values.gap[i] < -digits_of_sets * sizes_.gap(i, values))
      return fmt::format("The event `{}` sets a state that violates the contact {}.", first,
                         problem_.system.contact_label(i));
  impacts_.begin_anew(q, v, values);
  const double gained = functions_.energy(here_.t, q, v) - found[0];
  carried_.put_in(gained);  // what a set puts in is work
  journal_.books().events += gained;
  here_.q = q, here_.v = v;
  if (sets_positions(met.sets)) events_.forget_sides();
  return std::nullopt;
}

std::optional<std::string> ModeChange::trouble_of_hit(Met& met, std::vector<std::size_t>& touching) {
  Impacts::Outcome outcome = impacts_.hit(touching);
  if (!outcome.impact) return outcome.trouble;
  // Forces after an impact are others: what came to 0 before it may press.
  if (!outcome.impact->result.impulses.empty()) {
    std::erase_if(met.left, [](const Watch& w) { return w.what == Watch::What::Force; });
    events_.mark_zeros_of_velocities(met);
  }
  neighbours_.note_impact(std::move(*outcome.impact));
  return std::nullopt;
}

std::optional<std::string> ModeChange::trouble_of_sticking(const Met& met,
                                                           const std::vector<std::size_t>& touching) const {
  const auto contact = sliding_though_sticking(touching, problem_.system, here_.values(), sizes_);
  if (!contact) return std::nullopt;
  const std::string label = problem_.system.contact_label(*contact);
  if (met.begins && journal_.size() == 0)
    return fmt::format("The start slides on the contact {}, which is `sticking` and never slides.", label);
  if (!met.sets.empty())
    return fmt::format("The event `{}` sets a state that slides on the contact {}, which never slides.",
                       met.sets.front()->name, label);
  return fmt::format(
      "The contact {} slides after what happens here, and it is `sticking`: the model does not say what stops it.",
      label);
}

/// The mode that follows, with what is hit on the way to it.
std::optional<std::string> ModeChange::trouble_of_mode(Met& met, std::vector<std::size_t>& touching, double bound) {
  const Instant at{met, touching, bound, has_started_};
  // Cones may have a solution that slides where others hold the rest.
  const bool rests = problem_.in_space && choice_.rests_undetermined(at);
  bool gave_way = !motions_.now().given.is_preload || !problem_.in_space;  // a rest that was not determined
  if (!rests && !space_.choose_slips(touching, met, bound, false)) return std::string(no_cones);
  for (std::size_t turn = 0;; ++turn) {
    ModeChoice::Chosen chosen = choice_.choose(at);
    if (chosen.found && chosen.is_interrupted)  // trials may have moved the stepper of this mode
      motions_.stepper().start(here_.t, here_.q, here_.v, here_.t_rest);
    else if (chosen.found)
      go_on_in(*chosen.found, met);
    if (chosen.found) break;
    const auto& moved = trials_.moved_through_zero();
    if (!moved && !gave_way) {
      gave_way = true;
      if (!space_.choose_slips(touching, met, bound, true)) return std::string(no_cones);
      continue;
    }
    // Constraints of the mode to come may move the next contact through zero: that is hit at the same instant.
    if (!moved || turn >= problem_.system.contacts.size()) return std::move(chosen.reason);
    touching.push_back(*moved);
    if (auto why = trouble_of_hit(met, touching)) return why;
  }
  has_started_ = true;
  return std::nullopt;
}

void ModeChange::go_on_in(const Found& found, const Met& met) {
  const bool rest_ends = motions_.now().given.is_preload && !found.given.is_preload && !met.changes_state();
  const std::size_t first = journal_.size();
  const ContactMode before = motions_.now().mode;
  motions_.go_on_in(found.mode, found.given);
  if (has_started_)
    journal_.change_mode(before, found.mode, found.accelerations, impacts_.bounces_ended());
  else
    journal_.begin_in(before, found.mode, found.accelerations);
  if (rest_ends) journal_.note_end_of_rest(first);
}

}  // namespace maupertuis::hybrid

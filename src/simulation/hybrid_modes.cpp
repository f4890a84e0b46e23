#include "simulation/hybrid_modes.hpp"

#include "linear_algebra/combinations.hpp"
#include "simulation/mode_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maupertuis::hybrid {
namespace {

constexpr std::size_t most_kept = 32;  // motions of modes that were tried in vain at an instant

bool equal_to_rounding(const std::vector<double>& a, const std::vector<double>& b) {
  double off = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    off = std::max(off, std::abs(a[i] - b[i]));
    size = std::max({size, std::abs(a[i]), std::abs(b[i])});
  }
  return off <= 1e-9 * size;
}

std::string two_fit(const std::string& one, const std::string& other) {
  const auto name = [](const std::string& mode) { return mode.empty() ? "free" : mode; };
  return fmt::format(
      "Painlevé's paradox: friction turns the contact force around here, and more than one motion fits: in the mode "
      "`{}` and in the mode `{}`. {}",
      name(one), name(other), beyond_painleve);
}

/// In which order modes are tried, and how many of them. Of many contacts the one that the forces of all point to is
/// right as a rule, with rounding at a contact that neither presses nor opens: it and those that differ at one contact
/// come first with all leniencies.
std::vector<std::pair<Leniency, std::size_t>> attempts_with(std::size_t contacts) {
  constexpr std::size_t few = 4;
  std::vector<std::pair<Leniency, std::size_t>> out;
  out.reserve(6);
  for (const std::size_t most : {contacts > few ? contacts + 1 : 0, most_choices})
    for (const Leniency leniency : {Leniency::None, Leniency::Forces, Leniency::Gaps})
      if (most > 0) out.emplace_back(leniency, most);
  return out;
}

}  // namespace

ModeChoice::Chosen ModeChoice::choose(const Instant& at) {
  const ContactValues& values = here_.values();  // of one point throughout
  measure(at, values);
  const std::vector<Choice> list = ordered_choices(at, values);
  trials_.begin_instant(at.met);
  Chosen out;
  out.found = undetermined_rest(list, at);
  if (!out.found) out.found = mode_that_goes_on(at);
  if (!out.found) out.found = search(list, at, out.reason);
  out.is_interrupted = out.found && problem_.interrupted();
  if (!out.found || out.is_interrupted) return out;
  tell_choice(list, *out.found, at);
  sizes_.note_accelerations(out.found->accelerations, values);  // those of modes that do not fit are no measure
  trials_.end_instant(out.found->mode);
  const std::string told = undetermined_.sentence(list, out.found->mode, values);
  if (!told.empty()) journal_.remark(told);
  return out;
}

bool ModeChoice::rests_undetermined(const Instant& at) {
  return undetermined_rest(choices_.at(at.touching, here_.values(), at.met), at).has_value();
}

/// What forces are to be judged by.
void ModeChoice::measure(const Instant& at, const ContactValues& values) {
  if (!at.touching.empty() && !sizes_.knows_compliances()) {
    std::vector<SparseRow> rows;
    for (const std::size_t i : at.touching) rows.push_back(values.normal[i]);
    sizes_.note_compliances(at.touching, rows, here_.response(rows));
  }
  trials_.measure_forces(at);
}

/// The likeliest first.
std::vector<Choice> ModeChoice::ordered_choices(const Instant& at, const ContactValues& values) {
  std::vector<Choice> list = choices_.at(at.touching, values, at.met);
  if (list.size() < 2) return list;
  if (forces_.order(list, values, at.bound)) {
    told_choice_ = true;
    journal_.remark(
        "Static friction leaves a choice: where several contacts begin to slide at once, one of some can be held, and "
        "the one that is written first is.");
  }
  order_by_limits(list, at);
  return list;
}

/// Of frictions at rest those give way first that are at their limit, or beyond it where all rest; of the latter the
/// one that is written last, so that the first one is held where one can be.
void ModeChoice::order_by_limits(std::vector<Choice>& list, const Instant& at) {
  std::vector<std::size_t> at_limit;
  for (const Watch& w : at.met.left)
    if (w.what == Watch::What::Hold) at_limit.push_back(w.index);
  const bool overcome = at_limit.empty();
  if (overcome && std::any_of(list.begin(), list.end(), [&](const Choice& c) { return may_hold(c); })) {
    Found rest{choices_.mode_of(list, std::vector<std::size_t>(list.size(), 0)), {}, {}};
    at_limit = trials_.beyond_limits(rest, at).value_or(at_limit);
  }
  const auto first = std::stable_partition(list.begin(), list.end(), [&](const Choice& c) {
    return std::find(at_limit.begin(), at_limit.end(), c.contact) != at_limit.end();
  });
  if (overcome) std::reverse(list.begin(), first);
}

/// The mode in which all that may rest does, with forces that are given: before the least forces are tried, which may
/// lie beyond the limits of friction though others do not. Of more contacts than forces are sought for, those that the
/// forces of all point to.
std::optional<Found> ModeChoice::undetermined_rest(const std::vector<Choice>& list, const Instant& at) {
  std::vector<std::size_t> taken;
  const bool are_many = list.size() > undetermined_.most_that_hold();
  for (const Choice& c : list) {
    const bool is_contact = c.contact < problem_.system.contacts.size();
    const auto rests = std::find_if(c.options.begin(), c.options.end(), [&](const Choice::Option& o) {
      return o.closed == is_contact &&
             (o.state == FrictionState::Stick || (is_contact && o.state == FrictionState::None));
    });
    const bool may_stay = rests != c.options.end();  // others slide as they do
    const bool stays = may_stay && (!are_many || c.options.front().closed == is_contact);
    taken.push_back(stays ? static_cast<std::size_t>(rests - c.options.begin()) : 0);
  }
  Found out{choices_.mode_of(list, taken), {}, {}};
  return fits_by_given_forces(out, at) ? std::optional(out) : std::nullopt;
}

/// The mode in which all that has come to its limit gives way and all else stays: forces go on in it, or a rest ends in
/// it that was not determined, so that it is the one where no more than one fits. Of many contacts that the motion does
/// not need it is far from what their forces together point to. Those that carried nothing at the end of a rest that
/// was not determined open.
std::optional<Found> ModeChoice::mode_that_goes_on(const Instant& at) {
  const ContactValues& values = here_.values();
  const bool ends_rest = motions_.now().given.is_preload;
  Found out{motions_.now().mode, {}, {}};
  if (at.met.left.size() < 2 || problem_.in_space) return std::nullopt;
  if (ends_rest) open_idle(out.mode);
  for (const Watch& w : at.met.left) {
    if (w.what == Watch::What::Hold)
      out.mode.friction[w.index] = w.lower ? FrictionState::Forward : FrictionState::Backward;
    if (w.what == Watch::What::Force) out.mode.closed[w.index] = false;
  }
  for (std::size_t i = 0; i < out.mode.closed.size(); ++i)
    if (!out.mode.closed[i]) out.mode.friction[i] = FrictionState::None;
  if ((!ends_rest && !trials_.changes_no_force(out.mode, at.met, values)) || may_be_several(out.mode, values))
    return std::nullopt;
  // A contact that a solution of dependent equations leaves without force needs not be closed, but may.
  const Leniency leniency = ends_rest ? Leniency::Forces : Leniency::None;
  // Where a rest ends that was not determined, kinetic friction may take the place of more static friction.
  const bool is_right =
      trials_.fits(out, at, leniency) && (ends_rest || trials_.accelerations_go_on(out.accelerations, at.met));
  return is_right ? std::optional(out) : std::nullopt;
}

/// Closed contacts with the forces that the rest was given here, 0 to rounding.
void ModeChoice::open_idle(ContactMode& mode) const {
  constexpr double idle = 1e-12;
  std::vector<double> forces;
  double largest = 0;
  for (std::size_t i = 0, k = 0; i < mode.closed.size(); ++i) {
    if (mode.closed[i]) forces.push_back(motions_.now().given.preload(k++, here_.t));
    if (mode.closed[i]) largest = std::max(largest, std::abs(forces.back()));
  }
  for (std::size_t i = 0, k = 0; i < mode.closed.size(); ++i)
    if (mode.closed[i]) mode.closed[i] = std::abs(forces[k++]) > idle * largest;
}

/// False where the forces are determined, where none hold the rest, or where another condition of the mode is broken.
bool ModeChoice::fits_by_given_forces(Found& found, const Instant& at) {
  if (!found.given.begins.empty()) return false;
  const auto ahead = undetermined_.rest_ahead(found.mode, at.bound);
  if (!ahead) return false;
  // A contact that presses by nothing yet has forces that begin with the power of time with which those of the system
  // do.
  for (int power = 1; power <= preload_degree; ++power) {
    auto given = undetermined_.preload_through(found.mode, *ahead, power, at.bound);
    if (!given) return false;
    found.given = std::move(*given);
    if (trials_.fits(found, at, Leniency::None)) return true;
  }
  return false;
}

/// What a mode does from here, where it fits.
std::optional<Found> ModeChoice::found_in(ContactMode mode, const Instant& at, Leniency leniency) {
  Found out{std::move(mode), {}, {}};
  trials_.forget_moved();
  std::optional<Given> given = slips_.directions_in(out.mode, at.bound);
  finds_no_directions_ = finds_no_directions_ || !given;
  if (!given) return std::nullopt;
  out.given = std::move(*given);
  const bool is_right =
      trials_.fits(out, at, leniency) || (leniency == Leniency::None && fits_by_given_forces(out, at));
  return is_right ? std::optional(std::move(out)) : std::nullopt;
}

/// The first of the modes that fits; another one too is a paradox. Nothing, and why, where there is none.
std::optional<Found> ModeChoice::search(const std::vector<Choice>& list, const Instant& at, std::string& reason) {
  const ContactValues& values = here_.values();
  std::vector<std::size_t> counts;
  for (const Choice& c : list) counts.push_back(c.options.size());
  Combinations tries(std::move(counts), most_choices);
  std::optional<Found> found, unforced;
  finds_no_directions_ = false;
  for (const auto& [leniency, most] : attempts_with(list.size())) {
    for (std::size_t turn = 0; turn < (found ? most_choices : most); ++turn) {
      const std::vector<std::size_t>* taken = tries.number(turn);
      if (!taken) break;
      if (problem_.interrupted()) return Found{motions_.now().mode, {}, {}};  // the step that follows says so
      const ContactMode mode = choices_.mode_of(list, *taken);
      auto next = found_in(mode, at, leniency);
      if (!next) {
        if (turn == 0 && trials_.moved_through_zero() && list.size() > 1) return std::nullopt;
        if (turn >= most_kept) motions_.forget(mode);
      } else if (gives_way_unforced(list, *next, at)) {
        if (!unforced) unforced = std::move(next);
      } else if (!found) {
        found = std::move(next);
        if (!may_be_several(found->mode, values)) return found;
      } else if (!equal_to_rounding(found->accelerations, next->accelerations)) {
        reason = two_fit(mode_text(problem_.system, found->mode), mode_text(problem_.system, next->mode));
        return std::nullopt;
      }
    }
    if (found) break;
  }
  if (!found) found = std::move(unforced);
  if (found) trials_.begin_again(*found, at);  // others were begun after it
  if (!found) reason = why_none_fits(list, at, tries.number(most_choices - 1) != nullptr);
  return found;
}

/// Friction at rest whose static coefficient, or limit, is more than the kinetic one: where it holds another motion
/// fits as well, in which it slides.
bool ModeChoice::may_hold(const Choice& c) const {
  const ContactValues& values = here_.values();
  return c.options.size() > 2 && values.fixed[c.contact] > values.kinetic[c.contact];
}

/// Friction gives way where it comes to its own limit. Whether one begins to slide in this mode that would hold below
/// it beside all else as it is there: the one that has to give way is another.
bool ModeChoice::gives_way_unforced(const std::vector<Choice>& list, const Found& found, const Instant& at) {
  bool unforced = false, asked = false;
  for (const Choice& c : list) {
    const FrictionState state = found.mode.friction[c.contact];
    const bool begins = state == FrictionState::Forward || state == FrictionState::Backward;
    if (!begins || !may_hold(c) || at.met.comes_to_limit(c.contact)) continue;
    Found held{found.mode, {}, {}};
    held.mode.friction[c.contact] = FrictionState::Stick;
    const std::optional<Given> given = slips_.directions_in(held.mode, at.bound);
    if (!given) continue;
    held.given = *given;
    asked = true;
    const auto beyond = trials_.beyond_limits(held, at);
    unforced = beyond && std::find(beyond->begin(), beyond->end(), c.contact) == beyond->end();
    if (unforced) break;
  }
  if (asked && !unforced) {  // another mode was begun after it
    Found again = found;
    trials_.begin_again(again, at);
  }
  return unforced;
}

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
bool ModeChoice::may_be_several(const ContactMode& mode, const ContactValues& values) const {
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    const auto response = slips_.own_response(i, mode, values);
    if (response && !(response->with_friction > 0)) return true;
  }
  return false;
}

/// Pairs of frictions of which the first begins to slide, below its own limit or where both have come to theirs, and
/// the second is held, where one of the two has more static than kinetic friction.
ModeChoice::Pairs ModeChoice::exchangeable(const std::vector<Choice>& list, const ContactMode& mode,
                                           const Met& met) const {
  Pairs out;
  for (const Choice& slides : list) {
    const FrictionState state = mode.friction[slides.contact];
    const bool begins =
        slides.options.size() > 2 && (state == FrictionState::Forward || state == FrictionState::Backward);
    if (!begins) continue;
    for (const Choice& held : list) {
      if (met.comes_to_limit(slides.contact) && !met.comes_to_limit(held.contact)) continue;
      const bool holds = held.options.size() > 2 && mode.friction[held.contact] == FrictionState::Stick;
      if (holds && (may_hold(held) || may_hold(slides))) out.emplace_back(slides.contact, held.contact);
    }
  }
  return out;
}

/// Where one friction begins to slide and another is held, that the other way round would have done as well is told.
void ModeChoice::tell_choice(const std::vector<Choice>& list, Found& found, const Instant& at) {
  constexpr std::size_t most = 8;  // pairs that are looked at
  if (told_choice_ || !found.given.values.empty()) return;
  auto pairs = exchangeable(list, found.mode, at.met);
  pairs.resize(std::min(pairs.size(), most));
  const std::vector<bool> released = trials_.released();
  for (const auto& [slides, held] : pairs)
    for (const FrictionState way : {FrictionState::Forward, FrictionState::Backward}) {
      Found other{found.mode, {}, {}};
      other.mode.friction[slides] = FrictionState::Stick;
      other.mode.friction[held] = way;
      if (told_choice_ || !trials_.fits(other, at, Leniency::None)) continue;
      if (gives_way_unforced(list, other, at)) continue;
      told_choice_ = true;
      journal_.remark(choice_sentence(problem_.label_of(held), problem_.label_of(slides), here_.t));
    }
  trials_.set_released(released);
  if (!pairs.empty()) trials_.begin_again(found, at);  // others were begun after it
}

}  // namespace maupertuis::hybrid

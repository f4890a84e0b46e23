#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "linear_algebra/combinations.hpp"
#include "simulation/hybrid_parts.hpp"
#include "simulation/mode_remarks.hpp"
/// The motions of modes, what they watch, and which mode follows an instant.

namespace maupertuis {

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

}  // namespace

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
bool HybridMotion::may_be_several(const ContactMode& mode, const ContactValues& values) {
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i] || mode.friction[i] == FrictionState::None || mode.friction[i] == FrictionState::Stick)
      continue;
    const double sign = mode.friction[i] == FrictionState::Backward ? -1 : 1;
    const SparseRow summed = mode.friction[i] == FrictionState::Slide
                                 ? slips_.sliding_force(i, values)
                                 : sum_of(values.normal[i], values.tangent[i], -sign * values.kinetic[i]);
    const Eigen::MatrixXd response = here_.response({&summed, 1});
    if (!(dot(values.normal[i], response.col(0)) > 0)) return true;
  }
  return false;
}

/// Whether in one of the modes that are possible more normal force makes a contact close faster.
bool HybridMotion::may_be_painleve(const std::vector<Choice>& list, const ContactValues& values) {
  constexpr std::size_t most = 256;
  std::vector<std::size_t> counts;
  for (const Choice& c : list) counts.push_back(c.options.size());
  Combinations tries(std::move(counts), most);
  for (std::size_t turn = 0; turn < most; ++turn) {
    const std::vector<std::size_t>* taken = tries.number(turn);
    if (!taken) return false;
    if (may_be_several(choices_.mode_of(list, *taken), values)) return true;
  }
  return false;
}

/// In which order modes are tried, and how many of them. Of many contacts the one that the forces of all point to is
/// right as a rule, with rounding at a contact that neither presses nor opens: it and those that differ at one contact
/// come first with all leniencies.
std::vector<std::pair<HybridMotion::Leniency, std::size_t>> HybridMotion::attempts_with(std::size_t contacts) {
  constexpr std::size_t few = 4;
  std::vector<std::pair<Leniency, std::size_t>> out;
  out.reserve(6);
  for (const std::size_t most : {contacts > few ? contacts + 1 : 0, most_choices})
    for (const Leniency leniency : {Leniency::None, Leniency::Forces, Leniency::Gaps})
      if (most > 0) out.emplace_back(leniency, most);
  return out;
}

/// The first of the modes that fits; another one too is a paradox. Nothing, and why, where there is none.
std::optional<HybridMotion::Found> HybridMotion::search_mode(const std::vector<Choice>& list,
                                                             const std::vector<std::size_t>& touching, double bound,
                                                             std::string& reason) {
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
      Found next{choices_.mode_of(list, *taken), {}, {}};
      met_.reset();
      const std::optional<Given> given = slips_.directions_in(next.mode, bound);
      if (given) next.given = *given;
      finds_no_directions_ = finds_no_directions_ || !given;
      const bool is_right = given && (fits(next, touching, bound, leniency) ||
                                      (leniency == Leniency::None && fits_by_given_forces(next, touching, bound)));
      if (!is_right) {
        if (turn == 0 && met_ && list.size() > 1) return std::nullopt;
        if (turn >= most_kept) motions_.forget(next.mode);
        continue;
      }
      if (gives_way_unforced(list, next, touching, bound)) {
        if (!unforced) unforced = std::move(next);
        continue;
      }
      if (!found) {
        found = std::move(next);
        if (!may_be_several(found->mode, values)) break;
        continue;
      }
      if (equal_to_rounding(found->accelerations, next.accelerations)) continue;
      reason = fmt::format(
          "Painlevé's paradox: friction turns the contact force around here, and more than one motion fits: in the "
          "mode `{}` and in the mode `{}`. {}",
          mode_text(problem_.system, found->mode), mode_text(problem_.system, next.mode), beyond_painleve);
      return std::nullopt;
    }
    if (!found) continue;
    if (may_be_several(found->mode, values))  // others were begun after it
      static_cast<void>(fits(*found, touching, bound, Leniency::Gaps));
    return found;
  }
  if (unforced) {
    static_cast<void>(fits(*unforced, touching, bound, Leniency::Gaps));  // others were begun after it
    return unforced;
  }
  reason = why_none_fits(list, touching, values, tries.number(most_choices - 1) != nullptr);
  return std::nullopt;
}

/// Of frictions at rest those give way first that are at their limit, or beyond it where all rest; of the latter the
/// one that is written last, so that the first one is held where one can be.
void HybridMotion::order_by_limits(std::vector<Choice>& list, const std::vector<std::size_t>& touching, double bound) {
  std::vector<std::size_t> at_limit;
  for (const Watch& w : pending_->left)
    if (w.what == Watch::What::Hold) at_limit.push_back(w.index);
  const bool overcome = at_limit.empty();
  if (overcome && std::any_of(list.begin(), list.end(), [&](const Choice& c) { return may_hold(c); })) {
    Found rest{choices_.mode_of(list, std::vector<std::size_t>(list.size(), 0)), {}, {}};
    at_limit = beyond_limits(rest, touching, bound).value_or(at_limit);
  }
  const auto first = std::stable_partition(list.begin(), list.end(), [&](const Choice& c) {
    return std::find(at_limit.begin(), at_limit.end(), c.contact) != at_limit.end();
  });
  if (overcome) std::reverse(list.begin(), first);
}

/// Friction at rest whose static coefficient, or limit, is more than the kinetic one: where it holds another motion
/// fits as well, in which it slides.
bool HybridMotion::may_hold(const Choice& c) {
  const ContactValues& values = here_.values();
  return c.options.size() > 2 && values.fixed[c.contact] > values.kinetic[c.contact];
}

/// Friction gives way where it comes to its own limit. Whether one begins to slide in this mode that would hold below
/// it beside all else as it is there: the one that has to give way is another.
bool HybridMotion::gives_way_unforced(const std::vector<Choice>& list, const Found& found,
                                      const std::vector<std::size_t>& touching, double bound) {
  bool unforced = false, asked = false;
  for (const Choice& c : list) {
    const FrictionState state = found.mode.friction[c.contact];
    const bool begins = state == FrictionState::Forward || state == FrictionState::Backward;
    if (!begins || !may_hold(c) || pending_->comes_to_limit(c.contact)) continue;
    Found held{found.mode, {}, {}};
    held.mode.friction[c.contact] = FrictionState::Stick;
    const std::optional<Given> given = slips_.directions_in(held.mode, bound);
    if (!given) continue;
    held.given = *given;
    asked = true;
    const auto beyond = beyond_limits(held, touching, bound);
    unforced = beyond && std::find(beyond->begin(), beyond->end(), c.contact) == beyond->end();
    if (unforced) break;
  }
  if (asked && !unforced) {  // another mode was begun after it
    Found again = found;
    static_cast<void>(fits(again, touching, bound, Leniency::Gaps));
  }
  return unforced;
}

/// Pairs of frictions of which the first begins to slide, below its own limit or where both have come to theirs, and
/// the second is held, where one of the two has more static than kinetic friction.
std::vector<std::pair<std::size_t, std::size_t>> HybridMotion::exchangeable(const std::vector<Choice>& list,
                                                                            const ContactMode& mode) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (const Choice& slides : list) {
    const FrictionState state = mode.friction[slides.contact];
    const bool begins =
        slides.options.size() > 2 && (state == FrictionState::Forward || state == FrictionState::Backward);
    if (!begins) continue;
    for (const Choice& held : list) {
      if (pending_->comes_to_limit(slides.contact) && !pending_->comes_to_limit(held.contact)) continue;
      const bool holds = held.options.size() > 2 && mode.friction[held.contact] == FrictionState::Stick;
      if (holds && (may_hold(held) || may_hold(slides))) out.emplace_back(slides.contact, held.contact);
    }
  }
  return out;
}

/// Where one friction begins to slide and another is held, that the other way round would have done as well is told.
void HybridMotion::note_choice(const std::vector<Choice>& list, Found& found, const std::vector<std::size_t>& touching,
                               double bound) {
  constexpr std::size_t most = 8;  // pairs that are looked at
  if (told_choice_ || !found.given.values.empty()) return;
  auto pairs = exchangeable(list, found.mode);
  pairs.resize(std::min(pairs.size(), most));
  const std::vector<bool> released = released_;
  for (const auto& [slides, held] : pairs)
    for (const FrictionState way : {FrictionState::Forward, FrictionState::Backward}) {
      Found other{found.mode, {}, {}};
      other.mode.friction[slides] = FrictionState::Stick;
      other.mode.friction[held] = way;
      if (told_choice_ || !fits(other, touching, bound, Leniency::None)) continue;
      if (gives_way_unforced(list, other, touching, bound)) continue;
      told_choice_ = true;
      journal_.remark(choice_sentence(problem_.label_of(held), problem_.label_of(slides), here_.t));
    }
  released_ = released;
  if (!pairs.empty()) static_cast<void>(fits(found, touching, bound, Leniency::Gaps));  // others were begun after it
}

bool HybridMotion::choose_mode(const std::vector<std::size_t>& touching, double bound, std::string& reason) {
  const ContactValues& values = here_.values();  // of one point throughout
  if (!touching.empty() && !sizes_.knows_compliances()) {
    std::vector<SparseRow> rows;
    for (const std::size_t i : touching) rows.push_back(values.normal[i]);
    sizes_.note_compliances(touching, rows, here_.response(rows));
  }
  measure_forces(touching, values, bound);
  std::vector<Choice> list = choices_.at(touching, values, *pending_);
  if (list.size() > 1) order_by_forces(list, values, bound);
  if (list.size() > 1) order_by_limits(list, touching, bound);
  released_.assign(problem_.system.contacts.size(), false);
  for (const Watch& w : pending_->left)
    if (w.what == Watch::What::Force) released_[w.index] = true;
  std::optional<Found> found = undetermined_rest(list, touching, bound);
  if (!found) found = mode_that_goes_on(touching, bound);
  if (!found) found = search_mode(list, touching, bound, reason);
  if (!found) return false;
  if (problem_.interrupted()) return true;
  note_choice(list, *found, touching, bound);
  sizes_.note_accelerations(found->accelerations, values);  // those of modes that do not fit are no measure
  for (std::size_t i = 0; i < released_.size(); ++i)
    if (released_[i] && !found->mode.closed[i]) released_at_[i] = here_.t;
  note_indeterminate(list, found->mode, values);
  const bool rest_ends =
      motions_.now().given.is_preload && !found->given.is_preload && pending_->hit.empty() && pending_->sets.empty();
  const std::size_t first = journal_.size();
  const ContactMode before = motions_.now().mode;
  motions_.go_on_in(found->mode, found->given);
  if (started_)
    journal_.change_mode(before, found->mode, found->accelerations, end_of_bounces_);
  else
    journal_.begin_in(before, found->mode, found->accelerations);
  if (rest_ends) journal_.note_end_of_rest(first);
  return true;
}

}  // namespace maupertuis

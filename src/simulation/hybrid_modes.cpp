#include "linear_algebra/combinations.hpp"
#include "simulation/hybrid_parts.hpp"
#include "simulation/mode_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// The motions of modes, what they watch, and which mode follows an instant.
namespace maupertuis {
namespace {

constexpr std::size_t most_modes = 128;  // whose motions are kept
constexpr std::size_t most_kept = 32;    // motions of modes that were tried in vain at an instant

bool equal_to_rounding(const std::vector<double>& a, const std::vector<double>& b) {
  double off = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    off = std::max(off, std::abs(a[i] - b[i]));
    size = std::max({size, std::abs(a[i]), std::abs(b[i])});
  }
  return off <= 1e-9 * size;
}

}  // namespace

/// Recorded events end no step. Directions (keep_instants) have to know of gaps that are touched too.
void HybridMotion::treat_events(ModeMotion& motion) const {
  std::vector<TaylorStepper::EventTreatment> treatments;
  for (const Watch& w : motion.watches()) {
    const bool is_recorded =
        w.what == Watch::What::Event && model_.experiment.events[w.index].action == ModelEvent::Action::Record;
    treatments.push_back({!is_recorded, w.touches_count() || derivative_});
  }
  motion.stepper->treat_events(treatments);
}

/// A heap goes through thousands of modes: those that were last asked for stay.
void HybridMotion::forget_oldest() {
  if (modes_.size() <= most_modes) return;
  const auto older = [this](const auto& a, const auto& b) {
    if ((a.second.get() == now_) != (b.second.get() == now_)) return b.second.get() == now_;
    return a.second->asked_for < b.second->asked_for;
  };
  modes_.erase(std::min_element(modes_.begin(), modes_.end(), older));
}

/// [contacts] the speeds at which slips in space count as stopped.
std::vector<double> HybridMotion::stops() {
  std::vector<double> out;
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) out.push_back(stop_slip(i));
  return out;
}

HybridMotion::ModeMotion& HybridMotion::motion_in(const ContactMode& mode) { return motion_in(mode, {}); }

/// Of what is given there is another motion each time.
HybridMotion::ModeMotion& HybridMotion::motion_in(const ContactMode& mode, const Given& given) {
  const ModeDetails details{in_space_ ? stops() : std::vector<double>(), given.is_preload, given.begins};
  std::string key = key_of(mode, details);
  const auto known = modes_.find(key);
  if (!given.values.empty() && known != modes_.end() && known->second.get() == now_) key += " again";
  std::unique_ptr<ModeMotion>& slot = modes_[key];
  ++asked_for_;
  if (slot && slot->given == given) {
    slot->asked_for = asked_for_;
    return *slot;
  }
  auto made = std::make_unique<ModeMotion>();
  made->mode = mode;
  made->given = given;
  made->stops = details.stops;
  made->asked_for = asked_for_;
  made->program = library_->program(mode, details);
  std::vector<double> parameters = parameters_;
  parameters.insert(parameters.end(), given.values.begin(), given.values.end());
  TaylorOptions options = options_;
  if (std::find(mode.friction.begin(), mode.friction.end(), FrictionState::Slide) != mode.friction.end())
    options.order = order_beside_stops();
  made->stepper = std::make_unique<TaylorStepper>(made->program->kernel, parameters, options);
  treat_events(*made);
  slot = std::move(made);
  ModeMotion& out = *slot;
  forget_oldest();
  return out;
}

namespace {

FrictionState sliding_state(double slip, double rest) {
  return slip > rest ? FrictionState::Forward : slip < -rest ? FrictionState::Backward : FrictionState::None;
}

}  // namespace

/// Whether a contact has friction: with a coefficient that is 0 throughout it is smooth, and holds no rest.
bool HybridMotion::rubs(std::size_t i, const ContactValues& values) const {
  const Friction& f = system_.contacts[i].friction;
  return f.present() && (f.sticking || !keeps_friction_[i] || values.fixed[i] != 0 || values.kinetic[i] != 0);
}

/// What a contact that touches and does not open may do.
HybridMotion::Choice HybridMotion::choice_of_contact(std::size_t i, const ContactValues& values) const {
  Choice choice{i, {}};
  const Friction& f = system_.contacts[i].friction;
  const bool rubs = this->rubs(i, values);
  const FrictionState sliding = rubs ? sliding_state(values.slip[i], sizes_.rest_slip(i, values)) : FrictionState::None;
  if (!rubs)
    choice.options = {{true, FrictionState::None, 1}};
  else if (f.in_space() && !f.sticking)
    choice.options = {{true, slides_in_space(i, values) ? FrictionState::Slide : FrictionState::Stick, 1}};
  else if (f.sticking)
    choice.options = {{true, FrictionState::Stick, 1}};
  else if (sliding != FrictionState::None)
    choice.options = {{true, sliding, 1}};
  else
    choice.options = {
        {true, FrictionState::Stick, 1}, {true, FrictionState::Forward, 1}, {true, FrictionState::Backward, 1}};
  const HybridOption open{false, FrictionState::None, 1};
  const bool lets_go = std::any_of(pending_->left.begin(), pending_->left.end(),
                                   [&](const Watch& w) { return w.what == Watch::What::Force && w.index == i; });
  choice.options.insert(lets_go ? choice.options.begin() : choice.options.end(), open);
  return choice;
}

std::vector<HybridMotion::Choice> HybridMotion::choices(const std::vector<std::size_t>& touching,
                                                        const ContactValues& values) const {
  std::vector<Choice> out;
  for (const std::size_t i : touching)
    if (!(values.rate[i] > sizes_.rest_speed(i, values))) out.push_back(choice_of_contact(i, values));
  const std::size_t contacts = system_.contacts.size();
  for (std::size_t i = contacts; i < contacts + system_.frictions.size(); ++i) {
    Choice choice{i, {}};
    const bool signs = has_multipliers(system_.frictions[i - contacts].normal);
    const FrictionState sliding = sliding_state(values.slip[i], sizes_.rest_slip(i, values));
    for (const std::int8_t sign : {std::int8_t{1}, std::int8_t{-1}}) {
      if (sign < 0 && !signs) continue;
      if (sliding != FrictionState::None)
        choice.options.push_back({false, sliding, sign});
      else
        for (const FrictionState s : {FrictionState::Stick, FrictionState::Forward, FrictionState::Backward})
          choice.options.push_back({false, s, sign});
    }
    out.push_back(std::move(choice));
  }
  return out;
}

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
bool HybridMotion::may_be_several(const ContactMode& mode, const ContactValues& values) {
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i] || mode.friction[i] == FrictionState::None || mode.friction[i] == FrictionState::Stick)
      continue;
    const double sign = mode.friction[i] == FrictionState::Backward ? -1 : 1;
    const SparseRow summed = mode.friction[i] == FrictionState::Slide
                                 ? sliding_force(i, values)
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
    if (may_be_several(mode_of(list, *taken), values)) return true;
  }
  return false;
}

ContactMode HybridMotion::mode_of(const std::vector<Choice>& list, const std::vector<std::size_t>& taken) const {
  ContactMode mode = open_mode(system_);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const HybridOption& option = list[k].options[taken[k]];
    if (list[k].contact < mode.closed.size())
      mode.closed[list[k].contact] = option.closed;
    else
      mode.normal_sign[list[k].contact - mode.closed.size()] = option.normal_sign;
    mode.friction[list[k].contact] = option.state;
  }
  return mode;
}

bool HybridMotion::interrupted() const {
  return options_.interrupt && options_.interrupt->load(std::memory_order_relaxed);
}

/// A motion of a mode that did not fit makes room.
void HybridMotion::forget(const ContactMode& mode) {
  std::erase_if(modes_, [&](const auto& entry) { return entry.second->mode == mode && entry.second.get() != now_; });
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
      if (interrupted()) return Found{now_->mode, {}, {}};  // the step that follows says so
      Found next{mode_of(list, *taken), {}, {}};
      met_.reset();
      const std::optional<Given> given = given_in(next.mode, bound);
      if (given) next.given = *given;
      finds_no_directions_ = finds_no_directions_ || !given;
      const bool is_right = given && (fits(next, touching, bound, leniency) ||
                                      (leniency == Leniency::None && fits_by_given_forces(next, touching, bound)));
      if (!is_right) {
        if (turn == 0 && met_ && list.size() > 1) return std::nullopt;
        if (turn >= most_kept) forget(next.mode);
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
          mode_text(system_, found->mode), mode_text(system_, next.mode), beyond_painleve);
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
    Found rest{mode_of(list, std::vector<std::size_t>(list.size(), 0)), {}, {}};
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
    if (!begins || !may_hold(c) || comes_to_limit(c.contact)) continue;
    Found held{found.mode, {}, {}};
    held.mode.friction[c.contact] = FrictionState::Stick;
    const std::optional<Given> given = given_in(held.mode, bound);
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

/// Whether a friction that holds comes to its limit at this instant.
bool HybridMotion::comes_to_limit(std::size_t friction) const {
  return std::any_of(pending_->left.begin(), pending_->left.end(),
                     [&](const Watch& w) { return w.what == Watch::What::Hold && w.index == friction; });
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
      if (comes_to_limit(slides.contact) && !comes_to_limit(held.contact)) continue;
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
      remark(choice_sentence(label_of(held), label_of(slides), here_.t));
    }
  released_ = released;
  if (!pairs.empty()) static_cast<void>(fits(found, touching, bound, Leniency::Gaps));  // others were begun after it
}

bool HybridMotion::choose_mode(const std::vector<std::size_t>& touching, double bound, std::string& reason) {
  const ContactValues& values = here_.values();  // of one point throughout
  if (!touching.empty() && !knows_compliance_) note_compliance(touching, values);
  measure_forces(touching, values, bound);
  std::vector<Choice> list = choices(touching, values);
  if (list.size() > 1) order_by_forces(list, values, bound);
  if (list.size() > 1) order_by_limits(list, touching, bound);
  released_.assign(system_.contacts.size(), false);
  for (const Watch& w : pending_->left)
    if (w.what == Watch::What::Force) released_[w.index] = true;
  std::optional<Found> found = undetermined_rest(list, touching, bound);
  if (!found) found = mode_that_goes_on(touching, bound);
  if (!found) found = search_mode(list, touching, bound, reason);
  if (!found) return false;
  if (interrupted()) return true;
  note_choice(list, *found, touching, bound);
  sizes_.note_accelerations(found->accelerations, values);  // those of modes that do not fit are no measure
  for (std::size_t i = 0; i < released_.size(); ++i)
    if (released_[i] && !found->mode.closed[i]) released_at_[i] = here_.t;
  note_indeterminate(list, found->mode, values);
  const bool rest_ends =
      now_->given.is_preload && !found->given.is_preload && pending_->hit.empty() && pending_->sets.empty();
  const std::size_t first = record_.happenings.size();
  const ContactMode before = now_->mode;
  now_ = &motion_in(found->mode, found->given);
  record_changes(before, found->mode, found->accelerations);
  if (rest_ends) note_end_of_rest(first);
  return true;
}

}  // namespace maupertuis

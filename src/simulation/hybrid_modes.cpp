#include "linear_algebra/combinations.hpp"
#include "simulation/hybrid_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// The motions of modes, what they watch, and which mode follows an instant.
namespace maupertuis {
namespace {

constexpr double rounding_of_forces = 1e-13;  // of the terms of g̈
constexpr std::size_t most_choices = 1024;    // modes that are tried
constexpr std::size_t most_modes = 128;       // whose motions are kept
constexpr std::size_t most_kept = 32;         // motions of modes that were tried in vain at an instant

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
std::vector<double> HybridMotion::stops() const {
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
  made->asked_for = asked_for_;
  made->program = library_->program(mode, details);
  std::vector<double> parameters = parameters_;
  parameters.insert(parameters.end(), given.values.begin(), given.values.end());
  made->stepper = std::make_unique<TaylorStepper>(made->program->kernel, parameters, options_);
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

/// What a contact that touches and does not open may do.
HybridMotion::Choice HybridMotion::choice_of_contact(std::size_t i, const ContactValues& values) const {
  Choice choice{i, {}};
  const Friction& f = system_.contacts[i].friction;
  const FrictionState sliding = f.present() ? sliding_state(values.slip[i], rest_slip(i, values)) : FrictionState::None;
  if (!f.present())
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
    if (!(values.rate[i] > rest_speed(i, values))) out.push_back(choice_of_contact(i, values));
  const std::size_t contacts = system_.contacts.size();
  for (std::size_t i = contacts; i < contacts + system_.frictions.size(); ++i) {
    Choice choice{i, {}};
    const bool signs = has_multipliers(system_.frictions[i - contacts].normal);
    const FrictionState sliding = sliding_state(values.slip[i], rest_slip(i, values));
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

/// Whether what a condition does over the length that is judged is lost in rounding.
bool HybridMotion::vanishes(const Watch& watch, double size, const ContactValues& values) const {
  constexpr double digits = 1e-12;
  if (watch.what == Watch::What::Gap) return size <= digits * size_of_gap(watch.index, values);
  if (watch.what == Watch::What::Force) return size <= digits * hardest_[watch.index];
  return false;
}

/// Whether these accelerations close the gap of a contact beyond so many digits of the terms of g̈.
bool HybridMotion::presses_again(std::size_t contact, std::span<const double> accelerations,
                                 const ContactValues& values, double digits) {
  double sum = functions_.drifts(t_, q_, v_)[contact], size = std::abs(sum);
  for (const auto& [k, g] : values.normal[contact]) {
    sum += g * accelerations[k];
    size += std::abs(g) * acceleration_[kind_[k]];
  }
  return sum < -digits * size;
}

/// A friction that gives way as its force comes to the limit, with μ_s = μ, lets go without a jump where nothing else
/// happens: its slip, against that force, begins with the second power of time, whatever rounding makes of the first.
///
///     λ_t = −μ_s N: it slides forwards        λ_t = μ_s N: it slides backwards
bool HybridMotion::begins_slowly(const Watch& slip, FrictionState way, const ContactValues& values) const {
  const bool forwards = way == FrictionState::Forward;
  const bool gives_way = std::all_of(pending_->left.begin(), pending_->left.end(), [&](const Watch& x) {
    return x.what == Watch::What::Hold && x.index == slip.index && x.lower == forwards;
  });
  return gives_way && !pending_->left.empty() && pending_->hit.empty() && pending_->sets.empty() &&
         !friction_of(system_, slip.index).in_space() && values.fixed[slip.index] == values.kinetic[slip.index];
}

/// A rest whose forces are not determined ends when none are left to 10⁻¹⁴ of the limits: slips whose acceleration is
/// less than that leaves open begin with the second power of time too.
bool HybridMotion::has_slow_slips(ModeMotion& motion, const std::vector<std::size_t>& at_zero,
                                  const TaylorStepper::Outlook& outlook, const ContactValues& values) const {
  constexpr double slow = 1e-9;
  bool has_some = false;
  for (const std::size_t k : at_zero) {
    const Watch& w = motion.watches()[k];
    if (w.what != Watch::What::Slip || values.fixed[w.index] != values.kinetic[w.index]) continue;
    double acceleration = 0;
    for (const auto& [i, x] : values.tangent[w.index]) acceleration += std::abs(x) * acceleration_[kind_[i]];
    if (std::abs(outlook.slopes[k]) > slow * acceleration) continue;
    motion.stepper->put_at_zero({&k, 1}, 2);
    has_some = true;
  }
  return has_some;
}

/// Whether the motion in a mode keeps its conditions: gaps that do not close, forces that press, friction that holds
/// or opposes. A condition that is 0 here counts by the first of its derivatives that is not. Lenient: what is violated
/// at once is 0 here to rounding.
bool HybridMotion::fits(Found& found, const std::vector<std::size_t>& touching, double bound, Leniency leniency) {
  const bool lenient = leniency != Leniency::None;
  const ContactMode& mode = found.mode;
  const Given& given = found.given;
  ModeMotion& motion = motion_in(mode, given);
  TaylorStepper& s = *motion.stepper;
  s.start(t_, q_, v_, t_rest_);
  const ContactValues& values = functions_.at(t_, q_, v_);
  std::vector<std::size_t> at_zero;
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    const Watch& w = motion.watches()[k];
    const bool left = std::any_of(pending_->left.begin(), pending_->left.end(), [&](const Watch& x) {
      return x.what == w.what && x.index == w.index && x.lower == w.lower;
    });
    // A gap that opens and is not negative begins as it is: next to rounding, but with the way that it has.
    const bool opens =
        w.what == Watch::What::Gap && values.gap[w.index] > 0 && values.rate[w.index] > rest_speed(w.index, values);
    const bool touches =
        w.what == Watch::What::Gap && !opens && std::find(touching.begin(), touching.end(), w.index) != touching.end();
    const bool starts_to_slide = w.what == Watch::What::Slip && !friction_of(system_, w.index).in_space() &&
                                 std::abs(values.slip[w.index]) <= rest_slip(w.index, values);
    // A motion that is thrown back from the zero of an event has not passed it, whatever rounding makes of it.
    const bool is_met = w.what == Watch::What::Event && std::find(pending_->at_zero.begin(), pending_->at_zero.end(),
                                                                  w.index) != pending_->at_zero.end();
    const bool is_located_force =
        left && !given.is_preload &&
        (w.what == Watch::What::Force || w.what == Watch::What::Hold || w.what == Watch::What::Normal);
    if (touches || starts_to_slide || is_met || is_located_force) at_zero.push_back(k);
  }
  s.put_at_zero(at_zero);
  // A gap whose rate is rounding begins with the second power of time.
  for (const std::size_t k : at_zero) {
    const Watch& w = motion.watches()[k];
    if (w.what == Watch::What::Gap && std::abs(values.rate[w.index]) <= rest_speed(w.index, values))
      s.put_at_zero({&k, 1}, 2);
    if (w.what == Watch::What::Slip && begins_slowly(w, mode.friction[w.index], values)) s.put_at_zero({&k, 1}, 2);
  }
  // λ falls through 0, and so does g̈ rise from it: the gap begins with the third power of time.
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if (motion.watches()[k].what == Watch::What::Gap && released_[motion.watches()[k].index]) s.put_at_zero({&k, 1}, 3);
  std::vector<double> places, speeds;
  for (const std::size_t k : kind_) places.push_back(place_[k]), speeds.push_back(speed_[k]);
  s.set_usual_sizes(places, speeds);
  TaylorStepper::Outlook outlook = s.outlook(bound);
  if (outlook.ending != StepEnding::None) return false;
  if (now_->given.is_preload && !given.is_preload && has_slow_slips(motion, at_zero, outlook, values))
    outlook = s.outlook(bound);
  constexpr double located = 1e-11;
  constexpr double met = 1e-9;  // heights at which bounces have ended
  const auto touches_now = [&](std::size_t i) {
    return std::find(touching.begin(), touching.end(), i) != touching.end();
  };
  found.accelerations = outlook.accelerations;
  double largest_force = 0;
  const auto is_squared = [&](const Watch& w) {
    return w.what == Watch::What::Hold && friction_of(system_, w.index).in_space();
  };
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if (motion.watches()[k].what == Watch::What::Force || motion.watches()[k].what == Watch::What::Hold)
      largest_force = std::max(largest_force, is_squared(motion.watches()[k]) ? std::sqrt(std::abs(outlook.values[k]))
                                                                              : std::abs(outlook.values[k]));
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    const Watch& w = motion.watches()[k];
    if (!w.keeps_sign()) continue;
    const bool zero = std::find(at_zero.begin(), at_zero.end(), k) != at_zero.end();
    const bool must_move = w.what == Watch::What::Slip && zero;
    if (must_move && is_held(w.index, mode, values)) return false;
    const bool lost = vanishes(w, outlook.reach[k], values);
    if (w.what == Watch::What::Gap && lost) continue;
    if (w.what == Watch::What::Gap && released_[w.index]) {
      if (presses_again(w.index, outlook.accelerations, values, located_force)) return false;
      continue;
    }
    if (w.what == Watch::What::Force && lost && !lenient) return false;  // what does not press needs not be closed
    if (w.what == Watch::What::Force && std::abs(outlook.values[k]) <= located * hardest_[w.index]) {
      // λ was located to rounding of the time alone: what it does next counts, and where it falls the contact opens
      // whatever rounding makes of its gap.
      if (outlook.slopes[k] >= 0) continue;
      released_[w.index] = true;
      return false;
    }
    // Meeting the constraints of others may move a gap that opens through zero, by what they are known to.
    const bool is_moved =
        w.what == Watch::What::Gap && outlook.sides[k] < 0 && -outlook.values[k] <= met * widest_[w.index];
    if (is_moved && outlook.slopes[k] > rest_speed(w.index, values)) {
      s.put_at_zero({&k, 1});
      continue;
    }
    // One that closes is hit now: it is as near as constraints are known, but not among those that touch.
    if (is_moved && !touches_now(w.index) && values.rate[w.index] < -rest_speed(w.index, values) &&
        values.gap[w.index] <= met * widest_[w.index])
      met_ = w.index;
    const bool begins = w.what == Watch::What::Slip && friction_of(system_, w.index).in_space() &&
                        w.index < begins_to_slide_.size() && begins_to_slide_[w.index];
    if (begins) continue;  // it has not yet the speed at which it counts as stopped
    const bool wrong = outlook.sides[k] < 0 || (must_move && outlook.sides[k] == 0);
    if (!wrong) continue;
    const bool is_force = w.what == Watch::What::Force || w.what == Watch::What::Hold;
    const double size_of_force = is_squared(w) ? largest_force * largest_force : largest_force;
    const bool rests = leniency == Leniency::Gaps && w.what == Watch::What::Gap && zero &&
                       std::abs(values.rate[w.index]) <= rest_speed(w.index, values) &&
                       !presses_again(w.index, outlook.accelerations, values, rounding_of_forces);
    const bool rounding = rests || (is_force && std::abs(outlook.values[k]) <= 1e-12 * size_of_force) ||
                          (is_force && std::abs(outlook.values[k]) < 1e-280);
    if (!lenient || !rounding || must_move) return false;
  }
  return true;
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
    const Eigen::MatrixXd response = functions_.response(t_, q_, v_, {&summed, 1});
    if (!(dot(values.normal[i], response.col(0)) > 0)) return true;
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
  for (const std::size_t most : {contacts > few ? contacts + 1 : 0, most_choices})
    for (const Leniency leniency : {Leniency::None, Leniency::Forces, Leniency::Gaps})
      if (most > 0) out.emplace_back(leniency, most);
  return out;
}

/// The first of the modes that fits; another one too is a paradox. Nothing, and why, where there is none.
std::optional<HybridMotion::Found> HybridMotion::search_mode(const std::vector<Choice>& list,
                                                             const std::vector<std::size_t>& touching, double bound,
                                                             std::string& reason) {
  const ContactValues& values = functions_.at(t_, q_, v_);
  std::vector<std::size_t> counts;
  for (const Choice& c : list) counts.push_back(c.options.size());
  Combinations tries(std::move(counts), most_choices);
  std::optional<Found> found;
  for (const auto& [leniency, most] : attempts_with(list.size())) {
    for (std::size_t turn = 0; turn < (found ? most_choices : most); ++turn) {
      const std::vector<std::size_t>* taken = tries.number(turn);
      if (!taken) break;
      if (interrupted()) return Found{now_->mode, {}, {}};  // the step that follows says so
      Found next{mode_of(list, *taken), {}, {}};
      met_.reset();
      const std::optional<Given> given = given_in(next.mode, bound);
      if (given) next.given = *given;
      if (!given || !fits(next, touching, bound, leniency)) {
        if (turn == 0 && met_ && list.size() > 1) return std::nullopt;
        if (turn >= most_kept) forget(next.mode);
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
          "mode `{}` and in the mode `{}`.",
          mode_text(system_, found->mode), mode_text(system_, next.mode));
      return std::nullopt;
    }
    if (!found) continue;
    if (may_be_several(found->mode, values))  // others were begun after it
      static_cast<void>(fits(*found, touching, bound, Leniency::Gaps));
    return found;
  }
  const bool rubs = std::any_of(list.begin(), list.end(), [](const Choice& c) { return c.options.size() > 2; }) ||
                    std::any_of(touching.begin(), touching.end(),
                                [&](std::size_t i) { return system_.contacts[i].friction.present(); });
  reason = rubs ? "Painlevé's paradox: no finite forces of contact and friction fit the motion here."
           : tries.number(most_choices - 1)
               ? fmt::format("None of the {} modes that were tried fits the contacts that touch here.", most_choices)
               : "No forces keep all contacts that touch here from closing.";
  return std::nullopt;
}

bool HybridMotion::choose_mode(const std::vector<std::size_t>& touching, double bound, std::string& reason) {
  const ContactValues& values = functions_.at(t_, q_, v_);  // of one point throughout
  if (!touching.empty() && !knows_compliance_) note_compliance(touching, values);
  std::vector<Choice> list = choices(touching, values);
  if (list.size() > 1) order_by_forces(list, values, bound);
  released_.assign(system_.contacts.size(), false);
  for (const Watch& w : pending_->left)
    if (w.what == Watch::What::Force) released_[w.index] = true;
  if (Found free{open_mode(system_), {}, {}}; !started_) {  // what acts without contact is a first measure of forces
    static_cast<void>(fits(free, touching, bound, Leniency::Forces));
    if (!free.accelerations.empty()) note_accelerations(free.accelerations, values);
    std::fill(released_.begin(), released_.end(), false);
  }
  std::optional<Found> found = undetermined_rest(list, touching, bound);
  if (!found) found = search_mode(list, touching, bound, reason);
  if (!found) return false;
  if (interrupted()) return true;
  note_accelerations(found->accelerations, values);  // those of modes that do not fit are no measure
  for (std::size_t i = 0; i < released_.size(); ++i)
    if (released_[i] && !found->mode.closed[i]) released_at_[i] = t_;
  note_indeterminate(list, found->mode, values);
  const ContactMode before = now_->mode;
  now_ = &motion_in(found->mode, found->given);
  record_changes(before, found->mode);
  return true;
}

void HybridMotion::record_changes(const ContactMode& before, const ContactMode& after) {
  const std::string text = mode_text(system_, after);
  const std::size_t begin = record_.happenings.size();
  if (!started_) {
    record_.first_mode = text;
  } else {
    for (std::size_t i = 0; i < after.closed.size(); ++i) {
      const std::string label = system_.contact_label(i);
      if (after.closed[i] && !before.closed[i]) {
        add(Happening::Kind::Made, label, 0, 0, accumulated_.value_or(""));
        if (accumulated_) record_.happenings.back().t = accumulated_at_;
      }
      if (!after.closed[i] && before.closed[i]) add(Happening::Kind::Lost, label);
    }
    for (std::size_t i = 0; i < after.friction.size(); ++i) {
      const FrictionState now = after.friction[i];
      if (now == before.friction[i] || now == FrictionState::None) continue;
      const std::string label =
          i < after.closed.size() ? system_.contact_label(i) : system_.frictions[i - after.closed.size()].name;
      add(now == FrictionState::Stick ? Happening::Kind::Stick : Happening::Kind::Slip, label);
      const bool is_made_then = i < after.closed.size() && after.closed[i] && !before.closed[i];
      if (accumulated_ && is_made_then) record_.happenings.back().t = accumulated_at_;
    }
  }
  for (std::size_t k = record_.happenings.size(); k-- > 0;) {
    Happening& h = record_.happenings[k];
    if (k < begin && h.t != t_) break;
    h.mode = text;
  }
}

}  // namespace maupertuis

#include "simulation/hybrid_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis::hybrid {
namespace {

// Of the terms of g̈.
constexpr double located_force = 1e-9;  // what a located instant leaves of a force that falls through 0
constexpr double rounding_of_forces = 1e-13;

bool holds(const std::vector<std::size_t>& list, std::size_t x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

}  // namespace

void ModeTrials::start() {
  const std::size_t contacts = problem_.system.contacts.size();
  released_.assign(contacts, false);
  released_at_.assign(contacts, std::numeric_limits<double>::quiet_NaN());
  looks_at_forces_ = 0;
}

void ModeTrials::begin_instant(const Met& met) {
  released_.assign(released_.size(), false);
  for (const Watch& w : met.left)
    if (w.what == Watch::What::Force) released_[w.index] = true;
}

void ModeTrials::end_instant(const ContactMode& mode) {
  for (std::size_t i = 0; i < released_.size(); ++i)
    if (released_[i] && !mode.closed[i]) released_at_[i] = here_.t;
}

/// Whether what a condition does over the length that is judged is lost in rounding.
bool ModeTrials::vanishes(const Watch& watch, double size, const ContactValues& values) const {
  constexpr double digits = 1e-12;
  if (watch.what == Watch::What::Gap) return size <= digits * sizes_.gap(watch.index, values);
  if (watch.what == Watch::What::Force) return size <= digits * sizes_.hardest(watch.index);
  return false;
}

/// Whether these accelerations close the gap of a contact beyond so many digits of the terms of g̈.
bool ModeTrials::presses_again(std::size_t contact, std::span<const double> accelerations, double digits) const {
  return sizes_.opening_rate(contact, accelerations, here_) < -digits;
}

bool ModeTrials::changes_no_force(const ContactMode& mode, const Met& met, const ContactValues& values) const {
  const ContactMode& before = motions_.now().mode;
  if (met.left.empty() || met.changes_state()) return false;
  const auto opens = [&](std::size_t i) {
    return i < mode.closed.size() && before.closed[i] && !mode.closed[i] && met.ends({Watch::What::Force, i, false});
  };
  const auto gives_way = [&](std::size_t i) {
    const bool forwards = mode.friction[i] == FrictionState::Forward;
    return before.friction[i] == FrictionState::Stick && (forwards || mode.friction[i] == FrictionState::Backward) &&
           met.ends({Watch::What::Hold, i, forwards}) && values.fixed[i] == values.kinetic[i];
  };
  for (std::size_t i = 0; i < mode.closed.size(); ++i)
    if (mode.closed[i] != before.closed[i] && !opens(i)) return false;
  for (std::size_t i = 0; i < mode.friction.size(); ++i)
    if (mode.friction[i] != before.friction[i] && !gives_way(i) && !opens(i)) return false;
  return mode.normal_sign == before.normal_sign;
}

/// Friction that gives way where forces go on: its slip begins with the second power of time, whatever rounding makes
/// of the first.
bool ModeTrials::begins_slowly(const Watch& slip, const ContactMode& mode, const Met& met,
                               const ContactValues& values) const {
  const FrictionState before = motions_.now().mode.friction[slip.index];
  return before == FrictionState::Stick && !friction_of(problem_.system, slip.index).in_space() &&
         changes_no_force(mode, met, values);
}

bool ModeTrials::accelerations_go_on(std::span<const double> accelerations, const Met& met) const {
  if (met.begins || met.changes_state()) return false;
  const std::vector<double> before = motions_.stepper().sample(motions_.stepper().time()).a;
  for (std::size_t k = 0; k < before.size(); ++k)
    if (!(std::abs(accelerations[k] - before[k]) <= located_force * sizes_.acceleration(k))) return false;
  return true;
}

bool ModeTrials::is_just_released(std::size_t contact) const {
  constexpr double short_way = 1e-6, slow = 1e-9;
  const double since = std::abs(here_.t - released_at_[contact]);
  if (!(since * sizes_.fastest(contact) <= short_way * sizes_.widest(contact))) return false;
  const ContactValues& values = here_.values();
  if (!(std::abs(values.rate[contact]) <= slow * sizes_.fastest(contact))) return false;
  // Another change of contacts may have turned it back since.
  return !presses_again(contact, motions_.stepper().sample(motions_.stepper().time()).a, located_force);
}

/// A mode that is tried at an instant. A condition that is 0 there counts by the first of its derivatives that is not.
/// Lenient: what is violated at once is 0 there to rounding.
struct ModeTrials::Trial {
  ModeTrials& in;
  Found& found;
  const Instant& at;
  Leniency leniency;
  ModeMotion& motion;
  const ContactValues& values;
  std::vector<std::size_t> at_zero{};  // of the watches
  std::vector<std::size_t> jumped{};   // came to 0 here, but forces jump, and they with them
  Outlook outlook{};
  double largest_force = 0;

  const Watch& watch(std::size_t k) const { return motion.watches()[k]; }
  bool lenient() const { return leniency != Leniency::None; }
  bool begins_at_zero(const Watch& w) const;
  void begin();
  void put_at_zero();
  bool has_jumps();
  bool has_slow_slips();
  bool has_given_limits();
  bool has_slow_gaps();
  bool has_hidden_events();
  bool look();

  bool is_squared(const Watch& w) const {
    return w.what == Watch::What::Hold && friction_of(in.problem_.system, w.index).in_space();
  }
  bool is_rounding_of_forces(std::size_t k) const;
  bool keeps(std::size_t k);
  bool keeps_gap(std::size_t k);
  bool keeps_force(std::size_t k);
  bool keeps_slip(std::size_t k);
};

/// Whether a condition begins at 0, whatever rounding makes of it.
bool ModeTrials::Trial::begins_at_zero(const Watch& w) const {
  using What = Watch::What;
  const bool left = at.met.ends(w);
  switch (w.what) {
    case What::Gap: {
      // One that opens and is not negative begins as it is: next to rounding, but with the way that it has.
      const bool opens = values.gap[w.index] > 0 && values.rate[w.index] > in.sizes_.rest_speed(w.index, values);
      return !opens && holds(at.touching, w.index);
    }
    case What::Slip:
      return !friction_of(in.problem_.system, w.index).in_space() &&
             std::abs(values.slip[w.index]) <= in.sizes_.rest_slip(w.index, values);
    case What::Event: {  // a motion that is thrown back from its zero has not passed it
      const Zero* const zero = at.met.zero_of(w.index);
      return zero && !zero->moved;
    }
    case What::Force:
    case What::Hold:
    case What::Normal:
      return left && !found.given.is_preload;
    case What::Until:
      return false;
  }
  return false;
}

void ModeTrials::Trial::put_at_zero() {
  TaylorStepper& s = *motion.stepper;
  at_zero.clear();
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if (begins_at_zero(watch(k)) && !holds(jumped, k)) at_zero.push_back(k);
  s.put_at_zero(at_zero);
  for (const std::size_t k : at_zero) {
    const Watch& w = watch(k);
    if (w.what == Watch::What::Event) s.put_at_zero({&k, 1}, at.met.zero_of(w.index)->order);
    // A gap whose rate is rounding begins with the second power of time.
    if (w.what == Watch::What::Gap && std::abs(values.rate[w.index]) <= in.sizes_.rest_speed(w.index, values))
      s.put_at_zero({&k, 1}, 2);
    if (w.what == Watch::What::Slip && in.begins_slowly(w, found.mode, at.met, values)) s.put_at_zero({&k, 1}, 2);
  }
  // λ falls through 0, and so does g̈ rise from it: the gap begins with the third power of time.
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if (watch(k).what == Watch::What::Gap && in.released_[watch(k).index]) s.put_at_zero({&k, 1}, 3);
}

/// A force that has come to its limit is elsewhere in a mode in which others jump, as where kinetic friction takes the
/// place of more static friction.
bool ModeTrials::Trial::has_jumps() {
  double largest = 0;
  const auto is_force = [&](std::size_t k) {
    return watch(k).what == Watch::What::Force || watch(k).what == Watch::What::Hold;
  };
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    const double force = std::max(std::abs(outlook.values[k]), outlook.reach[k]);
    if (is_force(k)) largest = std::max(largest, is_squared(watch(k)) ? std::sqrt(force) : force);
  }
  for (const std::size_t k : at_zero) {
    const double size = is_squared(watch(k)) ? largest * largest : largest;
    if (is_force(k) && std::abs(outlook.values[k]) > located_force * size) jumped.push_back(k);
  }
  return !jumped.empty();
}

/// A rest whose forces are not determined ends when none are left to 10⁻¹² of the limits: slips whose acceleration is
/// less than that leaves open begin with the second power of time too.
bool ModeTrials::Trial::has_slow_slips() {
  constexpr double slow = 1e-9;
  if (!in.motions_.now().given.is_preload || found.given.is_preload) return false;
  bool has_some = false;
  for (const std::size_t k : at_zero) {
    const Watch& w = watch(k);
    if (w.what != Watch::What::Slip || values.fixed[w.index] != values.kinetic[w.index]) continue;
    if (std::abs(outlook.slopes[k]) > slow * in.sizes_.acceleration_along(values.tangent[w.index])) continue;
    motion.stepper->put_at_zero({&k, 1}, 2);
    has_some = true;
  }
  return has_some;
}

/// Forces that are given, and are at a limit to rounding, come from there: the first of their derivatives that is not
/// 0 tells which way. They are so where a contact presses by nothing yet.
bool ModeTrials::Trial::has_given_limits() {
  if (!found.given.is_preload) return false;
  std::vector<std::size_t> limits;
  for (std::size_t k = 0; k < motion.watches().size(); ++k)
    if ((watch(k).what == Watch::What::Force || watch(k).what == Watch::What::Hold) && is_rounding_of_forces(k))
      limits.push_back(k);
  motion.stepper->put_at_zero(limits);
  at_zero.insert(at_zero.end(), limits.begin(), limits.end());
  return !limits.empty();
}

/// Where accelerations go on, a gap that was kept closed begins with the third power of time: where a plate on many
/// legs begins to tip, those of legs that carried nothing too. Lenient: each gap whose acceleration is rounding does. A
/// wheel in a corner that a torque begins to turn goes through the wall by that, where the wall is open.
bool ModeTrials::Trial::has_slow_gaps() {
  const auto was_kept_closed = [&](std::size_t k) {
    const Watch& w = watch(k);
    return w.what == Watch::What::Gap && !(std::abs(values.rate[w.index]) > in.sizes_.rest_speed(w.index, values));
  };
  if (std::none_of(at_zero.begin(), at_zero.end(), was_kept_closed)) return false;
  if (leniency != Leniency::Gaps && !in.accelerations_go_on(outlook.accelerations, at.met)) return false;
  bool has_some = false;
  for (const std::size_t k : at_zero) {
    if (!was_kept_closed(k)) continue;
    const Watch& w = watch(k);
    const double opens = in.sizes_.opening_rate(w.index, outlook.accelerations, in.here_);
    if (leniency == Leniency::Gaps ? opens < -rounding_of_forces : std::abs(opens) > located_force) continue;
    motion.stepper->put_at_zero({&k, 1}, 3);
    has_some = true;
  }
  return has_some;
}

/// An event that is beyond its zero by rounding alone goes on from there: its slope tells whether the motion passes it.
/// So does one that is met here, where it is still 0 after what was set or hit.
bool ModeTrials::Trial::has_hidden_events() {
  bool has_some = false;
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    if (watch(k).what != Watch::What::Event) continue;
    const Zero* const zero = at.met.zero_of(watch(k).index);
    const bool stays = zero && zero->moved && in.events_.is_rounding(outlook, k);
    if (!stays && !in.events_.is_hidden(watch(k).index, outlook, k)) continue;
    motion.stepper->put_at_zero({&k, 1}, stays ? zero->order : std::uint8_t{1});
    has_some = true;
  }
  return has_some;
}

void ModeTrials::Trial::begin() {
  motion.stepper->start(in.here_.t, in.here_.q, in.here_.v, in.here_.t_rest);
  put_at_zero();
  if (motion.program->kernel.constraints() > 0) in.sizes_.tell(*motion.stepper);
}

/// False where there is no motion.
bool ModeTrials::Trial::look() {
  TaylorStepper& s = *motion.stepper;
  begin();
  outlook = s.outlook(at.bound);
  in.no_motion_ = outlook.reason;
  if (outlook.ending != StepEnding::None) return false;
  if (has_jumps()) {
    begin();
    outlook = s.outlook(at.bound);
    if (outlook.ending != StepEnding::None) return false;
  }
  for (std::size_t k = 0; k < motion.watches().size(); ++k) {
    const double force = std::abs(outlook.values[k]);
    if (watch(k).what == Watch::What::Force || watch(k).what == Watch::What::Hold)
      largest_force = std::max(largest_force, is_squared(watch(k)) ? std::sqrt(force) : force);
  }
  const bool slips = has_slow_slips(), forces = has_given_limits(), gaps = has_slow_gaps(),
             events = has_hidden_events();
  if (slips || forces || gaps || events) outlook = s.outlook(at.bound);
  found.accelerations = outlook.accelerations;
  return true;
}

bool ModeTrials::Trial::is_rounding_of_forces(std::size_t k) const {
  constexpr double digits = 1e-12;
  const double force = std::abs(outlook.values[k]);
  return force < 1e-280 || force <= digits * (is_squared(watch(k)) ? largest_force * largest_force : largest_force);
}

bool ModeTrials::Trial::keeps_gap(std::size_t k) {
  constexpr double met = 1e-9;  // heights at which bounces have ended
  const std::size_t i = watch(k).index;
  if (in.vanishes(watch(k), outlook.reach[k], values)) return true;
  if (in.released_[i]) return outlook.sides[k] >= 0 && !in.presses_again(i, outlook.accelerations, located_force);
  if (outlook.sides[k] >= 0) return true;
  // Meeting the constraints of others may move a gap that opens through zero, by what they are known to.
  const double rest = in.sizes_.rest_speed(i, values), reached = met * in.sizes_.widest(i);
  const bool is_moved = -outlook.values[k] <= reached;
  if (is_moved && outlook.slopes[k] > rest) {
    motion.stepper->put_at_zero({&k, 1});
    return true;
  }
  // One that closes is hit now: it is as near as constraints are known, but not among those that touch.
  if (is_moved && !holds(at.touching, i) && values.rate[i] < -rest && values.gap[i] <= reached)
    in.moved_through_zero_ = i;
  return false;
}

bool ModeTrials::Trial::keeps_force(std::size_t k) {
  constexpr double located = 1e-11;
  const std::size_t i = watch(k).index;
  // What does not press needs not be closed.
  if (!lenient() && in.vanishes(watch(k), outlook.reach[k], values)) return false;
  if (found.given.is_preload && holds(at_zero, k)) return outlook.sides[k] >= 0;
  // A body that hits a wall with an unstrained string behind it is pressed by nothing yet: beside what λ comes to,
  // rounding of the string is 0 too.
  const double comes_to = std::abs(outlook.slopes[k]) * outlook.length;
  if (std::abs(outlook.values[k]) <= located * std::max(in.sizes_.hardest(i), comes_to)) {
    // λ was located to rounding of the time alone: what it does next counts, and where it falls the contact opens
    // whatever rounding makes of its gap.
    if (outlook.slopes[k] >= 0) {
      if (outlook.values[k] < 0) motion.stepper->put_at_zero({&k, 1});
      return true;
    }
    in.released_[i] = true;
    return false;
  }
  return outlook.sides[k] >= 0 || (lenient() && is_rounding_of_forces(k));
}

/// From rest it goes the way that it is let go.
bool ModeTrials::Trial::keeps_slip(std::size_t k) {
  const std::size_t i = watch(k).index;
  if (holds(at_zero, k)) return outlook.sides[k] > 0 && !in.undetermined_.is_held(i, found.mode, values);
  // One that begins in space has not yet the speed at which it counts as stopped.
  if (friction_of(in.problem_.system, i).in_space() && (in.slips_.begins(i) || in.slips_.has_just_begun(i)))
    return true;
  return outlook.sides[k] >= 0;
}

bool ModeTrials::Trial::keeps(std::size_t k) {
  using What = Watch::What;
  switch (watch(k).what) {
    case What::Gap:
      return keeps_gap(k);
    case What::Force:
      return keeps_force(k);
    case What::Slip:
      return keeps_slip(k);
    case What::Hold:  // one that was located where it goes through 0 is over
      return outlook.sides[k] >= 0 || (lenient() && !holds(at_zero, k) && is_rounding_of_forces(k));
    case What::Normal:
      return outlook.sides[k] >= 0;
    case What::Until:
    case What::Event:
      return true;
  }
  return true;
}

bool ModeTrials::fits(Found& found, const Instant& at, Leniency leniency) {
  Trial trial{*this, found, at, leniency, motions_.in(found.mode, found.given), here_.values()};
  if (!trial.look()) return false;
  for (std::size_t k = 0; k < trial.motion.watches().size(); ++k)
    if (!trial.keeps(k)) return false;
  return true;
}

void ModeTrials::measure_forces(const Instant& at) {
  constexpr std::size_t looks = 16;
  const bool gives_way =
      std::any_of(at.met.left.begin(), at.met.left.end(), [](const Watch& w) { return w.what == Watch::What::Hold; });
  if (at.has_started && !(gives_way && looks_at_forces_++ < looks)) return;
  const ContactValues& values = here_.values();
  Found free{open_mode(problem_.system), {}, {}};
  std::fill(free.mode.friction.begin(), free.mode.friction.end(), FrictionState::None);
  Trial trial{*this, free, at, Leniency::Forces, motions_.in(free.mode), values};
  if (!trial.look()) return;
  sizes_.note_accelerations(free.accelerations, values);
  // At a start they may be 0, and what rests is to be measured by what they come to.
  TaylorStepper& stepper = *trial.motion.stepper;
  for (const double share : {0.5, 1.0}) {
    if (at.has_started) break;
    const double ahead = at.bound - here_.t;
    stepper.start(here_.t + std::copysign(share * trial.outlook.length, ahead), here_.q, here_.v);
    const Outlook later = stepper.outlook(at.bound + ahead);
    if (later.ending == StepEnding::None) sizes_.note_accelerations(later.accelerations, values);
  }
  sizes_.note_slip_rates(values);
}

std::optional<std::vector<std::size_t>> ModeTrials::beyond_limits(Found& found, const Instant& at) {
  Trial trial{*this, found, at, Leniency::None, motions_.in(found.mode, found.given), here_.values()};
  std::vector<std::size_t> out;
  if (!trial.look()) return std::nullopt;
  for (std::size_t k = 0; k < trial.motion.watches().size(); ++k)
    if (trial.watch(k).what == Watch::What::Hold && !trial.keeps(k)) out.push_back(trial.watch(k).index);
  return out;
}

}  // namespace maupertuis::hybrid

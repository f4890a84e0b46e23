#pragma once
#include "integrator/extended/modes.hpp"
#include "integrator/extended/stepper_code.hpp"

namespace maupertuis::extended {

namespace through_modes {

constexpr int roundings = 64;               // a value of so many rounding units of its terms is 0
constexpr int roundings_of_slips = 1024;    // the same of slips: impacts leave rates up to `roundings` unchanged
constexpr std::size_t most_at_once = 1000;  // changes at the same time
constexpr std::size_t most_choices = 1024;  // modes that are tried
constexpr std::size_t most_kept = 64;       // modes whose steppers are kept

constexpr const char* met_backwards =
    "Backwards in time the motion meets a change of contact here: what was before an impact or a stop does not follow "
    "from what is after it.";

constexpr const char* set_backwards =
    "Backwards in time the motion meets an event that sets the state here: what was before it does not follow from "
    "what "
    "is after it.";

inline std::string key_of(const ExtendedMode& mode) {
  std::string key;
  for (const bool closed : mode.closed) key += closed ? '1' : '0';
  for (const auto friction : mode.friction) key += static_cast<char>('a' + static_cast<int>(friction));
  for (const std::int8_t sign : mode.normal_sign) key += sign < 0 ? '-' : '+';
  for (const bool begins : mode.begins) key += begins ? 'b' : '.';
  for (const double stop : mode.stops) key += " " + std::to_string(std::log2(stop));
  return key;
}

inline bool holds(const std::vector<ExtendedWatch>& list, ExtendedWatch::What what, std::size_t index) {
  return std::any_of(list.begin(), list.end(),
                     [&](const ExtendedWatch& w) { return w.what == what && w.index == index; });
}

inline bool holds(const std::vector<std::size_t>& list, std::size_t index) {
  return std::find(list.begin(), list.end(), index) != list.end();
}

inline bool keeps_sign(const ExtendedWatch& w) {
  return w.what != ExtendedWatch::What::Until && w.what != ExtendedWatch::What::Event;
}

}  // namespace through_modes

template <class T>
Modes<T>::Modes(const ExtendedProblem& problem, const ExtendedOptions& options, std::span<const T> parameters,
                double log2_tolerance, ExtendedMotion& out)
    : problem_(problem),
      options_(options),
      parameters_(parameters.begin(), parameters.end()),
      log2_tolerance_(log2_tolerance),
      out_(out),
      base_(problem.kernel, 1) {
  base_.set_parameters(parameters_);
  now_ = &in_mode(open_mode());
}

template <class T>
bool Modes<T>::stop(StepEnding ending, std::optional<std::size_t> contact, std::string reason) {
  out_.ending = ending;
  out_.trouble = contact;
  out_.reason = std::move(reason);
  return false;
}

template <class T>
ExtendedMode Modes<T>::open_mode() const {
  const ExtendedContacts& all = problem_.contacts;
  ExtendedMode mode;
  mode.closed.assign(all.count, false);
  mode.friction.assign(all.frictions.size(), Slides::Stick);
  std::fill_n(mode.friction.begin(), all.count, Slides::None);
  mode.normal_sign.assign(all.frictions.size() - all.count, 1);
  return mode;
}

/// Without contacts and friction the kernel of the problem is that of the motion.
template <class T>
typename Modes<T>::InMode& Modes<T>::in_mode(const ExtendedMode& mode) {
  const bool slips_begin = !mode.begins.empty();  // along directions that depend on the state
  std::string key = through_modes::key_of(mode);
  if (slips_begin && modes_.contains(key) && modes_[key].get() == now_) key += " again";
  std::unique_ptr<InMode>& slot = modes_[key];
  if (slot && !slips_begin) return *slot;
  ExtendedProgram program{problem_.kernel, {}, {}};
  if (any()) {
    program = problem_.contacts.program(mode);
  } else {
    if (problem_.until) program.watches.push_back({What::Until, 0});
    for (std::size_t i = 0; i < problem_.events.size(); ++i) program.watches.push_back({What::Event, i});
  }
  auto made = std::make_unique<InMode>(InMode{mode, std::move(program), nullptr});
  if (slips_begin)
    begin_slips(*made);
  else
    made->stepper = std::make_unique<Stepper<T>>(made->program.kernel, parameters_, options_, log2_tolerance_);
  slot = std::move(made);
  return *slot;
}

template <class T>
void Modes<T>::start(const T& t, std::vector<T> q, std::vector<T> v, const T& bound) {
  t_ = last_time_ = t, bound_ = bound;
  q_ = std::move(q), v_ = std::move(v);
  const std::size_t n = q_.size(), contacts = problem_.contacts.count;
  place_.assign(n, T(0)), speed_ = acceleration_ = place_;
  widest_.assign(contacts, T(0)), fastest_.assign(contacts, T(0));
  fastest_slip_.assign(problem_.contacts.frictions.size(), T(0));
  slip_in_space_.assign(contacts, T(0));
  just_began_.assign(contacts, false);
  moment_.reset();
  stays_.assign(problem_.events.size(), T(0));
  bounces_.assign(contacts, {});
  ended_.assign(contacts, std::nullopt);
  stepper().start(t_, q_, v_);
  if (any()) {
    Met met;
    met.begins = true;
    settle(met);
  }
  if (!problem_.events.empty() && out_.ending == StepEnding::None) tell_events_at_start();
}

template <class T>
bool Modes<T>::has_forces() const {
  const ExtendedMode& mode = now_->mode;
  return std::find(mode.closed.begin(), mode.closed.end(), true) != mode.closed.end() ||
         std::any_of(mode.friction.begin(), mode.friction.end(), [](Slides s) { return s != Slides::None; });
}

// ---------------------------------------------------------------------------------------------- the state, and sizes

/// Contacts at the present state, switches on its sides. False where the formulas have no value.
template <class T>
bool Modes<T>::evaluate() {
  const std::size_t switches = base_.program().switch_slots.size();
  KernelStatus status = base_.evaluate(t_, q_, v_);
  for (std::size_t pass = 0; pass < switches; ++pass) {  // a function within another comes before it
    std::vector<std::int8_t> sides;
    for (std::size_t i = 0; i < switches; ++i) sides.push_back(taylor::watching::sign(base_.switch_function(i, 0)));
    if (sides == sides_) break;
    base_.set_branches(sides);
    sides_ = std::move(sides);
    status = base_.evaluate(t_, q_, v_);
  }
  if (status != KernelStatus::Ok) return false;
  point_.emplace(problem_, base_, v_);
  note_point();
  return true;
}

template <class T>
T Modes<T>::size_along(const std::vector<T>& row, const std::vector<T>& sizes) const {
  T sum = T(0);
  for (std::size_t i = 0; i < row.size(); ++i) sum += abs(row[i]) * sizes[problem_.contacts.kind[i]];
  return sum;
}

/// [n] The sizes of kinds, for each coordinate.
template <class T>
std::vector<T> Modes<T>::of_coordinates(const std::vector<T>& sizes) const {
  std::vector<T> out;
  for (const std::size_t kind : problem_.contacts.kind) out.push_back(sizes[kind]);
  return out;
}

/// Of the terms of g so far, and of what rounding of its coordinates may make of it.
template <class T>
T Modes<T>::size_of_gap(std::size_t c) const {
  return std::max(widest_[problem_.contacts.gap_kind[c]], size_along(point_->normal[c], place_));
}

/// What gives the accelerations that coordinates of this kind have had.
template <class T>
T Modes<T>::size_of_force(std::size_t c) const {
  return size_along(point_->normal[c], acceleration_) / compliance_[c];
}

template <class T>
void Modes<T>::note_point() {
  const ExtendedContacts& all = problem_.contacts;
  for (std::size_t i = 0; i < all.kind.size(); ++i) {
    place_[all.kind[i]] = std::max(place_[all.kind[i]], T(abs(q_[i])));
    speed_[all.kind[i]] = std::max(speed_[all.kind[i]], T(abs(v_[i])));
  }
  const ContactPoint<T>& p = *point_;
  for (std::size_t c = 0; c < p.gap.size(); ++c) {
    widest_[all.gap_kind[c]] = std::max(widest_[all.gap_kind[c]], p.gap_scale[c]);
    fastest_[c] = std::max(fastest_[c], T(abs(p.drive[c]) + size_along(p.normal[c], speed_)));
  }
  for (std::size_t f = 0; f < p.slip.size(); ++f)
    fastest_slip_[f] = std::max(fastest_slip_[f], T(abs(p.slip_drive[f]) + size_along(p.tangent[f], speed_)));
  note_slips();
}

template <class T>
void Modes<T>::note_accelerations(const std::vector<T>& a) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    T& size = acceleration_[problem_.contacts.kind[i]];
    size = std::max(size, T(abs(a[i])));
  }
}

template <class T>
void Modes<T>::note_step() {
  t_ = stepper().time();
  q_.assign(stepper().q().begin(), stepper().q().end());
  v_.assign(stepper().v().begin(), stepper().v().end());
  if (t_ != last_time_) same_time_ = 0;
  last_time_ = t_;
  if (!any() || !evaluate()) return;  // where there is no value the next step says why
  const T digits = epsilon_to<T>(0.6);
  for (std::size_t c = 0; c < point_->gap.size(); ++c)
    if (!now_->mode.closed[c] && point_->gap[c] < -digits * size_of_gap(c))
      stop(StepEnding::Paradox, c, "the motion went through it without a sign of it.");
}

/// What a located instant leaves of a rate is the rounding of t, times an acceleration.
template <class T>
T Modes<T>::rest_rate(std::size_t c) const {
  return through_modes::roundings * epsilon<T>() *
         (fastest_[c] + abs(t_) * size_along(point_->normal[c], acceleration_));
}

template <class T>
T Modes<T>::rest_slip(std::size_t f) const {
  return through_modes::roundings_of_slips * epsilon<T>() *
         (fastest_slip_[f] + abs(t_) * size_along(point_->tangent[f], acceleration_));
}

template <class T>
std::vector<std::size_t> Modes<T>::touching(const Met& met) const {
  std::vector<std::size_t> out;
  constexpr double digits_of_sets = 1e-9;
  const auto is_set_apart = [&](std::size_t c) {
    return !met.sets.empty() && point_->gap[c] > T(digits_of_sets) * size_of_gap(c);
  };
  for (std::size_t c = 0; c < point_->gap.size(); ++c) {
    const bool is_next_to_zero =
        abs(point_->gap[c]) <= through_modes::roundings * epsilon<T>() * widest_[problem_.contacts.gap_kind[c]];
    if (!is_set_apart(c) && (through_modes::holds(met.hit, c) || now_->mode.closed[c] || is_next_to_zero))
      out.push_back(c);
  }
  return out;
}

// ------------------------------------------------------------------------------------------------- sets and impacts

/// Assigns what events set, all from the values before. False where that breaks a constraint or a contact.
template <class T>
bool Modes<T>::carry_out_sets(const Met& met) {
  if (met.sets.empty()) return true;
  std::vector<T> q = q_, v = v_;
  for (const std::size_t event : met.sets) {
    std::size_t at = problem_.first_set;
    for (std::size_t before = 0; before < event; ++before) at += problem_.events[before].sets.size();
    for (const ExtendedEvent::Assignment& a : problem_.events[event].sets)
      (a.order == 0 ? q : v)[a.coordinate] = base_.observable(at++);
  }
  const auto is_finite = [](const T& x) { return isfinite(x); };
  if (!std::all_of(q.begin(), q.end(), is_finite) || !std::all_of(v.begin(), v.end(), is_finite))
    return stop(StepEnding::ImpossibleState, std::nullopt,
                "An event sets a state without a value: a formula of it has none here.");
  q_ = std::move(q), v_ = std::move(v);
  if (!evaluate()) return stop(StepEnding::Overflow, std::nullopt, "The state that an event sets has no forces.");
  constexpr double digits = 1e-9;
  const auto breaks = [&](const T& value, const T& scale) { return abs(value) > T(digits) * scale; };
  for (std::size_t k = 0; k < problem_.kernel.constraints(); ++k)
    if ((base_.program().constraint_values[k] != no_slot &&
         breaks(base_.constraint_value(k), base_.constraint_scale(k))) ||
        breaks(base_.constraint_rate(k), base_.constraint_rate_scale(k)))
      return stop(StepEnding::ImpossibleState, std::nullopt, "An event sets a state that violates a constraint.");
  for (std::size_t c = 0; c < point_->gap.size(); ++c)
    if (point_->gap[c] < -T(digits) * point_->gap_scale[c])
      return stop(StepEnding::ImpossibleState, c, "an event sets a state that violates it.");
  return true;
}

/// See Events::turned_unseen of simulation.
template <class T>
bool Modes<T>::returns_are_seen(const Met& met) {
  if (met.sets.empty() || met.zeros.empty()) return true;
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return true;  // the next step says why it cannot be made
  const int forwards = t_ <= bound_ ? 1 : -1;
  for (std::size_t k = 0; k < watches().size(); ++k) {
    const ExtendedWatch& w = watches()[k];
    const auto at = std::find(met.sets.begin(), met.sets.end(), w.index);
    const Zero* const zero = zero_that_stays(met, w.index);
    if (w.what != What::Event || at == met.sets.end() || !zero) continue;
    const int way = met.ways[static_cast<std::size_t>(at - met.sets.begin())];
    if (way != 0 && zero->order % 2 == 0) continue;  // at a switch: see is_at_switch of simulation
    if (outlook.slopes[k] * way < 0 && outlook.sides[k] != -way * forwards)
      return stop(StepEnding::Unending, std::nullopt,
                  "An event follows itself faster and faster: its returns accumulate here, and have become too short "
                  "to be told apart in so many digits.");
  }
  return true;
}

/// Events that hold as the motion begins are told, but do not act: it leaves them.
template <class T>
void Modes<T>::tell_events_at_start() {
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return;
  const int forwards = t_ <= bound_ ? 1 : -1;
  for (std::size_t k = 0; k < watches().size(); ++k) {
    const ExtendedWatch& w = watches()[k];
    if (w.what != What::Event || outlook.sides[k] == 0) continue;
    if (abs(outlook.values[k]) > through_modes::roundings * epsilon<T>() * outlook.reach[k]) continue;
    const int wanted = problem_.events[w.index].direction;
    if (wanted == 0 || wanted * forwards == outlook.sides[k]) record(ExtendedRoot::Kind::Event, w.index);
  }
}

/// What rounding leaves of a function that is 0 where it was located.
template <class T>
T Modes<T>::rounding_of_zero(const typename Stepper<T>::Outlook& outlook, std::size_t k) const {
  const T rounding = std::max(T(through_modes::roundings * epsilon<T>()), exp2_of<T>(log2_tolerance_ + 6));
  return rounding * (outlook.reach[k] + abs(t_ * outlook.slopes[k]));
}

template <class T>
void Modes<T>::measure_zeros(const Met& met) {
  left_.assign(problem_.events.size(), T(0));
  if (met.sets.empty()) return;
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return;
  for (std::size_t k = 0; k < watches().size(); ++k)
    if (watches()[k].what == What::Event) left_[watches()[k].index] = rounding_of_zero(outlook, k);
}

/// After the sets: functions that stay at 0 to rounding have no root that it does not make, as long as they stay.
template <class T>
void Modes<T>::note_stays(const Met& met) {
  if (met.sets.empty() || out_.ending != StepEnding::None) return;
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return;  // the next step says why
  for (const Zero& zero : met.zeros)
    for (std::size_t k = 0; k < watches().size(); ++k)
      if (watches()[k].what == What::Event && watches()[k].index == zero.event)
        stays_[zero.event] = outlook.reach[k] <= left_[zero.event] ? left_[zero.event] : T(0);
}

template <class T>
bool Modes<T>::stays_at_zero(const ExtendedWatch& watch, const typename Stepper<T>::Root& root) {
  T& left = stays_[watch.index];
  if (!(left > 0)) return false;
  const T length = stepper().length();
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return false;
  const bool begins_to_leave = root.direction != 0 && abs(outlook.slopes[root.event] * length) <= left;
  if (!begins_to_leave && outlook.reach[root.event] > left) left = T(0);
  return left > 0;
}

template <class T>
void Modes<T>::tell_at_end(const T& begin) {
  const auto outlook = stepper().outlook(T(bound_ + (bound_ - begin)));
  if (outlook.ending != StepEnding::None) return;
  const int forwards = begin <= bound_ ? 1 : -1;
  const T apart = std::max(epsilon_to<T>(0.9), exp2_of<T>(log2_tolerance_ + 6)) * abs(t_);
  const auto is_told = [&](std::size_t event) {
    for (std::size_t i = 0; i < out_.roots.size(); ++i)
      if (out_.roots[i].kind == ExtendedRoot::Kind::Event && out_.roots[i].index == event &&
          abs(t_ - times_[i]) <= apart)
        return true;
    return false;
  };
  for (std::size_t k = 0; k < watches().size(); ++k) {
    const ExtendedWatch& w = watches()[k];
    if (w.what != What::Event) continue;
    const T rate = outlook.slopes[k] * forwards, value = outlook.values[k];
    const bool comes_to_zero = value * rate <= 0 && rate != 0 && abs(value) <= rounding_of_zero(outlook, k);
    const bool stays = stays_[w.index] > 0 && outlook.reach[k] <= stays_[w.index];
    const int wanted = problem_.events[w.index].direction * forwards;
    if (comes_to_zero && !stays && !(wanted != 0 && wanted * rate < 0) && !is_told(w.index))
      record(ExtendedRoot::Kind::Event, w.index);
  }
}

/// When infinitely many bounces come to their end, from the last of them, once the heights of the flights are rounding:
/// the flights shorten as the speeds do.
template <class T>
std::optional<T> Modes<T>::end_of_bounces(std::size_t c, const T& speed) {
  auto& last = bounces_[c];
  last.push_back({t_, speed});
  if (last.size() > 4) last.erase(last.begin());
  if (last.size() < 4) return std::nullopt;
  const T ratio = last[3].speed / last[2].speed, before = last[2].speed / last[1].speed;
  const T flight = last[3].t - last[2].t, slowest = T(0.999);  // flights of a spring do not shorten
  const bool is_series = ratio < slowest && abs(ratio - before) < T(1e-3) && flight < slowest * (last[2].t - last[1].t);
  const bool is_low =
      speed * flight <= T(1e6) * epsilon<T>() * widest_[problem_.contacts.gap_kind[c]] && speed < T(1e-6) * fastest_[c];
  if (!is_series || !is_low) return std::nullopt;
  last.clear();
  return t_ + flight * ratio / (1 - ratio);
}

template <class T>
bool Modes<T>::hit(const std::vector<std::size_t>& touching, Met& met) {
  std::fill(ended_.begin(), ended_.end(), std::nullopt);
  std::vector<T> rest;
  std::vector<std::size_t> closing;
  for (const std::size_t c : touching) {
    rest.push_back(rest_rate(c));
    if (point_->rate[c] < -rest.back()) closing.push_back(c);
  }
  if (closing.empty()) return true;
  bool ends = true;
  for (const std::size_t c : closing) {
    ended_[c] = end_of_bounces(c, -point_->rate[c]);
    ends = ends && ended_[c];
  }
  if (!ends) std::fill(ended_.begin(), ended_.end(), std::nullopt);
  const ExtendedContacts& all = problem_.contacts;
  const Impact<T> impact(*point_, base_, touching, all, ends);
  const ExtendedSample before = stepper().sample(stepper().time());
  std::vector<T> v = v_;
  const bool at_once = all.simultaneous && !ends;
  auto blows = at_once ? impact.all_at_once(v) : impact.one_after_the_other(v, rest);
  const auto rubs = [&](const auto& blow) { return all.frictions[blow.contact].present; };
  if (at_once && blows && std::any_of(blows->begin(), blows->end(), rubs)) {
    v = v_;
    blows = impact.one_after_the_other(v, rest);  // it has its friction where it is hit alone
    for (std::size_t i = 1; blows && i < blows->size(); ++i)
      if ((*blows)[i].contact != blows->front().contact)
        return stop(StepEnding::Paradox, closing.front(),
                    "several contacts are hit, one with friction among them, and `impact simultaneous` says nothing of "
                    "friction.");
  }
  if (!blows)
    return stop(at_once ? StepEnding::Paradox : StepEnding::Unending, closing.front(),
                at_once ? "no impulses were found that keep all contacts that are hit from closing."
                        : "impacts follow each other without an end.");
  for (const auto& blow : *blows)
    add({ExtendedRoot::Kind::Impact, blow.contact, before, text_of(blow.impulse), text_of(blow.speed)}, t_);
  v_ = std::move(v);
  std::erase_if(met.left, [](const ExtendedWatch& w) { return w.what == What::Force; });
  const bool is_short = abs(t_ - last_impact_) <= through_modes::roundings * epsilon<T>() * abs(t_);
  short_flights_ = is_short ? short_flights_ + 1 : 0;
  last_impact_ = t_;
  if (short_flights_ > 3)
    return stop(StepEnding::Unending, closing.front(),
                "the flights between impacts have become too short to be told apart in so many digits.");
  return evaluate();
}

/// False where a contact that never slides has a slip, which no law of the model would stop.
template <class T>
bool Modes<T>::keeps_sticking(const std::vector<std::size_t>& touching, const Met& met) {
  constexpr double digits = 1e-9;
  for (const std::size_t c : touching) {
    if (!problem_.contacts.frictions[c].sticking || point_->rate[c] > rest_rate(c)) continue;
    if (point_->slip_speed(c) <= T(digits) * fastest_slip_[c]) continue;
    return stop(StepEnding::Paradox, c,
                met.begins          ? "the start slides on it, and it is `sticking` and never slides."
                : !met.sets.empty() ? "an event sets a state that slides on it, and it is `sticking` and never slides."
                                    : "it slides after what happens here, and it is `sticking`: the model does not say "
                                      "what stops it.");
  }
  return true;
}

// ------------------------------------------------------------------------------------------------------------ record

template <class T>
void Modes<T>::record(ExtendedRoot::Kind kind, std::size_t index, const std::optional<T>& time) {
  ExtendedRoot root{kind, index, stepper().sample(stepper().time()), {}, {}};
  if (time) root.state.t = text_of(*time);
  add(std::move(root), stepper().time());
}

/// Roots of one instant may be located some roundings or tolerances apart, one step after the other: they are told in
/// the order of their kinds, so that runs of different digits tell the same.
template <class T>
void Modes<T>::add(ExtendedRoot root, const T& t) {
  const auto rank = [](const ExtendedRoot& r) {
    return r.kind == ExtendedRoot::Kind::Event ? 0 : r.kind == ExtendedRoot::Kind::Impact ? 1 : 2;
  };
  const T apart = std::max(epsilon_to<T>(0.9), exp2_of<T>(log2_tolerance_ + 6));
  std::size_t at = out_.roots.size();
  while (at > 0 && rank(out_.roots[at - 1]) > rank(root) && abs(t - times_[at - 1]) <= apart * abs(t)) --at;
  out_.roots.insert(out_.roots.begin() + static_cast<std::ptrdiff_t>(at), std::move(root));
  times_.insert(times_.begin() + static_cast<std::ptrdiff_t>(at), t);
}

template <class T>
void Modes<T>::record_changes(const ExtendedMode& before, const ExtendedMode& after, bool begins) {
  if (begins) return;
  for (std::size_t c = 0; c < after.closed.size(); ++c) {
    if (after.closed[c] && !before.closed[c]) record(ExtendedRoot::Kind::Made, c, ended_[c]);
    if (!after.closed[c] && before.closed[c]) record(ExtendedRoot::Kind::Lost, c);
  }
  const auto closes = [&](std::size_t c) { return c < after.closed.size() && after.closed[c] && !before.closed[c]; };
  for (std::size_t f = 0; f < after.friction.size(); ++f)
    if (after.friction[f] != before.friction[f] && after.friction[f] != Slides::None &&
        !(closes(f) && after.friction[f] != Slides::Stick))  // it was not held
      record(after.friction[f] == Slides::Stick ? ExtendedRoot::Kind::Stick : ExtendedRoot::Kind::Slip, f);
}

template <class T>
void Modes<T>::settle(const Met& given) {
  Met met = given;
  const std::vector<bool>& began = now_->mode.begins;
  just_began_ = began.empty() ? std::vector<bool>(problem_.contacts.count, false) : began;
  if (++same_time_ > through_modes::most_at_once) {
    stop(StepEnding::Unending, std::nullopt, "A thousand changes follow each other at the same time without an end.");
    return;
  }
  if (!evaluate()) return;  // the next step says why
  steps_before_ += stepper().steps(), switches_before_ += stepper().switches();
  measure_zeros(met);
  if (!carry_out_sets(met)) return;
  if (!any()) {
    stepper().start(t_, q_, v_);
    put_at_zero(*now_, {}, met);
    if (!met.zeros.empty()) go_on_from_zero(*now_, stepper().outlook(bound_), met);
    returns_are_seen(met);
    note_stays(met);
    return;
  }
  const std::vector<std::size_t> touches = touching(met);
  moment_.reset();
  const auto settles = [&] {
    if (!hit(touches, met)) return false;
    come_to_rest(touches, met);
    return keeps_sticking(touches, met) && choose(touches, met) && returns_are_seen(met);
  };
  if (!settles()) stepper().start(t_, q_, v_);
  note_stays(met);
  if (moment_) stepper().come_from(moment_->t, moment_->q, moment_->v, moment_->a);
}

}  // namespace maupertuis::extended

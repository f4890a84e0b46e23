#pragma once
#include "integrator/extended/modes.hpp"
#include "integrator/extended/stepper_code.hpp"
#include "linear_algebra/independent_rows.hpp"

namespace maupertuis::extended {

namespace through_modes {

constexpr int roundings = 64;               // a value of so many rounding units of its terms is 0
constexpr int roundings_of_slips = 1024;    // the same of slips: impacts leave rates up to `roundings` unchanged
constexpr std::size_t most_at_once = 1000;  // changes at the same time
constexpr std::size_t most_choices = 1024;  // modes that are tried
constexpr std::size_t most_kept = 64;       // modes whose steppers are kept

inline std::string key_of(const ExtendedMode& mode) {
  std::string key;
  for (const bool closed : mode.closed) key += closed ? '1' : '0';
  for (const auto friction : mode.friction) key += static_cast<char>('a' + static_cast<int>(friction));
  for (const std::int8_t sign : mode.normal_sign) key += sign < 0 ? '-' : '+';
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
  std::unique_ptr<InMode>& slot = modes_[through_modes::key_of(mode)];
  if (slot) return *slot;
  ExtendedProgram program{problem_.kernel, {}};
  if (any()) {
    program = problem_.contacts.program(mode);
  } else {
    if (problem_.until) program.watches.push_back({What::Until, 0});
    for (std::size_t i = 0; i < problem_.events.size(); ++i) program.watches.push_back({What::Event, i});
  }
  auto made = std::make_unique<InMode>(InMode{mode, std::move(program), nullptr});
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
  bounces_.assign(contacts, {});
  ended_.assign(contacts, std::nullopt);
  stepper().start(t_, q_, v_);
  if (!any()) return;
  Met met;
  met.begins = true;
  settle(met);
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
  q_ = std::move(q), v_ = std::move(v);
  if (!evaluate()) return stop(StepEnding::Overflow, std::nullopt, "The state that an event sets has no forces.");
  constexpr double digits = 1e-9;
  const auto breaks = [&](const T& value, const T& scale) { return abs(value) > T(digits) * scale; };
  for (std::size_t k = 0; k < problem_.kernel.constraints(); ++k)
    if ((base_.program().constraint_values[k] != no_slot &&
         breaks(base_.constraint_value(k), base_.constraint_scale(k))) ||
        breaks(base_.constraint_rate(k), base_.constraint_rate_scale(k)))
      return stop(StepEnding::SingularConstraints, std::nullopt, "An event sets a state that violates a constraint.");
  for (std::size_t c = 0; c < point_->gap.size(); ++c)
    if (point_->gap[c] < -T(digits) * point_->gap_scale[c])
      return stop(StepEnding::SingularConstraints, c, "an event sets a state that violates it.");
  return true;
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
  const T flight = last[3].t - last[2].t;
  const bool is_series = ratio < T(0.999) && abs(ratio - before) < T(1e-3) && flight < last[2].t - last[1].t;
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
    if (abs(point_->slip[c]) <= T(digits) * fastest_slip_[c]) continue;
    return stop(StepEnding::Paradox, c,
                met.begins          ? "the start slides on it, and it is `sticking` and never slides."
                : !met.sets.empty() ? "an event sets a state that slides on it, and it is `sticking` and never slides."
                                    : "it slides after what happens here, and it is `sticking`: the model does not say "
                                      "what stops it.");
  }
  return true;
}

// -------------------------------------------------------------------------------------------------- the mode after it

template <class T>
typename Modes<T>::Choice Modes<T>::choice_of_contact(std::size_t c, const Met& met) const {
  Choice out{c, {}};
  const auto& friction = problem_.contacts.frictions[c];
  const T& slip = point_->slip[c];
  if (!friction.present)
    out.options = {{true, Slides::None, 1}};
  else if (friction.sticking)
    out.options = {{true, Slides::Stick, 1}};
  else if (abs(slip) > rest_slip(c))
    out.options = {{true, slip > 0 ? Slides::Forward : Slides::Backward, 1}};
  else
    out.options = {{true, Slides::Stick, 1}, {true, Slides::Forward, 1}, {true, Slides::Backward, 1}};
  const bool lets_go = through_modes::holds(met.left, What::Force, c);
  out.options.insert(lets_go ? out.options.begin() : out.options.end(), {false, Slides::None, 1});
  return out;
}

template <class T>
std::vector<typename Modes<T>::Choice> Modes<T>::choices(const std::vector<std::size_t>& touching,
                                                         const Met& met) const {
  std::vector<Choice> out;
  const ExtendedContacts& all = problem_.contacts;
  for (const std::size_t c : touching)
    if (!(point_->rate[c] > rest_rate(c))) out.push_back(choice_of_contact(c, met));
  for (std::size_t f = all.count; f < all.frictions.size(); ++f) {
    Choice choice{f, {}};
    const T& slip = point_->slip[f];
    for (const std::int8_t sign : {std::int8_t{1}, std::int8_t{-1}}) {
      if (sign < 0 && !all.frictions[f].has_sign) continue;
      if (abs(slip) > rest_slip(f))
        choice.options.push_back({false, slip > 0 ? Slides::Forward : Slides::Backward, sign});
      else
        for (const Slides s : {Slides::Stick, Slides::Forward, Slides::Backward})
          choice.options.push_back({false, s, sign});
    }
    out.push_back(std::move(choice));
  }
  return out;
}

template <class T>
ExtendedMode Modes<T>::mode_of(const std::vector<Choice>& list, const std::vector<std::size_t>& taken) const {
  ExtendedMode mode = open_mode();
  const std::size_t contacts = problem_.contacts.count;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Option& option = list[k].options[taken[k]];
    if (list[k].index < contacts)
      mode.closed[list[k].index] = option.closed;
    else
      mode.normal_sign[list[k].index - contacts] = option.sign;
    mode.friction[list[k].index] = option.friction;
  }
  return mode;
}

template <class T>
bool Modes<T>::sets_positions(const Met& met) const {
  return std::any_of(met.sets.begin(), met.sets.end(), [this](std::size_t event) {
    const auto& sets = problem_.events[event].sets;
    return std::any_of(sets.begin(), sets.end(), [](const ExtendedEvent::Assignment& a) { return a.order == 0; });
  });
}

/// What is 0 here counts by what it does next: gaps that touch, slips that begin, forces that came to 0.
template <class T>
void Modes<T>::put_at_zero(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met) {
  for (std::size_t k = 0; k < candidate.program.watches.size(); ++k) {
    const ExtendedWatch& w = candidate.program.watches[k];
    if (w.what == What::Gap && through_modes::holds(touching, w.index)) {
      const bool opens = point_->rate[w.index] > rest_rate(w.index);
      candidate.stepper->put_at_zero(k, opens ? 1 : released_[w.index] ? 3 : 2);
    } else if (w.what == What::Slip && !(abs(point_->slip[w.index]) > rest_slip(w.index))) {
      candidate.stepper->put_at_zero(k);
    } else if (w.what == What::Force && through_modes::holds(met.left, w.what, w.index)) {
      candidate.stepper->put_at_zero(k);
    } else if (w.what == What::Event && !sets_positions(met) && through_modes::holds(met.zeros, w.index)) {
      candidate.stepper->put_at_zero(k);  // thrown back from it, a motion has not passed it
    }
  }
}

/// A slip whose rate is rounding, as where friction gives way with μ_s = μ, begins with the second power of time: then
/// it is put there.
template <class T>
bool Modes<T>::begins_slowly(InMode& candidate, const typename Stepper<T>::Outlook& outlook) {
  bool any = false;
  for (std::size_t k = 0; k < candidate.program.watches.size(); ++k) {
    const ExtendedWatch& w = candidate.program.watches[k];
    if (w.what != What::Slip || abs(point_->slip[w.index]) > rest_slip(w.index)) continue;
    if (abs(outlook.slopes[k]) > epsilon_to<T>(0.85) * size_along(point_->tangent[w.index], acceleration_)) continue;
    candidate.stepper->put_at_zero(k, 2);
    any = true;
  }
  return any;
}

/// Whether the motion in a mode keeps its conditions. Lenient: forces that are 0 to rounding of others may be violated.
template <class T>
bool Modes<T>::fits(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met, bool lenient,
                    std::vector<T>* accelerations) {
  candidate.stepper->start(t_, q_, v_);
  put_at_zero(candidate, touching, met);
  candidate.stepper->set_usual_sizes(of_coordinates(place_), of_coordinates(speed_), of_coordinates(acceleration_));
  typename Stepper<T>::Outlook outlook = candidate.stepper->outlook(bound_);
  if (outlook.ending != StepEnding::None) return false;
  if (begins_slowly(candidate, outlook)) outlook = candidate.stepper->outlook(bound_);
  const auto is_force = [](const ExtendedWatch& w) { return w.what == What::Force || w.what == What::Hold; };
  T largest = T(0);
  const auto& watches = candidate.program.watches;
  for (std::size_t k = 0; k < watches.size(); ++k)
    if (is_force(watches[k])) largest = std::max(largest, T(abs(outlook.values[k])));
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const ExtendedWatch& w = watches[k];
    if (!through_modes::keeps_sign(w)) continue;
    // What is lost in rounding of the motion: a gap that stays, a force that is none.
    const T lost = epsilon_to<T>(0.77);
    if (w.what == What::Gap && outlook.reach[k] <= lost * size_of_gap(w.index)) continue;
    if (w.what == What::Force && outlook.reach[k] <= lost * size_of_force(w.index)) {
      if (lenient) continue;
      return false;
    }
    // λ was located to rounding of the time alone: what it does next counts.
    if (w.what == What::Force && abs(outlook.values[k]) <= epsilon_to<T>(0.7) * size_of_force(w.index)) {
      if (outlook.slopes[k] >= 0) continue;
      released_[w.index] = true;
      return false;
    }
    const bool must_move = w.what == What::Slip && !(abs(point_->slip[w.index]) > rest_slip(w.index));
    const bool must_press = w.what == What::Force && !lenient;
    if (outlook.sides[k] > 0 || (outlook.sides[k] == 0 && !must_move && !must_press)) continue;
    if (!lenient || !is_force(w) || abs(outlook.values[k]) > epsilon_to<T>(0.8) * largest) return false;
  }
  *accelerations = outlook.accelerations;
  return true;
}

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
template <class T>
bool Modes<T>::may_be_several(const ExtendedMode& mode) const {
  const Responses<T> responses(base_);
  for (std::size_t c = 0; c < mode.closed.size(); ++c) {
    if (!mode.closed[c] || (mode.friction[c] != Slides::Forward && mode.friction[c] != Slides::Backward)) continue;
    std::vector<T> force = point_->normal[c];
    const T factor = mode.friction[c] == Slides::Forward ? T(-point_->friction[c]) : point_->friction[c];
    for (std::size_t i = 0; i < force.size(); ++i) force[i] += factor * point_->tangent[c][i];
    if (!(along<T>(point_->normal[c], responses.of(force)) > 0)) return true;
  }
  return false;
}

/// Whether contacts that stick hold each other: rows of their normals and slips depend on each other.
template <class T>
bool Modes<T>::holds_undetermined(const ExtendedMode& mode) const {
  bool holds = false;
  bool are_dependent = false;
  IndependentRows independent;
  const auto add = [&](const std::vector<T>& row) {
    std::vector<double> rounded;
    for (const T& x : row) rounded.push_back(static_cast<double>(x));
    are_dependent = !independent.add(std::move(rounded)) || are_dependent;
  };
  for (std::size_t c = 0; c < problem_.contacts.count; ++c) {
    if (!mode.closed[c]) continue;
    add(point_->normal[c]);
    if (mode.friction[c] != ExtendedMode::Friction::Stick) continue;
    add(point_->tangent[c]);
    holds = holds || !problem_.contacts.frictions[c].sticking;
  }
  return holds && are_dependent;
}

/// At rest, with a static limit beyond the kinetic one: where it holds another motion fits as well, in which it slides.
template <class T>
bool Modes<T>::may_hold(const Choice& c) const {
  return c.options.size() > 2 && point_->fixed[c.index] > point_->friction[c.index];
}

/// Frictions that a mode holds beyond their limits; nothing where it has no motion.
template <class T>
std::optional<std::vector<std::size_t>> Modes<T>::beyond_limits(InMode& candidate,
                                                                const std::vector<std::size_t>& touching,
                                                                const Met& met) {
  candidate.stepper->start(t_, q_, v_);
  put_at_zero(candidate, touching, met);
  const auto outlook = candidate.stepper->outlook(bound_);
  if (outlook.ending != StepEnding::None) return std::nullopt;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < outlook.sides.size(); ++k)
    if (candidate.program.watches[k].what == What::Hold && outlook.sides[k] < 0)
      out.push_back(candidate.program.watches[k].index);
  return out;
}

/// Of frictions at rest those give way first that are at their limit, or beyond it where all rest; of the latter the
/// one that is written last, so that the first one is held where one can be (HybridMotion::order_by_limits).
template <class T>
void Modes<T>::order_by_limits(std::vector<Choice>& list, const std::vector<std::size_t>& touching, const Met& met) {
  std::vector<std::size_t> at_limit;
  for (const ExtendedWatch& w : met.left)
    if (w.what == What::Hold) at_limit.push_back(w.index);
  const bool overcome = at_limit.empty();
  if (overcome && std::any_of(list.begin(), list.end(), [&](const Choice& c) { return may_hold(c); })) {
    InMode& rest = in_mode(mode_of(list, std::vector<std::size_t>(list.size(), 0)));
    at_limit = beyond_limits(rest, touching, met).value_or(at_limit);
  }
  const auto first = std::stable_partition(list.begin(), list.end(), [&](const Choice& c) {
    return std::find(at_limit.begin(), at_limit.end(), c.index) != at_limit.end();
  });
  if (overcome) std::reverse(list.begin(), first);
}

/// Whether friction begins to slide in this mode that would hold below its own limit beside all else as it is there:
/// the one that has to give way is another (HybridMotion::gives_way_unforced).
template <class T>
bool Modes<T>::gives_way_unforced(const std::vector<Choice>& list, const ExtendedMode& mode,
                                  const std::vector<std::size_t>& touching, const Met& met) {
  for (const Choice& c : list) {
    const bool begins = mode.friction[c.index] == Slides::Forward || mode.friction[c.index] == Slides::Backward;
    if (!begins || !may_hold(c) || through_modes::holds(met.left, What::Hold, c.index)) continue;
    ExtendedMode held = mode;
    held.friction[c.index] = Slides::Stick;
    const auto beyond = beyond_limits(in_mode(held), touching, met);
    if (beyond && std::find(beyond->begin(), beyond->end(), c.index) == beyond->end()) return true;
  }
  return false;
}

/// What acts without contacts and friction is a measure of forces, where all is at rest the only one.
template <class T>
void Modes<T>::measure_forces(const Met& met) {
  constexpr std::size_t looks = 16;
  const bool gives_way =
      std::any_of(met.left.begin(), met.left.end(), [](const ExtendedWatch& w) { return w.what == What::Hold; });
  if (!gives_way || looks_at_forces_++ >= looks) return;
  ExtendedMode mode = open_mode();
  std::fill(mode.friction.begin(), mode.friction.end(), Slides::None);
  InMode& free = in_mode(mode);
  free.stepper->start(t_, q_, v_);
  const auto outlook = free.stepper->outlook(bound_);
  if (outlook.ending == StepEnding::None) note_accelerations(outlook.accelerations);
}

template <class T>
bool Modes<T>::choose(const std::vector<std::size_t>& touching, const Met& met) {
  measure_forces(met);
  std::vector<Choice> list = choices(touching, met);
  if (list.size() > 1) order_by_limits(list, touching, met);
  std::vector<std::size_t> counts;
  for (const Choice& c : list) counts.push_back(c.options.size());
  Combinations tries(counts, through_modes::most_choices);
  const Responses<T> responses(base_);
  compliance_.clear();
  for (const std::vector<T>& row : point_->normal) compliance_.push_back(along<T>(row, responses.of(row)));
  if (modes_.size() > through_modes::most_kept)
    std::erase_if(modes_, [&](const auto& entry) { return entry.second.get() != now_; });
  released_.assign(problem_.contacts.count, false);
  for (const ExtendedWatch& w : met.left)
    if (w.what == What::Force) released_[w.index] = true;
  std::vector<T> first;
  if (met.begins) {  // what acts without contacts is a first measure of forces
    std::vector<Choice> apart = list;
    std::erase_if(apart, [&](const Choice& c) { return c.index < problem_.contacts.count; });
    InMode& free = in_mode(mode_of(apart, std::vector<std::size_t>(apart.size(), 0)));
    free.stepper->start(t_, q_, v_);
    note_accelerations(free.stepper->outlook(bound_).accelerations);
  }
  InMode* found = nullptr;
  InMode *last = nullptr, *unforced = nullptr;
  std::vector<T> unforced_accelerations;
  bool unforced_lenient = false;
  bool by_leniency = false;
  for (const bool lenient : {false, true}) {
    for (std::size_t turn = 0; const std::vector<std::size_t>* taken = tries.number(turn); ++turn) {
      if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed))
        return stop(StepEnding::Interrupted, std::nullopt, "The run was interrupted.");
      InMode& candidate = in_mode(mode_of(list, *taken));
      std::vector<T> accelerations;
      last = &candidate;
      if (!fits(candidate, touching, met, lenient, &accelerations)) continue;
      if (gives_way_unforced(list, candidate.mode, touching, met)) {
        last = nullptr;  // others were begun after it
        if (!unforced) unforced = &candidate, unforced_accelerations = accelerations, unforced_lenient = lenient;
        continue;
      }
      if (!found) {
        found = &candidate, first = std::move(accelerations), by_leniency = lenient;
        if (!may_be_several(candidate.mode)) break;
        continue;
      }
      T off = T(0), size = T(0);
      for (std::size_t i = 0; i < first.size(); ++i) {
        off = std::max(off, T(abs(first[i] - accelerations[i])));
        size = std::max({size, T(abs(first[i])), T(abs(accelerations[i]))});
      }
      if (off <= T(1e-9) * size) continue;
      return stop(StepEnding::Paradox, std::nullopt,
                  "Painlevé's paradox: friction turns the contact force around here, and more than one motion fits.");
    }
    if (found) break;
  }
  if (!found && unforced)
    found = unforced, first = std::move(unforced_accelerations), by_leniency = unforced_lenient, last = nullptr;
  if (std::any_of(list.begin(), list.end(), [&](const Choice& c) { return may_hold(c); })) last = nullptr;
  // Of a rest that is not determined one distribution of forces was tried, be it within the limits or not.
  if (holds_undetermined(found ? found->mode : mode_of(list, std::vector<std::size_t>(list.size(), 0))))
    return stop(StepEnding::Paradox, std::nullopt,
                "Friction at several contacts holds more than the rest needs, and its forces are not determined: with "
                "more digits none are sought within its limits.");
  if (!found)
    return stop(StepEnding::Paradox, std::nullopt,
                "No mode of the contacts and frictions was found that keeps its conditions here.");
  note_accelerations(first);
  if (last != found) static_cast<void>(fits(*found, touching, met, by_leniency, &first));
  const ExtendedMode before = now_->mode;
  now_ = found;
  record_changes(before, found->mode, met.begins);
  return true;
}

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
  for (std::size_t f = 0; f < after.friction.size(); ++f)
    if (after.friction[f] != before.friction[f] && after.friction[f] != Slides::None)
      record(after.friction[f] == Slides::Stick ? ExtendedRoot::Kind::Stick : ExtendedRoot::Kind::Slip, f);
}

template <class T>
void Modes<T>::settle(const Met& given) {
  Met met = given;
  if (++same_time_ > through_modes::most_at_once) {
    stop(StepEnding::Unending, std::nullopt, "A thousand changes follow each other at the same time without an end.");
    return;
  }
  if (!evaluate()) return;  // the next step says why
  steps_before_ += stepper().steps(), switches_before_ += stepper().switches();
  if (!carry_out_sets(met)) return;
  if (!any()) {
    stepper().start(t_, q_, v_);
    return;
  }
  const std::vector<std::size_t> touches = touching(met);
  if (!hit(touches, met) || !keeps_sticking(touches, met) || !choose(touches, met)) stepper().start(t_, q_, v_);
}

}  // namespace maupertuis::extended

#pragma once
#include "integrator/extended/modes_code.hpp"
#include "integrator/extended/space_code.hpp"
#include "linear_algebra/independent_rows.hpp"

/// The mode after an instant: which are possible, whether one keeps its conditions, and which static friction gives way
/// (hybrid_modes.cpp and hybrid_trials.cpp of simulation, over T).
namespace maupertuis::extended {

template <class T>
typename Modes<T>::Choice Modes<T>::choice_of_contact(std::size_t c, const Met& met) const {
  Choice out{c, {}};
  const auto& friction = problem_.contacts.frictions[c];
  const T& slip = point_->slip[c];
  if (!friction.present)
    out.options = {{true, Slides::None, 1}};
  else if (friction.sticking)
    out.options = {{true, Slides::Stick, 1}};
  else if (friction.in_space)
    out = choice_in_space(c);
  else if (abs(slip) > rest_slip(c))
    out.options = {{true, slip > 0 ? Slides::Forward : Slides::Backward, 1}};
  else
    out.options = {{true, Slides::Stick, 1}, {true, Slides::Forward, 1}, {true, Slides::Backward, 1}};
  const bool lets_go = through_modes::holds(met.left, What::Force, c);
  out.options.insert(lets_go ? out.options.begin() : out.options.end(), Option{});
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
    if (option.friction != Slides::Slide) continue;
    mode.stops.resize(contacts, 0.0);
    mode.stops[list[k].index] = static_cast<double>(stop_speed(list[k].index));
    if (!option.begins) continue;
    mode.begins.resize(contacts, false);
    mode.begins[list[k].index] = true;
  }
  return mode;
}

template <class T>
auto Modes<T>::zero_that_stays(const Met& met, std::size_t event) const -> const Zero* {
  const auto zero = std::find_if(met.zeros.begin(), met.zeros.end(), [&](const Zero& z) { return z.event == event; });
  if (zero == met.zeros.end() || !problem_.events[event].of_state) return nullptr;
  const auto is_set = [&](const ExtendedEvent::Assignment& read) {
    return std::any_of(met.sets.begin(), met.sets.end(), [&](std::size_t other) {
      const auto& sets = problem_.events[other].sets;
      return std::find(sets.begin(), sets.end(), read) != sets.end();
    });
  };
  const auto changes = [&](const ExtendedEvent::Assignment& read) {
    return (read.order == 1 && !met.hit.empty()) || is_set(read);
  };
  const auto& reads = problem_.events[event].reads;
  return std::any_of(reads.begin(), reads.end(), changes) ? nullptr : &*zero;
}

template <class T>
bool Modes<T>::go_on_from_zero(InMode& candidate, const typename Stepper<T>::Outlook& outlook, const Met& met) {
  if (outlook.ending != StepEnding::None) return false;  // the next step says why
  // Roots are located within the tolerance of the run.
  const T rounding = std::max(T(64) * epsilon<T>(), exp2_of<T>(log2_tolerance_ + 6));
  bool any = false;
  for (std::size_t k = 0; k < candidate.program.watches.size(); ++k) {
    const ExtendedWatch& w = candidate.program.watches[k];
    const auto is_it = [&](const Zero& z) { return w.what == What::Event && z.event == w.index; };
    const auto zero = std::find_if(met.zeros.begin(), met.zeros.end(), is_it);
    if (zero == met.zeros.end() || zero_that_stays(met, w.index)) continue;
    if (abs(outlook.values[k]) > rounding * (outlook.reach[k] + abs(t_ * outlook.slopes[k]))) continue;
    candidate.stepper->put_at_zero(k, zero->order);
    any = true;
  }
  return any;
}

/// What is 0 here counts by what it does next: gaps that touch, slips that begin, forces that came to 0.
template <class T>
void Modes<T>::put_at_zero(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met) {
  for (std::size_t k = 0; k < candidate.program.watches.size(); ++k) {
    const ExtendedWatch& w = candidate.program.watches[k];
    if (w.what == What::Gap && through_modes::holds(touching, w.index)) {
      const bool opens = point_->rate[w.index] > rest_rate(w.index);
      candidate.stepper->put_at_zero(k, opens ? 1 : released_[w.index] ? 3 : 2);
    } else if (w.what == What::Slip && !problem_.contacts.frictions[w.index].in_space &&
               !(abs(point_->slip[w.index]) > rest_slip(w.index))) {
      candidate.stepper->put_at_zero(k);
    } else if (w.what == What::Force && through_modes::holds(met.left, w.what, w.index)) {
      candidate.stepper->put_at_zero(k);
    } else if (const Zero* const zero = w.what == What::Event ? zero_that_stays(met, w.index) : nullptr) {
      candidate.stepper->put_at_zero(k, zero->order);  // thrown back from it, a motion has not passed it
    }
  }
}

/// A slip whose rate is rounding, as where friction gives way with μ_s = μ, begins with the second power of time: then
/// it is put there.
template <class T>
bool Modes<T>::begins_slowly(InMode& candidate, const typename Stepper<T>::Outlook& outlook, const Met& met) {
  bool any = false;
  for (std::size_t k = 0; k < candidate.program.watches.size(); ++k) {
    const ExtendedWatch& w = candidate.program.watches[k];
    if (w.what != What::Slip || problem_.contacts.frictions[w.index].in_space ||
        abs(point_->slip[w.index]) > rest_slip(w.index))
      continue;
    // Of a force that has come to its limit the rounding of time is left.
    const T digits = epsilon_to<T>(through_modes::holds(met.left, What::Hold, w.index) ? 0.6 : 0.85);
    if (abs(outlook.slopes[k]) > digits * size_along(point_->tangent[w.index], acceleration_)) continue;
    candidate.stepper->put_at_zero(k, 2);
    any = true;
  }
  return any;
}

/// Whether the motion in a mode keeps its conditions. Lenient: forces that are 0 to rounding of others may be violated.
template <class T>
bool Modes<T>::fits(InMode& candidate, const std::vector<std::size_t>& touching, const Met& met, bool lenient,
                    std::vector<T>* accelerations) {
  if (!candidate.stepper) return false;
  candidate.stepper->start(t_, q_, v_);
  put_at_zero(candidate, touching, met);
  candidate.stepper->set_usual_sizes(of_coordinates(place_), of_coordinates(speed_), of_coordinates(acceleration_));
  typename Stepper<T>::Outlook outlook = candidate.stepper->outlook(bound_);
  if (outlook.ending != StepEnding::None) return false;
  const bool slips = begins_slowly(candidate, outlook, met), events = go_on_from_zero(candidate, outlook, met);
  if (slips || events) outlook = candidate.stepper->outlook(bound_);
  const auto is_force = [](const ExtendedWatch& w) { return w.what == What::Force || w.what == What::Hold; };
  // The limit of friction in space is a difference of squares.
  const auto is_squared = [&](const ExtendedWatch& w) {
    return w.what == What::Hold && problem_.contacts.frictions[w.index].in_space;
  };
  T largest = T(0);
  const auto& watches = candidate.program.watches;
  for (std::size_t k = 0; k < watches.size(); ++k)
    if (is_force(watches[k]))
      largest =
          std::max(largest, is_squared(watches[k]) ? T(sqrt(T(abs(outlook.values[k])))) : T(abs(outlook.values[k])));
  for (std::size_t k = 0; k < watches.size(); ++k) {
    const ExtendedWatch& w = watches[k];
    if (!through_modes::keeps_sign(w)) continue;
    const T size = is_squared(w) ? T(largest * largest) : largest;
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
    const bool is_met = w.what == What::Hold && through_modes::holds(met.left, What::Hold, w.index);
    if (is_met && abs(outlook.values[k]) <= epsilon_to<T>(0.6) * size) {
      if (outlook.slopes[k] >= 0) continue;
      return false;
    }
    if (w.what == What::Slip && problem_.contacts.frictions[w.index].in_space) {
      if (keeps_slip_in_space(candidate, w.index, outlook.sides[k])) continue;
      return false;
    }
    const bool must_move = w.what == What::Slip && !(abs(point_->slip[w.index]) > rest_slip(w.index));
    const bool must_press = w.what == What::Force && !lenient;
    if (outlook.sides[k] > 0 || (outlook.sides[k] == 0 && !must_move && !must_press)) continue;
    if (!lenient || !is_force(w) || abs(outlook.values[k]) > epsilon_to<T>(0.8) * size) return false;
  }
  *accelerations = outlook.accelerations;
  return true;
}

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
template <class T>
bool Modes<T>::may_be_several(const ExtendedMode& mode) const {
  const Responses<T> responses(base_);
  for (std::size_t c = 0; c < mode.closed.size(); ++c) {
    if (!mode.closed[c] || mode.friction[c] == Slides::None || mode.friction[c] == Slides::Stick) continue;
    if (!mode.begins.empty() && mode.begins[c]) continue;
    std::vector<T> force = point_->normal[c];
    const bool slides = mode.friction[c] == Slides::Slide;
    const T speed = point_->slip_speed(c);
    const T factor = mode.friction[c] == Slides::Backward ? point_->friction[c] : T(-point_->friction[c]);
    for (std::size_t i = 0; i < force.size(); ++i) {
      force[i] += factor * (slides ? T(point_->slip[c] / speed) : T(1)) * point_->tangent[c][i];
      if (slides) force[i] += factor * (point_->second_slip[c] / speed) * point_->second_tangent[c][i];
    }
    if (!(along<T>(point_->normal[c], responses.of(force)) > 0)) return true;
  }
  return false;
}

/// Rows of numbers one after the other, those of constraints first.
template <class T>
class Modes<T>::Rows {
 public:
  explicit Rows(const Modes& modes) {
    const std::size_t n = modes.q_.size(), constraints = modes.base_.program().unknowns - n;
    for (std::size_t k = 0; k < constraints; ++k) {
      std::vector<double> row;
      for (std::size_t i = 0; i < n; ++i) row.push_back(static_cast<double>(modes.base_.constraint_matrix(k, i)));
      static_cast<void>(independent_.add(std::move(row)));
    }
  }
  void add(const std::vector<T>& row) {
    std::vector<double> rounded;
    for (const T& x : row) rounded.push_back(static_cast<double>(x));
    are_dependent_ = !independent_.add(std::move(rounded)) || are_dependent_;
  }
  bool are_dependent() const { return are_dependent_; }

 private:
  IndependentRows independent_;
  bool are_dependent_ = false;
};

/// Whether frictions that stick hold each other, or what constraints hold: rows of normals and slips depend on each
/// other.
template <class T>
bool Modes<T>::holds_undetermined(const ExtendedMode& mode) const {
  const ExtendedContacts& all = problem_.contacts;
  bool holds = false;
  Rows rows(*this);
  for (std::size_t f = 0; f < mode.friction.size(); ++f) {
    if (f < all.count && !mode.closed[f]) continue;
    if (f < all.count) rows.add(point_->normal[f]);
    if (mode.friction[f] != ExtendedMode::Friction::Stick) continue;
    rows.add(point_->tangent[f]);
    if (all.frictions[f].in_space) rows.add(point_->second_tangent[f]);
    holds = holds || !all.frictions[f].sticking;
  }
  return holds && rows.are_dependent();
}

/// More contacts than the motion needs, with friction by their forces.
template <class T>
void Modes<T>::note_indeterminate(const std::vector<std::size_t>& touching) {
  Rows rows(*this);
  bool rubs = false;
  for (const std::size_t c : touching) {
    if (point_->rate[c] > rest_rate(c)) continue;
    rows.add(point_->normal[c]);
    rubs = rubs || (problem_.contacts.frictions[c].present && !problem_.contacts.frictions[c].sticking);
  }
  if (rubs && rows.are_dependent() && out_.undetermined.empty()) out_.undetermined = touching;
}

/// Where one friction begins to slide and another is held, that the other way round would have done as well is told.
template <class T>
void Modes<T>::note_choice(const std::vector<Choice>& list, const ExtendedMode& mode,
                           const std::vector<std::size_t>& touching, const Met& met) {
  const auto is_left = [&](const Choice& c) { return through_modes::holds(met.left, What::Hold, c.index); };
  const auto begins = [&](const Choice& c) {
    return mode.friction[c.index] == Slides::Forward || mode.friction[c.index] == Slides::Backward;
  };
  for (const Choice& slides : list)
    for (const Choice& held : list) {
      if (problem_.contacts.frictions[held.index].in_space) continue;
      if (out_.choice || slides.options.size() < 3 || held.options.size() < 3 || !begins(slides) ||
          mode.friction[held.index] != Slides::Stick || (is_left(slides) && !is_left(held)) ||
          !(may_hold(held) || may_hold(slides)))
        continue;
      for (const Slides way : {Slides::Forward, Slides::Backward}) {
        ExtendedMode other = mode;
        other.friction[slides.index] = Slides::Stick, other.friction[held.index] = way;
        std::vector<T> accelerations;
        if (fits(in_mode(other), touching, met, false, &accelerations) &&
            !gives_way_unforced(list, other, touching, met))
          out_.choice = ExtendedMotion::Choice{held.index, slides.index, stepper().sample(stepper().time()).t};
      }
    }
}

/// At rest, with a static limit beyond the kinetic one: where it holds another motion fits as well, in which it slides.
template <class T>
bool Modes<T>::may_hold(const Choice& c) const {
  return c.options.size() > 2 && !problem_.contacts.frictions[c.index].in_space &&
         point_->fixed[c.index] > point_->friction[c.index];
}

/// Frictions that a mode holds beyond their limits; nothing where it has no motion.
template <class T>
std::optional<std::vector<std::size_t>> Modes<T>::beyond_limits(InMode& candidate,
                                                                const std::vector<std::size_t>& touching,
                                                                const Met& met) {
  if (!candidate.stepper) return std::nullopt;
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
/// one that is written last, so that the first one is held where one can be (ModeChoice::order_by_limits).
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
/// the one that has to give way is another (ModeChoice::gives_way_unforced).
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

/// Whether in one of the modes that are possible more normal force makes a contact close faster.
template <class T>
bool Modes<T>::is_painleve(const std::vector<Choice>& list, Combinations& tries) const {
  constexpr std::size_t most = 256;
  for (std::size_t turn = 0; turn < most; ++turn) {
    const std::vector<std::size_t>* taken = tries.number(turn);
    if (!taken) return false;
    if (may_be_several(mode_of(list, *taken))) return true;
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
  if (!found && unforced) found = unforced, first = std::move(unforced_accelerations), by_leniency = unforced_lenient;
  // Others were begun after it, to see what they would hold.
  if (std::any_of(list.begin(), list.end(), [&](const Choice& c) { return may_hold(c); })) last = nullptr;
  if (found && !last && !out_.choice) note_choice(list, found->mode, touching, met);
  note_indeterminate(touching);
  // Of a rest that is not determined one distribution of forces was tried, be it within the limits or not.
  if (holds_undetermined(found ? found->mode : mode_of(list, std::vector<std::size_t>(list.size(), 0))))
    return stop(StepEnding::Paradox, std::nullopt,
                "Friction holds more than the rest needs here, so that its forces are not determined (statically "
                "indeterminate): with more digits none are sought within its limits, as in double precision.");
  if (!found && bound_ < t_) return stop(StepEnding::Paradox, std::nullopt, through_modes::met_backwards);
  if (!found)
    return stop(StepEnding::Paradox, std::nullopt,
                is_painleve(list, tries)
                    ? "Painlevé's paradox: no finite forces of contact and friction fit the motion here."
                    : "No mode of the contacts and frictions was found that keeps its conditions here.");
  note_accelerations(first);
  if (last != found) static_cast<void>(fits(*found, touching, met, by_leniency, &first));
  const ExtendedMode before = now_->mode;
  now_ = found;
  record_changes(before, found->mode, met.begins);
  return true;
}

}  // namespace maupertuis::extended

#pragma once
#include "disks/unread_switches.hpp"
#include "integrator/taylor/met_roots.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::taylor {

template <class T>
void MetRoots<T>::note(const RootOf<T>& root, std::size_t index, const T& together, int direction) {
  if (found && root.x > x * (1 + together) + together) return;
  if (root.x < x * (1 - together) - together) roots.clear();
  x = std::min(x, root.x);
  found = true;
  is_lost = false;
  roots.push_back({index, direction, root.kind == RootKind::Jump, root.hidden, root.order});
}

template <class T>
void MetRoots<T>::forget(std::size_t index) {
  std::erase_if(roots, [&](const MetRoot<T>& root) { return root.index == index; });
}

template <class T>
void MetRoots<T>::end_where_lost(const T& place) {
  roots.clear();
  found = false;
  is_lost = true;
  x = place;
}

template <class T>
bool MetRoots<T>::holds(std::size_t index) const {
  return std::any_of(roots.begin(), roots.end(), [&](const MetRoot<T>& root) { return root.index == index; });
}

template <class T>
bool Kinks<T>::ends_at_switch(const MetRoots<T>& met) const {
  return met.x > 0 && met.x < 1 && comes_to_switch(met);
}

template <class T>
bool Kinks<T>::comes_to_switch(const MetRoots<T>& met) const {
  return std::any_of(met.roots.begin(), met.roots.end(),
                     [&](const MetRoot<T>& root) { return root.index < switches_ && !root.is_jump; });
}

template <class T>
bool Kinks<T>::has_kink(std::size_t event, const MetRoots<T>& met) {
  if (reads_[event].empty()) reads_[event] = switches_read_by(*program_, program_->events[event]);
  return std::any_of(met.roots.begin(), met.roots.end(),
                     [&](const MetRoot<T>& root) { return root.index < switches_ && reads_[event][root.index]; });
}

template <class T>
bool Kinks<T>::ends_by_event(const MetRoots<T>& met) {
  return std::any_of(met.roots.begin(), met.roots.end(), [&](const MetRoot<T>& root) {
    if (root.index < switches_) return false;
    const std::size_t event = root.index - switches_;
    return !(tells_touches(event) && has_kink(event, met));
  });
}

template <class T>
void Kinks<T>::stay_at_zeros(std::span<const Watched> before, const T& together, MetRoots<T>& met) const {
  for (std::size_t event = 0; event < before.size(); ++event) {
    if (!stays_at_zero(before[event], met, together)) continue;
    met.forget(switches_ + event);
    met.after[switches_ + event] = before[event].is_open ? before[event] : Watched{0, true, before[event].order};
  }
}

/// Events that end the step and come to zero where a switch changes. A zero that the step begins at, and that rounding
/// does not tell from the switch, was met: the next step begins at it as well.
template <class T>
void Kinks<T>::leave_open(RootSearchOf<T>& search, std::span<const Watched> before, const T& h, const T& together,
                          MetRoots<T>& met) {
  stay_at_zeros(before, together, met);
  if (!ends_at_switch(met) || ends_by_event(met)) return;
  const std::vector<bool> vanishes = search.vanishing_at(met.x);
  for (std::size_t event = 0; event < before.size(); ++event) {
    const std::size_t i = switches_ + event;
    if (!ends_step(event) || !tells_touches(event) || stays_at_zero(before[event], met, together)) continue;
    if (!met.holds(i) && !vanishes[i]) continue;
    const RootOf<T> zero = search.zero_at(i, met.x);
    const bool was_met = before[event].at_zero && !before[event].is_open && zero.hidden >= met.x;
    met.after[i] = was_met ? Watched{0, true, zero.order} : left_open(met.after[i].side, zero, h);
    met.forget(i);
  }
}

template <class T>
Watched left_open(std::int8_t side, const RootOf<T>& zero, const T& h) {
  using std::abs;
  const double hidden = zero.order > 2 ? static_cast<double>(zero.hidden * abs(h)) : 0;
  return {side, true, zero.order, side != 0, hidden};
}

template <class T>
LeavesZero leaves_zero(const ScaledPolynomialOf<T>& polynomial, std::uint8_t order) {
  using std::abs, std::pow;
  const T epsilon = std::numeric_limits<T>::epsilon();
  for (T x = std::max(T(pow(epsilon, T(0.77))), T(4 * pow(epsilon, T(1) / order))); x < 1; x *= 2) {
    T sum = T(0), largest = T(0), power = x;
    LeavesZero out{0, 0};
    for (std::size_t k = 1; k < polynomial.p.size(); ++k, power *= x) {
      const T term = polynomial.p[k] * power;
      sum += term;
      if (abs(term) > largest) largest = abs(term), out = {watching::sign(term), static_cast<std::uint8_t>(k)};
    }
    if (abs(sum) > watching::unit<T>() * polynomial.scale && watching::sign(sum) == out.side) return out;
  }
  return {polynomial.direction(order), order};
}

template <class Work, class T>
std::optional<int> root_at_begin(const Work& work, std::size_t event, const std::type_identity_t<T>& h,
                                 Watched& watched) {
  using std::abs;
  const Watched before = watched;
  watched.is_open = false;
  const T here = work.event(event, 0);
  watched.at_zero = watched.at_zero || watching::is_zero(here, T(work.event_scale(event)));
  watched.side = watching::sign(here);
  if (!watched.at_zero && (before.side == 0 || watched.side != -before.side)) return std::nullopt;
  const ScaledPolynomialOf<T> whole = event_polynomial(work, event, h), polynomial = judged(whole);
  if (watched.at_zero && (before.is_open || watched.order > 1)) {
    const LeavesZero leaves = leaves_zero(whole, watched.order);
    watched.side = leaves.side, watched.order = leaves.order;
  } else if (watched.at_zero) {
    watched.side = polynomial.direction(watched.order);
  }
  // What comes from one side to a zero that was left open goes back to it, or on to the other, or stays at zero.
  if (before.is_open) return watched.side == before.side ? 0 : -before.side;
  constexpr double close = 1e-6;  // beyond, the sign has changed by a jump
  const bool is_past = before.side != 0 && watched.side == -before.side;
  if (!is_past || !(abs(polynomial.p[0]) <= T(close) * polynomial.reach)) return std::nullopt;
  return watched.side;
}

}  // namespace maupertuis::taylor

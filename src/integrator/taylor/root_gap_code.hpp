#pragma once
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// Points, and stretches, at which a function along a step has no series: poles, cuts, borders of its domain.
namespace maupertuis::taylor {

template <class T>
bool RootSearchOf<T>::has_value(std::size_t index, const T& x) {
  const T here = value(index, x);
  return here == here;
}

/// The border of the domain of a function, on the side where it has a value.
template <class T>
T RootSearchOf<T>::border(std::size_t index, T without, T with) {
  for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
    const T middle = T(0.5) * (without + with);
    if (middle == without || middle == with) break;
    (has_value(index, middle) ? with : without) = middle;
  }
  return with;
}

/// The first place, of those looked at, where a function is analytic again, or where it has a value as it had none at
/// the place before; `until` where there is none.
template <class T>
typename RootSearchOf<T>::Beyond RootSearchOf<T>::analytic_beyond(std::size_t index, const T& x, const T& until) {
  const T widest = T(1) / T(32);  // of the step, from one place to the next
  Beyond at{x, until};
  for (T width = resolution_; at.last + width < until; width = std::min(T(2 * width), widest)) {
    const T place = at.last + width;
    if (has_value(index, place) &&
        (!has_value(index, at.last) || piece(index, place, std::min(T(place - x), T(until - place))).width > 0))
      return {at.last, place};
    at.last = place;
  }
  return at;
}

/// The change of sign from `side` at `low` to the other at `high`, beyond which the function is analytic from `end` on.
template <class T>
std::optional<RootOf<T>> RootSearchOf<T>::change_of_sign(std::size_t index, T low, T high, std::int8_t side,
                                                         const T& end) {
  using std::abs;
  T at_low = abs(value(index, low)), at_high = abs(value(index, high));
  const T before = std::max(at_low, at_high);
  for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
    const T middle = T(0.5) * (low + high);
    if (!(low < middle && middle < high)) break;
    const T there = value(index, middle);
    (watching::sign(there) == side ? low : high) = middle;
    (watching::sign(there) == side ? at_low : at_high) = abs(there);
  }
  // A zero gets smaller on both sides, a jump does not.
  const bool is_zero = std::max(at_low, at_high) <= T(0.5) * before || std::max(at_low, at_high) == 0;
  if (is_zero) {
    RootOf<T> found = told_by_values(index, high, T(0));
    found.kind = RootKind::Crossing;
    if (!(found.hidden > resolution_)) found.hidden = T(0);
    return found;
  }
  // The motion goes on from where the function has a value with its new sign; at a pole itself it has none.
  const auto is_beyond = [&](const T& x) {
    const T there = value(index, x);
    return abs(there) <= std::numeric_limits<T>::max() && watching::sign(there) == -side;
  };
  T place = high;
  for (T width = std::numeric_limits<T>::epsilon() * high; place < end && !is_beyond(place); width *= 2)
    place = std::min(end, T(high + width));
  return RootOf<T>{place, RootKind::Jump, static_cast<std::int8_t>(-side)};
}

/// Looks for the other side of a point, or of a stretch, where the function is not analytic, and for what its sign does
/// there.
template <class T>
typename RootSearchOf<T>::Gap RootSearchOf<T>::gap(std::size_t index, const T& x, const T& until, std::int8_t side) {
  Gap result{until, side, std::nullopt};
  const auto sign_at = [&](const T& at) { return watching::sign(value(index, at)); };
  const Beyond beyond = analytic_beyond(index, x, until);
  result.end = beyond.place;
  const bool ends_with_value = has_value(index, result.end);
  if (!ends_with_value || !has_value(index, beyond.last)) {  // it has none for a while
    const T without = ends_with_value ? beyond.last : result.end;
    if (ends_with_value) result.end = analytic_beyond(index, border(index, without, result.end), until).place;
    result.side = sign_at(result.end);
    if (has_value(index, x))
      result.root = RootOf<T>{std::min(until, T(border(index, without, x) + 2 * resolution_)), RootKind::Jump, 0};
    else if (result.side != 0)
      result.root = RootOf<T>{result.end, RootKind::Jump, result.side};
    return result;
  }
  constexpr double point = 1e-6;  // of the step
  result.is_point = result.end - x <= std::max(T(point), T(1024 * resolution_));
  result.side = sign_at(result.end);
  if (side != 0 && result.side != 0 && result.side != side)
    result.root = change_of_sign(index, x, result.end, side, result.end);
  return result;
}

}  // namespace maupertuis::taylor

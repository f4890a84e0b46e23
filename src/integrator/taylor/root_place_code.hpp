#pragma once
#include "integrator/taylor/hidden_root.hpp"
#include "integrator/taylor/roots.hpp"
#include "integrator/taylor/switches_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// Where a root of a function along a step is, and of what kind, by the values of the function about it.
namespace maupertuis::taylor {

/// Secants on the function itself, whose digits near the root are its own and not those of the polynomial.
template <class T>
T RootSearchOf<T>::refined(std::size_t index, const Piece& piece, const T& begin, const T& root) {
  using std::abs;
  const auto& p = piece.polynomial.p;
  T slope = T(0);
  for (std::size_t k = p.size(); k-- > 1;) slope = slope * root + T(k) * p[k];
  T x = begin + piece.width * root;
  if (slope == 0 || (ends_[index] && is_rough_[index])) return x;
  T there = at_a_time(x), off = value(index, there);
  for (int turn = 0; turn < 2; ++turn) {
    const T change = off / slope * piece.width;
    if (!(abs(change) <= T(1e-6) * piece.width)) break;
    const T next = there - change, next_there = at_a_time(next), next_off = value(index, next_there);
    if (!(abs(next_off) <= abs(off))) break;  // next to another root the slope says nothing
    x = next, there = next_there, off = next_off;
  }
  return std::clamp(x, begin, T(begin + piece.width));
}

/// Of a root of higher order with the stretch about it that rounding does not tell from zero, in the middle of its
/// change of sign.
template <class T>
RootOf<T> RootSearchOf<T>::crossing_at(std::size_t index, const Piece& piece, const T& begin, const T& root) {
  using std::abs;
  constexpr double narrow = 1e-9;  // of the piece
  RootOf<T> found{refined(index, piece, begin, root), RootKind::Crossing};
  if (hidden_by_slope(piece.polynomial, root) <= T(narrow)) return found;
  const HiddenRoot<T> hidden = hidden_about(piece.polynomial, root);
  if (hidden.order == 1) return found;
  RootOf<T> beside = told_by_values(index, found.x, T(piece.width * hidden.half_width()));
  if (beside.kind == RootKind::Crossing) {
    found.x = sign_change(index, T(found.x - beside.hidden), T(found.x + beside.hidden));
    beside = told_by_values(index, found.x, T(0));
    found.hidden = beside.hidden;
  } else {
    found.hidden = beside.hidden + abs(begin + piece.width * hidden.middle() - found.x);
  }
  found.order = std::max(hidden.order, beside.order);
  return found;
}

/// Halved to the last digit.
template <class T>
T RootSearchOf<T>::sign_change(std::size_t index, T low, T high) {
  const std::int8_t side = watching::sign(value(index, low));
  for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
    const T middle = T(0.5) * (low + high);
    if (!(low < middle && middle < high)) break;
    (watching::sign(value(index, middle)) == side ? low : high) = middle;
  }
  return high;
}

/// The side of the function there, 0 where rounding hides it.
template <class T>
std::int8_t RootSearchOf<T>::told_side(std::size_t index, const T& x) {
  using std::abs;
  constexpr int clear = 4;  // rounding errors
  const T here = value(index, x), terms = watching::unit<T>() * retrace_.scale(slots_[index]);
  const bool is_told = abs(here) > T(clear) * terms && abs(here) > T(clear) * rounding_at(index, x);
  return is_told ? watching::sign(here) : std::int8_t{0};
}

/// Down from x, by steps that double until it goes up again, and from there by the golden section.
template <class T>
typename RootSearchOf<T>::Lowest RootSearchOf<T>::lowest_about(std::size_t index, std::int8_t side, const T& x,
                                                               T step) {
  const auto height = [&](const T& at) { return side * value(index, at); };
  const T golden = T(0.381966011250105151795413165634);
  T middle = x, at_middle = height(middle);
  const bool goes_left = height(x - step) < height(x + step);
  if (goes_left) step = -step;
  T low = middle - step, high = middle + step;
  for (int turn = 0; turn < 60; ++turn) {
    const T there = height(high);
    if (there < 0 && told_side(index, high) == -side) return {middle, true};
    if (!(there < at_middle)) break;
    low = middle, middle = high, at_middle = there, step *= 2, high = middle + step;
  }
  for (int turn = 0; turn < 2 * std::numeric_limits<T>::digits; ++turn) {
    using std::abs;
    if (!(abs(high - low) > resolution_)) break;
    const bool is_far = abs(high - middle) > abs(middle - low);
    const T next = middle + golden * ((is_far ? high : low) - middle), there = height(next);
    if (there < 0 && told_side(index, next) == -side) return {middle, true};
    if (there < at_middle) {
      (is_far ? low : high) = middle;
      middle = next, at_middle = there;
    } else {
      (is_far ? high : low) = next;
    }
  }
  return {middle, false};
}

/// Whether a function that is lowest at x does not come to zero there: its value is more than rounding, and more than
/// what it changes by within the places that rounding does not tell from x, as (x − 1)⁴ does by a multiple.
template <class T>
bool RootSearchOf<T>::stays_clear_of_zero(std::size_t index, std::int8_t side, const T& x) {
  using std::abs;
  constexpr int beside = 8;  // roundings of the place
  if (told_side(index, x) != side) return false;
  const T here = value(index, x), left = value(index, T(x - beside * resolution_)),
          right = value(index, T(x + beside * resolution_));
  return abs(here) > std::max(abs(left - here), abs(right - here));
}

/// Where the slope vanishes, by the same rule, unless the values tell it better: those of (x − 1)⁸ do, whose
/// polynomial is not told from zero over a hundredth of its piece. Nothing where they stay clear of zero, or lead
/// through it, which the search for crossings finds.
template <class T>
std::optional<RootOf<T>> RootSearchOf<T>::touch_at(std::size_t index, const Piece& piece, const T& begin, const T& root,
                                                   std::int8_t side) {
  const HiddenRoot<T> hidden = hidden_about(slope_of(piece.polynomial), root);
  RootOf<T> found{T(begin + piece.width * root), RootKind::Touching, 0, 2, T(0)};
  if (hidden.order > 1 || told_side(index, found.x) != 0) {
    constexpr double first = 1e-3;  // of the piece: over less, values next to zero differ by rounding
    const T step = std::max(resolution_, T(piece.width * std::max(T(first), hidden.half_width())));
    const Lowest lowest = lowest_about(index, side, T(begin + piece.width * hidden.middle()), step);
    if (lowest.is_crossed || stays_clear_of_zero(index, side, lowest.x)) return std::nullopt;
    found.x = lowest.x;
  }
  const RootOf<T> beside = told_by_values(index, found.x, T(0));
  if (beside.kind == RootKind::Crossing) return beside;
  if (beside.order <= 2) return found;
  found.order = static_cast<std::uint8_t>(beside.order + beside.order % 2);
  found.hidden = beside.hidden;
  return found;
}

/// What the values on both sides say of a root: hidden as far as they are rounding of their terms, of the order by
/// which they grow beyond, and crossed where their signs differ there.
template <class T>
RootOf<T> RootSearchOf<T>::told_by_values(std::size_t index, const T& root, const T& least) {
  using std::abs;
  constexpr double widest = 0.03;  // of the step
  RootOf<T> out{root, RootKind::Touching, 0, 1, std::max(resolution_, least)};
  const auto side_at = [&](const T& x) { return told_side(index, x); };
  int before = side_at(root - out.hidden), after = side_at(root + out.hidden);
  while (before * after == 0 && out.hidden < T(widest)) {
    out.hidden *= 2;
    before = side_at(root - out.hidden), after = side_at(root + out.hidden);
  }
  if (before * after < 0) out.kind = RootKind::Crossing;
  const T ratio = value(index, root + 4 * out.hidden) / value(index, root + 2 * out.hidden);
  constexpr double most = 63;
  if (abs(ratio) > 1)
    out.order =
        static_cast<std::uint8_t>(std::clamp(std::round(std::log2(static_cast<double>(abs(ratio)))), 1.0, most));
  return out;
}

}  // namespace maupertuis::taylor
